//! Three coordinates per cylinder against six: a symmetric machine stays in its plane exactly.
use crate::rope::{optimised, recommended};
use simulation::model::Machine;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunSettings, simulate};

/// Whole runs in three and in six coordinates take the same steps, and their gauges agree within
/// 1e-9 of their range.
#[test]
fn a_run_in_the_plane_is_the_run_in_space() {
    let plane = Machine::new(reference::description(), 2).unwrap();
    let space = plane.clone().in_space();
    assert!(plane.layout.len() * 19 < space.layout.len() * 10);
    let settings = RunSettings {
        samples: 72,
        ..RunSettings::default()
    };
    for law in [recommended(), optimised()] {
        let run = |machine: &Machine| {
            let mut recorder = Recorder::gauges_only();
            let result = simulate(machine, &law, &settings, &mut recorder);
            (result.statistics, recorder.curves.gauge)
        };
        let (work, gauges) = run(&plane);
        let (work_6, gauges_6) = run(&space);
        assert_eq!(work, work_6);
        for (a, b) in gauges.iter().zip(&gauges_6) {
            let highest = b.iter().fold(f64::MIN, |m, x| m.max(*x));
            let lowest = b.iter().fold(f64::MAX, |m, x| m.min(*x));
            let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max) / (highest - lowest);
            println!("plane and space apart: {apart:e} of the range");
            assert!(apart < 1e-9, "{apart:e}");
        }
    }
}
