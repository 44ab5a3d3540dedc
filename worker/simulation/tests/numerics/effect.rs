//! Tests of effects in motion: the energy balance closes with each of them, and laws with history converge.
use simulation::effect::{Descriptor, EffectRequest, Place, Selection, catalogue};
use simulation::integrator::{method::Method, tableau::ESDIRK4};
use simulation::model::Machine;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunResult, RunSettings, simulate};
use simulation::verdict::Verdict;

/// Returns an effect each of whose parameters is interpolated between its value for the absent effect
/// (`share` 0) and its typical value (`share` 1).
fn asked(d: &Descriptor, share: f64) -> EffectRequest<'_> {
    let value = |p: &simulation::effect::Parameter| p.absent + share * (p.typical - p.absent);
    EffectRequest {
        id: &d.id,
        parameters: d.parameters.iter().map(|p| (p.name, value(p))).collect(),
    }
}

fn run(asked: &[EffectRequest<'_>], tolerance: f64) -> (RunResult, [Vec<f64>; 4]) {
    let selection = Selection::new(asked).unwrap();
    let machine = Machine::with_effects(reference::description(), 2, selection.effects()).unwrap();
    let settings = RunSettings {
        method: Method::RungeKutta(&ESDIRK4),
        tolerance,
        samples: 180,
        budget: 10_000_000,
        ..RunSettings::default()
    };
    let mut recorder = Recorder::gauges_only();
    let result = simulate(&machine, &reference::law(), &settings, &mut recorder);
    assert_eq!(result.verdict, Verdict::Complete, "{asked:?}");
    (result, recorder.curves.gauge)
}

/// Returns the defect of the energy balance over one revolution, relative to the crank's work.
fn defect(asked: &[EffectRequest<'_>], tolerance: f64) -> f64 {
    let (result, _) = run(asked, tolerance);
    let gained = result.work.input - result.work.output - result.work.dissipated;
    (result.stored - gained).abs() / result.work.input
}

/// Largest permitted defect of the energy balance relative to the crank's work, at a hundredth of the default
/// tolerance.
const BOUND: f64 = 1e-4;

/// Checks that the energy balance closes with every effect that acts on the motion, one at a time; generic
/// forces are grouped by joint, all their forms at once. The bound is that of the plain machine at this
/// tolerance. Chattering contacts scatter the defect by a factor of ten and more: a run above the bound is
/// repeated with a ten times smaller tolerance and must then be below the bound, or below 3e-4 and 30 % of
/// its first defect (measured: needed only for the damping of the rods at a chattering suspension point).
#[test]
fn ledger_closes_with_every_effect() {
    let acts = |d: &&Descriptor| d.place != Place::Gauge && !d.generic;
    let mut groups: Vec<(String, Vec<EffectRequest<'_>>)> = catalogue()
        .iter()
        .filter(acts)
        .map(|d| (d.id.to_string(), vec![asked(d, 1.0)]))
        .collect();
    for d in catalogue().iter().filter(|d| d.generic) {
        let name = format!("probe.{}", d.joint);
        let one = asked(d, 0.1);
        match groups.iter_mut().find(|(other, _)| *other == name) {
            Some((_, all)) => all.push(one),
            None => groups.push((name, vec![one])),
        }
    }
    assert!(groups.len() > 25);
    for (name, asked) in groups {
        let mut defects = vec![defect(&asked, 0.01)];
        if defects[0] >= BOUND {
            defects.push(defect(&asked, 0.001));
        }
        eprintln!("{name}: {defects:?}");
        let last = defects[defects.len() - 1];
        let shrinks = last < 0.3 * defects[0] && last < 3e-4;
        assert!(last < BOUND || shrinks, "{name}: {defects:?}");
    }
}
