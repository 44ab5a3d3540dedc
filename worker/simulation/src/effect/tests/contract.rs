//! Contract tests of all effects: complete descriptors, no change at absent values, bounds and order of
//! action.
use crate::effect::{Descriptor, EffectRequest, Role, Selection, SelectionError, catalogue};
use crate::model::Machine;
use crate::observe::Recorder;
use crate::reference;
use crate::run::{RunResult, RunSettings, simulate};
use crate::statistics::Statistics;
use crate::verdict::Verdict;
use std::collections::BTreeSet;

const SAMPLES: usize = 72;

/// Simulates the reference machine with effects; returns the result and the gauge curves.
fn run(asked: &[EffectRequest<'_>]) -> (RunResult, [Vec<f64>; 4]) {
    let selection = Selection::new(asked).unwrap();
    let machine = Machine::with_effects(reference::description(), 2, selection.effects()).unwrap();
    let settings = RunSettings {
        samples: SAMPLES,
        ..RunSettings::default()
    };
    let mut recorder = Recorder::gauges_only();
    let result = simulate(&machine, &reference::law(), &settings, &mut recorder);
    (result, recorder.curves.gauge)
}

fn bits(gauges: &[Vec<f64>; 4]) -> Vec<u64> {
    gauges.iter().flatten().map(|x| x.to_bits()).collect()
}

fn at(descriptor: &Descriptor, value: impl Fn(usize) -> f64) -> EffectRequest<'_> {
    let parameters = descriptor.parameters.iter().enumerate();
    EffectRequest {
        id: &descriptor.id,
        parameters: parameters.map(|(k, p)| (p.name, value(k))).collect(),
    }
}

pub(super) fn typical(descriptor: &Descriptor) -> EffectRequest<'_> {
    at(descriptor, |k| descriptor.parameters[k].typical)
}

#[test]
fn descriptors_are_complete_and_consistent() {
    let mut ids = BTreeSet::new();
    for d in catalogue() {
        assert!(ids.insert(&d.id), "{} twice", d.id);
        assert!(!d.title.is_empty() && !d.joint.is_empty());
        assert_eq!(d.generic, d.id.starts_with("probe."));
        assert!(
            d.parameters.iter().any(|p| p.role == Role::Size),
            "{}",
            d.id
        );
        let mut names = BTreeSet::new();
        for p in &d.parameters {
            let what = format!("{}.{}", d.id, p.name);
            assert!(names.insert(p.name), "{what} twice");
            assert!(!p.unit.symbol().is_empty());
            assert!(p.lower < p.upper, "{what}");
            for value in [p.absent, p.typical] {
                assert!((p.lower..=p.upper).contains(&value), "{what}: {value}");
            }
            assert!(p.scale > 0.0, "{what}");
            let moves = p.typical.to_bits() != p.absent.to_bits();
            assert_eq!(moves, p.role == Role::Size, "{what}");
        }
    }
    let wanted = [
        "crank_speed_ripple",
        "crank_angle_offset",
        "pivot_friction",
        "stuffing_box_friction",
        "rope_bending_loss",
        "rope_hysteresis",
        "rope_toe",
        "rope_stretch",
        "twin_rope_inequality",
        "pin_clearance",
        "card_time_shift",
        "load_offset",
        "load_cell_lag",
        "card_smoothing",
        "fluid_pound",
        "amplifier_lag",
        "gauge_drift",
        "head_profile_wear",
        "post_compliance",
        "gauge_gain",
        "gauge_cross_talk",
        "front_head_radius",
        "beam_inertia",
        "rod_string_reaction",
        "counterweight_phase",
    ];
    for id in wanted {
        assert!(ids.iter().any(|known| *known == id), "{id}");
    }
    assert!(catalogue().iter().filter(|d| d.generic).count() >= 60);
}

/// Checks that effects at their absent values, singly and together and with any shapes, change no bit of the
/// results.
#[test]
fn absent_effects_leave_every_bit_alone() {
    let plain: (Vec<u64>, Statistics) = reference::bits();
    let absent = |d: &'static Descriptor| {
        at(d, |k| match d.parameters[k].role {
            Role::Size => d.parameters[k].absent,
            Role::Shape => d.parameters[k].upper,
        })
    };
    let all: Vec<EffectRequest<'_>> = catalogue().iter().map(absent).collect();
    let (result, gauges) = run(&all);
    assert_eq!((bits(&gauges), result.statistics), plain);
    // each alone is refused by nothing and selects nothing
    for one in &all {
        let selection = Selection::new(std::slice::from_ref(one)).unwrap();
        assert!(selection.is_empty(), "{}", one.id);
    }
    let (result, gauges) = run(&[]);
    assert_eq!((bits(&gauges), result.statistics), plain);
}

