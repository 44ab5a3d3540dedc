//! Pages of a folder of runs: a table that compares them, and the page of each.
use super::{
    board::{Board, PageReader},
    follow::{Followed, has_grown_lately, is_locked},
    server::Pages,
    simulator::Simulator,
};
use journal::event::Event;
use journal::{Growth, JournalFollower};
use maud::{Markup, html};
use report::{
    Block, Section,
    number::{MISSING, count, duration, significant},
};
use run::folder::{MANIFEST, RESULT, RunFolder};
use serde_json::{Map, Value};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

/// Interval at which the folder is read.
const INTERVAL: Duration = Duration::from_secs(2);
/// Maximum number of runs that are followed at a time; of more, the one requested longest ago is given up, and an
/// open page of it asks for it again.
const MOST_FOLLOWED: usize = 16;

/// Pages of a folder of runs; a run is followed from the first request for its page.
pub struct FolderPages {
    path: PathBuf,
    index: PageReader,
    /// Followed runs by name, each with the time of the last request for it.
    followed: Mutex<BTreeMap<String, (Arc<Followed>, Instant)>>,
    simulator: Simulator,
    /// Kept so that the thread that reads the folder ends with the pages.
    _open: Arc<()>,
}

impl FolderPages {
    /// Begins to list the runs of a folder.
    pub fn begin(path: &Path) -> Self {
        let board = Board::new("Runs", &path.display().to_string());
        let index = board.reader();
        let open = Arc::new(());
        let (folder, wanted) = (path.to_owned(), Arc::downgrade(&open));
        thread::spawn(move || {
            let (mut board, mut counts) = (board, Counts::default());
            // to count results takes a while where there are long journals
            board.publish(("Runs", "folder"), &[list(&folder, None)], true);
            while wanted.strong_count() > 0 {
                let section = list(&folder, Some(&mut counts));
                counts.forget_others();
                board.publish(("Runs", "folder"), &[section], true);
                thread::sleep(INTERVAL);
            }
        });
        Self {
            path: path.to_owned(),
            index,
            followed: Mutex::default(),
            simulator: Simulator::new(),
            _open: open,
        }
    }

    /// Ends the worker of the pages' simulator, and removes its temporary run.
    pub fn close(&self) {
        let mut followed = self.followed.lock().unwrap_or_else(PoisonError::into_inner);
        followed.clear();
        self.simulator.close();
    }

    /// Returns a reader of a run's page, which is followed from now on; `None` if the folder has no such run.
    fn follow(&self, name: &str) -> Option<PageReader> {
        // a name is one folder of this folder, and no path
        let is_plain = !name.contains(['/', '\\', '\0']) && name != "." && name != "..";
        let path = self.path.join(name);
        let mut followed = self.followed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((own, requested)) = followed.get_mut(name) {
            *requested = Instant::now();
            return Some(own.reader());
        }
        if !is_plain || !RunFolder::new(&path).is_begun() {
            return None;
        }
        if followed.len() >= MOST_FOLLOWED {
            let oldest = followed.iter().min_by_key(|(_, (_, requested))| *requested);
            let oldest = oldest.map(|(name, _)| name.clone());
            followed.remove(&oldest?);
        }
        let own = Arc::new(Followed::begin(&path, &self.simulator));
        let reader = own.reader();
        followed.insert(name.to_owned(), (own, Instant::now()));
        Some(reader)
    }
}

impl Pages for FolderPages {
    fn start(&self) -> PageReader {
        self.index.clone()
    }

    fn run(&self, name: &str) -> Option<PageReader> {
        self.follow(name)
    }

    async fn individual(&self, run: &str, number: u64) -> Option<String> {
        let followed = {
            let followed = self.followed.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(&followed.get(run)?.0)
        };
        followed.individual(number).await
    }
}

/// Run as the table of a folder shows it.
struct Row {
    name: String,
    /// Command, preset, seed and case, in words.
    about: String,
    state: &'static str,
    simulations: Option<u64>,
    outcome: String,
    /// Objective of a calibration, by which the table can be sorted.
    objective: Option<f64>,
    wall_s: Option<f64>,
}

fn json(file: &Path) -> Option<Value> {
    serde_json::from_str(&fs::read_to_string(file).ok()?).ok()
}

/// Journals of unfinished runs, whose results are counted as they grow.
#[derive(Default)]
struct Counts {
    journals: BTreeMap<PathBuf, (JournalFollower, u64)>,
    /// Runs that were counted since [`Counts::forget_others`].
    counted: BTreeSet<PathBuf>,
}

impl Counts {
    /// Closes the journals of runs that were not counted since the last call.
    fn forget_others(&mut self) {
        let counted = std::mem::take(&mut self.counted);
        self.journals.retain(|run, _| counted.contains(run));
    }

    /// Returns the number of results in the journal of a run; `None` if it cannot be read.
    fn of(&mut self, run: &Path) -> Option<u64> {
        let new = || (JournalFollower::new(&run.join(journal::FILE)), 0);
        self.counted.insert(run.to_owned());
        let (follower, count) = self.journals.entry(run.to_owned()).or_insert_with(new);
        loop {
            let read =
                follower.read(|_, event| *count += u64::from(matches!(&event, Event::Finished(_))));
            match read.ok()? {
                Growth::Replaced => *count = 0,
                Growth::Missing => return None,
                Growth::Unchanged | Growth::Grown => return Some(*count),
            }
        }
    }
}

