//! List of the workers that may join, read again while the coordinator runs: added names are admitted,
//! removed names are disconnected.
use super::{inner::RouterConnector, terms::CONNECTIONS};
use crate::keys::Keys;
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
    time::Duration,
};
use tokio::{
    sync::{Semaphore, watch},
    time::{MissedTickBehavior, interval, timeout},
};

/// Interval between readings of the list; a removed worker is disconnected well within five seconds.
const AGAIN: Duration = Duration::from_secs(1);
/// Maximum time for which an unlisted peer waits for the next reading of the list, because its name may have
/// been written only just before its launch.
const FRESH: Duration = Duration::from_millis(1200);

/// Names of the workers that may join, each with a semaphore whose permits are its free connections.
#[derive(Clone, Debug)]
pub(super) struct AllowList(BTreeMap<String, Arc<Semaphore>>);

impl AllowList {
    /// Creates the list from the names of workers, none of which has a connection yet.
    pub(super) fn new(names: &BTreeSet<String>) -> Self {
        let places = |name: &String| (name.clone(), Arc::new(Semaphore::new(CONNECTIONS)));
        Self(names.iter().map(places).collect())
    }

    /// Returns the semaphore that limits a worker's connections, if its name is on the list.
    pub(super) fn places(&self, name: &str) -> Option<Arc<Semaphore>> {
        self.0.get(name).cloned()
    }

    /// Replaces the names of the list; names on both lists keep their semaphores, and so their connections.
    /// Returns whether the set of names has changed.
    fn change(&mut self, names: &BTreeSet<String>) -> bool {
        if self.0.keys().eq(names) {
            return false;
        }
        let Self(mut stays) = Self::new(names);
        for (name, places) in &mut stays {
            if let Some(old) = self.0.remove(name) {
                *places = old;
            }
        }
        self.0 = stays;
        true
    }
}

/// Reads the list periodically and publishes changes. A list that cannot be read changes nothing and is
/// logged once; so is a name for which the coordinator made no access rules at its start.
pub(super) async fn read_again(
    keys: Keys,
    inner: Arc<RouterConnector>,
    say: watch::Sender<AllowList>,
) {
    let mut ticks = interval(AGAIN);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut told = BTreeSet::new();
    loop {
        ticks.tick().await;
        let reading = keys.clone();
        let Ok(read) = tokio::task::spawn_blocking(move || reading.workers_now()).await else {
            return;
        };
        let (names, without): (BTreeSet<_>, BTreeSet<_>) = match read {
            Ok(names) => names.into_iter().partition(|name| inner.knows(name)),
            Err(error) => {
                if told.insert(error.to_string()) {
                    tracing::warn!(
                        "the list of workers could not be read and was not updated: {error}"
                    );
                }
                continue;
            }
        };
        for name in without {
            if told.insert(name.clone()) {
                tracing::warn!(
                    "\"{name}\" may join once this command is started again: while it runs, \
                     there is room for further names only of the form worker-01, worker-02"
                );
            }
        }
        say.send_if_modified(|listed| listed.change(&names));
    }
}

/// Returns the semaphore that limits a worker's connections; if its name is not on the list, waits briefly
/// for the next reading.
pub(super) async fn places(
    mut listed: watch::Receiver<AllowList>,
    name: &str,
) -> Option<Arc<Semaphore>> {
    let there = listed.wait_for(|listed| listed.places(name).is_some());
    let listed = timeout(FRESH, there).await.ok()?.ok()?;
    listed.places(name)
}

/// Completes once a name is no longer on the list.
pub(super) async fn removed(mut listed: watch::Receiver<AllowList>, name: &str) {
    // without the one who reads the list nobody is taken off it
    if listed
        .wait_for(|listed| listed.places(name).is_none())
        .await
        .is_err()
    {
        std::future::pending::<()>().await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_stays_on_the_list_keeps_its_connections() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let mut listed = AllowList::new(&names(&["a", "b"]));
        let places = listed.places("a").unwrap();
        let _taken = places.try_acquire().unwrap();
        assert!(!listed.change(&names(&["b", "a"])));
        assert!(listed.change(&names(&["a", "c"])));
        let left = |name: &str| listed.places(name).map(|places| places.available_permits());
        assert_eq!(left("a"), Some(CONNECTIONS - 1));
        assert_eq!((left("b"), left("c")), (None, Some(CONNECTIONS)));
    }
}
