//! Map from worker ids to the workers' names on the bus, limited in number per certificate.
use crate::gate::terms::CONNECTIONS;
use protocol::{
    id::WorkerId,
    name::{NO_CERTIFICATE, WorkerName},
};
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

/// Maximum number of workers without a certificate: those on loopback, and on networks opened with
/// `--insecure`.
const OF_ANYONE: usize = 4096;
/// Duration without frames after which a worker's name may be replaced by another one of the same
/// certificate. Longer than the time after which a worker counts as lost, so that no certificate works under
/// more names than it may have.
const SILENT: Duration = Duration::from_secs(10);
/// Interval during which a certificate at its limit gets no further worker names and no search is made for
/// silent ones to replace.
const PAUSE: Duration = Duration::from_millis(100);

/// Worker names from which frames have been received, by worker id and by certificate owner.
#[derive(Debug, Default)]
pub(super) struct Names {
    known: BTreeMap<WorkerId, Known>,
    owners: BTreeMap<String, Owner>,
}

#[derive(Debug)]
struct Known {
    name: WorkerName,
    heard: Instant,
}

#[derive(Debug, Default)]
struct Owner {
    names: usize,
    /// Time until which new names of this certificate are refused without a search for silent ones.
    full_until: Option<Instant>,
    told: bool,
}

impl Names {
    /// Records a frame from a worker's name and returns the worker's id; `None` if its certificate has the
    /// maximum number of workers.
    pub(super) fn note(&mut self, name: WorkerName, now: Instant) -> Option<WorkerId> {
        let id = name.id();
        if let Some(known) = self.known.get_mut(&id) {
            known.heard = now;
            return Some(id);
        }
        self.make_room(name.owner(), now).then_some(())?;
        let owner = self.owners.entry(name.owner().to_owned()).or_default();
        owner.names += 1;
        self.known.insert(id, Known { name, heard: now });
        Some(id)
    }

    /// Returns the name on the bus of the worker with this id.
    pub(super) fn of(&self, id: WorkerId) -> Option<&WorkerName> {
        self.known.get(&id).map(|known| &known.name)
    }

    /// Removes the name of a worker that has left.
    pub(super) fn forget(&mut self, id: WorkerId) {
        if let Some(known) = self.known.remove(&id)
            && let Some(owner) = self.owners.get_mut(known.name.owner())
        {
            owner.names -= 1;
            owner.full_until = None;
        }
    }

    /// Returns whether a certificate owner may have another worker name; to make room, removes its name that
    /// has been silent longest, if that exceeds [`SILENT`].
    fn make_room(&mut self, owner: &str, now: Instant) -> bool {
        let most = if owner == NO_CERTIFICATE {
            OF_ANYONE
        } else {
            CONNECTIONS
        };
        let Some(state) = self.owners.get_mut(owner) else {
            return true;
        };
        if state.names < most {
            return true;
        }
        if state.full_until.is_some_and(|until| now < until) {
            return false;
        }
        let of_owner = self
            .known
            .iter()
            .filter(|(_, known)| known.name.owner() == owner);
        let silent = of_owner
            .min_by_key(|(_, known)| known.heard)
            .filter(|(_, known)| now.saturating_duration_since(known.heard) > SILENT)
            .map(|(id, _)| *id);
        if let Some(silent) = silent {
            self.forget(silent);
            return true;
        }
        state.full_until = Some(now + PAUSE);
        if !std::mem::replace(&mut state.told, true) {
            tracing::warn!(
                "\"{owner}\" has {most} workers, the maximum per certificate: further ones \
                 are not heard"
            );
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(owner: &str, process: u64) -> WorkerName {
        WorkerName::of(owner, process).unwrap()
    }

    /// Checks that a certificate with any number of process names gets no more worker ids than connections,
    /// keeps those it has, and does not displace those of other certificates.
    #[test]
    fn a_flood_of_names_gets_no_more_than_its_share_and_takes_nothing_from_others() {
        let (mut names, begun) = (Names::default(), Instant::now());
        let at = |ms: u64| begun + Duration::from_millis(ms);
        let steady = names.note(name("steady", 0), begun).unwrap();
        let mut admitted = 0;
        for process in 0..CONNECTIONS as u64 * 3 {
            admitted += usize::from(names.note(name("flood", process), at(process)).is_some());
        }
        assert_eq!(admitted, CONNECTIONS);
        assert_eq!(
            names.note(name("flood", 0), at(5000)),
            Some(name("flood", 0).id())
        );
        assert_eq!(
            names.note(name("steady", 1), at(5000)),
            Some(name("steady", 1).id())
        );
        assert!(names.of(steady).is_some());
        // a name that says no more gives way
        let late = at(12_000);
        assert_eq!(
            names.note(name("flood", 9_999_999), late),
            Some(name("flood", 9_999_999).id())
        );
        assert!(
            names.of(name("flood", 1).id()).is_none(),
            "silent for longest"
        );
        assert!(names.of(name("flood", 0).id()).is_some());
        assert_eq!(names.owners["flood"].names, CONNECTIONS);
        // and so does one that is gone
        assert_eq!(names.note(name("flood", 7_000_000), begun), None);
        names.forget(name("flood", 5).id());
        assert!(names.note(name("flood", 7_000_000), begun).is_some());
    }
}
