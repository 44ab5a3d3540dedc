//! Tests of the command line: help texts, run folders, gene files.
use super::*;
use crate::cli::argument::{individual::condition, settings};
use ::case::{Overrides, load, read_genes, write_genes};
use protocol::{
    case::{Case, EffectSetting},
    pumping_unit::{Machine, PumpingUnit},
};
use run::{
    calibration::CalibrationRun,
    folder::RunFolder,
    hash,
    manifest::{self, CALIBRATE, DIAGNOSE, FORMAT, Manifest, StartPoint},
    name::{RunName, belongs_to_another},
    opened::Run,
    settings::{KeyValue, ResolvedSettings, choose, keep_worker_dependent},
};
use search::{
    space::Space,
    strategy::{SearchPlan, preset},
};
use std::path::{Path, PathBuf};
use support::Problem;

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

fn manifest(case: &Case, seed: u64) -> Manifest {
    let space = Space::new(&case.unknowns).unwrap();
    Manifest {
        kind: CALIBRATE.to_owned(),
        format: FORMAT,
        program: manifest::PROGRAM.to_owned(),
        command: "horsehead calibrate X".to_owned(),
        preset: "quick".to_owned(),
        seed,
        set: Vec::new(),
        settings: (preset("quick").unwrap().settings)(&SearchPlan {
            space: &space,
            workers: 1,
        }),
        start: None,
        table: None,
        assessed: None,
        case_folder: shipped(),
        measured: "X".to_owned(),
        synthetic: false,
        notes: Vec::new(),
        effects: Vec::new(),
        wall_s: 0.0,
    }
}

/// Returns the start of a run at values of the unknowns other than the recommended ones.
fn started(case: &Case) -> StartPoint {
    StartPoint {
        families: None,
        file: "found.toml".into(),
        genes: case.unknowns.iter().map(|gene| 2.0 * gene.start).collect(),
        effects: Vec::new(),
    }
}

#[test]
fn a_run_keeps_the_genes_that_it_started_at() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let manifest = manifest(&case, 3);
    let elsewhere = Manifest {
        start: Some(started(&case)),
        ..manifest.clone()
    };
    assert_ne!(
        manifest.settings_json().unwrap(),
        elsewhere.settings_json().unwrap()
    );
    let begin = |manifest: &Manifest| Run::begin(scratch.path(), manifest.clone(), case.clone());
    begin(&elsewhere).unwrap().save(0.0).unwrap();
    begin(&elsewhere).unwrap();
    let error = begin(&manifest).unwrap_err();
    assert!(
        error.to_string().ends_with("it starts at other genes"),
        "{error}"
    );
    // what is computed again for a report begins there, too
    let kept = CalibrationRun::open(scratch.path()).unwrap();
    let origin = vec![0.0; case.unknowns.len()];
    assert_eq!(
        kept.manifest.space(&kept.case).unwrap().values(&origin),
        started(&case).genes
    );
}

fn commands(command: &clap::Command, path: &str, all: &mut Vec<(String, clap::Command)>) {
    for sub in command
        .get_subcommands()
        .filter(|sub| sub.get_name() != "help")
    {
        let path = format!("{path} {}", sub.get_name());
        all.push((path.clone(), sub.clone()));
        commands(sub, &path, all);
    }
}

#[test]
fn every_command_shows_an_example_that_parses_and_its_exit_codes() {
    Cli::command().debug_assert();
    let mut all = Vec::new();
    commands(&Cli::command(), "horsehead", &mut all);
    let leaves = all
        .into_iter()
        .filter(|(_, command)| !command.has_subcommands());
    for (path, mut command) in leaves {
        let help = command.render_long_help().to_string();
        assert!(help.contains("Exit codes: 0 done"), "{path}");
        let joined = help.replace("\\\n", " ");
        let examples: Vec<&str> = joined
            .lines()
            .map(str::trim)
            .filter(|line| line.starts_with(&path))
            .collect();
        assert!(!examples.is_empty(), "{path} has no example:\n{help}");
        for example in examples {
            let words = example.split_whitespace().take_while(|word| *word != ">");
            assert!(Cli::try_parse_from(words).is_ok(), "{example}");
        }
    }
}

#[test]
fn every_command_that_a_report_advises_parses() {
    for advised in ::report::words::command::ALL {
        let parsed = Cli::try_parse_from(advised.split_whitespace());
        assert!(parsed.is_ok(), "{advised}");
    }
}