/// Checks that every effect at its typical size lets a revolution complete and changes the gauge readings.
#[test]
fn every_effect_at_its_typical_size_acts() {
    let (_, plain) = run(&[]);
    for d in catalogue() {
        let (result, gauges) = run(&[typical(d)]);
        assert_eq!(result.verdict, Verdict::Complete, "{}", d.id);
        let mut largest = 0.0_f64;
        for (a, b) in gauges.iter().flatten().zip(plain.iter().flatten()) {
            assert!(a.is_finite(), "{}", d.id);
            largest = largest.max((a - b).abs());
        }
        assert!(largest > 0.0, "{} does nothing", d.id);
    }
}

/// Checks every parameter at both bounds with the others typical: every run completes or reports why it
/// failed, the gauge curves are finite, and the two bounds give different curves.
#[test]
fn bounds_end_in_a_verdict() {
    let settings = RunSettings {
        samples: SAMPLES,
        budget: 6000,
        // coarse steps will do for a verdict
        slow_swing: f64::INFINITY,
        ..RunSettings::default()
    };
    let mut complete = 0;
    let mut failed = Vec::new();
    for d in catalogue().iter().filter(|d| !d.generic) {
        for (k, p) in d.parameters.iter().enumerate() {
            let mut seen = Vec::new();
            for bound in [p.lower, p.upper] {
                let other = |i: usize| d.parameters[i].typical;
                let asked = at(d, |i| if i == k { bound } else { other(i) });
                let selection = Selection::new(&[asked]).unwrap();
                let built = Machine::with_effects(reference::description(), 2, selection.effects());
                let Ok(machine) = built else {
                    failed.push(format!("{}.{} {bound} cannot be built", d.id, p.name));
                    continue;
                };
                let mut recorder = Recorder::gauges_only();
                let result = simulate(&machine, &reference::law(), &settings, &mut recorder);
                let mut stress = recorder.curves.gauge.iter().flatten();
                assert!(stress.all(|s| s.is_finite()), "{}.{} {bound}", d.id, p.name);
                seen.push(bits(&recorder.curves.gauge));
                if result.verdict == Verdict::Complete {
                    complete += 1;
                } else {
                    failed.push(format!("{}.{} {bound} {:?}", d.id, p.name, result.verdict));
                }
            }
            if let [lower, upper] = seen.as_slice() {
                assert_ne!(lower, upper, "{}.{} does nothing", d.id, p.name);
            }
        }
    }
    assert!(complete > 9 * failed.len(), "{complete} {failed:?}");
}

/// Checks that all named effects give the same bits when requested in forward and in reverse order.
#[test]
fn the_order_of_asking_changes_no_bit() {
    let mut asked: Vec<EffectRequest<'_>> = catalogue()
        .iter()
        .filter(|d| !d.generic)
        .map(typical)
        .collect();
    let (result, forwards) = run(&asked);
    assert_eq!(result.verdict, Verdict::Complete);
    asked.reverse();
    let (reversed, backwards) = run(&asked);
    assert_eq!(bits(&forwards), bits(&backwards));
    assert_eq!(result.statistics, reversed.statistics);
}

#[test]
fn what_is_unknown_or_out_of_bounds_is_refused_by_name() {
    let asked = |id, name, value| {
        Selection::new(&[EffectRequest {
            id,
            parameters: vec![(name, value)],
        }])
        .unwrap_err()
    };
    assert!(matches!(
        asked("pivot_fricton", "moment", 1.0),
        SelectionError::UnknownEffect { effect: 0, .. }
    ));
    let unknown = asked("pivot_friction", "mu", 1.0);
    assert_eq!(unknown.parameter(), Some("mu"));
    for d in catalogue() {
        for p in &d.parameters {
            let reach = p.upper - p.lower;
            let hostile = [
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                p.lower - 1e-6 * reach,
                p.upper + 1e-6 * reach,
                1e308,
            ];
            for value in hostile {
                let refused = asked(&d.id, p.name, value);
                assert_eq!(refused.parameter(), Some(p.name), "{} {value}", d.id);
            }
        }
    }
    let twice = Selection::new(&[
        typical(&catalogue()[0]),
        typical(&catalogue()[1]),
        typical(&catalogue()[0]),
    ]);
    assert!(matches!(
        twice.unwrap_err(),
        SelectionError::Duplicate { effect: 2, .. }
    ));
}
