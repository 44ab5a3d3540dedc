//! Stage times read back from a diagnosis result that was written earlier.
use discrepancy::laboratory::Stage;
use serde::Deserialize;
use std::time::Duration;
use study::StageCost;

/// Wall times of the stages in a result written earlier.
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
    /// Restores the wall times of the stages; stages that are not in the result keep theirs.
    pub(crate) fn restore(&self, accounts: &mut [(Stage, StageCost)]) {
        for (stage, account) in accounts {
            let known = self.stages.iter().find(|time| time.stage == stage.name());
            let wall = known.and_then(|time| Duration::try_from_secs_f64(time.wall_s).ok());
            account.wall = wall.unwrap_or(account.wall);
        }
    }
}
