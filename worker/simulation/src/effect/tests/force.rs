//! Tests of the forces of every effect against finite differences: the tangent, and the potential at rest.
use super::contract::typical;
use crate::drive::Drive;
use crate::effect::{Descriptor, EffectRequest, Selection, catalogue};
use crate::model::contact::Surface;
use crate::model::tests::{assert_plane_is_space, disturbed, free, unit};
use crate::model::{Machine, RopeMachine};
use crate::reference;
use crate::run::RunSettings;
use crate::system::{StateRef, StateShift, System};

/// Builds the reference machine with one effect at its typical size; `None` if the effect changes neither
/// forces nor surfaces.
fn machine(d: &'static Descriptor) -> Option<Machine> {
    let selection = Selection::new(&[typical(d)]).unwrap();
    let machine = Machine::with_effects(reference::description(), 2, selection.effects()).unwrap();
    let acts = !machine.extensions.is_empty() || machine.extensions.profile().is_some();
    acts.then_some(machine)
}

fn individual(machine: &Machine, turning: bool) -> System<RopeMachine<'_>> {
    let mut law = reference::law();
    if !turning {
        // torsion and bending must be equal for an exact potential out of plane
        law.bushing.rotational_stiffness = [308.0; 2];
    }
    let drive = Drive {
        start: 1.0,
        ramp: if turning { 1e-3 } else { 1e3 },
        speed: 0.5,
    };
    System::new(RopeMachine::new(machine, machine.ropes(&law), drive))
}

/// Checks the tangent in a disturbed, moving state in which friction is about to reverse and laws with memory
/// have a history.
#[test]
fn tangent_is_the_derivative_of_the_forces() {
    let mut checked = 0;
    for d in catalogue() {
        let Some(machine) = machine(d) else { continue };
        checked += 1;
        let allowed = if d.generic { 1e-5 } else { 2e-6 };
        let layout = machine.layout;
        let n = layout.len();
        let (q, mut v) = disturbed(&machine);
        (v[layout.beam()], v[layout.suspension()]) = (1.5e-3, -4e-3);
        let mut at = individual(&machine, true);
        let mut force = vec![0.0; n];
        let before = crate::system::State {
            q: q.iter()
                .enumerate()
                .map(|(i, q)| q + 1e-5 * (i % 7) as f64)
                .collect(),
            ..crate::system::State::at_rest(0.6, vec![0.0; n])
        };
        at.equations.update_memory(&before);
        let t = 0.7;
        for gamma in [0.0, 40.0] {
            let mut matrix = layout.matrix();
            let shift = StateShift {
                mass: 0.0,
                damping: gamma,
            };
            let state = StateRef { t, q: &q, v: &v };
            at.forces(state, &mut force).tangent(shift, &mut matrix);
            for i in free(&machine) {
                let column = matrix.product(&unit(n, i));
                let mut step = |h: f64| {
                    let (mut q, mut v) = (q.clone(), v.clone());
                    q[i] += h;
                    v[i] += gamma * h;
                    at.forces(StateRef { t, q: &q, v: &v }, &mut force);
                    force.clone()
                };
                let h = 1e-7;
                let (plus, minus) = (step(h), step(-h));
                let scale = column.iter().map(|x| x.abs()).fold(0.0, f64::max);
                for r in 0..n {
                    let expected = (minus[r] - plus[r]) / (2.0 * h);
                    // forces of 3e5 N are rounded to 1e-10 N, and divided by 2e-7; a cube of strains far
                    // beyond those of a run bends within the step
                    assert!(
                        (expected - column[r]).abs() < allowed * scale + 1e-3,
                        "{} gamma {gamma} row {} column {}: {expected} {}",
                        d.id,
                        layout.describe(r),
                        layout.describe(i),
                        column[r]
                    );
                }
            }
        }
    }
    assert!(checked > 100, "{checked}");
}

/// Checks that at rest every force is the negative gradient of the potential that the equilibrium solver
/// minimises.
#[test]
fn forces_at_rest_are_the_gradient_of_the_potential() {
    for d in catalogue() {
        let Some(machine) = machine(d) else { continue };
        let layout = machine.layout;
        let n = layout.len();
        let (q, _) = disturbed(&machine);
        let still = vec![0.0; n];
        let mut at = individual(&machine, false);
        let mut force = vec![0.0; n];
        at.forces(StateRef::new(0.0, &q, &still), &mut force);
        let expected = force.clone();
        let scale = expected.iter().map(|x| x.abs()).fold(0.0, f64::max);
        for i in free(&machine) {
            let mut potential = |h: f64| {
                let mut q = q.clone();
                q[i] += h;
                let rest = StateRef::new(0.0, &q, &still);
                at.forces(rest, &mut force).potential()
            };
            let h = 1e-6;
            let numeric = (potential(-h) - potential(h)) / (2.0 * h);
            assert!(
                (numeric - expected[i]).abs() < 1e-6 * scale,
                "{} {}: {numeric} {}",
                d.id,
                layout.describe(i),
                expected[i]
            );
        }
    }
}

/// Checks that every effect gives equal results in the planar and the spatial model.
#[test]
fn plane_and_space_agree() {
    for d in catalogue() {
        if let Some(machine) = machine(d) {
            assert_plane_is_space(&machine, &d.id);
        }
    }
}

/// Checks that contact is still detected on a head surface that an effect raises by more than the head itself
/// can deflect.
#[test]
fn nothing_of_a_raised_surface_lies_out_of_reach() {
    for (id, parameter, value) in [
        ("head_profile_wear", "depth", -0.02),
        ("post_compliance", "compliance", 3e-7),
    ] {
        let asked = EffectRequest {
            id,
            parameters: vec![(parameter, value)],
        };
        let selection = Selection::new(&[asked]).unwrap();
        let machine =
            Machine::with_effects(reference::description(), 2, selection.effects()).unwrap();
        let mut system = individual(&machine, true);
        let q = crate::run::settle(&mut system, &RunSettings::default(), None).unwrap();
        let v = vec![0.0; q.len()];
        let scratch = &mut system.equations.scratch;
        machine.pose(&q, &v, scratch);
        let surface = machine.surface(0, &q, &v, &scratch.deflection);
        let bend = surface.bend.unwrap();
        let arc = &machine.description.back_arc;
        let highest = (0..400).fold(0.0_f64, |highest, k| {
            let angle = arc.anchor - arc.sense * 0.005 * f64::from(k);
            let deflected = bend.sum.at(bend.shapes, &bend.shapes.place(angle)).0.value;
            let height = surface.profile.map_or(0.0, |p| p.height(angle)[0]);
            highest.max(deflected + height)
        });
        let own = Surface::new(arc, surface.beam, None).reach - arc.radius;
        let reach = surface.reach - arc.radius;
        assert!(highest > own && highest < reach, "{id}: {highest} {reach}");
    }
}
