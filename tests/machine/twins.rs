//! Twin ropes on the real unit, with the head's tables for a pair that the case is delivered with.
use crate::{folder, individuals, run};
use protocol::case::Case;
use simulation::model::description::RopeLaw;
use simulation::observe::Recorder;
use simulation::run::RunResult;
use std::{fs, os::unix::fs::symlink};

/// The shipped case with twin ropes at `z = +-0.12 m`, those at -z longer by so much [mm].
fn twins(back_mm: f64, front_mm: f64) -> Case {
    let scratch = tempfile::tempdir().unwrap();
    for name in ["back_head", "measured"] {
        symlink(folder().join(name), scratch.path().join(name)).unwrap();
    }
    let text = fs::read_to_string(folder().join("case.toml")).unwrap();
    let entry = format!(
        "\n[twin_ropes]\noffset_m = 0.12\nback_length_difference_m = {:?}\n\
         front_length_difference_m = {:?}\nhead_file = \"back_head/back_head_twin.json\"\n",
        1e-3 * back_mm,
        1e-3 * front_mm
    );
    fs::write(scratch.path().join("case.toml"), text + &entry).unwrap();
    coordinator::case::load(scratch.path(), &coordinator::case::Overrides::default()).unwrap()
}

fn simulated(case: &Case, law: &RopeLaw) -> (RunResult, Recorder) {
    let machine = worker::convert::machine(case, 0).unwrap();
    run(&machine, law, &worker::convert::run_settings(case))
}

fn twisted(law: &RopeLaw, stiffer: f64, damped: f64) -> RopeLaw {
    let mut other = *law;
    other.bushing.rotational_stiffness[0] *= stiffer;
    other.bushing.rotational_damping[0] *= damped;
    other
}

/// Range of a curve.
fn range(curve: &[f64]) -> f64 {
    let low = curve.iter().copied().fold(f64::MAX, f64::min);
    curve.iter().copied().fold(f64::MIN, f64::max) - low
}

/// Largest difference of a gauge of two runs over its range in the second.
fn apart(a: &Recorder, b: &Recorder) -> [f64; 4] {
    [0, 1, 2, 3].map(|k| {
        let pairs = a.curves.gauge[k].iter().zip(&b.curves.gauge[k]);
        let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        most / range(&b.curves.gauge[k])
    })
}

#[test]
#[ignore = "looks"]
fn explore() {
    let single = crate::case();
    for (name, genes) in individuals(&single) {
        let law = worker::convert::rope_law(&single, &genes).unwrap();
        let (one_result, one) = simulated(&single, &law);
        eprintln!("{name} single {:?}", one_result.statistics);
        let case = twins(0.0, 0.0);
        let started = std::time::Instant::now();
        let (result, two) = simulated(&case, &law);
        eprintln!(
            "{name} equal {:?} {:?} {:?}",
            result.statistics,
            apart(&two, &one),
            started.elapsed()
        );
        for mm in [0.1, 1.0, 3.0] {
            let case = twins(mm, 0.0);
            let machine = worker::convert::machine(&case, 0).unwrap();
            let mut recorder = Recorder::everything(0);
            let started = std::time::Instant::now();
            let result = simulation::run::simulate(
                &machine,
                &law,
                &worker::convert::run_settings(&case),
                &mut recorder,
            );
            let work = result.work;
            let gained = work.input - work.output - work.dissipated;
            let defect = (result.stored - gained).abs() / work.input;
            eprintln!(
                "{name} {mm} mm {:?} {:?} ledger {defect:.1e} {:?} {:?}",
                result.verdict,
                result.statistics,
                apart(&recorder, &one),
                started.elapsed()
            );
            let uneven = &recorder.curves.tension_difference[0];
            let mean = uneven.iter().sum::<f64>() / uneven.len() as f64;
            let ea = law.bushing.stiffness[0] * 0.05;
            eprintln!("  T1-T2 {mean} range {} expected {}", range(uneven), mm * 1e-3 * ea / 7.2);
            for k in 0..4 {
                let d: Vec<f64> = recorder.curves.gauge[k].iter().zip(&one.curves.gauge[k]).map(|(a, b)| (a - b) / 1e6).collect();
                eprintln!("  gauge {} differs by mean {:.3} range {:.3} MPa of {:.2}", k + 1, d.iter().sum::<f64>() / d.len() as f64, range(&d), range(&one.curves.gauge[k]) / 1e6);
            }
            let rec_plain = recorder;
            for (stiffer, damped) in [(1e-4, 1.0), (1e-2, 1.0), (1e2, 1.0), (1e4, 1.0), (1.0, 1e-4), (1.0, 1e4)] {
                let mut recorder = Recorder::gauges_only();
                let result = simulation::run::simulate(
                    &machine,
                    &twisted(&law, stiffer, damped),
                    &worker::convert::run_settings(&case),
                    &mut recorder,
                );
                eprintln!("   K44 x{stiffer:e} C44 x{damped:e}: {:?} {:?} newton {}", result.verdict, apart(&recorder, &rec_plain).map(|x| format!("{x:.1e}")), result.statistics.newton_iterations);
            }
        }
    }
}