#[test]
fn every_option_has_a_twin_in_the_environment() {
    let mut all = Vec::new();
    commands(&Cli::command(), "horsehead", &mut all);
    for (path, command) in all {
        for option in command
            .get_opts()
            .filter(|option| option.get_id() != "jobs")
        {
            let twin = option
                .get_env()
                .map(|name| name.to_string_lossy().into_owned());
            let name = option.get_id().as_str().to_uppercase();
            assert_eq!(
                twin,
                Some(format!("HORSEHEAD_{name}")),
                "{path} --{}",
                option.get_id()
            );
        }
    }
}

/// Checks that no line of a help text exceeds the help width, since clap would wrap it and break its layout.
#[test]
fn every_line_of_a_help_fits() {
    let mut all = Vec::new();
    commands(&Cli::command(), "horsehead", &mut all);
    let mut long = Vec::new();
    for (path, command) in all {
        let texts = [command.get_after_help(), command.get_after_long_help()];
        for text in texts.into_iter().flatten() {
            let text = text.to_string();
            // a command is one line, however long
            let lines = text
                .lines()
                .filter(|line| !line.trim().starts_with("horsehead "));
            let lines = lines.filter(|line| line.chars().count() > 98);
            long.extend(lines.map(|line| format!("{path}: {line}")));
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn completions_exist_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            Cli::try_parse_from(["horsehead", "completions", shell]).is_ok(),
            "{shell}"
        );
    }
}

/// Returns the default path of a run with seed 3 on the shipped case's folder.
fn name(case: &Case, what: &str, set: &[String], measured: Option<&Path>) -> PathBuf {
    let name = RunName {
        case_folder: &shipped(),
        case,
        what,
        set,
        measured,
        seed: 3,
    };
    name.path().unwrap()
}

/// Checks that the effects of a case and the values from which a run starts are part of its name, and that long parts
/// are replaced by their hash.
#[test]
fn a_name_states_what_distinguishes_a_run() {
    let mut case = load(&shipped(), &Overrides::default()).unwrap();
    let effect = |id: &str| EffectSetting {
        id: id.to_owned(),
        ..EffectSetting::default()
    };
    case.effects = vec![effect("pivot_friction")];
    let path = name(&case, "quick", &["genes-01234567".to_owned()], None);
    let expected = "runs/cyjs10-5-37hb-quick-genes-01234567-with-pivot-friction-seed3";
    assert_eq!(path, Path::new(expected));
    case.effects = vec![
        effect("post_compliance"),
        effect("stuffing_box_friction"),
        effect("head_profile_wear"),
        effect("pivot_friction"),
    ];
    let long = name(&case, "quick", &[], None).display().to_string();
    let hash = long.strip_prefix("runs/cyjs10-5-37hb-quick-with-").unwrap();
    assert_eq!(hash.len(), "01234567-seed3".len(), "{long}");
}

/// Checks that two case folders of the same name have runs in folders of their own, which each finds again, and that a
/// case folder that was moved keeps its runs.
#[test]
fn case_folders_of_one_name_do_not_share_a_run() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let [first, second] = ["a", "b"].map(|above| scratch.path().join(above).join("unit"));
    for folder in [&first, &second] {
        std::fs::create_dir_all(folder).unwrap();
    }
    let run = scratch.path().join("run");
    std::fs::create_dir(&run).unwrap();
    let belongs = |folder: &Path| {
        let text = format!("{{\"case_folder\": {:?}}}", folder.display().to_string());
        std::fs::write(run.join("run.json"), text).unwrap();
        let here = std::fs::canonicalize(&first).unwrap();
        belongs_to_another(&run, &here)
    };
    assert!(belongs(&second));
    assert!(!belongs(&first));
    assert!(!belongs(&scratch.path().join("moved/unit")));
    let folder = |case_folder| {
        let name = RunName {
            case_folder,
            case: &case,
            what: "quick",
            set: &[],
            measured: None,
            seed: 1,
        };
        name.path().unwrap()
    };
    assert_eq!(folder(&first), folder(&second), "while neither has a run");
    assert_eq!(folder(&first), Path::new("runs/unit-quick-seed1"));
}

