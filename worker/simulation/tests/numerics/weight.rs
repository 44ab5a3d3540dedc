//! Tests of the weight of beam, connecting rods and crossbeam.
use simulation::drive::Drive;
use simulation::effect::Cycle;
use simulation::model::{Machine, RopeMachine, description::Description};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunSettings, settle, simulate};
use simulation::system::{Equations as _, State, StateRef, StateShift, System};

/// Moment of the beam's weight at beam angle 0: weight times horizontal distance of the centre of mass from
/// the pivot, towards the well \[N m\]; `UP` is weight times its height above the pivot.
const ACROSS: f64 = 9.0e3;
const UP: f64 = 4.0e4;

/// Builds the reference machine with the given moments of the beam's weight (horizontal, vertical) \[N m\].
fn machine([across, up]: [f64; 2]) -> Machine {
    let description = Description {
        beam_gravity_moment: across,
        beam_gravity_height: up,
        ..reference::description()
    };
    Machine::new(description, 2).unwrap()
}

/// Returns the generalised forces at rest, the diagonal stiffness of the beam's coordinate, and the energy.
fn at_rest(system: &mut System<RopeMachine<'_>>, q: &[f64], beam: usize) -> (Vec<f64>, f64, f64) {
    let still = vec![0.0; q.len()];
    let mut force = still.clone();
    let mut matrix = system.equations.matrix();
    let mut loads = system.forces(StateRef::new(0.0, q, &still), &mut force);
    loads.tangent(StateShift::NONE, &mut matrix);
    let mut unit = still;
    unit[beam] = 1.0;
    let stiffness = matrix.product(&unit)[beam];
    let rest = State::at_rest(0.0, q.to_vec());
    (force, stiffness, system.equations.energy(&rest))
}

/// Checks that a mass on the beam acts as a pendulum: at beam angle `theta` it stands `x sin theta + y cos
/// theta` above the pivot; weight times this height is the energy, its slope a torque, its curvature a
/// stiffness. No other coordinate is affected, and the machine still finds its equilibrium.
#[test]
fn a_heavy_beam_is_a_pendulum() {
    let (plain, heavy) = (machine([0.0, 0.0]), machine([ACROSS, UP]));
    let settings = RunSettings::default();
    let law = reference::law();
    let mut angles = Vec::new();
    for turn in [0.4, 2.4, 4.4] {
        let drive = Drive {
            start: -turn,
            ramp: settings.ramp,
            speed: plain.description.crank.speed,
        };
        let system = |machine| {
            System::new(RopeMachine::new(
                machine,
                Machine::ropes(machine, &law),
                drive,
            ))
        };
        let (mut light, mut loaded) = (system(&plain), system(&heavy));
        let q = settle(&mut light, &settings, None).unwrap();
        let beam = plain.layout.beam();
        let theta: f64 = q[beam];
        let (force, stiffness, energy) = at_rest(&mut light, &q, beam);
        let (more, stiffer, higher) = at_rest(&mut loaded, &q, beam);
        let height = ACROSS * theta.sin() + UP * theta.cos();
        let torque = -(ACROSS * theta.cos() - UP * theta.sin());
        assert!(
            (higher - energy - height).abs() < 1e-6,
            "{theta}: {}",
            higher - energy
        );
        assert!((more[beam] - force[beam] - torque).abs() < 1e-6, "{theta}");
        let curvature = -height;
        assert!(
            (stiffer - stiffness - curvature).abs() < 1e-9 * stiffness.abs(),
            "{theta}: {stiffness} {stiffer}"
        );
        for (i, (more, force)) in more.iter().zip(&force).enumerate() {
            assert!(
                i == beam || more.to_bits() == force.to_bits(),
                "coordinate {i}"
            );
        }
        let rest = settle(&mut loaded, &settings, None).unwrap();
        assert!((rest[beam] - theta).abs() < 0.01, "{} {theta}", rest[beam]);
        angles.push(theta);
    }
    let wide = angles.iter().any(|a| *a < -0.3) && angles.iter().any(|a| *a > 0.2);
    assert!(
        wide,
        "the angles do not tell sines from cosines: {angles:?}"
    );
}

/// Returns the cosine and sine amplitude of the first order of a curve over one turn.
fn first_order(curve: &[f64]) -> [f64; 2] {
    let step = std::f64::consts::TAU / curve.len() as f64;
    let sum = |of: fn(f64) -> f64| -> f64 {
        let each = curve.iter().enumerate();
        each.map(|(k, value)| value * of(step * k as f64)).sum()
    };
    [libm::cos as fn(f64) -> f64, libm::sin].map(|of| 2.0 / curve.len() as f64 * sum(of))
}

/// Checks that the net torque of the ideal mechanism has the first order of that of a simulated revolution, in
/// which counterweight and load nearly cancel: rods and crossbeam of 450 kg alone have 4.8 kN.m. The rest of the
/// tolerance is that of elastic ropes, which sink into the heads.
#[test]
fn the_ideal_mechanism_lifts_rods_and_crossbeam() {
    let description = reference::description();
    let ideal = Cycle::of(&description).unwrap();
    let moment = description.crank.counterweight_moment;
    let machine = Machine::new(description, 2).unwrap();
    let mut recorder = Recorder::everything(0);
    simulate(
        &machine,
        &reference::law(),
        &RunSettings::default(),
        &mut recorder,
    );
    let simulated = &recorder.curves.torque;
    let step = std::f64::consts::TAU / simulated.len() as f64;
    let expected: Vec<f64> = (0..simulated.len())
        .map(|k| ideal.torque(step * k as f64, 0.0, moment))
        .collect();
    let [ours, theirs] = [simulated, &expected].map(|curve| first_order(curve));
    for (simulated, ideal) in ours.iter().zip(theirs) {
        assert!((simulated - ideal).abs() < 2.5e3, "{ours:?} {theirs:?}");
    }
}
