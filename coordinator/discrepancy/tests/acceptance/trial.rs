//! Diagnosis of one true machine, and helpers for checking the answer.
use crate::case::{ORDERS, space};
use crate::machine::{ImmediateLaboratory, Machine, Roughness, finer, ripple};
use crate::truth::{ALL, Truth, add_smooth_error, record};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::thresholds::Thresholds;
use protocol::announce::EffectDescriptor;
use protocol::job::Numerics;
use std::convert::Infallible;
use std::pin::pin;
use std::sync::LazyLock;
use std::task::{Context, Poll, Waker};

/// Stand-in machine that the tool simulates.
pub(crate) static MACHINE: LazyLock<Machine> = LazyLock::new(Machine::new);

/// Settings of a trial: record, diagnosis and faults of the laboratory.
#[derive(Clone, Debug)]
pub(crate) struct Setup {
    pub(crate) channels: Vec<usize>,
    /// Number of cycles of the record.
    pub(crate) cycles: usize,
    pub(crate) thresholds: Thresholds,
    pub(crate) library: Vec<EffectDescriptor>,
    /// Reciprocal of the share of simulation runs that are lost; 0 loses none.
    pub(crate) lost_every: u64,
    /// Pairs of a library label and the machine's own identifier, where the two differ.
    pub(crate) labels: Vec<(String, String)>,
    /// Discretisation error of the stand-in machine that the diagnosis simulates.
    pub(crate) numerics: Roughness,
    /// Ripple added to the gauges of the record that no model reproduces (MPa).
    pub(crate) ripple_mpa: f64,
    /// Smooth error of the model in every record, in standard errors of the mean.
    pub(crate) model_error: f64,
    /// Whether derivatives are finite differences of whole simulations, not computed by the laboratory.
    pub(crate) differences: bool,
    /// Ratio of the noise that the data sheet states to the true noise; NaN if no noise is stated.
    pub(crate) stated: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            channels: ALL.to_vec(),
            cycles: 8,
            thresholds: Thresholds {
                orders: ORDERS,
                draws: 100,
                ..Thresholds::default()
            },
            library: MACHINE.library().to_vec(),
            lost_every: 0,
            labels: Vec::new(),
            numerics: Roughness::Exact,
            ripple_mpa: 0.0,
            model_error: 0.0,
            differences: false,
            stated: 1.0,
        }
    }
}

/// Diagnoses a true machine; returns the diagnosis and the number of lost runs.
pub(crate) fn diagnosed(truth: &Truth, setup: &Setup) -> (Diagnosis, u64) {
    let mut records = vec![
        record(truth, 0, &setup.channels, setup.cycles),
        record(truth, 1, &setup.channels, 4),
    ];
    for record in &mut records {
        add_smooth_error(record, setup.model_error, truth.seed);
        for cycle in &mut record.cycles {
            // nothing but the gauges has it
            let gauges = setup.channels.len().min(4);
            ripple(&mut cycle[..gauges], setup.ripple_mpa);
        }
        for recorded in &mut record.channels {
            let stated = recorded.channel.noise.map(|noise| noise * setup.stated);
            recorded.channel.noise = stated.filter(|noise| !noise.is_nan());
        }
    }
    let inputs = Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: setup.differences,
        space: space(),
        unknowns: Vec::new(),
        records,
        library: setup.library.clone(),
        // a calibration has been there: it ends beside the truth, not on it
        families: None,
        start: Some(
            truth
                .genes
                .iter()
                .enumerate()
                .map(|(k, x)| x + if k % 2 == 0 { 0.008 } else { -0.03 })
                .collect(),
        ),
        usual: Numerics::FROM_CASE,
        finer: finer(),
        global_search: "quick",
        seed: 1,
        thresholds: setup.thresholds.clone(),
    };
    let mut lab = ImmediateLaboratory::new(
        &MACHINE,
        setup.lost_every,
        &setup.labels,
        setup.numerics,
        !setup.differences,
    );
    let answer = now(diagnose(&mut lab, &inputs));
    (answer, lab.lost)
}

/// Returns the result of a future that completes at the first poll.
pub(crate) fn now<T>(work: impl Future<Output = Result<T, Infallible>>) -> T {
    let mut work = pin!(work);
    match work.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(Ok(done)) => done,
        Poll::Ready(Err(never)) => match never {},
        Poll::Pending => unreachable!("a laboratory that answers at once never waits"),
    }
}

/// Diagnoses with the usual setup.
pub(crate) fn diagnose_usual(truth: &Truth) -> Diagnosis {
    diagnosed(truth, &Setup::default()).0
}

/// Summarises a diagnosis in one line, for failure messages and surveys.
pub(crate) fn line(diagnosis: &Diagnosis) -> String {
    let base = diagnosis
        .before
        .as_ref()
        .map_or(f64::NAN, |fit| fit.chi_squared / fit.entries as f64);
    let rounds: Vec<String> = diagnosis
        .rounds
        .iter()
        .map(|r| {
            let best: Vec<String> = r
                .refits
                .iter()
                .take(3)
                .map(|f| format!("{} {:.0}", f.id, r.nats(f.log_evidence)))
                .collect();
            format!(
                "[p {:.1e} dispersion {:.2} set {:?} best {}]",
                r.p_value,
                r.dispersion,
                r.set,
                best.join(", ")
            )
        })
        .collect();
    format!(
        "{:?} chi2/n {base:.2} effects {:?} generic {:?} {:?} {}",
        diagnosis.verdict,
        diagnosis
            .effects
            .iter()
            .map(|e| e.id.as_str())
            .collect::<Vec<_>>(),
        diagnosis.generic,
        diagnosis.reason,
        rounds.join(" ")
    )
}

/// Returns whether every stratum has its full size: `HORSEHEAD_ACCEPTANCE=full`.
fn is_full() -> bool {
    std::env::var("HORSEHEAD_ACCEPTANCE").is_ok_and(|v| v == "full")
}

/// Returns the number of diagnoses of a stratum: `few` in continuous integration, at fixed seeds; `many` for
/// rates.
pub(crate) fn diagnoses(few: u64, many: u64) -> u64 {
    if is_full() { many } else { few }
}

/// Returns the number of records of a stratum without diagnoses: five times as many if it has its full size.
pub(crate) fn trials(few: u64) -> u64 {
    if is_full() { 5 * few } else { few }
}

/// Prints a line about the result of a stratum; shown with `--nocapture` and when a test fails.
#[expect(
    clippy::print_stdout,
    reason = "captured by the test harness, shown on request"
)]
pub(crate) fn say(what: &str) {
    println!("{what}");
}
