//! A calibration from the first proposal to the comparison of its result.
//!
//! [`calibrate()`] asks a search strategy for individuals, has them scored and tells the strategy
//! the results; [`compare()`] then scores and simulates chosen parameter sets under chosen
//! conditions. Both see workers only through the trait [`Evaluator`], in whatever order results
//! arrive: what they return is a function of the case, the settings and the seed.
mod calibrate;
mod compare;
mod diagnose;
mod digest;
mod error;
mod evaluator;
mod head;
mod integrators;
mod log;
mod progress;
mod recorded;
mod whole_box;

pub use calibrate::{Calibrated, Observe, Stop, calibrate};
pub use compare::{Compared, Curves, Wanted, compare};
pub use diagnose::{Account, Diagnosed, Watch, diagnose_on, library};
pub use digest::simulation_digest;
pub use error::StudyError;
pub use evaluator::{Completed, Crew, Evaluator, EvaluatorError, WorkerStatus};
pub use head::{
    HalfRanges, HeadComparison, ModeMatch, WrappedTurn, compare_head, reduce_head, wrapped_turn,
};
pub use integrators::{WorkPlan, WorkPoint, WorkPrecision, work_precision};
pub use log::{Ending, Entry, EvaluationLog};
pub use progress::ProgressView;
pub use recorded::Recorded;
pub use whole_box::{BoxClass, BoxPlan, BoxPoint, box_classes, whole_box};

#[cfg(test)]
pub(crate) mod tests;
