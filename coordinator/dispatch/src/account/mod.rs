//! How the slots of a run spent their time, and why: a fold over its journal.
//!
//! It adds up what the core wrote down (one row per worker and coordinator process) and puts the
//! causes into words. It decides nothing, and knows neither workers nor sockets.
mod cost;
mod job;

pub use cost::{Costs, JobCost};
pub use job::JobUse;

use crate::journal::{self, Damage, JournalError};
use protocol::{
    event::{Event, Spent, WorkerAccount},
    id::WorkerId,
};
use std::{collections::BTreeMap, path::Path};

/// Shares below this are not worth a word \[1\].
const NOTABLE: f64 = 0.02;

/// What the workers of one machine did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HostUse {
    /// Worker processes, restarted ones counted again.
    pub workers: u64,
    /// Slots of the largest of them.
    pub slots: u32,
    /// Results of theirs that were accepted.
    pub done: u64,
    /// Attempts that failed there.
    pub failed: u64,
    /// Their slot time by use.
    pub spent: Spent,
}

/// What a journal says of the use of slot time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunAccount {
    /// Coordinator processes that worked on the run.
    pub processes: u32,
    /// Results recorded.
    pub results: u64,
    /// Time that those processes worked, as far as it was accounted \[s\].
    pub wall_s: f64,
    /// Results by kind of job.
    pub jobs: BTreeMap<&'static str, JobUse>,
    /// Jobs that were given up, with the reason.
    pub given_up: Vec<(u64, String)>,
    /// Attempts that failed, on any worker.
    pub failed: u64,
    /// Every worker, added up over the coordinator's processes.
    pub workers: Vec<WorkerAccount>,
    /// All of them together.
    pub spent: Spent,
    /// Why workers went, with how often; the most frequent first.
    pub left: Vec<(String, u64)>,
    /// What of the journal could not be read.
    pub damage: Vec<Damage>,
}

/// Reads the account of a journal.
///
/// # Errors
/// [`JournalError::Io`] if it cannot be read, [`JournalError::Version`] if another version wrote it.
pub fn read(path: &Path) -> Result<RunAccount, JournalError> {
    let mut folding = Folding::default();
    let report = journal::fold(path, |_, event| folding.apply(&event))?;
    Ok(folding.finish(report.damage))
}

/// Reads the account of a journal, and what every job cost.
///
/// # Errors
/// [`JournalError::Io`] if it cannot be read, [`JournalError::Version`] if another version wrote it.
pub fn read_with_costs(path: &Path) -> Result<(RunAccount, Costs), JournalError> {
    let (mut folding, mut costs) = (Folding::default(), Costs::new());
    let report = journal::fold(path, |_, event| {
        if let Event::Finished(finished) = &event {
            cost::add(&mut costs, finished);
        }
        folding.apply(&event);
    })?;
    Ok((folding.finish(report.damage), costs))
}

/// An account while the journal is read, for whoever reads it for other reasons too.
#[derive(Debug, Default)]
pub struct Folding {
    account: RunAccount,
    rows: BTreeMap<(WorkerId, u32), WorkerAccount>,
    left: BTreeMap<String, u64>,
    jobs: job::Jobs,
    /// How long each process lasted \[ms\].
    lasted: BTreeMap<u32, u64>,
}

impl Folding {
    /// Takes the next event.
    pub fn apply(&mut self, event: &Event) {
        match event {
            Event::Opened { .. } => self.account.processes += 1,
            Event::Finished(finished) => {
                self.account.results += 1;
                self.jobs.add(finished);
            }
            Event::Left { reason, .. } => *self.left.entry(reason.clone()).or_default() += 1,
            Event::Accounted(said) => {
                let longest = self.lasted.entry(said.epoch).or_default();
                *longest = said.at_ms.max(*longest);
                for row in &said.workers {
                    // the last word about a worker in a process counts
                    self.rows.insert((row.worker, said.epoch), row.clone());
                }
            }
            Event::Begun { .. }
            | Event::Joined { .. }
            | Event::Closed
            | Event::Proved { .. }
            | Event::Asked { .. } => {}
        }
    }

    /// The account, with what of the journal could not be read.
    pub fn finish(self, damage: Vec<Damage>) -> RunAccount {
        let mut account = self.account;
        account.damage = damage;
        account.wall_s = self.lasted.values().sum::<u64>() as f64 / 1e3;
        (account.jobs, account.given_up) = self.jobs.counted();
        for row in self.rows.into_values() {
            account.spent.add(&row.spent);
            account.failed += row.failed;
            match account.workers.last_mut() {
                Some(last) if last.worker == row.worker => {
                    last.done += row.done;
                    last.failed += row.failed;
                    last.spent.add(&row.spent);
                }
                Some(_) | None => account.workers.push(row),
            }
        }
        account.left = self.left.into_iter().collect();
        account
            .left
            .sort_by_key(|(_, times)| std::cmp::Reverse(*times));
        account
    }
}

