//! How the result was made: enough to make it again and to compare it.
use super::{Rendered, Section, Subject};
use crate::report::data::{Calibration, Provenance};
use crate::report::number::{NONE, count, duration};
use maud::{Markup, html};
use protocol::case::{Case, Offset};
use protocol::job::{Counters, Simulation};

pub(super) const SECTION: Section = Section {
    id: "provenance",
    title: "How it was made",
    render,
};

#[expect(clippy::unnecessary_wraps, reason = "all sections share one signature")]
fn render(subject: Subject<'_>) -> Rendered {
    Ok(Some(match subject {
        Subject::Calibration(calibration) => {
            let optimum = calibration
                .optimised
                .id
                .map_or_else(|| NONE.to_owned(), |id| format!("individual {}", count(id)));
            let simulation = calibration
                .calibrated()
                .map(|result| &result.optimised.simulation);
            html! {
                (facts(&calibration.provenance, &calibration.case, Some((calibration, &optimum))))
                @if let Some(simulation) = simulation { (work(simulation)) }
            }
        }
        Subject::Single(run) => html! {
            (facts(&run.provenance, &run.case, None))
            (work(&run.simulation))
        },
    }))
}

/// The facts as a list of names and values.
fn facts(
    provenance: &Provenance,
    case: &Case,
    calibration: Option<(&Calibration, &str)>,
) -> Markup {
    let gauges: Vec<_> = case
        .objective
        .gauges
        .iter()
        .map(|(gauge, weight)| format!("{weight} × MSE at point {gauge}"))
        .collect();
    let offset = match case.objective.offset {
        Offset::Free => "free: the mean difference of each gauge is removed first",
        Offset::Fixed => "fixed: absolute values are compared",
    };
    html! {
        dl.facts {
            (origin(provenance, case))
            @if let Some((calibration, optimum)) = calibration {
                dt { "objective" } dd { (gauges.join(" + ")) "; offset " (offset) }
                dt { "optimum" } dd { (optimum) }
                dt { "wall time" } dd { (duration(calibration.wall_s)) }
                dt { "digest of the evaluation log" } dd { code { (provenance.digest) } }
            } @else {
                dt { "digest of the result" } dd { code { (provenance.digest) } }
            }
        }
    }
}

/// Where any result comes from, as entries of a list of facts.
pub(in crate::report) fn origin(provenance: &Provenance, case: &Case) -> Markup {
    html! {
        dt { "program" } dd { (provenance.program) }
        dt { "command" } dd { code { (provenance.command) } }
        dt { "run" } dd { (provenance.run) }
        dt { "case" } dd { (case.name) " " code { (provenance.case_hash) } }
        dt { "measured records" } dd { (provenance.measured_name) }
        @if let Some(preset) = &provenance.preset { dt { "preset" } dd { (preset) } }
        @if let Some(seed) = provenance.seed { dt { "seed" } dd { (seed) } }
    }
}

/// Counters of the integrator.
fn work(simulation: &Simulation) -> Markup {
    let Counters {
        steps,
        rejected_steps,
        newton_iterations,
        jacobians,
        factorizations,
    } = simulation.counters;
    html! {
        p {
            "One simulation with these parameters took " (count(steps)) " steps ("
            (count(rejected_steps)) " rejected), " (count(newton_iterations))
            " Newton iterations, " (count(jacobians)) " Jacobians and " (count(factorizations))
            " factorisations, in " (duration(simulation.wall_s)) " on its worker."
        }
    }
}