#[test]
fn a_run_folder_goes_on_with_the_same_run_and_refuses_another() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let path = scratch.path().join(name(&case, "quick", &[], None));
    assert!(path.ends_with("runs/cyjs10-5-37hb-quick-seed3"));
    // other records in a folder of the same name are another run
    let changed = |change: fn(&mut Machine)| {
        let mut unit = PumpingUnit::of(case.clone()).unwrap();
        change(&mut unit.machine);
        unit.into_case().unwrap()
    };
    let other = changed(|machine| machine.conditions[0].speed_rpm += 1.0);
    let beside = |case| {
        let records = Path::new("tests/of/march");
        name(case, "diagnose", &[], Some(records))
    };
    assert_ne!(beside(&case), beside(&other));
    let named = beside(&case).display().to_string();
    assert!(
        named.starts_with("runs/cyjs10-5-37hb-diagnose-march-"),
        "{named}"
    );
    let begin = |seed, case: &Case| Run::begin(&path, manifest(case, seed), case.clone());
    let first = begin(3, &case).unwrap();
    assert!(!first.folder.is_begun() && !first.folder.is_finished());
    assert!(!path.exists(), "nothing is written before the journal is");
    std::fs::create_dir_all(&path).unwrap();
    first.save(12.5).unwrap();
    let again = begin(3, &case).unwrap();
    assert!(again.folder.is_begun());
    assert!(again.lost_journal(), "12.5 s were spent on nothing");
    assert!((again.manifest.wall_s - 12.5).abs() < 1e-12);

    let other = begin(4, &case).unwrap_err();
    assert!(
        other
            .to_string()
            .ends_with("holds another run: its seed is 3, not 4"),
        "{other}"
    );
    let changed = changed(|machine| machine.ropes.diameter_m *= 1.0 + f64::EPSILON);
    let other = begin(3, &changed).unwrap_err();
    assert!(
        other
            .to_string()
            .ends_with("was begun: the model (its tables or numbers)"),
        "{other}"
    );
    let help = other.downcast::<Problem>().unwrap().remedy;
    assert!(help.contains("-quick-seed3-2"), "another folder in {help}");
    // the case comes back with every bit, so its hash and the journal still fit
    let kept = CalibrationRun::open(&path).unwrap().case;
    assert_eq!(kept, case);
    assert_eq!(
        hash::case_hash(&kept).unwrap(),
        hash::case_hash(&case).unwrap()
    );
}

#[test]
fn calibrated_parameters_come_back_from_their_file_bit_for_bit() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let values: Vec<f64> = (0..)
        .zip(&case.unknowns)
        .map(|(n, gene)| gene.start * (1.0 + f64::from(n) / 7.0))
        .collect();
    let file = scratch.path().join("calibrated.toml");
    std::fs::write(&file, write_genes(&case, &values, &[], "a test")).unwrap();
    let back = read_genes(&file, &case).unwrap();
    for (value, back) in values.iter().zip(&back) {
        assert_eq!(value.to_bits(), back.to_bits());
    }
}

#[test]
fn an_unknown_condition_is_refused_with_those_there_are() {
    let case = load(&shipped(), &Overrides::default()).unwrap();
    assert_eq!(condition(&case, None).unwrap(), case.objective.condition);
    assert_eq!(condition(&case, Some("4rpm")).unwrap(), 1);
    let error = condition(&case, Some("9rpm")).unwrap_err();
    assert_eq!(error.remedy, "it has: 5rpm, 4rpm");
}

#[test]
fn a_folder_of_something_else_is_no_run_folder() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let begin = |path: &Path| Run::begin(path, manifest(&case, 3), case.clone());
    let message = |path: &Path| begin(path).unwrap_err().to_string();
    assert!(begin(scratch.path()).is_ok(), "an empty one is fine");
    let file = scratch.path().join("letter.txt");
    std::fs::write(&file, "mine").unwrap();
    assert!(message(scratch.path()).ends_with("is not empty, and no run was begun in it"));
    assert!(message(&file).contains("cannot be a run folder"));
    std::fs::write(scratch.path().join(journal::FILE), "x").unwrap();
    assert!(begin(scratch.path()).is_ok(), "a journal makes it one");
    std::fs::write(scratch.path().join("run.json"), "{").unwrap();
    let error = begin(scratch.path()).unwrap_err();
    let usage = error.downcast_ref::<Problem>().unwrap();
    assert!(usage.message.contains("run.json is damaged"), "{usage}");
    assert!(
        usage.remedy.contains("(the same command"),
        "{}",
        usage.remedy
    );
}

