//! A search on a mathematical test function, for tests that kill and resume runs. The fitness is the length
//! of a worker's reply, so that it truly depends on the workers, and the log can be compared bit by bit.
use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::{
    id::JobId,
    job::{Answer, Job, Outcome},
};
use search::{
    space::Space,
    strategy::{
        EvaluatedIndividual, EvaluationResult, Settings, Strategy, build,
        memetic::{MemeticSettings, window::WindowSettings},
    },
    test_function::SPHERE,
};
use std::time::Duration;

/// Longest time that the search waits for a worker's result.
const PATIENCE: Duration = Duration::from_mins(1);

/// Search in which each individual is evaluated by one short job on the workers.
pub struct SearchRun {
    /// Search strategy, which proposes individuals and is told their fitness.
    pub strategy: Box<dyn Strategy>,
    delay_ms: u32,
}

impl SearchRun {
    /// Creates a memetic search with a sliding window (no generation barrier) of about 700 individuals, whose
    /// jobs each take `delay_ms`.
    ///
    /// # Panics
    /// Never: the settings lie within their range.
    pub fn new(seed: u64, delay_ms: u32) -> Self {
        Self::of(26, seed, delay_ms)
    }

    /// Creates a memetic search with about 20 + 26 `generations` individuals.
    ///
    /// # Panics
    /// Never: the settings lie within their range.
    pub fn of(generations: u32, seed: u64, delay_ms: u32) -> Self {
        let settings = Settings::of(&WindowSettings {
            window: 16,
            memetic: MemeticSettings {
                population: 20,
                generations,
                crossover_trials: 3,
                mutation_trials: 3,
                ..MemeticSettings::paper()
            },
        });
        let space: Space = SPHERE.space();
        Self {
            strategy: build(&settings, &space, seed).expect("valid settings"),
            delay_ms,
        }
    }

    /// Runs the search to its end; after each result `each` is called with the number of results so far.
    ///
    /// # Panics
    /// If the run cannot go on, or no result arrives for a minute.
    pub async fn run(&mut self, dispatch: &mut Dispatch, mut each: impl FnMut(usize)) {
        let mut results = 0;
        while self.strategy.finished().is_none() {
            for (id, job) in self.ask() {
                dispatch
                    .submit(JobId(id), job, JobReason::default())
                    .expect("an open run");
            }
            let completed = tokio::time::timeout(PATIENCE, dispatch.next()).await;
            let completed = completed.expect("a result in time").expect("an open run");
            self.tell(completed.id.0, &completed.outcome);
            results += 1;
            each(results);
        }
    }

    /// Returns the jobs that the strategy proposes now, with their ids.
    pub fn ask(&mut self) -> Vec<(u64, Job)> {
        let proposals = self.strategy.ask();
        let jobs = proposals.into_iter().map(|proposal| {
            // a number for the trace, then every bit of the individual
            let mut payload = proposal.id.to_le_bytes().to_vec();
            for gene in &proposal.genes {
                payload.extend_from_slice(&gene.to_le_bytes());
            }
            let fitness = SPHERE.tell(&SPHERE.space(), &proposal.genes).fitness;
            let job = Job::Nothing {
                payload,
                reply_bytes: reply_bytes(fitness),
                delay_ms: self.delay_ms,
            };
            (proposal.id, job)
        });
        jobs.collect()
    }

    /// Passes the length of a job's reply to the search strategy as the individual's fitness.
    pub fn tell(&mut self, id: u64, outcome: &Outcome) {
        let told = match outcome {
            Outcome::Done(Answer::Nothing(reply)) => EvaluationResult {
                fitness: reply.len() as f64,
                complete: true,
            },
            Outcome::Done(_) | Outcome::Failed(_) => EvaluationResult {
                fitness: f64::INFINITY,
                complete: false,
            },
        };
        self.strategy.tell(id, told);
    }

    /// Returns the bit patterns of all individuals' values and fitness as text, in id order, to compare runs
    /// exactly.
    pub fn log(&self) -> String {
        let line = |entry: &EvaluatedIndividual| {
            let genes = entry.genes.iter().chain([&entry.result.fitness]);
            let bits: Vec<String> = genes
                .map(|value| format!("{:016x}", value.to_bits()))
                .collect();
            format!("{} {}\n", entry.id, bits.join(" "))
        };
        self.strategy.archive().entries().iter().map(line).collect()
    }
}

/// Returns the length of the reply that encodes a fitness, at most 2000 (bytes).
fn reply_bytes(fitness: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 2000"
    )]
    let bytes = (fitness * 20.0).clamp(0.0, 2000.0) as u32;
    bytes
}
