//! A search without physics, for runs that are killed: its fitness is the length of what workers
//! send back, so that it really depends on them, and its log has a digest.
use dispatch::runtime::Dispatch;
use protocol::{
    id::JobId,
    job::{Answer, Job, Outcome},
};
use search::{
    space::Space,
    strategy::{
        Evaluated, Settings, Strategy, Told, build,
        memetic::{MemeticSettings, window::WindowSettings},
    },
    test_function::SPHERE,
};
use std::time::Duration;

/// How long a result may take.
const PATIENCE: Duration = Duration::from_mins(1);

/// A search whose every individual is one short job.
pub struct SearchRun {
    /// The search.
    pub strategy: Box<dyn Strategy>,
    delay_ms: u32,
}

impl SearchRun {
    /// A search without generations, some 700 individuals; jobs take so long.
    ///
    /// # Panics
    /// Never: the settings lie within their range.
    pub fn new(seed: u64, delay_ms: u32) -> Self {
        Self::of(26, seed, delay_ms)
    }

    /// The same with another number of individuals: twenty and some 26 times `generations`.
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

    /// Has it done; `each` is called with the number of results after each of them.
    ///
    /// # Panics
    /// If the run cannot go on, or nothing comes for a minute.
    pub async fn run(&mut self, dispatch: &mut Dispatch, mut each: impl FnMut(usize)) {
        let mut results = 0;
        while self.strategy.finished().is_none() {
            for (id, job) in self.ask() {
                dispatch.submit(JobId(id), job).expect("an open run");
            }
            let completed = tokio::time::timeout(PATIENCE, dispatch.next()).await;
            let completed = completed.expect("a result in time").expect("an open run");
            self.tell(completed.id.0, &completed.outcome);
            results += 1;
            each(results);
        }
    }

    /// Jobs that can be done now, by id.
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

    /// Takes a result.
    pub fn tell(&mut self, id: u64, outcome: &Outcome) {
        let told = match outcome {
            Outcome::Done(Answer::Nothing(reply)) => Told {
                fitness: reply.len() as f64,
                complete: true,
            },
            Outcome::Done(_) | Outcome::Failed(_) => Told {
                fitness: f64::INFINITY,
                complete: false,
            },
        };
        self.strategy.tell(id, told);
    }

    /// Every bit of every individual and result, in id order, as text.
    pub fn log(&self) -> String {
        let line = |entry: &Evaluated| {
            let genes = entry.genes.iter().chain([&entry.told.fitness]);
            let bits: Vec<String> = genes
                .map(|value| format!("{:016x}", value.to_bits()))
                .collect();
            format!("{} {}\n", entry.id, bits.join(" "))
        };
        self.strategy.archive().entries().iter().map(line).collect()
    }
}

/// Bytes that stand for a fitness: up to two thousand.
fn reply_bytes(fitness: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 2000"
    )]
    let bytes = (fitness * 20.0).clamp(0.0, 2000.0) as u32;
    bytes
}