#[test]
fn the_way_to_go_on_names_the_folder_in_hand() {
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let manifest = manifest(&case, 3);
    let command = manifest.resume_command(Path::new("moved here/run"));
    assert!(
        command.ends_with("--preset quick --seed 3 --run 'moved here/run' --measured X"),
        "{command}"
    );
    let started = Manifest {
        start: Some(started(&case)),
        ..manifest
    };
    let command = started.resume_command(Path::new("run"));
    assert!(
        command.ends_with("--seed 3 --run run --genes found.toml --measured X"),
        "{command}"
    );
    let words = [
        "horsehead",
        "calibrate",
        "case",
        "--preset",
        "quick",
        "--seed",
        "3",
        "--workers",
    ];
    let with = |count: &'static str| Cli::try_parse_from(words.into_iter().chain([count]));
    assert!(with("0").is_ok() && with("1024").is_ok());
    assert!(with("1025").is_err() && with("-1").is_err());
}

/// Applies `--set` arguments to the settings of a preset, with defaults for the given number of workers.
fn chosen(name: &str, set: &[(&str, &str)], workers: usize) -> Result<ResolvedSettings, Problem> {
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let space = Space::new(&case.unknowns).unwrap();
    let plan = SearchPlan {
        space: &space,
        workers,
    };
    choose(&pairs(set), preset(name).unwrap(), &plan)
}

fn pairs(set: &[(&str, &str)]) -> Vec<KeyValue> {
    let words = set.iter();
    let set = words.map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
    set.collect()
}

#[test]
fn settings_by_name_make_another_run_in_a_folder_of_its_own() {
    let scratch = tempfile::tempdir().unwrap();
    let case = load(&shipped(), &Overrides::default()).unwrap();
    let plain = chosen("paper", &[], 1).unwrap();
    let same = chosen("paper", &[("population", "80")], 1).unwrap();
    assert_eq!((plain.set.len(), &plain.settings), (0, &same.settings));
    assert_eq!(same.set, plain.set, "the preset says 80");
    let gray = chosen("paper", &[("encoding", "gray"), ("threshold", "0.5")], 1).unwrap();
    assert_eq!(gray.set, ["threshold=0.5", "encoding=gray"]);

    let path = |set: &[String]| name(&case, "paper", set, None);
    assert!(path(&plain.set).ends_with("cyjs10-5-37hb-paper-seed3"));
    let own = path(&gray.set);
    assert!(
        own.ends_with("cyjs10-5-37hb-paper-threshold-0.5-encoding-gray-seed3"),
        "{}",
        own.display()
    );

    let of = |chosen: &ResolvedSettings| Manifest {
        preset: "paper".to_owned(),
        settings: chosen.settings.clone(),
        set: chosen.set.clone(),
        ..manifest(&case, 3)
    };
    let begin = |chosen| Run::begin(scratch.path(), of(chosen), case.clone());
    begin(&gray).unwrap().save(0.0).unwrap();
    let run = begin(&gray).unwrap();
    let error = begin(&plain).unwrap_err().to_string();
    assert!(
        error.contains("threshold is 0.5, not none, encoding is gray, not binary"),
        "{error}"
    );
    let command = run.resume_command();
    assert!(
        command.contains("--preset paper --set threshold=0.5 --set encoding=gray"),
        "{command}"
    );
    Cli::try_parse_from(shlex::split(&command).unwrap()).unwrap();
}

#[test]
fn unknown_settings_are_answered_with_the_nearest_and_bad_values_with_what_is_allowed() {
    let error = chosen("paper", &[("encodign", "gray")], 1).unwrap_err();
    assert!(
        error.remedy.starts_with("did you mean `encoding`?"),
        "{error:?}"
    );
    let error = chosen("memetic", &[("roulette", "wheel")], 1).unwrap_err();
    assert!(
        error
            .message
            .ends_with("must be inverse, inverse_plus_one, difference, rank"),
        "{error:?}"
    );
    let error = chosen("quick", &[("window", "4")], 1).unwrap_err();
    assert!(error.message.contains("no setting `window`"), "{error:?}");
    let error = chosen("quick", &[("populaton", "4")], 1).unwrap_err();
    let remedy = &error.remedy;
    assert!(
        remedy.starts_with("`population` is a setting of memetic, hybrid, paper"),
        "{remedy}"
    );
    let error = chosen("quick", &[("xyz", "4")], 1).unwrap_err();
    assert_eq!(error.remedy, "`horsehead presets quick` lists its settings");
    let line = ["horsehead", "calibrate", "CASE", "--set"];
    let typed = |set: &'static str| Cli::try_parse_from(line.into_iter().chain([set]));
    assert!(typed("population=40,encoding=gray").is_ok() && typed("population").is_err());
}