impl RunAccount {
    /// By machine.
    pub fn hosts(&self) -> BTreeMap<&str, HostUse> {
        let mut hosts: BTreeMap<&str, HostUse> = BTreeMap::new();
        for row in &self.workers {
            let host = hosts.entry(&row.host).or_default();
            host.workers += 1;
            host.slots = host.slots.max(row.slots);
            host.done += row.done;
            host.failed += row.failed;
            host.spent.add(&row.spent);
        }
        hosts
    }

    /// Why slots were not useful, in words, the greatest share first.
    pub fn reasons(&self) -> Vec<String> {
        reasons(&self.spent)
    }
}

/// Why slot time was not useful, in words, the greatest share first; one sentence if it was.
pub fn reasons(spent: &Spent) -> Vec<String> {
    if spent.connected_us == 0 {
        return vec!["no worker was connected for a measurable time".to_owned()];
    }
    let mut kinds: Vec<(&str, f64)> = spent
        .kinds()
        .into_iter()
        .map(|(kind, us)| (kind, us as f64 / spent.connected_us as f64))
        .filter(|(kind, share)| *kind != "useful" && *share >= NOTABLE)
        .collect();
    kinds.sort_by(|a, b| b.1.total_cmp(&a.1));
    let sentence = |(kind, share): &(&str, f64)| {
        let why = match *kind {
            "barrier" => {
                "barrier: everything asked for was given out and the search waited for the last \
                 results; a search without generations (--preset window) or fewer workers leave \
                 less idle"
            }
            "starved" => {
                "starved: slots waited for the case, for the next order, for a journal that could \
                 not be written, or the run asked for nothing; look at the network, at the \
                 coordinator's load and at the disk"
            }
            "speculative" => {
                "speculative: copies of slow jobs that were not needed in the end; some workers \
                 are slower than others"
            }
            "failed" => {
                "failed: attempts that crashed or ran out of time; the warnings of the run name \
                 the jobs"
            }
            _ => {
                "lost: attempts on workers that were lost, or that nobody answered for; see why \
                 workers left"
            }
        };
        format!("{:.0} % {why}", 100.0 * share)
    };
    if kinds.is_empty() {
        return vec!["slots were busy with results nearly all the time".to_owned()];
    }
    kinds.iter().map(sentence).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::journal::{Journal, sample::finished};
    use protocol::{
        event::{Account, RunHeader},
        id::{ContentHash, RunId},
        job::{Answer, Failure, Outcome},
    };

    fn row(worker: u64, useful_us: u64, barrier_us: u64) -> WorkerAccount {
        WorkerAccount {
            worker: WorkerId(worker),
            host: "host".to_owned(),
            slots: 1,
            done: 3,
            failed: 1,
            spent: Spent {
                connected_us: useful_us + barrier_us,
                useful_us,
                barrier_us,
                ..Spent::default()
            },
        }
    }

    #[test]
    fn the_last_account_of_each_process_counts_and_processes_add_up() {
        let folder = tempfile::tempdir().unwrap();
        let header = RunHeader {
            kind: "test".to_owned(),
            case: ContentHash::of(b""),
            settings: String::new(),
        };
        let accounted = |epoch, workers| {
            Event::Accounted(Box::new(Account {
                epoch,
                at_ms: 1,
                workers,
            }))
        };
        for epoch in 1..=2 {
            let (journal, begun) =
                Journal::open(folder.path(), &header, RunId(1), 0, |_| {}).unwrap();
            assert_eq!(begun.epoch, epoch);
            let early = accounted(epoch, vec![row(1, 10, 10)]);
            let late = accounted(epoch, vec![row(1, 60, 20), row(2, 20, 0)]);
            for event in [early, late] {
                journal.append(event).unwrap();
            }
            let place = u64::from(epoch);
            for (job, seconds, outcome) in [
                (
                    place,
                    2 * place - 1,
                    Outcome::Done(Answer::Nothing(vec![1])),
                ),
                (
                    place + 2,
                    2 * place,
                    Outcome::Done(Answer::Nothing(vec![1])),
                ),
                (9, 1, Outcome::Failed(Failure::Lost { workers: 4 })),
            ] {
                journal
                    .append(finished(job, seconds * 1_000_000, outcome))
                    .unwrap();
            }
        }
        let account = read(&folder.path().join(journal::FILE)).unwrap();
        assert_eq!((account.processes, account.workers.len()), (2, 2));
        assert_eq!(account.workers[0].spent.useful_us, 120);
        assert_eq!(account.workers[0].done, 6);
        assert_eq!(account.spent.connected_us, 200);
        assert_eq!(account.failed, 4);
        assert_eq!((account.results, account.wall_s), (6, 0.002));
        let hosts = account.hosts();
        assert_eq!((hosts["host"].workers, hosts["host"].done), (2, 12));
        let nothing = account.jobs["nothing"];
        assert_eq!((nothing.results, nothing.machine_failed), (4, 0));
        assert_eq!((nothing.median_s, nothing.longest_s), (2.0, 4.0));
        let given_up = (9, "4 workers were lost over it".to_owned());
        assert_eq!(account.given_up, [given_up.clone(), given_up]);
        let reasons = account.reasons();
        assert_eq!(reasons.len(), 1);
        assert!(reasons[0].starts_with("20 % barrier: "), "{reasons:?}");
    }
}
