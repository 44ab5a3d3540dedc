//! Tables of a diagnosis on numerical error and on the cost of its stages.
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::{Row, Table};
use crate::number::{MISSING, count, duration, fixed, quantity};
use discrepancy::baseline::discretisation_check::Preflight;
use protocol::case::Channel;
use std::time::Duration;

/// Builds the table of the discretisation error of each channel, for the recalibrated model and for the model
/// with the added effects.
pub(in crate::diagnosis) fn numerics(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let diagnosis = subject.diagnosis();
    let record = subject.calibrated()?;
    let checks = [
        ("the recalibrated model", diagnosis.preflight.as_ref()),
        ("the answer", diagnosis.preflight_after.as_ref()),
    ];
    let mut rows = Vec::new();
    let mut notes = Vec::new();
    for (name, check) in checks {
        let Some(check) = check else { continue };
        rows.push(Row::group(name));
        let each = record.channels.iter().enumerate();
        rows.extend(each.map(|(c, own)| row(check, c, &own.channel)));
        notes.push(format!(
            "{name}: at most {} of the standard error is left{}.",
            if check.ratio().is_finite() {
                format!("{}\u{a0}×", fixed(check.ratio(), 2))
            } else {
                "an unknown multiple".to_owned()
            },
            if check.whole {
                ""
            } else {
                ", refined one thing at a time"
            }
        ));
    }
    notes.push(
        "What recalibration leaves of the difference counts as noise in every test, so that no effect is \
         named for a discretisation error; a name must also remain significant with the discretisation error at the answer."
            .to_owned(),
    );
    Table::new(
        "Numerical check: the finer model less the one that is fitted, root mean square",
        [
            "",
            "difference",
            "after recalibration",
            "standard error of the mean",
        ],
        rows,
    )
    .with_notes(notes)
    .non_empty()
}

/// Builds one channel's row in the table of discretisation errors.
fn row(check: &Preflight, c: usize, channel: &Channel) -> Row {
    let of = |values: &[f64]| {
        values.get(c).map_or_else(
            || MISSING.to_owned(),
            |value| quantity(*value, &channel.unit),
        )
    };
    Row::new(
        channel.title.as_str(),
        [
            of(&check.rms),
            of(&check.rms_left),
            of(&check.standard_error),
        ],
    )
}

/// Builds the table of the cost of each stage of the diagnosis; `None` if no cost was recorded.
pub(in crate::diagnosis) fn stages(subject: &DiagnosisInput<'_>) -> Option<Table> {
    let accounts = &subject.diagnosed.result.accounts;
    let mut rows: Vec<Row> = accounts
        .iter()
        .map(|(stage, account)| {
            Row::new(
                stage.name(),
                [
                    count(account.experiments),
                    count(account.with_derivatives),
                    count(account.known),
                    count(account.failed),
                    count(account.batches),
                    duration(subject.busy(*stage).as_secs_f64()),
                ],
            )
        })
        .collect();
    let total = |of: fn(&study::StageCost) -> u64| accounts.iter().map(|(_, a)| of(a)).sum();
    let busy: Duration = accounts.iter().map(|(stage, _)| subject.busy(*stage)).sum();
    rows.push(Row::new(
        "all",
        [
            count(total(|account| account.experiments)),
            count(total(|account| account.with_derivatives)),
            count(total(|account| account.known)),
            count(total(|account| account.failed)),
            count(total(|account| account.batches)),
            duration(busy.as_secs_f64()),
        ],
    ));
    if accounts.is_empty() {
        return None;
    }
    Some(Table::new(
            "What each stage cost",
            [
                "",
                "simulations",
                "with derivatives",
                "known already",
                "did not complete",
                "batches",
                "slot time",
            ],
            rows,
        ).with_notes([
            "Known already: experiments that an equal one had answered; they are not simulated again.",
            "Simulations of one batch are independent of each other; a batch waits for the one before.",
            "Slot time is the time in slots of workers, summed over all simulations of a stage.",]))
}
