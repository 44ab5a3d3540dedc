//! Account of how the slots of a run spent their time, and why: a fold over the run's journal.
//!
//! Sums the accounts that the coordinator core recorded (one row per worker and coordinator process) and
//! explains the causes in words. It makes no decisions and depends neither on workers nor on sockets.
mod cost;
mod job;

pub use cost::{Costs, JobCost};
pub use job::JobUse;

use crate::event::{Event, Spent, WorkerAccount};
use crate::{Damage, JournalError, fold};
use protocol::id::WorkerId;
use std::{collections::BTreeMap, path::Path};

/// Minimum share of slot time from which a cause of lost slot time is reported \[1\].
const NOTABLE: f64 = 0.02;

/// Slot use of the workers of one host.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HostUse {
    /// Number of worker processes; a restarted worker counts again.
    pub workers: u64,
    /// Slots of the host's largest worker.
    pub slots: u32,
    /// Accepted results from the host's workers.
    pub done: u64,
    /// Number of attempts at jobs that failed on the host.
    pub failed: u64,
    /// Slot time of the host's workers, divided by what the slots did.
    pub spent: Spent,
}

/// Account of a run's slot time, jobs and workers, read from its journal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunAccount {
    /// Number of coordinator processes that worked on the run.
    pub processes: u32,
    /// Number of results recorded in the run's journal.
    pub results: u64,
    /// Total working time of the coordinator processes, as far as accounted \[s\].
    pub wall_s: f64,
    /// Statistics of results by kind of job.
    pub jobs: BTreeMap<&'static str, JobUse>,
    /// Numbers of the jobs that were given up, each with the reason.
    pub given_up: Vec<(u64, String)>,
    /// Number of attempts that failed, on any worker.
    pub failed: u64,
    /// Slot time and results of each worker, summed over the coordinator processes.
    pub workers: Vec<WorkerAccount>,
    /// Slot time of all workers, divided by what the slots did.
    pub spent: Spent,
    /// Reasons why workers left, with their counts; the most frequent first.
    pub left: Vec<(String, u64)>,
    /// Presence of the workers over time, by coordinator process and worker.
    pub presence: Vec<Presence>,
    /// Stretches of the journal that could not be read.
    pub damage: Vec<Damage>,
}

/// Presence of one worker in one coordinator process, with the use of its slots over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Presence {
    /// Worker that was present.
    pub worker: WorkerId,
    /// Host name of the worker's machine.
    pub host: String,
    /// Accounts in order of time.
    pub marks: Vec<PresenceMark>,
}

/// Account of one worker at one time; sums are those since it joined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PresenceMark {
    /// Working time of the run's coordinator processes up to the account \[s\].
    pub at_s: f64,
    /// Time for which the worker was connected \[s\].
    pub connected_s: f64,
    /// Share of the slots' connected time that was spent on accepted results \[1\].
    pub useful_share: f64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
}

/// Reads the account from a journal.
///
/// # Errors
/// [`JournalError::Io`] if the journal cannot be read, [`JournalError::Version`] if another version wrote it.
pub fn read(path: &Path) -> Result<RunAccount, JournalError> {
    let mut folding = AccountBuilder::default();
    let report = fold(path, |_, event| folding.apply(&event))?;
    Ok(folding.finish(report.damage))
}

/// Reads the account and the cost of each job from a journal.
///
/// # Errors
/// [`JournalError::Io`] if the journal cannot be read, [`JournalError::Version`] if another version wrote it.
pub fn read_with_costs(path: &Path) -> Result<(RunAccount, Costs), JournalError> {
    let (mut folding, mut costs) = (AccountBuilder::default(), Costs::new());
    let report = fold(path, |_, event| {
        if let Event::Finished(finished) = &event {
            cost::add(&mut costs, finished);
        }
        folding.apply(&event);
    })?;
    Ok((folding.finish(report.damage), costs))
}

