//! Evaluator for tests that answers from a test function in random order; included by the tests of this crate
//! and of the program.
use journal::event::JobReason;
use protocol::pumping_unit::failure;
use protocol::{
    case::Case,
    id::JobId,
    job::{
        Answer, ChannelScore, Counters, Evaluation, Individual, Job, Outcome, Reached, Reply,
        Verdict,
    },
    message::Cost,
    pumping_unit::{Energy, HeadLoads, Simulation},
};
use search::{
    random::{Phase, Stream, Streams},
    space::Space,
    test_function::RESONANCE,
};
use std::{collections::BTreeMap, path::Path};
use study::{Completed, Evaluator, EvaluatorError, JobNumbers, Snapshot};

/// Evaluator that answers jobs in a random order; `known` holds results of an earlier session.
pub(crate) struct TestEvaluator {
    pub(crate) space: Space,
    open: Vec<(JobId, Job)>,
    order: Stream,
    answer: fn(&Space, u64, &Individual) -> Outcome,
    pub(crate) known: BTreeMap<JobId, Outcome>,
    pub(crate) answered: BTreeMap<JobId, Outcome>,
    pub(crate) computed: usize,
    pub(crate) numbers: JobNumbers,
}

impl TestEvaluator {
    pub(crate) fn new(
        case: &Case,
        order: u64,
        answer: fn(&Space, u64, &Individual) -> Outcome,
    ) -> Self {
        Self {
            space: Space::new(&case.unknowns).unwrap(),
            open: Vec::new(),
            order: Streams::new(order, 0).at(0, Phase::Initial, 0),
            answer,
            known: BTreeMap::new(),
            answered: BTreeMap::new(),
            computed: 0,
            numbers: JobNumbers::default(),
        }
    }
}

impl Evaluator for TestEvaluator {
    fn submit(&mut self, id: JobId, job: Job, _reason: JobReason) -> Result<(), EvaluatorError> {
        assert!(
            self.open.iter().all(|(other, _)| *other != id),
            "{id} submitted twice"
        );
        assert!(!self.answered.contains_key(&id), "{id} submitted twice");
        self.open.push((id, job));
        Ok(())
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        if self.open.is_empty() {
            std::future::pending::<()>().await;
        }
        let (id, job) = self.open.swap_remove(self.order.index(self.open.len()));
        let known = self.known.get(&id).cloned();
        let replayed = known.is_some();
        self.computed += usize::from(!replayed);
        let outcome = known.unwrap_or_else(|| {
            let Job::Simulate(spec) = &job else {
                return Outcome::Done(Answer::Nothing(Vec::new()));
            };
            if matches!(spec.reply, Reply::Score { .. }) {
                return (self.answer)(&self.space, id.0, &spec.individual);
            }
            Outcome::Done(Answer::Curves(Box::new(
                curves(spec.individual.genes[0])
                    .into_curves(Vec::new())
                    .unwrap(),
            )))
        });
        self.answered.insert(id, outcome.clone());
        Ok(Completed {
            id,
            cost: Cost::default(),
            outcome,
            replayed,
        })
    }

    fn numbers(&self) -> Result<JobNumbers, EvaluatorError> {
        Ok(self.numbers.clone())
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            queued: self.open.len(),
            ..Snapshot::default()
        }
    }
}

pub(crate) fn case() -> Case {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let mut shipped = above.map(|folder| folder.join("cases/cyjs10-5-37hb"));
    let folder = shipped.find(|folder| folder.is_dir()).unwrap();
    ::case::load(&folder, &::case::Overrides::default()).unwrap()
}

pub(crate) fn curves(first_gene: f64) -> Simulation {
    Simulation {
        verdict: Verdict::Complete,
        counters: Counters::default(),
        wall_s: 0.0,
        turn_deg: vec![0.0, 180.0],
        gauge_mpa: [
            vec![first_gene, 2.0],
            vec![0.0; 2],
            vec![1.0; 2],
            vec![0.0; 2],
        ],
        back_rope_tension_n: vec![1e5; 2],
        front_rope_tension_n: vec![9e4; 2],
        tension_difference_n: [Vec::new(), Vec::new()],
        beam_deg: vec![0.0; 2],
        suspension_m: vec![0.0; 2],
        suspension_velocity_m_s: vec![0.0; 2],
        suspension_acceleration_m_s2: vec![0.0; 2],
        crank_torque_n_m: vec![0.0; 2],
        modal: Vec::new(),
        head_loads: HeadLoads::default(),
        energy: Energy::default(),
        motion: Vec::new(),
    }
}

pub(crate) fn evaluation(fitness: f64, verdict: Verdict) -> Evaluation {
    let channel = ChannelScore {
        channel: 0,
        mse: fitness,
        mse_fixed_offset: fitness,
        offset: 0.0,
        rmse_over_half_range: 0.1,
        relative_error: 0.1,
        peak_to_peak_error: 0.1,
    };
    Evaluation {
        verdict,
        fitness,
        channels: vec![channel],
        residual: Vec::new(),
        columns: Vec::new(),
        counters: Counters::default(),
    }
}

pub(crate) fn physics(space: &Space, _id: u64, individual: &Individual) -> Outcome {
    let told = RESONANCE.tell(space, &individual.genes);
    let kind = failure::LOAD_NOT_LIFTED;
    let verdict = if told.complete {
        Verdict::Complete
    } else {
        Verdict::Failed {
            kind,
            reached: Reached::LoadFraction(0.5),
        }
    };
    Outcome::Done(Answer::Scored(evaluation(told.fitness, verdict)))
}
