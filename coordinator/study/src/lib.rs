//! Studies: from the first proposal of a search to the comparison of its result.
//!
//! [`calibrate()`] asks a search strategy for individuals, has them scored and reports the results to the
//! strategy; [`compare()`] then scores and simulates selected individuals under selected conditions;
//! [`evaluate()`] scores individuals requested by another program, [`score_all()`] those of a list; [`Sweep`]
//! runs many searches in parallel. All use workers only through the trait [`Evaluator`], with results in any
//! order; what they return is a function of the case, the settings and the seed.
mod calibrate;
mod compare;
mod diagnose;
mod error;
mod evaluate;
mod evaluator;
mod identify;
mod job_number;
mod laboratory;
mod listed;
mod log;
mod mismatch;
#[cfg(test)]
mod oracle;
pub mod orthogonal;
mod progress;
mod recorded;
pub mod scaling;
mod stop;
mod sweep;
mod watch;

pub use calibrate::{Calibrated, calibrate};
pub use compare::{Compared, Curves, PICTURES, Wanted, compare};
pub use diagnose::{Diagnosed, diagnose_on};
pub use dispatch::scheduler::Completed;
pub use error::{EvaluatorError, StudyError};
pub use evaluate::{Request, Scored, evaluate};
pub use evaluator::answer;
pub use evaluator::{Crew, Evaluator, WorkerStatus};
pub use identify::{IdentifiedOn, glance_on, identify_on};
pub use job_number::JobNumbers;
pub use laboratory::{StageCost, StageView, library};
pub use listed::score_all;
pub use log::{Ending, Entry, EvaluationLog};
pub use mismatch::{check_records, mismatches, recommended};
pub use progress::ProgressView;
pub use recorded::Recorded;
pub use stop::Stop;
pub use stop::or_stop;
pub use sweep::{Search, Searched, Sweep};
pub use watch::{View, Watch};

#[cfg(test)]
mod tests;

// tests of other crates include the oracle
#[cfg(test)]
extern crate self as study;
