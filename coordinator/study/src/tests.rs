//! Tests of the search loop with an evaluator that answers from a test function in random order.
use super::test_evaluator::{TestEvaluator, case, evaluation, physics};
use super::*;
use protocol::pumping_unit::failure;
use protocol::{
    case::Case,
    job::{Answer, Failure, Individual, Outcome, Reached, Verdict},
    pumping_unit::Simulation,
};
use search::{
    space::Space,
    strategy::{
        Archive, Best, EvaluationResult, Finish, Progress, Proposal, Purpose, SearchPlan, Settings,
        Strategy, build, memetic::MemeticSettings, preset,
    },
};
use tokio::sync::watch;

struct Quiet(Vec<ProgressView>);

impl Watch<ProgressView> for Quiet {
    fn progress(&mut self, view: &ProgressView, _crew: &dyn Fn() -> Snapshot) {
        self.0.push(view.clone());
    }
}

fn settings() -> Settings {
    Settings::of(&MemeticSettings {
        generations: 4,
        population: 30,
        ..MemeticSettings::paper()
    })
}

async fn run(oracle: &mut TestEvaluator, case: &Case) -> Result<(Calibrated, Quiet), StudyError> {
    let mut strategy = build(&settings(), &oracle.space, 3)?;
    let (_sender, mut stop) = watch::channel(false);
    let mut observer = Quiet(Vec::new());
    let found = calibrate(oracle, case, strategy.as_mut(), &mut observer, &mut stop).await?;
    Ok((found, observer))
}

#[tokio::test]
async fn the_result_and_its_digest_do_not_depend_on_arrival() {
    let case = case();
    let (first, watched) = run(&mut TestEvaluator::new(&case, 1, physics), &case)
        .await
        .unwrap();
    for order in 2..5 {
        let (other, _) = run(&mut TestEvaluator::new(&case, order, physics), &case)
            .await
            .unwrap();
        assert_eq!(first, other);
        assert_eq!(first.log.digest(), other.log.digest());
    }
    assert_eq!(first.log.digest().len(), 64);
    let last = watched.0.last().unwrap();
    assert_eq!(last.completed, first.log.len() as u64);
    assert_eq!(last.failed, first.log.failed() as u64);
    assert_eq!(last.expected, last.completed);
    assert_eq!(last.best, Some(first.best.fitness));
    assert!(
        first.log.failed() > 0,
        "the test function must fail sometimes"
    );
}

#[tokio::test]
async fn a_run_that_is_opened_again_computes_nothing_twice() {
    let case = case();
    let mut oracle = TestEvaluator::new(&case, 1, physics);
    let (first, _) = run(&mut oracle, &case).await.unwrap();
    let mut again = TestEvaluator::new(&case, 9, physics);
    again.known = oracle
        .answered
        .iter()
        .take(80)
        .map(|(id, o)| (*id, o.clone()))
        .collect();
    let (second, watched) = run(&mut again, &case).await.unwrap();
    assert_eq!(first, second);
    assert_eq!(again.computed, first.log.len() - 80);
    assert_eq!(watched.0.last().unwrap().replayed, 80);
}

#[test]
fn the_digest_sees_every_part_of_an_entry() {
    let proposal = |id, gene| Proposal {
        id,
        genes: vec![gene, 2.0],
        generation: 0,
        purpose: Purpose::Initial,
    };
    let digest = |id, gene, fitness| {
        let mut log = EvaluationLog::default();
        log.insert(LogEntry::scored(
            proposal(id, gene),
            &evaluation(fitness, Verdict::Complete),
        ));
        log.digest()
    };
    let base = digest(0, 1.0, 0.5);
    assert_ne!(base, digest(1, 1.0, 0.5));
    assert_ne!(base, digest(0, 1.0 + f64::EPSILON, 0.5));
    assert_ne!(base, digest(0, 1.0, 0.5 + f64::EPSILON));
    assert_eq!(base, digest(0, 1.0, 0.5));
}

