//! What the verdict rests on: numerical error, noise, convergence, parameters, cost.
use super::{Figures, Section};
use crate::report::diagnosis::{Subject, table as tables};
use crate::report::number::{figure, percent};
use crate::report::table::markup;
use maud::{Markup, html};

pub(super) const SECTION: Section = Section {
    id: "certainty",
    title: "What it rests on",
    render,
};

fn render(subject: &Subject<'_>, _: &Figures) -> Option<Markup> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let fit = diagnosis.before.as_ref()?;
    Some(html! {
        dl.facts {
            dt { "noise" }
            dd {
                @if diagnosis.assumed_noise {
                    "assumed from the data sheet and the highest orders: there was one cycle"
                } @else {
                    "seen: the scatter between the cycles, order by order"
                }
            }
            dt { "recalibration" }
            dd {
                "one more step promises to lower the misfit by "
                (percent(fit.search.promised_decrease()))
                "; the tests look at the residual after that step"
            }
            @if let Some(after) = &diagnosis.after {
                @if !after.model.added.is_empty() {
                    dt { "fit with the answer" }
                    dd { "the same: " (percent(after.search.promised_decrease())) }
                }
            }
            @if let Some(round) = diagnosis.rounds.first() {
                dt { "misfit" }
                dd {
                    "χ² per entry of the record, best model: " (figure(round.phi))
                    "; variances are inflated by its square"
                }
            }
        }
        @match tables::numerics(subject) {
            Some(numerics) => (markup(&numerics)),
            None => p { "The finer model of the numerical check did not complete: how far the \
                         discretisation moves the curves is not known." },
        }
        @if let Some(genes) = tables::genes(subject) { (markup(&genes)) }
        @if let Some(stages) = tables::stages(subject) { (markup(&stages)) }
    })
}
