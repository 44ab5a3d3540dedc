//! Which name on the bus stands behind each worker id, for as many as one certificate may have.
use protocol::{id::WorkerId, name::WorkerName};
use std::collections::BTreeMap;

/// Workers of one certificate that are remembered: beyond it the one that has been silent for
/// longest is forgotten, so that no peer can fill the memory with names.
const MOST: usize = 4096;

/// The names that were heard.
#[derive(Debug, Default)]
pub(super) struct Names {
    known: BTreeMap<WorkerId, Known>,
    /// How many of each owner.
    owners: BTreeMap<String, usize>,
    heard: u64,
}

#[derive(Debug)]
struct Known {
    name: WorkerName,
    heard: u64,
}

impl Names {
    /// A name was heard; its id.
    pub(super) fn note(&mut self, name: WorkerName) -> WorkerId {
        let id = name.id();
        self.heard += 1;
        let heard = self.heard;
        if let Some(known) = self.known.get_mut(&id) {
            known.heard = heard;
            return id;
        }
        let count = self.owners.entry(name.owner().to_owned()).or_default();
        *count += 1;
        if *count > MOST {
            self.forget_oldest(name.owner());
        }
        self.known.insert(id, Known { name, heard });
        id
    }

    /// The name behind an id.
    pub(super) fn of(&self, id: WorkerId) -> Option<&WorkerName> {
        self.known.get(&id).map(|known| &known.name)
    }

    /// A worker is gone.
    pub(super) fn forget(&mut self, id: WorkerId) {
        if let Some(known) = self.known.remove(&id)
            && let Some(count) = self.owners.get_mut(known.name.owner())
        {
            *count -= 1;
        }
    }

    fn forget_oldest(&mut self, owner: &str) {
        let of_owner = self
            .known
            .iter()
            .filter(|(_, known)| known.name.owner() == owner);
        let oldest = of_owner.min_by_key(|(_, known)| known.heard);
        if let Some(id) = oldest.map(|(id, _)| *id) {
            self.forget(id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_of_names_displaces_only_its_own_silent_ones() {
        let mut names = Names::default();
        let steady = names.note(WorkerName::of("steady", 0).unwrap());
        let talker = WorkerName::of("flood", 0).unwrap();
        for process in 1..=MOST as u64 * 2 {
            names.note(WorkerName::of("flood", process).unwrap());
            names.note(talker.clone());
        }
        assert_eq!(names.known.len(), MOST + 1);
        assert!(names.of(steady).is_some() && names.of(talker.id()).is_some());
        names.forget(talker.id());
        assert!(names.of(talker.id()).is_none());
        assert_eq!(names.owners["flood"], MOST - 1);
    }
}
