//! The verdict in words: by how much the error fell, where, and where it did not.
use super::{Rendered, Section, Subject};
use crate::report::data::{Calibration, SingleRun};
use crate::report::number::{count, duration, figure};
use crate::report::words;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "summary",
    title: "Summary",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: Subject<'_>) -> Rendered {
    Ok(Some(match subject {
        Subject::Calibration(calibration) => of_calibration(calibration),
        Subject::Single(run) => of_single(run),
    }))
}

fn of_calibration(calibration: &Calibration) -> Markup {
    let case = &calibration.case;
    let failed = calibration.history.iter().filter(|p| !p.complete).count();
    let warnings = words::warnings(calibration);
    html! {
        p.verdict { (words::headline(calibration)) }
        @if calibration.provenance.synthetic { p { (words::SYNTHETIC) } }
        @for result in &calibration.conditions {
            @let sentences = words::gauges(case, result);
            @let calibrated = result.condition == case.objective.condition;
            h3 {
                "Condition " (words::condition_name(case, result.condition))
                span.role {
                    @if calibrated { "calibrated" } @else { "took no part in the fit" }
                }
            }
            @if sentences.is_empty() {
                p { "There are no scores under this condition: no record, or no complete run." }
            } @else {
                ul { @for sentence in sentences { li { (sentence) } } }
            }
            @if let Some(sentence) = words::absolute_worse(case, result) { p { (sentence) } }
        }
        p {
            (count(calibration.history.len() as u64)) " evaluations, " (count(failed as u64))
            " of which did not complete a revolution, in " (duration(calibration.wall_s))
            ". The search ended because " (calibration.finish) "."
        }
        @if !warnings.is_empty() {
            div.warning { @for warning in warnings { p { (warning) } } }
        }
    }
}

fn of_single(run: &SingleRun) -> Markup {
    let verdict = words::verdict(&run.simulation.verdict);
    html! {
        p.verdict {
            "Condition " (words::condition_name(&run.case, run.condition)) " with the "
            (run.genes_name) " parameters: " (verdict) "."
        }
        @if run.provenance.synthetic && run.evaluation.is_some() { p { (words::SYNTHETIC) } }
        @if let Some(evaluation) = &run.evaluation {
            @if evaluation.channels.is_empty() {
                p { "There is no score: no record, or no complete run." }
            } @else {
                p { "The objective is " (figure(evaluation.fitness)) " MPa²." }
            }
        }
    }
}
