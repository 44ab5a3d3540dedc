//! Studies: from the first proposal of a search to the comparison of its result.
//!
//! [`calibrate()`] asks a search strategy for individuals, has them scored and reports the results to the
//! strategy; [`compare()`] then scores and simulates selected individuals under selected conditions;
//! [`evaluate()`] scores individuals requested by another program, [`score_all()`] those of a list; [`Sweep`]
//! runs many searches in parallel. All use workers only through the trait [`Evaluator`], with results in any
//! order, which the dispatcher of a run implements; what they return is a function of the case, the settings and the
//! seed. [`ColumnDivision`] divides simulations with derivatives for idle slots.
mod batch;
mod calibrate;
mod calibration;
mod column_division;
mod compare;
mod diagnose;
mod dispatched;
mod entry;
mod error;
mod evaluate;
mod evaluator;
mod experiments;
mod identify;
mod job_number;
mod known;
mod log;
mod mismatch;
pub mod orthogonal;
mod progress;
mod recorded;
pub mod scaling;
mod stop;
mod sweep;
#[cfg(test)]
mod test_evaluator;
mod watch;

pub use batch::{run_batch, score_all};
pub use calibrate::{Calibrated, calibrate};
pub use calibration::{
    CalibrationReader, CalibrationResult, RecordedCalibration, calibrate_case, read_calibration,
};
pub use column_division::{ColumnDivision, least_parts};
pub use compare::{CompareRequest, Compared, ComparedCurves, NamedIndividual, PICTURES, compare};
pub use diagnose::diagnose_on;
pub use dispatch::scheduler::{Completed, Snapshot};
pub use entry::{DiagnosisResult, Entry, IdentificationStudy, StageCost};
pub use error::{EvaluatorError, PROGRAM_REMEDY, StudyError};
pub use evaluate::{EvaluationRequest, Scored, evaluate};
pub use evaluator::Evaluator;
pub use evaluator::answer;
pub use experiments::{StageView, library};
pub use identify::{estimate_at_start_on, identify_on, neighbourhood_at_start_on};
pub use job_number::JobNumbers;
pub use log::{EvaluationLog, EvaluationOutcome, LogEntry};
pub use mismatch::{check_records, mismatches, recommended};
pub use progress::ProgressView;
pub use recorded::{
    RecordError, RecordedDiagnosis, RecordedTable, read_diagnosis, read_grid, read_identification,
    read_table, read_test,
};
pub use stop::Stop;
pub use stop::or_stop;
pub use sweep::{Search, SearchResult, Sweep};
pub use watch::Watch;

#[cfg(test)]
mod tests;

// tests of other crates include the test evaluator
#[cfg(test)]
extern crate self as study;
