//! The machine at rest at several crank angles: in equilibrium, and its gauges as statics have them.
use super::{case, individuals};
use coordinator::{case::QuasiStatic, study};
use simulation::{
    drive::Drive,
    integrator::State,
    model::{Individual, Machine, description::RopeLaw},
    observe::gauge_stress,
    run::{RunSettings, settle},
    system::System,
};
use std::f64::consts::TAU;

/// Crank angles before bottom dead centre \[rad\].
const TURNS: [f64; 6] = [0.4, 1.4, 2.4, 3.4, 4.4, 5.4];

/// The machine at rest with its crank `turn` before bottom dead centre.
fn at_rest<'a>(
    machine: &'a Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    turn: f64,
) -> (System<Individual<'a>>, State) {
    let drive = Drive {
        start: -turn,
        ramp: settings.ramp,
        speed: machine.description.crank.speed,
    };
    let mut system = System::new(Individual::new(machine, machine.ropes(law), drive));
    let q = settle(&mut system, settings, None).unwrap();
    (system, State::at_rest(0.0, q))
}

/// Mode acceleration is exact statics: with the machine at rest, whatever six modes miss, the gauges
/// read the influence lines of a rope that wraps the arc under the tension that it has there, and the
/// head's own weight. The chain presses with its cylinders, lifts off gradually and stretches, so that
/// the two agree to 2 % of the largest reading, where modes alone are off by a third of it.
#[test]
fn gauges_at_rest_read_exact_statics() {
    let case = case();
    let machine = worker::convert::machine(&case, 0).unwrap();
    let settings = worker::convert::run_settings(&case);
    let mechanism = machine.mechanism(machine.description.back_arc.radius, machine.back_length());
    for (name, genes) in individuals(&case) {
        let law = worker::convert::rope_law(&case, &genes).unwrap();
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for turn in TURNS {
            let (mut system, mut state) = at_rest(&machine, &law, &settings, turn);
            let mut force = vec![0.0; state.q.len()];
            system.forces(0.0, &state.q, &state.v, &mut force);
            state.a.fill(0.0);
            let read = gauge_stress(&system.equations, &state);
            let mut at = machine.bottom;
            for k in 1..=100 {
                let pin = machine.bottom.pin + turn * f64::from(k) / 100.0;
                at = mechanism.position(pin, at.beam, at.tangent).unwrap();
            }
            let quasi_static = QuasiStatic {
                turn_deg: vec![(TAU - turn).to_degrees()],
                contact_deg: vec![at.tangent.to_degrees()],
                tension_n: vec![system.equations.base_tensions(0).sum()],
            };
            let wrapped = study::wrapped_turn(&quasi_static, case.back_head.rope_anchor_deg);
            let rope = wrapped.exact(&case.modal_head.influence);
            let (s, c) = state.q[machine.layout.beam()].sin_cos();
            let [x, y, _] = case.modal_head.inertia_stress_mpa;
            let g = machine.description.gravity;
            for gauge in 0..4 {
                let exact = rope[gauge][0] + g * (s * x[gauge] + c * y[gauge]);
                worst = worst.max((1e-6 * read[gauge] - exact).abs());
                largest = largest.max(exact.abs());
            }
        }
        eprintln!("{name}: {worst:.2} MPa of {largest:.1} MPa");
        assert!(worst < 0.02 * largest, "{name}: {worst} of {largest}");
    }
}

/// A run starts from equilibrium: nothing accelerates there, and the beam a tenth of a milliradian
/// beside it does, ten thousand times as much.
#[test]
fn a_run_starts_at_rest() {
    let case = case();
    let machine = worker::convert::machine(&case, 0).unwrap();
    let settings = worker::convert::run_settings(&case);
    let beam = machine.layout.beam();
    for (name, genes) in individuals(&case) {
        let law = worker::convert::rope_law(&case, &genes).unwrap();
        for turn in TURNS {
            let (mut system, mut state) = at_rest(&machine, &law, &settings, turn);
            let mut accelerated = |q: &[f64]| {
                system
                    .accelerations(0.0, q, &state.v, &mut state.a)
                    .unwrap();
                state.a[beam].abs()
            };
            let rest = accelerated(&state.q);
            let mut beside = state.q.clone();
            beside[beam] += 1e-4;
            let displaced = accelerated(&beside);
            eprintln!("{name} at {turn}: {rest:.1e} rad/s2, displaced {displaced:.1e} rad/s2");
            assert!(rest < 1e-4 * displaced, "{name} at {turn}: {rest}");
        }
    }
}
