//! Process tree below a process, found through parent process ids, so that neither a new session nor a
//! cleared environment hides a process. Independent of slots and jobs.
use rustix::{
    io,
    process::{Pid, Signal, kill_process},
};
use std::{fs, thread, time::Duration};

/// Largest number of passes made to end a process tree that keeps growing; `PAUSE` is the time between
/// passes.
const MAX_PASSES: u32 = 500;
const PAUSE: Duration = Duration::from_millis(2);

/// Process as listed by the operating system.
#[derive(Clone, Copy, Debug)]
struct Listed {
    pid: i32,
    parent: i32,
    is_over: bool,
}

/// Ends all direct and indirect descendants of `root`, but not `root` itself. Orphaned descendants are found
/// only where `root` inherits them (as a subreaper).
pub(crate) fn end_below(root: Pid) {
    for _ in 0..MAX_PASSES {
        let living: Vec<Pid> = below(root.as_raw_nonzero().get())
            .into_iter()
            .filter_map(Pid::from_raw)
            .collect();
        if living.is_empty() {
            return;
        }
        for pid in living {
            // fails if it has just ended
            drop(kill_process(pid, Signal::KILL).map_err(std::io::Error::from));
        }
        thread::sleep(PAUSE);
    }
}

/// Ends a process and all its descendants. The process is stopped first, so that it starts no more of them
/// meanwhile.
pub(crate) fn end_with_all(root: Pid) {
    let tell = |signal| -> io::Result<()> { kill_process(root, signal) };
    drop(tell(Signal::STOP).map_err(std::io::Error::from));
    end_below(root);
    drop(tell(Signal::KILL).map_err(std::io::Error::from));
}

/// Returns the descendants of a process that have not ended.
fn below(root: i32) -> Vec<i32> {
    let all = listed();
    let mut found = vec![root];
    let mut at = 0;
    while at < found.len() {
        let parent = found[at];
        let children = all.iter().filter(|one| one.parent == parent);
        let new: Vec<i32> = children
            .map(|one| one.pid)
            .filter(|pid| !found.contains(pid))
            .collect();
        found.extend(new);
        at += 1;
    }
    let living = |pid: &i32| all.iter().any(|one| one.pid == *pid && !one.is_over);
    found.into_iter().skip(1).filter(living).collect()
}

fn listed() -> Vec<Listed> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    let listed = entries.filter_map(|entry| {
        let pid = entry.file_name().to_str()?.parse().ok()?;
        let stat = fs::read_to_string(entry.path().join("stat")).ok()?;
        // behind the name, which is in parentheses and may hold anything
        let (_, rest) = stat.rsplit_once(')')?;
        let mut words = rest.split_whitespace();
        let state = words.next()?;
        let parent = words.next()?.parse().ok()?;
        Some(Listed {
            pid,
            parent,
            is_over: matches!(state, "Z" | "X"),
        })
    });
    listed.collect()
}