#[tokio::test]
async fn a_case_that_cannot_be_built_ends_the_study_with_its_field() {
    let case = case();
    let answer = |_: &Space, _: u64, _: &Individual| {
        let (field, problem) = ("run.modes".to_owned(), "7 of 6 modes".to_owned());
        Outcome::Failed(Failure::Misconfigured { field, problem })
    };
    let error = run(&mut TestEvaluator::new(&case, 1, answer), &case)
        .await
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "the workers cannot build this case: run.modes: 7 of 6 modes"
    );
    assert!(error.help().unwrap().contains("case check"));
}

#[tokio::test]
async fn if_the_whole_initial_population_fails_the_study_says_how() {
    let case = case();
    let answer = |_: &Space, id: u64, _: &Individual| {
        let kind = if id < 4 {
            failure::BUDGET
        } else {
            failure::LOAD_NOT_LIFTED
        };
        let verdict = Verdict::Failed {
            kind,
            reached: Reached::LoadFraction(0.1),
        };
        Outcome::Done(Answer::Scored(evaluation(1e6, verdict)))
    };
    let error = run(&mut TestEvaluator::new(&case, 1, answer), &case)
        .await
        .err()
        .unwrap();
    assert_eq!(
        error.to_string(),
        "all of the first 30 individuals failed: 26 x load not lifted, 4 x budget"
    );
    assert!(error.help().unwrap().contains("simulate"));
}

#[tokio::test]
async fn an_individual_that_is_lost_is_the_worst_and_the_search_goes_on() {
    let case = case();
    let answer = |space: &Space, id: u64, individual: &Individual| {
        if id.is_multiple_of(7) {
            return Outcome::Failed(Failure::Lost { workers: 2 });
        }
        physics(space, id, individual)
    };
    let (found, _) = run(&mut TestEvaluator::new(&case, 1, answer), &case)
        .await
        .unwrap();
    assert!(!found.best.id.is_multiple_of(7) && found.best.complete);
    let lost = found
        .log
        .entries()
        .filter(|entry| entry.fitness.is_infinite());
    assert!(lost.count() >= found.log.len() / 7);
}

#[tokio::test]
async fn the_user_can_stop_while_nothing_comes_back() {
    let case = case();
    let mut oracle = TestEvaluator::new(&case, 1, physics);
    let (sender, mut stop) = watch::channel(false);
    let stopped = async { or_stop(oracle.next(), &mut stop).await.err() };
    let stopper = async { sender.send(true).unwrap() };
    assert_eq!(
        tokio::join!(stopped, stopper).0,
        Some(StudyError::Interrupted)
    );
}

#[tokio::test]
async fn a_comparison_keeps_its_order_whatever_arrives_first() {
    let case = case();
    let best: Vec<f64> = case.start().iter().map(|gene| 2.0 * gene).collect();
    let individuals = vec![
        NamedIndividual::new("recommended", case.start()),
        NamedIndividual::new("optimised", best),
    ];
    let wanted = |condition| CompareRequest {
        condition,
        first: 0,
        individuals: individuals.clone(),
        frames: 0,
        columns: Vec::new(),
    };
    for order in 1..6 {
        let mut oracle = TestEvaluator::new(&case, order, physics);
        let (_sender, mut stop) = watch::channel(false);
        let compared = compare(&mut oracle, &case, &[wanted(0), wanted(1)], &mut stop).await;
        let compared = compared.unwrap();
        assert_eq!(compared.len(), 2);
        for (condition, group) in compared.iter().enumerate() {
            assert_eq!(group.condition, condition);
            for (curves, own) in group.individuals.iter().zip(&individuals) {
                assert_eq!(curves.name, own.name);
                assert_eq!(
                    Simulation::of(&curves.drawn).unwrap().gauge_mpa[0][0].to_bits(),
                    own.genes[0].to_bits()
                );
                assert!(curves.evaluation.is_some());
            }
        }
        assert_eq!(oracle.computed, 8);
    }
}

