//! Division of a simulation with derivatives into parts with some of its columns, and the joining of their answers.
//!
//! Results are pure functions of their jobs, and the derivative by one column does not depend on the others: the joined
//! answers are, bit for bit, the answer to the whole job.
use super::{Answer, Column, Derivative, Job, Outcome, Reply};

/// Returns the number of columns of a job that its parts can share: those of a simulation whose answer has the
/// derivatives; 0 for a job that stays whole.
pub const fn shared_columns(job: &Job) -> usize {
    match job {
        Job::Simulate(spec) => match spec.reply {
            Reply::Score {
                with_residual: true,
                ..
            }
            | Reply::Channels => spec.columns.len(),
            Reply::Score { .. } | Reply::Curves { .. } => 0,
        },
        Job::Own { .. } | Job::Describe | Job::Nothing { .. } => 0,
    }
}

/// Returns the parts of a simulation with at most `size` columns each (at least one), in the order of the columns; any
/// other job as it is.
pub fn split(job: Job, size: usize) -> Vec<Job> {
    match job {
        Job::Simulate(spec) if !spec.columns.is_empty() => {
            let part = |columns: &[Column]| {
                let mut part = spec.clone();
                part.columns = columns.to_vec();
                Job::Simulate(part)
            };
            spec.columns.chunks(size.max(1)).map(part).collect()
        }
        whole @ (Job::Simulate(_) | Job::Own { .. } | Job::Describe | Job::Nothing { .. }) => {
            vec![whole]
        }
    }
}

/// Joins the outcome of the next part of a simulation to that of the parts before it; the first failure is that of the
/// whole.
pub fn join(joined: Outcome, next: Outcome) -> Outcome {
    match (joined, next) {
        (Outcome::Done(mut first), Outcome::Done(mut next)) => {
            if let (Some(all), Some(more)) = (columns(&mut first), columns(&mut next)) {
                all.append(more);
            }
            Outcome::Done(first)
        }
        (failed @ Outcome::Failed(_), _) | (Outcome::Done(_), failed @ Outcome::Failed(_)) => {
            failed
        }
    }
}

const fn columns(answer: &mut Answer) -> Option<&mut Vec<Derivative>> {
    match answer {
        Answer::Scored(evaluation) => Some(&mut evaluation.columns),
        Answer::Channels(observation) => Some(&mut observation.columns),
        Answer::Curves(_) | Answer::Own(_) | Answer::Described(_) | Answer::Nothing(_) => None,
    }
}
