//! Error rates of the diagnosis for this model: synthetic records without a hidden effect and records with
//! one, as repeated periods and as a single log with stated noise. The model runs in the test process.
use crate::rig::Rig;
use case::{self, Overrides};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::laboratory::{Laboratory, Stage};
use discrepancy::thresholds::Thresholds;
use discrepancy::verdict::Verdict;
use oscillator::case_folder::HIDDEN;
use oscillator::{
    effect::{Effects, descriptors},
    simulate::Values,
    simulator::Oscillators,
};
use protocol::job::{Numerics, Observation, SimulateSpec};
use search::space::Space;
use std::convert::Infallible;
use std::pin::pin;
use std::task::{Context, Poll, Waker};
use worker::simulator::{Model, Simulator as _};

/// Simulator for the diagnosis that answers its requests at once, in this process.
struct SynchronousLaboratory(Box<dyn Model>);

impl Laboratory for SynchronousLaboratory {
    type Error = Infallible;

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        let seen = batch.iter().map(|spec| self.0.observe(spec, false).ok());
        Ok(seen.collect())
    }
}

/// Diagnoses the case in a test folder from the first `cycles` periods of each condition.
fn diagnosed(rig: &Rig, cycles: usize) -> Diagnosis {
    let loaded = case::load_with_notes(&rig.file("case"), &Overrides::default()).unwrap();
    let case = loaded.case;
    let records = loaded.cycles.iter().map(|record| record.part(0..cycles));
    let inputs = Inputs {
        conditions: case.conditions.iter().map(|own| own.name.clone()).collect(),
        space: Space::new(&case.unknowns).unwrap(),
        unknowns: case.unknowns.clone(),
        records: records.collect(),
        library: descriptors(),
        families: None,
        start: None,
        usual: Numerics::FROM_CASE,
        finer: Vec::new(),
        global_search: "least-squares",
        seed: 1,
        thresholds: Thresholds::default(),
        differentiates: true,
        differences: false,
    };
    let mut laboratory = SynchronousLaboratory(Oscillators.prepare(&case).unwrap());
    let mut work = pin!(diagnose(&mut laboratory, &inputs));
    match work.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(Ok(diagnosis)) => diagnosis,
        Poll::Ready(Err(never)) => match never {},
        Poll::Pending => unreachable!("it answers at once"),
    }
}

/// Returns the effect hidden in record number `which`: its name, the values of the unknowns and the effects.
fn hiding(which: u64) -> (&'static str, Values, Effects) {
    let none = Effects::default();
    let size = 1.0 + (which / 5) as f64 * 0.4;
    match which % 5 {
        0 => (
            "dry_friction",
            HIDDEN,
            Effects {
                friction_n: 0.6 * size,
                ..none
            },
        ),
        1 => (
            "second_order",
            HIDDEN,
            Effects {
                second_order_n: [0.4 * size, -0.3 * size],
                ..none
            },
        ),
        2 => (
            "base_motion",
            HIDDEN,
            Effects {
                base_mm: [0.03 * size, 0.02 * size],
                ..none
            },
        ),
        3 => (
            "force_lag",
            HIDDEN,
            Effects {
                lag_ms: 0.6 * size,
                ..none
            },
        ),
        _ => (
            "crosstalk",
            Values {
                crosstalk_mm_per_n: 1.5e-3 * size,
                ..HIDDEN
            },
            none,
        ),
    }
}

/// Returns whether a diagnosis concludes that an effect is present, whether in the library of effects or not.
fn claims(answer: &Diagnosis) -> bool {
    matches!(
        answer.verdict,
        Verdict::Named | Verdict::Ambiguous | Verdict::Unlisted
    )
}

/// Formats a diagnosis in one line for failure messages.
fn line(what: &str, answer: &Diagnosis) -> String {
    let ids: Vec<&str> = answer.effects.iter().map(|own| &*own.id).collect();
    let scores: Vec<f64> = answer.prediction.iter().map(|one| one.nats).collect();
    format!(
        "{what}: {:?} {ids:?} {scores:.1?} {:?}",
        answer.verdict, answer.reason
    )
}

/// Checks that the diagnosis is wrong for at most two of forty records without a hidden effect and forty with
/// one, and that at least thirty of the forty hidden effects are found.
#[test]
fn names_are_hardly_ever_wrong() {
    let (mut wrong, mut silent, mut named) = (Vec::new(), Vec::new(), 0);
    for record in 0..40 {
        let cycles = if record % 2 == 0 { 8 } else { 1 };
        let empty = diagnosed(
            &Rig::hiding(&HIDDEN, &Effects::default(), 50 + record),
            cycles,
        );
        if claims(&empty) {
            wrong.push(line("nothing", &empty));
        } else if empty.verdict != Verdict::NothingDetected {
            silent.push(line("nothing", &empty));
        }
        let (id, values, effects) = hiding(record / 2);
        let answer = diagnosed(&Rig::hiding(&values, &effects, 150 + record), cycles);
        let right = answer
            .rounds
            .iter()
            .any(|round| round.set.iter().any(|own| own == id));
        if !claims(&answer) {
            silent.push(line(id, &answer));
        } else if right {
            named += 1;
        } else {
            wrong.push(line(id, &answer));
        }
    }
    eprintln!(
        "{named} of 40 named, {} wrong: {wrong:#?}; silent: {silent:#?}",
        wrong.len()
    );
    assert!(wrong.len() <= 2, "{wrong:#?}");
    assert!(named >= 30, "{named} of 40: {silent:#?}");
}