/// Accumulator of a run's account, for callers that read the journal's events for other purposes too.
#[derive(Clone, Debug, Default)]
pub struct AccountBuilder {
    account: RunAccount,
    rows: BTreeMap<(WorkerId, u32), WorkerAccount>,
    left: BTreeMap<String, u64>,
    jobs: job::Jobs,
    /// Duration of each coordinator process, by epoch \[ms\].
    lasted: BTreeMap<u32, u64>,
    /// Accounts of each worker in each coordinator process with the time of each in the process \[ms\].
    accounts: BTreeMap<(u32, WorkerId), Vec<(u64, WorkerAccount)>>,
}

impl AccountBuilder {
    /// Adds the next event of the journal.
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
                    let own = self.accounts.entry((said.epoch, row.worker)).or_default();
                    own.push((said.at_ms, row.clone()));
                }
            }
            Event::Begun { .. }
            | Event::Joined { .. }
            | Event::Closed
            | Event::Proved { .. }
            | Event::Asked(_)
            | Event::Found { .. } => {}
        }
    }

    /// Completes the account; `damage` lists the unreadable stretches of the journal.
    pub fn finish(self, damage: Vec<Damage>) -> RunAccount {
        let mut account = self.account;
        account.damage = damage;
        account.presence = presence(&self.accounts, &self.lasted);
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

/// Places the accounts of workers on the working time of the run, in which one coordinator process follows
/// another.
fn presence(
    accounts: &BTreeMap<(u32, WorkerId), Vec<(u64, WorkerAccount)>>,
    lasted: &BTreeMap<u32, u64>,
) -> Vec<Presence> {
    let one = |((epoch, worker), rows): (&(u32, WorkerId), &Vec<(u64, WorkerAccount)>)| {
        let earlier_ms: u64 = lasted.range(..epoch).map(|(_, ms)| ms).sum();
        let mark = |(at_ms, row): &(u64, WorkerAccount)| {
            let connected = row.spent.connected_us as f64 / 1e6;
            PresenceMark {
                at_s: (earlier_ms + at_ms) as f64 / 1e3,
                connected_s: connected / f64::from(row.slots.max(1)),
                useful_share: row.spent.useful_us as f64 / row.spent.connected_us.max(1) as f64,
                failed: row.failed,
            }
        };
        Presence {
            worker: *worker,
            host: rows
                .first()
                .map_or_else(String::new, |(_, row)| row.host.clone()),
            marks: rows.iter().map(mark).collect(),
        }
    };
    accounts.iter().map(one).collect()
}

impl RunAccount {
    /// Sums the use of slots by host.
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

    /// Explains in words why slot time was not useful, greatest share first.
    pub fn reasons(&self) -> Vec<String> {
        reasons(&self.spent)
    }
}

/// Explains in words why slot time was not useful, greatest share first; returns a single sentence if nearly
/// all of it was useful.
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
                "barrier: all requested jobs were assigned and the search waited for the last results; \
                 a search without generations (--preset window) or fewer workers reduce the \
                 idle time"
            }
            "starved" => {
                "starved: slots waited for the case, for the next job, for a journal that could \
                 not be written, or the run requested no jobs; check the network, the \
                 coordinator's load and the disk"
            }
            "speculative" => {
                "speculative: copies of slow jobs that were not needed in the end, and jobs that idle \
                 slots computed ahead but the search did not request; neither delayed a requested job"
            }
            "failed" => {
                "failed: attempts that crashed or exceeded their deadline; the warnings of the run name \
                 the jobs"
            }
            _ => {
                "lost: attempts on workers that were lost, or that were never answered; see the reasons \
                 why workers left"
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
    use crate::event::{Account, RunHeader};
    use crate::{FILE, Journal, sample::finished};
    use protocol::{
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
                (
                    9,
                    1,
                    Outcome::Failed(Failure::crashed("signal 9".to_owned())),
                ),
            ] {
                journal
                    .append(finished(job, seconds * 1_000_000, outcome))
                    .unwrap();
            }
        }
        let account = read(&folder.path().join(FILE)).unwrap();
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
        let reason = "signal 9";
        let given_up = (9, reason.to_owned());
        assert_eq!(account.given_up, [given_up.clone(), given_up]);
        let reasons = account.reasons();
        assert_eq!(reasons.len(), 1);
        assert!(reasons[0].starts_with("20 % barrier: "), "{reasons:?}");
    }
}