/// Returns the error of a comparison of one individual whose jobs all have the outcome `answer`.
async fn comparison_fails(answer: fn(&Space, u64, &Individual) -> Outcome) -> StudyError {
    let case = case();
    let mut oracle = TestEvaluator::new(&case, 1, answer);
    let (_sender, mut stop) = watch::channel(false);
    let individuals = vec![NamedIndividual::new("recommended", case.start())];
    let wanted = [CompareRequest {
        condition: 0,
        first: 0,
        individuals,
        frames: 0,
        columns: Vec::new(),
    }];
    let compared = compare(&mut oracle, &case, &wanted, &mut stop).await;
    compared.err().unwrap()
}

#[tokio::test]
async fn a_comparison_that_cannot_be_made_names_the_individual() {
    let error = comparison_fails(|_, _, _| Outcome::Failed(Failure::deadline(1500))).await;
    assert_eq!(
        error.to_string(),
        "the recommended individual at 5rpm could not be evaluated: it ran longer than 1.5 s"
    );
    assert!(error.help().unwrap().contains("`deadline_s` of the case"));
}

/// Checks that a request for derivatives by an unknown parameter is reported as invalid input, since
/// repeating the command would fail again.
#[tokio::test]
async fn a_column_that_does_not_exist_is_said_to_be_wrong() {
    let refused = |_: &Space, _: u64, _: &Individual| {
        Outcome::Failed(Failure::misconfigured("columns[0]", "there is no `kb7`"))
    };
    let error = comparison_fails(refused).await;
    assert_eq!(
        error.to_string(),
        "the workers cannot differentiate by this: there is no `kb7`"
    );
    assert!(error.help().unwrap().contains("EFFECT.PARAMETER"));
}

/// Strategy that proposes one individual at a time, none with the purpose "initial".
struct OneByOne {
    genes: Vec<f64>,
    asked: u64,
    results: Vec<EvaluationResult>,
    archive: Archive,
}

impl Strategy for OneByOne {
    fn ask(&mut self) -> Vec<Proposal> {
        let id = self.asked;
        if self.results.len() as u64 != id {
            return Vec::new();
        }
        self.asked += 1;
        vec![Proposal {
            id,
            genes: self.genes.clone(),
            generation: 0,
            purpose: Purpose::Scan,
        }]
    }

    fn tell(&mut self, _id: u64, result: EvaluationResult) {
        self.results.push(result);
    }

    fn finished(&self) -> Option<Finish> {
        self.results.last()?.complete.then_some(Finish::Planned)
    }

    fn progress(&self) -> Progress {
        Progress {
            generation: 0,
            generations: 0,
            evaluations: self.results.len() as u64,
            expected_evaluations: 20,
            best_fitness: None,
        }
    }

    fn best(&self) -> Option<Best> {
        let last = self.results.last()?;
        Some(Best {
            id: self.results.len() as u64 - 1,
            genes: self.genes.clone(),
            fitness: last.fitness,
            complete: last.complete,
        })
    }

    fn archive(&self) -> &Archive {
        &self.archive
    }
}

/// Returns an outcome that is a failure of the machine for ids below `from`, and complete otherwise.
fn failing_below(from: u64, id: u64) -> Outcome {
    let verdict = if id < from {
        Verdict::Failed {
            kind: failure::LOAD_NOT_LIFTED,
            reached: Reached::LoadFraction(0.5),
        }
    } else {
        Verdict::Complete
    };
    Outcome::Done(Answer::Scored(evaluation(1.0, verdict)))
}

/// Runs a search with [`OneByOne`] and returns the id of the best individual.
async fn one_by_one(answer: fn(&Space, u64, &Individual) -> Outcome) -> Result<u64, StudyError> {
    let case = case();
    let mut oracle = TestEvaluator::new(&case, 1, answer);
    let mut strategy = OneByOne {
        genes: case.start(),
        asked: 0,
        results: Vec::new(),
        archive: Archive::default(),
    };
    let (_sender, mut stop) = watch::channel(false);
    let mut quiet = Quiet(Vec::new());
    let found = calibrate(&mut oracle, &case, &mut strategy, &mut quiet, &mut stop).await;
    found.map(|found| found.best.id)
}

