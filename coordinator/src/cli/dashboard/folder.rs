//! Pages of a folder of runs: a table that compares them, and the page of each.
use super::{
    follow::{Followed, is_locked},
    simulator::Simulator,
};
use crate::cli::run::folder::{MANIFEST, RESULT, RunFolder};
use dashboard::{Board, PageReader, Pages};
use maud::{Markup, html};
use report::{
    Block, Section,
    number::{MISSING, count, duration, significant},
};
use serde_json::Value;
use std::{
    collections::BTreeMap,
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
pub(crate) struct FolderPages {
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
    pub(crate) fn begin(path: &Path) -> Self {
        let board = Board::new("Runs", &path.display().to_string());
        let index = board.reader();
        let open = Arc::new(());
        let (folder, wanted) = (path.to_owned(), Arc::downgrade(&open));
        thread::spawn(move || {
            let mut board = board;
            while wanted.strong_count() > 0 {
                let section = list(&folder);
                board.publish(("Runs", "folder"), 0, &[section], true);
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
    kind: String,
    case: String,
    preset: String,
    seed: Option<u64>,
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

impl Row {
    /// Reads a run folder; `None` if it holds no run.
    fn read(folder: &Path) -> Option<Self> {
        let name = folder.file_name()?.to_string_lossy().into_owned();
        if !folder.join(MANIFEST).exists() {
            return None;
        }
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let Some(manifest) = json(&folder.join(MANIFEST)) else {
            return Some(Self {
                name,
                kind: String::new(),
                case: String::new(),
                preset: String::new(),
                seed: None,
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
        } else if result.is_null() {
            "stopped"
        } else {
            "finished"
        };
        let objective = result["objective"]["optimised"].as_f64();
        let first = &result["effects"][0];
        let effect = first["title"].as_str().or_else(|| first["id"].as_str());
        let outcome = match (result["verdict"].as_str(), effect) {
            (Some(verdict), Some(effect)) => format!("{}: {effect}", verdict.replace('_', " ")),
            (Some(verdict), None) => verdict.replace('_', " "),
            (None, _) => objective.map_or_else(String::new, significant),
        };
        let case = Path::new(manifest["case_folder"].as_str().unwrap_or_default());
        let case = case.file_name().unwrap_or_default().to_string_lossy();
        let simulations = ["evaluations", "simulations"]
            .iter()
            .find_map(|key| result[key].as_u64());
        Some(Self {
            name,
            kind: manifest["kind"].as_str().unwrap_or("calibrate").to_owned(),
            case: case.into_owned(),
            preset: text(&manifest["preset"]),
            seed: manifest["seed"].as_u64(),
            state,
            simulations,
            outcome,
            objective,
            wall_s: result["wall_s"].as_f64(),
        })
    }

    fn markup(&self) -> Markup {
        let missing = || MISSING.to_owned();
        html! {
            tr {
                th scope="row" { a href=(format!("/runs/{}/", path_segment(&self.name))) { (self.name) } }
                td { (self.kind) }
                td { (self.case) }
                td { (self.preset) }
                td data-value=[self.seed] { (self.seed.map_or_else(missing, count)) }
                td { (self.state) }
                td data-value=[self.simulations] { (self.simulations.map_or_else(missing, count)) }
                td data-value=[self.wall_s] { (self.wall_s.map_or_else(missing, duration)) }
                td data-value=[self.objective] { (self.outcome) }
            }
        }
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
fn list(folder: &Path) -> Section {
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
            Some((begun, Row::read(&entry.path())?))
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
                table data-sortable="" {
                    thead {
                        tr {
                            @for head in ["run", "command", "case", "preset", "seed", "state", "evaluations",
                                "wall time", "objective or verdict"] {
                                th scope="col" { (head) }
                            }
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
