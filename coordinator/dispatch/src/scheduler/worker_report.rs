//! Detailed list of a run's workers, built on request for control clients.
use super::{member::Member, state::Core};
use protocol::id::WorkerId;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// State of a connected worker, as `workers list` prints it in a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorkerReport {
    /// Name in the worker's certificate; `anyone` without key material.
    pub name: String,
    /// Identifier of the worker process, 16 hexadecimal digits.
    pub id: String,
    /// Host name of the worker.
    pub host: String,
    /// Process id of the worker on its host.
    #[serde(default)]
    pub pid: u32,
    /// Whether the run started the worker on its own machine.
    #[serde(default)]
    pub local: bool,
    /// Number of slots of the worker, i.e. of simultaneous simulations.
    pub slots: u32,
    /// Version and build profile of the worker program.
    pub version: String,
    /// Phase of the worker: joining, working, draining or drained.
    pub state: WorkerPhase,
    /// Jobs held by the worker, those running in slots first.
    pub jobs: Vec<HeldJob>,
    /// Number of results that the worker has delivered.
    pub done: u64,
    /// Number of attempts that failed on the worker.
    pub failed: u64,
    /// Results per minute that the worker has delivered since it joined.
    pub per_minute: f64,
    /// Time since the worker joined \[s\].
    pub present_s: f64,
    /// Time since the last message of the worker \[s\]; workers send one every second.
    pub last_seen_s: f64,
}

/// Phase of a worker's participation in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WorkerPhase {
    /// The worker is fetching the case and proving that its results equal those of the other workers.
    Joining,
    /// The worker takes jobs.
    Working,
    /// The worker finishes its jobs and gets no more.
    Draining,
    /// The worker holds no job and gets none.
    Drained,
}

/// Job held by a worker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldJob {
    /// Number of the job.
    pub job: u64,
    /// Time since the job was sent \[s\].
    pub for_s: f64,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "nobody below needs to know what is shown of the state"
)]
impl Core {
    /// Returns all connected workers, ordered by id. `named` returns the name of a worker by its id, host and process id,
    /// and whether the run started it on its own machine.
    pub fn worker_reports(
        &self,
        now: Duration,
        named: impl Fn(WorkerId, &str, u32) -> (String, bool),
    ) -> Vec<(WorkerId, WorkerReport)> {
        let members = self.members.iter();
        let one = |(id, member): (&WorkerId, &Member)| {
            let announced = &member.announcement;
            let named = named(*id, &announced.host, announced.pid);
            (*id, report((*id, member), named, now))
        };
        members.map(one).collect()
    }
}

fn report(
    (id, member): (WorkerId, &Member),
    (name, local): (String, bool),
    now: Duration,
) -> WorkerReport {
    let present_s = now.saturating_sub(member.joined_at).as_secs_f64();
    let jobs = member.leases.iter().map(|lease| HeldJob {
        job: lease.attempt.job.0,
        for_s: now.saturating_sub(lease.sent).as_secs_f64(),
    });
    WorkerReport {
        name,
        id: id.to_string(),
        host: member.announcement.host.clone(),
        pid: member.announcement.pid,
        local,
        slots: member.announcement.slots,
        version: member.announcement.build.clone(),
        state: match (member.drained, member.ready) {
            (true, _) if member.leases.is_empty() => WorkerPhase::Drained,
            (true, _) => WorkerPhase::Draining,
            (false, true) => WorkerPhase::Working,
            (false, false) => WorkerPhase::Joining,
        },
        jobs: jobs.collect(),
        done: member.done,
        failed: member.failed,
        // of a worker that has just come nothing is known yet
        per_minute: 60.0 * member.done as f64 / present_s.max(1.0),
        present_s,
        last_seen_s: now.saturating_sub(member.last_heard).as_secs_f64(),
    }
}
