//! Orthogonal test of a search's settings: searches with every row of an orthogonal array and every seed,
//! then confirms the best levels with new seeds; its result as the journal states it.
use crate::{manifest::RunIdentity, opened::Run, searches::Searches};
use report::{Report, orthogonal as page};
use serde::{Deserialize, Serialize};
use study::orthogonal::{Analysis, Array, Confirmation, TestResult};
use study::{Evaluator, ProgressView, Stop, Sweep, Watch};

/// Settings of an orthogonal test that determine its result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orthogonal {
    /// Orthogonal array, whose rows are the combinations of factor levels to test.
    pub array: Array,
    /// Base settings, factors and seeds of the searches.
    pub searches: Searches,
}

impl RunIdentity for Orthogonal {
    const KIND: &'static str = "sweep orthogonal";

    fn arguments(&self) -> String {
        format!(
            " --array {}{}",
            self.array.name(),
            self.searches.arguments()
        )
    }
}

/// Runs the orthogonal test, with the given evaluator for all simulations.
///
/// # Errors
/// As [`Sweep::run`].
pub async fn test<E: Evaluator>(
    evaluator: &mut E,
    run: &Run<Orthogonal>,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<TestResult> {
    let Orthogonal { array, searches } = &run.manifest.settings;
    let space = run.manifest.space(&run.case)?;
    let mut sweep = Sweep::new(&run.case, &space);
    let factors = searches.factors.len();
    let rows = array.rows(factors);
    let list = searches.list(&space, &rows)?;
    let found = sweep.run(evaluator, &list, watch, stop).await?;
    let runs = searches.tried(&rows, &found);
    let analysis = Analysis::of(*array, factors, &searches.seeds, &runs);
    let confirmation = if let Some(analysis) = &analysis {
        // seeds that chose nothing: those of the test would flatter the levels that they chose
        let count = searches.seeds.len() as u64;
        let seeds = searches.seeds.iter().map(|seed| seed.wrapping_add(count));
        let fresh = Searches {
            seeds: seeds.collect(),
            ..searches.clone()
        };
        let best = [analysis.best()];
        let list = fresh.list(&space, &best)?;
        let found = sweep.run(evaluator, &list, watch, stop).await?;
        let [levels] = best;
        Some(Confirmation {
            runs: fresh.tried(std::slice::from_ref(&levels), &found),
            predicted: analysis.predicted,
            levels,
        })
    } else {
        None
    };
    Ok(TestResult {
        array: *array,
        factors: searches.factors.clone(),
        runs,
        analysis,
        confirmation,
    })
}

/// Reads the result of a finished orthogonal test from its journal.
///
/// # Errors
/// If the test is not finished, or its journal cannot be read.
pub fn recorded(run: &Run<Orthogonal>) -> anyhow::Result<TestResult> {
    let read = study::read_test(&run.expect_journal()?);
    read.map_err(|error| run.unreadable(error))
}

/// Builds the report of a finished orthogonal test.
///
/// # Errors
/// If the case cannot be encoded.
pub fn report(run: &Run<Orthogonal>, tested: &TestResult) -> anyhow::Result<Report> {
    Ok(page::report(&page::SweepInput {
        case: &run.case,
        tested,
        origin: run.origin(String::new())?,
    }))
}
