//! Report content of the pumping unit, as an implementation of [`ModelReport`].
use super::{animation, card::card, check, contact::contact, csv, revolution, single};
use crate::{
    data::{SimulationView, SingleRun},
    document::{Block, Figure, Section, Table},
    folder::{ReportError, stream},
    machine_check::{ComparedChannel, MachineCheck},
    model_report::ModelReport,
};
use case::kind::PumpingUnitModel;
use maud::html;
use protocol::case::Case;
use protocol::job::Curves;
use protocol::pumping_unit::{Machine, Simulation};
use std::path::{Path, PathBuf};

impl ModelReport for PumpingUnitModel {
    fn channels(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        vec![revolution::gauges(of)]
    }

    fn figures(&self, of: &SimulationView<'_>) -> Vec<Figure> {
        let (Ok(unit), Ok(drawn)) = (Machine::of(of.case), Simulation::of(of.curves)) else {
            return Vec::new();
        };
        let mut figures = vec![revolution::tension(&drawn)];
        figures.extend(contact(&unit, &drawn));
        figures.push(revolution::motion(&drawn));
        figures.extend(card((of.case, &unit), of.condition, &drawn));
        figures.push(revolution::torque(&drawn));
        figures
    }

    fn sections(&self, whose: &str, of: Option<&SimulationView<'_>>) -> Vec<Section> {
        let moving = of.and_then(|of| {
            let machine =
                animation::machine(of.case, of.condition, &Simulation::of(of.curves).ok()?)?;
            Some(Block::Markup(html! {
                p {
                    "Side view with " (whose) " parameters. The well is on the right; the drawing \
                     moves where JavaScript is allowed."
                }
                (machine)
            }))
        });
        vec![Section {
            id: "moving-machine",
            title: "The machine in motion",
            blocks: moving
                .into_iter()
                .flat_map(|moving| [moving, Block::Script(animation::PLAYER)])
                .collect(),
        }]
    }

    fn script(&self) -> &'static str {
        animation::PLAYER
    }

    fn tables(&self, run: &SingleRun) -> Vec<Table> {
        Simulation::of(&run.curves).map_or_else(
            |_| Vec::new(),
            |drawn| {
                vec![
                    single::simulation(run, &drawn),
                    single::balance(run, &drawn),
                ]
            },
        )
    }

    fn warning(&self, run: &SingleRun) -> Option<String> {
        check::warning(&Simulation::of(&run.curves).ok()?)
    }

    fn checks(
        &self,
        case: &Case,
        condition: usize,
        channels: &[ComparedChannel<'_>],
        runs: Option<[&Curves; 2]>,
    ) -> Vec<MachineCheck> {
        check::checks(case, condition, channels, runs)
    }

    fn files(
        &self,
        folder: &Path,
        runs: &[(&str, SimulationView<'_>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        let mut written = vec![stream(folder, "curves.csv", |file| {
            csv::curves(file, runs)
        })?];
        if let [(_, alone)] = runs
            && let Ok(drawn) = Simulation::of(alone.curves)
        {
            let ropes = |file| csv::ropes(file, &drawn);
            written.push(stream(folder, "ropes.csv", ropes)?);
        }
        Ok(written)
    }
}
