//! Jobs submitted together, and the scoring of a list of individuals.
use super::{
    error::StudyError,
    evaluate::{EVALUATION, EvaluationRequest, Scored, job, scored},
    evaluator::Evaluator,
    progress::ProgressView,
    stop::{Stop, or_stop},
    watch::Watch,
};
use dispatch::scheduler::Completed;
use journal::event::JobReason;
use protocol::{
    case::Case,
    id::JobId,
    job::{Evaluation, Job, Verdict},
};
use std::collections::BTreeMap;

/// Submits jobs for a reason; `take` receives the place in the list and the result of each, in the order of arrival.
///
/// # Errors
/// If no evaluator is left, the user stops, or `take` fails.
pub async fn run_batch<E: Evaluator>(
    evaluator: &mut E,
    jobs: Vec<(JobId, Job)>,
    reason: &JobReason,
    stop: &mut Stop,
    mut take: impl FnMut(&E, usize, Completed) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    let mut open: BTreeMap<JobId, usize> = BTreeMap::new();
    for (place, (id, job)) in jobs.into_iter().enumerate() {
        evaluator.submit(id, job, reason.clone())?;
        open.insert(id, place);
    }
    while !open.is_empty() {
        let completed = or_stop(evaluator.next(), stop).await??;
        // others may be results of jobs that an earlier study no longer waits for
        if let Some(place) = open.remove(&completed.id) {
            take(evaluator, place, completed)?;
        }
    }
    Ok(())
}

/// Scores individuals, each with one value for each unknown of the case \[declared units\]; equal individuals
/// are computed once.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if no evaluator is left, or if the user stops
/// it.
pub async fn score_all<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    individuals: &[Vec<f64>],
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<Vec<Scored>> {
    // those of each job, with equal individuals together
    let mut wanted: Vec<((JobId, Job), Vec<usize>)> = Vec::new();
    let mut places: BTreeMap<JobId, usize> = BTreeMap::new();
    let mut numbers = evaluator.numbers()?;
    for (index, genes) in individuals.iter().enumerate() {
        let request = EvaluationRequest {
            tag: (),
            genes: genes.clone(),
            with_residual: false,
        };
        let job = job(case, &request);
        let id = numbers.number(&job);
        if let Some((_, same)) = places.get(&id).and_then(|place| wanted.get_mut(*place)) {
            same.push(index);
        } else {
            places.insert(id, wanted.len());
            wanted.push(((id, job), vec![index]));
        }
    }
    let (jobs, indices): (Vec<(JobId, Job)>, Vec<Vec<usize>>) = wanted.into_iter().unzip();
    let mut view = ProgressView {
        generations: 1,
        expected: jobs.len() as u64,
        ..ProgressView::default()
    };
    watch.progress(&view, &|| evaluator.snapshot());
    let reason = JobReason::outside_search(EVALUATION);
    let mut found: BTreeMap<usize, Scored> = BTreeMap::new();
    run_batch(
        evaluator,
        jobs,
        &reason,
        stop,
        |evaluator, place, completed| {
            let scored = scored(completed.id, completed.outcome)?;
            view.add(complete(&scored), completed.replayed);
            watch.progress(&view, &|| evaluator.snapshot());
            let own = indices.get(place).into_iter().flatten();
            found.extend(own.map(|index| (*index, scored.clone())));
            Ok(())
        },
    )
    .await?;
    Ok(found.into_values().collect())
}

/// Returns the objective of a scored individual; `None` if its simulation did not complete.
fn complete(scored: &Scored) -> Option<f64> {
    let complete = |it: &&Evaluation| it.verdict == Verdict::Complete;
    let evaluation = scored.as_ref().ok().filter(complete)?;
    Some(evaluation.fitness)
}
