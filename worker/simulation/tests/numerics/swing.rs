//! Tests of the beam's natural frequency on its ropes, which limits the time step.
use simulation::drive::Drive;
use simulation::linear::Bordered;
use simulation::model::description::RopeLaw;
use simulation::model::{Machine, RopeMachine};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunSettings, settle, simulate};
use simulation::settle::swing_rate;
use simulation::system::{Equations, StateRef, StateShift, System};

fn machine() -> Machine {
    Machine::new(reference::description(), 2).unwrap()
}

/// Returns the reference rope law with its axial stiffness multiplied by `factor`.
fn stretched(factor: f64) -> RopeLaw {
    let mut law = reference::law();
    law.bushing.stiffness[0] *= factor;
    law
}

fn settled<'a>(machine: &'a Machine, law: &RopeLaw) -> (System<RopeMachine<'a>>, Vec<f64>) {
    let settings = RunSettings::default();
    let drive = Drive {
        start: -settings.lead_in,
        ramp: settings.ramp,
        speed: machine.description.crank.speed,
    };
    let mut system = System::new(RopeMachine::new(machine, machine.ropes(law), drive));
    let q = settle(&mut system, &settings, None).unwrap();
    (system, q)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Computes the product of the mass matrix with a vector, `M x`.
fn momentum(system: &System<RopeMachine<'_>>, q: &[f64], x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    system.equations.subtract_inertia(q, x, &mut out);
    out.iter().map(|x| -x).collect()
}

/// Returns a machine's static tangent stiffness matrix, not factorised.
fn stiffness(system: &mut System<RopeMachine<'_>>, q: &[f64]) -> Bordered {
    let still = vec![0.0; q.len()];
    let mut force = still.clone();
    let mut matrix = system.equations.matrix();
    let mut loads = system.forces(StateRef::new(0.0, q, &still), &mut force);
    loads.tangent(StateShift::NONE, &mut matrix);
    matrix
}

/// Checks that the swing rate is the Rayleigh quotient (strain energy over kinetic energy) of the shape into
/// which the beam's own inertia deflects the machine.
#[test]
fn the_rate_is_the_rayleigh_quotient_of_the_beams_deflection() {
    let machine = machine();
    for factor in [0.1, 1.0] {
        let (mut system, q) = settled(&machine, &stretched(factor));
        let rate = swing_rate(&mut system, &q).unwrap();
        let matrix = stiffness(&mut system, &q);
        let mut unit = vec![0.0; q.len()];
        unit[machine.layout.beam()] = 1.0;
        let mut shape = momentum(&system, &q, &unit);
        let mut factors = matrix.clone();
        factors.factorize().unwrap();
        factors.solve(&mut shape);
        let strain = dot(&shape, &matrix.product(&shape));
        let kinetic = dot(&shape, &momentum(&system, &q, &shape));
        let expected = (strain / kinetic).sqrt();
        assert!(
            (rate / expected - 1.0).abs() < 1e-6,
            "{factor}: {rate} {expected}"
        );
    }
}

/// Checks that ropes ten times softer lower the swing rate, at most by the square root of ten, since other
/// parts deform too.
#[test]
fn softer_ropes_swing_slower() {
    let machine = machine();
    let [soft, stiff] = [0.1, 1.0].map(|factor| {
        let (mut system, q) = settled(&machine, &stretched(factor));
        swing_rate(&mut system, &q).unwrap()
    });
    let ratio = stiff / soft;
    assert!((1.3..3.2).contains(&ratio), "{ratio}");
}

/// Checks that the time steps shrink in inverse proportion to the swing rate where the beam swings faster
/// than the settings permit, and are unchanged elsewhere.
#[test]
fn steps_are_cut_to_the_swing() {
    let machine = machine();
    let law = reference::law();
    let (mut system, q) = settled(&machine, &law);
    let rate = swing_rate(&mut system, &q).unwrap();
    let steps = |slow_swing: f64| {
        let settings = RunSettings {
            slow_swing,
            samples: 12,
            ..RunSettings::default()
        };
        let run = simulate(&machine, &law, &settings, &mut Recorder::gauges_only());
        run.statistics.steps as f64
    };
    let (never, just, half) = (steps(f64::INFINITY), steps(rate), steps(0.5 * rate));
    assert!((just - never).abs() < 0.5, "{just} {never}");
    assert!((1.6..2.2).contains(&(half / never)), "{half} {never}");
}
