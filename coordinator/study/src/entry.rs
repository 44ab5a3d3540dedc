//! Entries of a study in its journal: what it found and concluded, as plain data.
use super::orthogonal::{TestResult, TrialRun};
use discrepancy::{
    diagnose::Diagnosis,
    identify::{IdentificationResult, UnknownEstimate},
    laboratory::{Finding, Stage},
};
use protocol::announce::EffectDescriptor;
use record::Record;
use search::strategy::{Best, DescentEnd, Finish};
use serde::{Deserialize, Serialize};

/// Entry of a study. It holds no times and does not depend on the order in which results arrive, so that a resumed study
/// makes the same entries again. The form of entries belongs to the journal's version ([`journal::VERSION`]).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Entry {
    /// Measured record that the study uses, or further cycles of the one before, if it has the same condition.
    Record(Record),
    /// Notes about the case and its records, one sentence each.
    Noted(Vec<String>),
    /// Plan of a calibration's search: its number of generations, and about how many individuals it evaluates.
    Planned {
        /// Planned number of generations.
        generations: u32,
        /// Expected number of evaluations.
        evaluations: u64,
    },
    /// Stages of a diagnosis or identification with their budgets, in simulations without derivatives.
    Budgeted(Vec<(Stage, f64)>),
    /// Interim result of a diagnosis.
    Interim(Finding),
    /// Result of the search of a calibration; its evaluations are the recorded jobs.
    Calibrated {
        /// Best individual found by the search.
        best: Best,
        /// Stopping criterion that ended the search.
        finish: Finish,
        /// Ends of the search's least-squares descents that converged.
        descent_ends: Vec<DescentEnd>,
        /// Number of evaluations in the evaluation log; those with higher ids were not used.
        evaluations: u64,
        /// Digest of the evaluation log.
        digest: String,
    },
    /// First-order estimates of the unknowns of a calibration, its last entry; none where they cannot be estimated.
    Estimated(Vec<UnknownEstimate>),
    /// Result of a diagnosis.
    Diagnosed(Box<DiagnosisResult>),
    /// Result of an identification.
    Identified(Box<IdentificationStudy>),
    /// Results of the searches of a grid.
    Swept(Vec<TrialRun>),
    /// Result of an orthogonal test.
    Tested(Box<TestResult>),
    /// Individuals of a table, of which each has been evaluated; their results are the recorded jobs. The rows of all
    /// such entries follow each other.
    Table {
        /// Names of the columns.
        names: Vec<String>,
        /// Values of the searched unknowns of each individual, in declared units.
        rows: Vec<Vec<f64>>,
        /// Number of rows of the whole table.
        total: u64,
    },
}

/// Length of what one entry holds of a record or a table (values), far below what a record of the journal may hold.
const LONGEST: usize = 500_000;

impl Entry {
    /// Returns the entries of measured records.
    pub fn records(records: &[Record]) -> Vec<Self> {
        let parts = records.iter().flat_map(|record| {
            let values = |cycle: &Vec<Vec<f64>>| cycle.iter().map(Vec::len).sum::<usize>();
            let longest = record.cycles.iter().map(values).max().unwrap_or_default();
            let count = (LONGEST / longest.max(1)).max(1);
            let of = |from: usize| Self::Record(record.part(from..from + count));
            (0..record.cycles.len().max(1))
                .step_by(count)
                .map(of)
                .collect::<Vec<_>>()
        });
        parts.collect()
    }

    /// Returns the entries of a table of individuals.
    pub fn table(names: &[String], rows: &[Vec<f64>]) -> Vec<Self> {
        let count = (LONGEST / names.len().max(1)).max(1);
        let part = |own: &[Vec<f64>]| Self::Table {
            names: names.to_vec(),
            rows: own.to_vec(),
            total: rows.len() as u64,
        };
        rows.chunks(count).map(part).collect()
    }
}

/// Result of a diagnosis of model deficiencies, with what it considered and the cost of its experiments.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DiagnosisResult {
    /// Findings of the diagnosis: possible model deficiencies and how well each explains the measured
    /// records.
    pub diagnosis: Diagnosis,
    /// Cost of the diagnosis by stage, for stages that ran experiments.
    pub accounts: Vec<(Stage, StageCost)>,
    /// Candidate effects: those known to the workers but absent from the case, and unknowns of the case that are
    /// switched off.
    pub library: Vec<EffectDescriptor>,
    /// Notes about the case, its records and its numerical settings, one sentence each.
    pub notes: Vec<String>,
}

/// Result of an identification of unknowns, and the number of its experiments.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct IdentificationStudy {
    /// Unknowns that the measured record determines, with their values.
    pub identified: IdentificationResult,
    /// Number of simulations.
    pub simulations: u64,
    /// Notes about the case and its records, one sentence each.
    pub notes: Vec<String>,
}

/// Cost so far of one stage of a diagnosis or identification.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageCost {
    /// Number of the stage's completed experiments (simulations).
    pub experiments: u64,
    /// Number of these simulations that also computed derivatives.
    pub with_derivatives: u64,
    /// Number of experiments that were answered by the simulation of an equal one.
    pub known: u64,
    /// Number of the stage's experiments whose simulation failed or ended early.
    pub failed: u64,
    /// Number of batches of experiments that the stage ran one after another; experiments of one batch are
    /// independent.
    pub batches: u64,
}
