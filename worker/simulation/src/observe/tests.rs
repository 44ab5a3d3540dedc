//! Tests of both methods of stress recovery.
use super::{Curves, Recorder};
use crate::model::Machine;
use crate::model::description::StressRecovery;
use crate::reference;
use crate::run::{RunSettings, simulate};

/// Returns the reference machine and its gauge and modal curves under a method of stress recovery.
fn curves(recovery: StressRecovery) -> (Machine, Curves) {
    let mut description = reference::description();
    description.head.recovery = recovery;
    let machine = Machine::new(description, 2).unwrap();
    let mut recorder = Recorder::everything(0);
    let settings = RunSettings {
        samples: 24,
        ..RunSettings::default()
    };
    simulate(&machine, &reference::law(), &settings, &mut recorder);
    (machine, recorder.curves)
}

#[test]
fn mode_displacement_is_the_modes_and_nothing_else() {
    let (machine, modes) = curves(StressRecovery::ModeDisplacement);
    let (_, exact) = curves(StressRecovery::ModeAcceleration);
    assert_eq!(
        modes.modal, exact.modal,
        "recovery does not touch the motion"
    );
    assert_eq!(modes.beam.len(), 24);
    let per_unit = &machine.description.head.gauge_stress;
    for gauge in 0..4 {
        for (k, stress) in modes.gauge[gauge].iter().enumerate() {
            let sum: f64 = (0..2).map(|m| per_unit[m][gauge] * modes.modal[m][k]).sum();
            assert!((stress - sum).abs() <= 1e-12 * sum.abs(), "{stress} {sum}");
        }
        assert_ne!(modes.gauge[gauge], exact.gauge[gauge]);
    }
}
