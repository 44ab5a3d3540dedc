//! Stage times of a diagnosis, read back from a result file that was written earlier.
use discrepancy::laboratory::Stage;
use serde::Deserialize;
use std::time::Duration;
use study::StageCost;

/// Wall times of the diagnosis stages in a result file that was written earlier.
#[derive(Debug, Deserialize)]
pub(crate) struct Times {
    stages: Vec<StageTime>,
}

#[derive(Debug, Deserialize)]
struct StageTime {
    stage: String,
    wall_s: f64,
}

impl Times {
    /// Restores the wall times of the diagnosis stages from an earlier result file; stages that it lacks keep
    /// theirs.
    pub(crate) fn restore(&self, accounts: &mut [(Stage, StageCost)]) {
        for (stage, account) in accounts {
            let known = self.stages.iter().find(|time| time.stage == stage.name());
            let wall = known.and_then(|time| Duration::try_from_secs_f64(time.wall_s).ok());
            account.wall = wall.unwrap_or(account.wall);
        }
    }
}
