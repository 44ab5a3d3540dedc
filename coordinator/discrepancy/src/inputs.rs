//! Inputs of a diagnosis, with its thresholds.
use crate::{
    budget::cost_with_derivatives, laboratory::Stage, model::inactive_unknowns::InactiveUnknowns,
    thresholds::Thresholds,
};
use protocol::announce::EffectDescriptor;
use protocol::case::Unknown;
use protocol::job::Numerics;
use record::Record;
use search::space::Space;

/// Inputs of a diagnosis: case, records, candidate effects and thresholds.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Search space of the case: its unknowns with their bounds.
    pub space: Space,
    /// Names of the case's working conditions, in the order of the case.
    pub conditions: Vec<String>,
    /// All unknowns of the case; those whose start is their absent value are candidate effects.
    pub unknowns: Vec<Unknown>,
    /// Measured records of all conditions; the record of the calibrated condition comes first.
    pub records: Vec<Record>,
    /// Effects that the workers can simulate: the library of missing effects from which the diagnosis
    /// selects.
    pub library: Vec<EffectDescriptor>,
    /// Coordinates of a calibrated point in the search space, if there is one.
    pub start: Option<Vec<f64>>,
    /// Coordinates of the best fits of other families that the calibration of the start saw; `None` where the start
    /// is not the result of a calibration of this case on these records, whose minima are then searched.
    pub families: Option<Vec<Vec<f64>>>,
    /// Numerical settings of all simulations except those that check the discretisation error.
    pub usual: Numerics,
    /// Finer numerical settings to check the discretisation error: first everything refined, then one
    /// refinement at a time, for use where the first does not complete.
    pub finer: Vec<Numerics>,
    /// Name of the global search preset that finds the narrow minimum of the misfit if there is no start.
    pub global_search: &'static str,
    /// Seed of the global search.
    pub seed: u64,
    /// Thresholds of all decisions of the diagnosis.
    pub thresholds: Thresholds,
    /// Whether the simulator computes derivatives; an external program computes none.
    pub differentiates: bool,
    /// Whether derivatives are computed by finite differences even if the simulator can differentiate.
    pub differences: bool,
}

impl Inputs {
    /// Returns the effects of the library and the unknowns that are switched off, except those excluded by
    /// the thresholds.
    pub(crate) fn considered(&self) -> impl Iterator<Item = EffectDescriptor> {
        let without = &self.thresholds.without;
        let off = InactiveUnknowns::of(&self.unknowns)
            .into_iter()
            .map(|off| off.candidate);
        let all = self.library.iter().cloned().chain(off);
        all.filter(|suspect| !without.contains(&suspect.id))
    }

    /// Returns the budget of each stage in plain simulations: a number of simulations, never a time, so that the
    /// result does not depend on the machine. Stages that need derivatives grow with their cost, which is that
    /// of many simulations where the simulator computes none; tests and refits with the number of candidate
    /// effects; checks and validation with the number of conditions.
    pub fn budget(&self) -> [f64; Stage::ALL.len()] {
        /// Number of candidate effects for which the budgets are stated.
        const CANDIDATES: f64 = 100.0;
        /// Number of conditions for which the budgets are stated.
        const CONDITIONS: f64 = 2.0;
        /// Number of unknowns for which the budgets are stated.
        const UNKNOWNS: usize = 10;
        let stated = self.thresholds.budget.map(f64::from);
        if let Some(whole) = self.thresholds.simulations {
            let share = f64::from(whole.get()) / stated.iter().sum::<f64>().max(1.0);
            return stated.map(|own| own * share);
        }
        let unknowns = self.space.dimension();
        let linearized = if self.differentiates && !self.differences {
            cost_with_derivatives(unknowns)
        } else {
            unknowns as f64 + 1.0
        };
        let linearized = (linearized / cost_with_derivatives(UNKNOWNS)).max(1.0);
        let candidates = (self.considered().count() as f64 / CANDIDATES).max(1.0);
        let conditions = (self.records.len() as f64 / CONDITIONS).max(1.0);
        std::array::from_fn(|k| {
            let growth = match Stage::ALL[k] {
                Stage::Basin | Stage::Recalibrate | Stage::Where => linearized,
                Stage::Preflight => conditions,
                Stage::Test | Stage::Refit => linearized * candidates,
                Stage::Show => linearized * conditions,
            };
            stated[k] * growth
        })
    }

    /// Returns the name of a working condition for messages, e.g. "condition fast"; its number if it has no
    /// name.
    pub(crate) fn condition(&self, place: usize) -> String {
        let name = self.conditions.get(place);
        name.map_or_else(
            || format!("condition {}", place + 1),
            |name| format!("condition {name}"),
        )
    }

    /// Returns the records of all conditions but the calibrated one, without records held out by the case.
    pub(crate) fn others(&self) -> impl Iterator<Item = &Record> {
        self.records
            .iter()
            .skip(1)
            .filter(|record| !record.held_out)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use protocol::case::Scale;
    use std::num::NonZeroU32;

    /// Creates inputs with two conditions, no record and one unknown.
    pub(crate) fn case() -> Inputs {
        with_unknowns(1)
    }

    fn with_unknowns(count: usize) -> Inputs {
        let one = |k| Unknown::new(format!("mass {k}"), "kg", Scale::Linear, 1.0, [0.0, 2.0]);
        let unknowns: Vec<Unknown> = (0..count).map(one).collect();
        Inputs {
            space: Space::new(&unknowns).expect("ordered"),
            conditions: ["5rpm", "4rpm"].map(str::to_owned).to_vec(),
            unknowns: Vec::new(),
            records: Vec::new(),
            library: Vec::new(),
            start: None,
            families: None,
            usual: Numerics::default(),
            finer: Vec::new(),
            global_search: "quick",
            seed: 1,
            thresholds: Thresholds::default(),
            differentiates: true,
            differences: false,
        }
    }

    /// Checks that budgets are those stated for a small case, and grow with what makes a diagnosis costly.
    #[test]
    fn budgets_grow_with_the_case_unless_a_total_is_stated() {
        let of = |inputs: &Inputs, stage: Stage| inputs.budget()[stage as usize];
        let usual = with_unknowns(10);
        for stage in Stage::ALL {
            let stated = f64::from(Thresholds::default().budget[stage as usize]);
            for small in [&usual, &case()] {
                assert!((of(small, stage) - stated).abs() < 1e-9, "{stage:?}");
            }
        }

        let many = with_unknowns(60);
        let growth = cost_with_derivatives(60) / cost_with_derivatives(10);
        for stage in [Stage::Basin, Stage::Recalibrate, Stage::Refit, Stage::Show] {
            let grown = of(&many, stage) / of(&usual, stage);
            assert!((grown - growth).abs() < 1e-12, "{stage:?} {grown}");
        }
        let checks = [&many, &usual].map(|own| of(own, Stage::Preflight));
        assert!((checks[0] - checks[1]).abs() < 1e-9, "{checks:?}");

        let mut external = with_unknowns(60);
        external.differentiates = false;
        let grown = of(&external, Stage::Refit) / of(&usual, Stage::Refit);
        assert!((grown - 61.0 / cost_with_derivatives(10)).abs() < 1e-12);

        let mut total = with_unknowns(60);
        total.thresholds.simulations = NonZeroU32::new(500);
        let whole: f64 = total.budget().iter().sum();
        assert!((whole - 500.0).abs() < 1e-9);
    }
}