impl Row {
    /// Reads a run folder; `None` if it holds no run.
    fn read(folder: &Path, counts: Option<&mut Counts>) -> Option<Self> {
        let name = folder.file_name()?.to_string_lossy().into_owned();
        if !folder.join(MANIFEST).exists() {
            return None;
        }
        let Some(manifest) = json(&folder.join(MANIFEST)) else {
            return Some(Self {
                name,
                about: String::new(),
                state: "damaged",
                simulations: None,
                outcome: format!("{MANIFEST} cannot be read"),
                objective: None,
                wall_s: None,
            });
        };
        let result = json(&folder.join(RESULT)).unwrap_or(Value::Null);
        let state = if is_locked(folder) {
            "running"
        } else if !result.is_null() {
            "finished"
        } else if has_grown_lately(folder) {
            "running"
        } else {
            "stopped"
        };
        let simulations = ["evaluations", "simulations"]
            .iter()
            .find_map(|key| result[key].as_u64());
        Some(Self {
            name,
            about: about(&manifest),
            state,
            simulations: simulations.or_else(|| counts?.of(folder)),
            outcome: outcome(&result),
            objective: result["objective"]["optimised"].as_f64(),
            wall_s: result["wall_s"].as_f64(),
        })
    }

    fn markup(&self) -> Markup {
        let missing = || MISSING.to_owned();
        html! {
            tr {
                th scope="row" {
                    a href=(format!("/runs/{}/", path_segment(&self.name))) { (self.name) }
                    div.about { (self.about) }
                }
                td data-label="state" { (self.state) }
                td.prose data-label="result" data-value=[self.objective] { (self.outcome) }
                td data-label="evaluations" data-value=[self.simulations] { (self.simulations.map_or_else(missing, count)) }
                td data-label="wall time" data-value=[self.wall_s] { (self.wall_s.map_or_else(missing, duration)) }
            }
        }
    }
}

/// Returns the command of a run with preset, seed and case, in words.
fn about(manifest: &Value) -> String {
    let case = Path::new(manifest["case_folder"].as_str().unwrap_or_default());
    let case = case.file_name().unwrap_or_default().to_string_lossy();
    let text = |key: &str| manifest[key].as_str().filter(|text| !text.is_empty());
    let mut words = vec![text("kind").unwrap_or("calibrate").to_owned()];
    words.extend(text("preset").map(str::to_owned));
    words.extend(manifest["seed"].as_u64().map(|seed| format!("seed {seed}")));
    words.extend((!case.is_empty()).then(|| format!("case {case}")));
    words.join(", ")
}

/// Returns the result of a finished run in a few words: the verdict and first effect of a diagnosis, the objective of a
/// calibration, the number of unknowns that an identification determines.
fn outcome(result: &Value) -> String {
    let first = &result["effects"][0];
    let effect = first["title"].as_str().or_else(|| first["id"].as_str());
    if let Some(verdict) = result["verdict"].as_str() {
        let verdict = verdict.replace('_', " ");
        return effect.map_or_else(|| verdict.clone(), |effect| format!("{verdict}: {effect}"));
    }
    let objective = &result["objective"];
    if let Some(optimised) = objective["optimised"].as_f64() {
        let recommended = objective["recommended"].as_f64();
        let before = recommended.map(|before| format!("{} → ", significant(before)));
        return format!(
            "objective {}{}",
            before.unwrap_or_default(),
            significant(optimised)
        );
    }
    let unknowns = result["unknowns"].as_object();
    let determined = |all: &Map<String, Value>| {
        let both = all.values().filter(|own| own["seen"] == "both");
        format!("{} of {} unknowns determined", both.count(), all.len())
    };
    match unknowns {
        Some(unknowns) if unknowns.values().all(|own| own["seen"].is_null()) => {
            "the model lacks something".to_owned()
        }
        Some(unknowns) => determined(unknowns),
        None => String::new(),
    }
}

/// Encodes a file name as one segment of a URL's path.
fn path_segment(name: &str) -> String {
    let encoded = |byte: u8| {
        if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
            char::from(byte).to_string()
        } else {
            format!("%{byte:02X}")
        }
    };
    name.bytes().map(encoded).collect()
}

/// Returns the section with the table of the runs of a folder, newest first.
fn list(folder: &Path, mut counts: Option<&mut Counts>) -> Section {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => {
            return section(vec![Block::Warning(vec![format!(
                "{} cannot be read: {error}",
                folder.display()
            )])]);
        }
    };
    let mut runs: Vec<_> = entries
        .flatten()
        .filter_map(|entry| {
            let begun = fs::metadata(entry.path().join(MANIFEST))
                .ok()?
                .modified()
                .ok();
            Some((begun, Row::read(&entry.path(), counts.as_deref_mut())?))
        })
        .collect();
    runs.sort_by(|(a, one), (b, other)| b.cmp(a).then_with(|| one.name.cmp(&other.name)));
    if runs.is_empty() {
        return section(vec![Block::Text(format!(
            "There is no run in {} yet.",
            folder.display()
        ))]);
    }
    section(vec![Block::Markup(table(&runs))])
}

fn table<T>(runs: &[(T, Row)]) -> Markup {
    html! {
        figure.table {
            p.filter {
                label { "Filter " input type="search" id="runs-filter" size="34" placeholder="words"; }
                " " span.count {}
            }
            div.scroll {
                table.stacked data-sortable="" {
                    thead {
                        tr {
                            th scope="col" { "run" }
                            th scope="col" { "state" }
                            th.prose scope="col" { "result" }
                            th scope="col" { "evaluations" }
                            th scope="col" { "wall time" }
                        }
                    }
                    tbody { @for (_, row) in runs { (row.markup()) } }
                }
            }
        }
    }
}

const fn section(blocks: Vec<Block>) -> Section {
    Section {
        id: "runs",
        title: "Runs",
        blocks,
    }
}