/// Checks that a resumed run keeps the window length with which it began, even if the number of workers has
/// changed.
#[test]
fn what_follows_the_workers_stays_with_the_run() {
    let window = preset("window").unwrap();
    let kept = |set: &[(&str, &str)], earlier: Option<&ResolvedSettings>| {
        let mut now = chosen("window", set, 40).unwrap();
        let earlier = earlier.map(|earlier| &earlier.settings);
        keep_worker_dependent(&pairs(set), &mut now, window, earlier);
        now.set
    };
    let earlier = chosen("window", &[], 2).unwrap();
    assert_eq!(kept(&[], None), ["window=120"]);
    assert_eq!(kept(&[], Some(&earlier)), ["window=6"]);
    assert_eq!(kept(&[("window", "9")], Some(&earlier)), ["window=9"]);
    let other = chosen("paper", &[], 2).unwrap();
    assert_eq!(kept(&[], Some(&other)), ["window=120"]);
}

#[test]
fn every_setting_of_every_preset_is_listed_with_its_values() {
    for preset in search::strategy::CATALOGUE {
        let table = settings::table(preset);
        for named in preset.settable() {
            let allowed = format!("({})\n", named.setting.allowed());
            let lines = table.split_once(&format!("  {} = ", named.key)).unwrap().1;
            let meaning = lines.lines().nth(1).unwrap();
            assert!(format!("{meaning}\n").ends_with(&allowed), "{meaning}");
        }
    }
}

/// Checks that the help of the first level lists every command once, and that of a command fits on two screens,
/// with the options of the network apart.
#[test]
fn help_is_short_and_complete() {
    let mut all = command();
    let names: Vec<String> = {
        let all = all.get_subcommands();
        all.map(|one| one.get_name().to_owned()).collect()
    };
    let text = all.render_help().to_string();
    for name in &names {
        let lines = text.lines();
        let own = lines.filter(|line| line.starts_with(&format!("  {name} ")));
        assert_eq!(own.count(), 1, "{name}: {text}");
    }
    let listed: usize = GROUPS.iter().map(|(_, names)| names.len()).sum();
    assert_eq!(listed, names.len());
    for title in ["For clusters:", "For programs:"] {
        assert!(text.contains(title), "{text}");
    }
    let help = |words: &[&str]| {
        let parsed = command().try_get_matches_from(words);
        parsed.unwrap_err().to_string()
    };
    let long = help(&["horsehead", "calibrate", "--help"]);
    assert!(long.lines().count() <= 100, "{long}");
    let (own, network) = long.split_once("Workers on other machines:").unwrap();
    for option in ["--output", "--dashboard", "--pause-limit", "--help"] {
        assert!(
            own.contains(option) && !network.contains(option),
            "{option}"
        );
    }
    assert!(network.contains("--listen") && network.contains("--prologue"));
    assert_eq!(long, help(&["horsehead", "calibrate", "-h"]));
}

/// Checks that the remedy for a damaged run folder names the right command, which is read from the journal.
#[test]
fn the_way_out_of_damage_is_the_command_of_the_run() {
    let scratch = tempfile::tempdir().unwrap();
    let header = journal::event::RunHeader {
        kind: DIAGNOSE.to_owned(),
        case: protocol::id::ContentHash::of(b"case"),
        settings: "{}".to_owned(),
    };
    let run = protocol::id::RunId(1);
    drop(journal::Journal::open(scratch.path(), &header, run, 5, |_| {}).unwrap());
    std::fs::write(scratch.path().join("run.json"), "{").unwrap();
    let error = RunFolder::new(scratch.path()).head().err().unwrap();
    let usage = error.downcast_ref::<Problem>().unwrap();
    assert!(
        usage.remedy.contains("horsehead diagnose CASE --seed N"),
        "{}",
        usage.remedy
    );
}