/// Checks that a few initial failures do not end the study but many do, independent of the purpose of the
/// proposals.
#[tokio::test]
async fn a_search_that_begins_with_failures_goes_on_until_there_are_too_many() {
    assert_eq!(one_by_one(|_, id, _| failing_below(5, id)).await, Ok(5));
    let error = one_by_one(|_, id, _| failing_below(100, id)).await;
    assert_eq!(
        error.unwrap_err().to_string(),
        "all of the first 8 individuals failed: load not lifted"
    );
}

/// Checks that individuals whose hashes begin alike each get the score of their own values, whether requested
/// one by one, in a list or by a search.
#[tokio::test]
async fn jobs_whose_hashes_begin_alike_keep_their_own_results() {
    let case = case();
    let first = |_: &Space, _: u64, individual: &Individual| {
        Outcome::Done(Answer::Scored(evaluation(
            individual.genes[0],
            Verdict::Complete,
        )))
    };
    let individuals: Vec<Vec<f64>> = (0..200)
        .map(|n| {
            let mut genes = case.start();
            genes[0] *= 1.0 + f64::from(n % 150) / 1000.0;
            genes
        })
        .collect();
    let (_sender, mut stop) = watch::channel(false);
    // 150 jobs in 256 numbers
    let mut oracle = TestEvaluator::new(&case, 1, first);
    oracle.numbers = JobNumbers::with_bits(8);
    let mut quiet = Quiet(Vec::new());
    let scored = score_all(&mut oracle, &case, &individuals, &mut quiet, &mut stop).await;
    assert_eq!(oracle.computed, 150);
    for (genes, scored) in individuals.iter().zip(scored.unwrap()) {
        assert_eq!(scored.unwrap().fitness.to_bits(), genes[0].to_bits());
    }
    let mut oracle = TestEvaluator::new(&case, 2, first);
    oracle.numbers = JobNumbers::with_bits(8);
    let (ask, mut asked) = tokio::sync::mpsc::channel(individuals.len());
    for genes in individuals {
        let (tag, with_residual) = (genes[0], false);
        let request = EvaluationRequest {
            tag,
            genes,
            with_residual,
        };
        ask.send(request).await.unwrap();
    }
    drop(ask);
    let mut answers = 0;
    let mut answer = |tag: f64, scored: &Scored| {
        answers += 1;
        assert_eq!(scored.as_ref().unwrap().fitness.to_bits(), tag.to_bits());
        Ok(())
    };
    let done = evaluate(&mut oracle, &case, &mut asked, &mut answer, &mut stop).await;
    done.unwrap();
    assert_eq!(answers, 200);
}

/// Regression: a search that a threshold ends logged what had arrived by then, so that the digest depended on the order
/// of arrival and a resumed run was refused.
#[tokio::test]
async fn a_search_that_a_threshold_ends_has_one_log() {
    let case = case();
    let space = Space::new(&case.unknowns).unwrap();
    let window = preset("window").unwrap();
    let mut settings = (window.settings)(&SearchPlan {
        space: &space,
        workers: 4,
    });
    let mut ended = Vec::new();
    for threshold in ["0", "1e9"] {
        window.set(&mut settings, "threshold", threshold).unwrap();
        let mut digests = Vec::new();
        for order in 1..5 {
            let mut oracle = TestEvaluator::new(&case, order, physics);
            let mut strategy = build(&settings, &oracle.space, 3).unwrap();
            let (_sender, mut stop) = watch::channel(false);
            let mut observer = Quiet(Vec::new());
            let found = calibrate(
                &mut oracle,
                &case,
                strategy.as_mut(),
                &mut observer,
                &mut stop,
            );
            let found = found.await.unwrap();
            digests.push((found.finish, found.log.len(), found.log.digest()));
        }
        digests.dedup();
        assert_eq!(digests.len(), 1, "threshold {threshold}: {digests:?}");
        ended.extend(digests);
    }
    assert_eq!(ended[1].0, Finish::Threshold);
    assert!(ended[1].1 < ended[0].1, "{ended:?}");
}
