//! Tests of planar motion (three coordinates per cylinder) against spatial motion (six): a symmetric machine
//! stays in its plane exactly.
use crate::rope::{optimised, recommended};
use simulation::effect::{EffectRequest, Selection};
use simulation::model::Machine;
use simulation::model::description::RopeLaw;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunSettings, simulate};
use simulation::verdict::Verdict;

/// Checks that whole runs in three and in six coordinates take the same steps, with gauge signals equal
/// within 1e-9 of their range.
#[test]
fn a_run_in_the_plane_is_the_run_in_space() {
    let plane = Machine::new(reference::description(), 2).unwrap();
    for law in [recommended(), optimised()] {
        assert_agreement(&plane, &law, "without effects");
    }
}

/// Checks that planar and spatial runs agree with effects along the ropes, on the head's surface and under
/// the pivot.
#[test]
fn a_run_with_effects_in_the_plane_is_the_run_in_space() {
    let wear = ("head_profile_wear", vec![("depth", 0.004)]);
    let toe = ("rope_toe", vec![("strain", 7.5e-4)]);
    let hysteresis = ("rope_hysteresis", vec![("share", 0.05)]);
    let drag = ("probe.front_rope.v", vec![("amplitude", 1000.0)]);
    let post = ("post_compliance", vec![("compliance", 5e-8)]);
    for effects in [
        vec![toe.clone()],
        vec![hysteresis.clone()],
        vec![wear.clone()],
        vec![toe, hysteresis, wear, drag, post],
    ] {
        let names: Vec<&str> = effects.iter().map(|(id, _)| *id).collect();
        let asked: Vec<EffectRequest<'_>> = effects
            .iter()
            .map(|(id, parameters)| EffectRequest {
                id,
                parameters: parameters.clone(),
            })
            .collect();
        let selection = Selection::new(&asked).unwrap();
        let plane =
            Machine::with_effects(reference::description(), 2, selection.effects()).unwrap();
        assert_agreement(&plane, &recommended(), &names.join(", "));
    }
}

/// Checks that preloaded joints give the same results in the plane and in space, and affect a machine as a
/// different length of its back rope does (the front rope's preload moves the suspension point alone). The
/// two cases agree to a fifteenth of the effect, because cylinders that lie closer together touch the head at
/// other points.
#[test]
fn a_preload_is_another_length_of_rope() {
    let mut preloaded = recommended();
    preloaded.bushing.preload = 4e4;
    let plain = Machine::new(reference::description(), 2).unwrap();
    assert_agreement(&plain, &preloaded, "preloaded");
    let mut description = reference::description();
    let rope = &description.rope;
    // joints of coarser cylinders are softer and under the same preload
    let joint = preloaded.bushing.scaled(rope.reference_pitch / rope.pitch);
    description.rod.length += rope.back as f64 * joint.extension_under(0.0);
    let shorter = Machine::new(description, 2).unwrap();
    let gauges = |machine: &Machine, law: &RopeLaw| {
        let mut recorder = Recorder::gauges_only();
        let result = simulate(machine, law, &RunSettings::default(), &mut recorder);
        assert_eq!(result.verdict, Verdict::Complete);
        recorder.curves.gauge
    };
    let apart = |a: &[Vec<f64>; 4], b: &[Vec<f64>; 4]| {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let other = gauges(&plain, &preloaded);
    let left = apart(&other, &gauges(&shorter, &recommended()));
    let whole = apart(&other, &gauges(&plain, &recommended()));
    eprintln!("preload: {left:.3e} of {whole:.3e} Pa");
    assert!(left < whole / 15.0, "{left} of {whole}");
}

fn assert_agreement(plane: &Machine, law: &RopeLaw, name: &str) {
    let space = plane.clone().in_space();
    assert!(plane.layout.len() * 19 < space.layout.len() * 10);
    let settings = RunSettings {
        samples: 72,
        ..RunSettings::default()
    };
    let run = |machine: &Machine| {
        let mut recorder = Recorder::gauges_only();
        let result = simulate(machine, law, &settings, &mut recorder);
        assert_eq!(result.verdict, Verdict::Complete, "{name}");
        (result.statistics, recorder.curves.gauge)
    };
    let (work, gauges) = run(plane);
    let (work_6, gauges_6) = run(&space);
    assert_eq!(work, work_6, "{name}");
    for (a, b) in gauges.iter().zip(&gauges_6) {
        let highest = b.iter().fold(f64::MIN, |m, x| m.max(*x));
        let lowest = b.iter().fold(f64::MAX, |m, x| m.min(*x));
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max) / (highest - lowest);
        println!("{name}: plane and space apart by {apart:e} of the range");
        assert!(apart < 1e-9, "{name}: {apart:e}");
    }
}
