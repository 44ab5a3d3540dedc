//! Scaling of searches with the number of slots (parallel jobs): speed, and use of slot time.
//!
//! Data types and arithmetic over accounts of slot time, independent of the measurement and of the display.
use journal::event::Spent;
use serde::{Deserialize, Serialize};

/// Workers on which a search was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SlotMode {
    /// Workers of this machine simulated the case.
    Computed,
    /// Workers of other machines, or started by hand, simulated the case.
    Remote,
}

impl SlotMode {
    /// Returns the name of the workers, as written in result files.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Computed => "computed",
            Self::Remote => "remote",
        }
    }
}

/// Shares of slot time by use; their sum is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Share of slot time spent computing accepted results.
    pub useful: f64,
    /// Share of slot time in which the search waits for results that other slots compute.
    pub barrier: f64,
    /// Share of slot time spent waiting for the next job although jobs were available.
    pub starved: f64,
    /// Share of slot time spent computing results that another slot delivered first, or that were never
    /// requested.
    pub speculative: f64,
    /// Share of slot time spent on attempts that failed.
    pub failed: f64,
    /// Share of slot time spent on attempts whose worker was lost.
    pub lost: f64,
}

impl Shares {
    /// Computes the shares of the time between two accounts; all 0 if no time passed.
    pub fn between(before: &Spent, after: &Spent) -> Self {
        let share = |of: fn(&Spent) -> u64| {
            let us = of(after).saturating_sub(of(before)) as f64;
            us / after.sum_us().saturating_sub(before.sum_us()).max(1) as f64
        };
        Self {
            useful: share(|spent| spent.useful_us),
            barrier: share(|spent| spent.barrier_us),
            starved: share(|spent| spent.starved_us),
            speculative: share(|spent| spent.speculative_us),
            failed: share(|spent| spent.failed_us),
            lost: share(|spent| spent.lost_us),
        }
    }
}

/// Scaling result of one search on one number of slots.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScalingRow {
    /// Workers that computed the search's results.
    pub how: SlotMode,
    /// Name of the settings preset with which the search was run.
    pub preset: String,
    /// Number of individuals per generation, if it was chosen for the measurement.
    pub population: Option<u64>,
    /// Number of slots (parallel jobs) of the search.
    pub slots: u64,
    /// Number of evaluations of the search.
    pub evaluations: u64,
    /// Wall time of the search from its first request to its last result \[s\].
    pub wall_s: f64,
    /// Computing time of the search's accepted results \[s\].
    pub useful_s: f64,
    /// Shares of slot time by use during the search.
    pub shares: Shares,
    /// Processor time of the coordinator per result, including that of the search \[us\].
    pub coordinator_us_per_result: f64,
    /// Processor time of the coordinator divided by the wall time; 1 if one processor is always busy.
    pub coordinator_share: f64,
    /// Speed-up: computing time of a single slot for the same number of evaluations, divided by the wall
    /// time.
    pub speed_up: f64,
    /// Parallel efficiency: speed-up over the number of slots.
    pub efficiency: f64,
    /// Mean computing time of a simulation \[s\].
    pub simulation_s: f64,
    /// Quantiles of the computing time of a simulation at 0, 5 .. 100 % \[s\]; the distribution is wide since
    /// many simulations end early.
    pub simulation_quantiles_s: Vec<f64>,
    /// Computing time of a simulation with derivatives by all unknowns over that of a plain one.
    pub derivatives_over_plain: f64,
}

impl ScalingRow {
    /// Names the search: its preset, with the population if that was chosen.
    pub fn search(&self) -> String {
        match self.population {
            Some(population) => format!("{} {population}", self.preset),
            None => self.preset.clone(),
        }
    }
}

/// Scaling results of several searches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScalingResult {
    /// Scaling results, one for every search and number of slots.
    pub rows: Vec<ScalingRow>,
}

impl ScalingResult {
    /// Computes speed-up and efficiency of the rows relative to one slot. The reference is the computing time
    /// per evaluation of the same search on one slot, or that of the row if this was not measured.
    pub fn new(mut rows: Vec<ScalingRow>) -> Self {
        let per_evaluation = |row: &ScalingRow| row.useful_s / row.evaluations.max(1) as f64;
        let alone: Vec<ScalingRow> = rows.iter().filter(|row| row.slots == 1).cloned().collect();
        for row in &mut rows {
            let same = alone.iter().find(|one| {
                (one.how, &one.preset, one.population) == (row.how, &row.preset, row.population)
            });
            let once = per_evaluation(same.unwrap_or(row));
            row.speed_up = once * row.evaluations as f64 / row.wall_s;
            row.efficiency = row.speed_up / row.slots.max(1) as f64;
        }
        Self { rows }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(slots: u64, wall_s: f64, useful_s: f64) -> ScalingRow {
        ScalingRow {
            how: SlotMode::Computed,
            preset: "paper".to_owned(),
            population: Some(80),
            slots,
            evaluations: 100,
            wall_s,
            useful_s,
            shares: Shares::default(),
            coordinator_us_per_result: 100.0,
            coordinator_share: 0.0,
            speed_up: 0.0,
            efficiency: 0.0,
            simulation_s: 0.1,
            simulation_quantiles_s: Vec::new(),
            derivatives_over_plain: 5.0,
        }
    }

    /// Checks that two slots that slow each other down, and so take longer over each evaluation, do not count
    /// as speed-up.
    #[test]
    fn speed_up_is_against_what_one_slot_takes() {
        let scaled = ScalingResult::new(vec![row(1, 12.5, 10.0), row(2, 8.0, 15.0)]);
        let speed: Vec<(f64, f64)> = {
            let rows = scaled.rows.iter();
            rows.map(|row| (row.speed_up, row.efficiency)).collect()
        };
        assert_eq!(speed, [(0.8, 0.8), (1.25, 0.625)]);
        // without one slot the row's own computing time counts
        let other = ScalingResult::new(vec![row(4, 5.0, 15.0)]);
        assert!((other.rows[0].speed_up - 3.0).abs() < 1e-12);
    }

    #[test]
    fn shares_are_of_the_time_between_two_accounts() {
        let before = Spent {
            connected_us: 10,
            useful_us: 10,
            ..Spent::default()
        };
        let after = Spent {
            connected_us: 50,
            useful_us: 40,
            barrier_us: 10,
            ..Spent::default()
        };
        let shares = Shares::between(&before, &after);
        assert_eq!(
            (shares.useful, shares.barrier, shares.lost),
            (0.75, 0.25, 0.0)
        );
    }
}
