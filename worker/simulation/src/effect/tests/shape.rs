//! Test that no shape parameter merely scales a size's contribution, computed from what each effect changes
//! in the machine, without a simulation.
use crate::drive::DriveState;
use crate::effect::{Descriptor, Effect, Hollow, Place, Role, SampleState, Unit, catalogue};
use crate::model::extension::axial::RopeProperties;
use crate::model::extension::{Extensions, Site};
use crate::model::{Machine, MachineState};
use crate::reference;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Returns a pseudo-random number between -1 and 1.
fn scattered(k: usize) -> f64 {
    libm::sin(12.9898 * k as f64 + 0.3)
}

/// Concatenates everything that an effect changes in the reference machine into one vector: load, added
/// modes, lead of the crank, forces, laws along the ropes, surface, readings.
fn trace(effect: Arc<dyn Effect>) -> Vec<f64> {
    let plain = Machine::new(reference::description(), 2).unwrap();
    let machine = Machine::with_effects(reference::description(), 2, &[effect]).unwrap();
    let turns = || (0..180).map(|k| TAU * f64::from(k) / 180.0);
    let mut trace: Vec<f64> = turns()
        .map(|turn| machine.card.value(turn, 0) - plain.card.value(turn, 0))
        .collect();
    let (head, modes) = (&machine.description.head, plain.layout.modes);
    for k in modes..machine.layout.modes {
        trace.push(head.frequencies[k]);
        trace.extend(head.radial[k].iter().chain(&head.participation[k]));
    }
    let extensions = &machine.extensions;
    trace.extend(turns().map(|turn| extensions.turn([turn, 0.5, 0.0])[0] - turn));
    let ropes = machine.ropes(&reference::law());
    let n = machine.layout.len();
    for (k, turn) in turns().enumerate() {
        let drive = DriveState {
            time: 0.1 * k as f64,
            turn,
            pin_rate: -0.5,
            load: machine.card.value(turn, 0),
            ..DriveState::default()
        };
        // rates from far below to far above those at which friction sets in
        let size = libm::pow(10.0, -4.0 + 0.03 * k as f64);
        let q: Vec<f64> = (0..n).map(|i| 0.3 * scattered(i + k)).collect();
        let v: Vec<f64> = (0..n).map(|i| size * scattered(2 * i + k)).collect();
        let mut force = vec![0.0; n];
        let at = MachineState {
            ropes: &ropes,
            drive: &drive,
            q: &q,
            v: &v,
        };
        extensions.add_forces(&at, &mut force);
        trace.extend(force);
        let carrier = RopeProperties {
            stiffness: 2e7,
            share: 1.0,
            length: 0.15,
        };
        for rope in 0..2 {
            if let Some(laws) = extensions.axial(rope, &drive, carrier) {
                let memory = vec![[0.0; 2]; laws.len()];
                let along = laws.pull(3e-6 * k as f64, 1e-4 * scattered(k), &memory);
                trace.push(along.spring + along.non_conservative);
            }
        }
        if let Some(profile) = extensions.profile() {
            trace.push(profile.height(1.8 + 0.015 * k as f64)[0]);
        }
        let stress = [1e7, 2e7, -3e7, 4e7].map(|s| s * (1.0 + 0.5 * scattered(k)));
        let sampled = SampleState {
            beam: 0.5 * scattered(k),
            elapsed: k as f64 / 180.0,
            head_force: [5e4 * scattered(3 * k), 5e4 * scattered(5 * k)],
            back_tension: 1e5 * (1.0 + 0.3 * scattered(k)),
            joint_stiffness: 1e8,
        };
        let mut read = stress;
        extensions.read(&sampled, &mut read);
        trace.extend(read.iter().zip(stress).map(|(read, stress)| read - stress));
    }
    let curve = || turns().map(|turn| 1e7 * libm::sin(3.0 * turn)).collect();
    let mut series: [Vec<f64>; 4] = std::array::from_fn(|_| curve());
    let before: Vec<f64> = curve();
    extensions.read_series(0.07, &mut series);
    trace.extend(series[0].iter().zip(before).map(|(a, b)| a - b));
    trace
}

/// Returns the factor between two proportional vectors of changes (see [`trace`]), second by first; `None` if
/// they are not proportional.
fn ratio(a: &[f64], b: &[f64]) -> Option<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
    (a.len() == b.len() && ab * ab >= (1.0 - 1e-5) * aa * bb).then(|| ab / aa)
}

/// Searches an effect for a shape parameter that merely scales a size's contribution; returns a message that
/// names both.
fn factor(d: &Descriptor) -> Option<String> {
    let of = |role: Role| {
        d.parameters
            .iter()
            .enumerate()
            .filter(move |(_, p)| p.role == role)
    };
    for (size, p) in of(Role::Size) {
        for (shape, q) in of(Role::Shape) {
            let [low, high] = [q.lower, q.upper].map(|bound| {
                let mut values: Vec<f64> = d.parameters.iter().map(|p| p.absent).collect();
                values[size] = p.typical;
                values[shape] = bound;
                trace(d.build(&values))
            });
            // a shape may leave a size alone: that is a ratio of one
            if ratio(&low, &high).is_some_and(|ratio| (ratio - 1.0).abs() > 1e-6) {
                return Some(format!("{}.{} is a factor of {}", d.id, q.name, p.name));
            }
        }
    }
    None
}

/// Checks that no shape parameter merely scales a size: the six signatures that a diagnosis computes per
/// shape would then be identical up to scale.
#[test]
fn no_shape_is_a_factor_of_a_size() {
    let mut shapes = 0;
    for d in catalogue().iter().filter(|d| !d.generic) {
        assert_eq!(factor(d), None);
        shapes += d
            .parameters
            .iter()
            .filter(|p| p.role == Role::Shape)
            .count();
    }
    assert!(shapes > 20, "{shapes}");
}

/// Test effect that has the flaw: a groove in the back head of a given depth \[m\].
#[derive(Debug)]
struct Groove(f64);

impl Effect for Groove {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_hollow(Hollow {
            depth: self.0,
            centre: 2.9,
            reach: 0.1,
        });
    }
}

/// Checks that an effect is refused whose groove depth is the product of a size and a shape.
#[test]
fn a_factor_is_found() {
    let groove = Descriptor::new("groove", "Groove")
        .with_location("back_head", Place::Dynamics)
        .size("depth", Unit::Metre, 1e-3, [0.0, 0.01])
        .shape("share", Unit::One, 0.5, [0.1, 1.0])
        .with_constructor(|v| Groove(v.get("depth") * v.get("share")));
    assert!(factor(&groove).unwrap().contains("share"));
}
