//! The curves of one simulation: stress, ropes, contact, motion, card and torque.
use crate::report::chart;
use crate::report::data::{Calibration, SingleRun};
use crate::report::document::{Block, Figure, Section, figures};
use maud::html;
use protocol::{
    case::Case,
    pumping_unit::{Machine, Simulation},
};

/// With the optimised parameters; their gauges are in the overlays.
pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    if let Some(result) = calibration.calibrated() {
        let whose = html! { p { "With the optimised parameters, calibrated condition." } };
        blocks.push(Block::Markup(whose));
        let simulation = &result.optimised.simulation;
        blocks.extend(figures(machine(
            &calibration.case,
            result.condition,
            simulation,
        )));
    }
    section(blocks)
}

pub(super) fn simulation(run: &SingleRun) -> Section {
    let (case, condition, simulation) = (&run.case, run.condition, &run.simulation);
    let gauges = chart::gauges(case, condition, simulation);
    let machine = machine(case, condition, simulation);
    section(figures(std::iter::once(gauges).chain(machine)))
}

const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "curves",
        title: "Curves over the revolution",
        blocks,
    }
}

/// Everything but the gauges.
fn machine(case: &Case, condition: usize, simulation: &Simulation) -> Vec<Figure> {
    let Ok(unit) = Machine::of(case) else {
        return Vec::new();
    };
    let mut figures = vec![chart::tension(simulation)];
    figures.extend(chart::contact(&unit, simulation));
    figures.push(chart::motion(simulation));
    figures.extend(chart::card((case, &unit), condition, simulation));
    figures.push(chart::torque(simulation));
    figures
}
