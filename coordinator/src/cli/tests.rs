//! Habits of the command line: help, run folders, gene files.
use super::{
    run_folder::{self, Manifest, RunFolder, Start},
    *,
};
use clap::CommandFactory as _;
use search::{space::Space, strategy::preset};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

fn manifest(case: &protocol::case::Case, seed: u64) -> Manifest {
    let space = Space::new(&case.genes).unwrap();
    Manifest {
        kind: run_folder::CALIBRATE.to_owned(),
        format: run_folder::format(),
        program: bus::PROGRAM.to_owned(),
        command: "horsehead calibrate X".to_owned(),
        preset: "quick".to_owned(),
        seed,
        settings: (preset("quick").unwrap().settings)(&space),
        start: None,
        case_folder: shipped(),
        measured: "X".to_owned(),
        synthetic: false,
        notes: Vec::new(),
        wall_s: 0.0,
    }
}

/// A start at other genes than the recommended ones.
fn started(case: &protocol::case::Case) -> Start {
    Start {
        file: "found.toml".into(),
        genes: case
            .genes
            .iter()
            .map(|gene| 2.0 * gene.recommended)
            .collect(),
    }
}

#[test]
fn a_run_keeps_the_genes_that_it_started_at() {
    let scratch = tempfile::tempdir().unwrap();
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
    let manifest = manifest(&case, 3);
    let elsewhere = Manifest {
        start: Some(started(&case)),
        ..manifest.clone()
    };
    assert_ne!(
        manifest.settings_json().unwrap(),
        elsewhere.settings_json().unwrap()
    );
    let begun = RunFolder::begin(scratch.path(), &elsewhere, &case).unwrap();
    begun.folder.spent(&elsewhere, &case, 0.0).unwrap();
    RunFolder::begin(begun.folder.path(), &elsewhere, &case).unwrap();
    let error = RunFolder::begin(begun.folder.path(), &manifest, &case).unwrap_err();
    assert!(
        error.to_string().ends_with("it starts at other genes"),
        "{error}"
    );
    // what is computed again for a report begins there, too
    let (_, kept, case) =
        RunFolder::open::<search::strategy::Settings>(begun.folder.path(), run_folder::CALIBRATE)
            .unwrap();
    let origin = vec![0.0; case.genes.len()];
    assert_eq!(
        kept.space(&case).unwrap().values(&origin),
        started(&case).genes
    );
}

/// Every command, also those below others.
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

#[test]
fn completions_exist_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            Cli::try_parse_from(["horsehead", "completions", shell]).is_ok(),
            "{shell}"
        );
    }
}

#[test]
fn a_run_folder_goes_on_with_the_same_run_and_refuses_another() {
    let scratch = tempfile::tempdir().unwrap();
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
    let path = scratch
        .path()
        .join(RunFolder::default_path(&case, "quick", None, 3).unwrap());
    assert!(path.ends_with("runs/cyjs10-5-37hb-quick-seed3"));
    // other records in a folder of the same name are another run
    let mut other = case.clone();
    other.conditions[0].speed_rpm += 1.0;
    let beside = |case| {
        let records = Path::new("tests/of/march");
        RunFolder::default_path(case, "diagnose", Some(records), 3).unwrap()
    };
    assert_ne!(beside(&case), beside(&other));
    let named = beside(&case).display().to_string();
    assert!(
        named.starts_with("runs/cyjs10-5-37hb-diagnose-march-"),
        "{named}"
    );
    let first = RunFolder::begin(&path, &manifest(&case, 3), &case).unwrap();
    assert!(!first.resumed && !first.folder.is_finished());
    assert!(!path.exists(), "nothing is written before the journal is");
    std::fs::create_dir_all(&path).unwrap();
    first
        .folder
        .spent(&manifest(&case, 3), &case, 12.5)
        .unwrap();
    let again = RunFolder::begin(&path, &manifest(&case, 3), &case).unwrap();
    assert!(again.resumed);
    assert!(again.lost_journal, "12.5 s were spent on nothing");
    assert!((again.wall_s - 12.5).abs() < 1e-12);

    let other = RunFolder::begin(&path, &manifest(&case, 4), &case).unwrap_err();
    assert!(
        other
            .to_string()
            .ends_with("holds another run: its seed is 3, not 4"),
        "{other}"
    );
    let mut changed = case.clone();
    changed.ropes.diameter_m *= 1.0 + f64::EPSILON;
    let other = RunFolder::begin(&path, &manifest(&case, 3), &changed).unwrap_err();
    assert!(
        other
            .to_string()
            .ends_with("its case or its records differ"),
        "{other}"
    );
    // the case comes back with every bit, so its hash and the journal still fit
    let (_, _, kept) =
        RunFolder::open::<search::strategy::Settings>(&path, run_folder::CALIBRATE).unwrap();
    assert_eq!(kept, case);
    assert_eq!(
        bus::case_hash(&kept).unwrap(),
        bus::case_hash(&case).unwrap()
    );
}

#[test]
fn calibrated_parameters_come_back_from_their_file_bit_for_bit() {
    let scratch = tempfile::tempdir().unwrap();
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
    let values: Vec<f64> = (0..)
        .zip(&case.genes)
        .map(|(n, gene)| gene.recommended * (1.0 + f64::from(n) / 7.0))
        .collect();
    let file = scratch.path().join("calibrated.toml");
    std::fs::write(&file, crate::case::write_genes(&case, &values, "a test")).unwrap();
    let back = crate::case::read_genes(&file, &case).unwrap();
    for (value, back) in values.iter().zip(&back) {
        assert_eq!(value.to_bits(), back.to_bits());
    }
}

#[test]
fn an_unknown_condition_is_refused_with_those_there_are() {
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
    assert_eq!(condition(&case, None).unwrap(), case.objective.condition);
    assert_eq!(condition(&case, Some("4rpm")).unwrap(), 1);
    let error = condition(&case, Some("9rpm")).unwrap_err();
    assert_eq!(error.help, "it has: 5rpm, 4rpm");
}

#[test]
fn a_folder_of_something_else_is_no_run_folder() {
    let scratch = tempfile::tempdir().unwrap();
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
    let begin = |path: &Path| RunFolder::begin(path, &manifest(&case, 3), &case);
    let message = |path: &Path| begin(path).unwrap_err().to_string();
    assert!(begin(scratch.path()).is_ok(), "an empty one is fine");
    let file = scratch.path().join("letter.txt");
    std::fs::write(&file, "mine").unwrap();
    assert!(message(scratch.path()).ends_with("is not empty, and no run was begun in it"));
    assert!(message(&file).contains("cannot be a run folder"));
    std::fs::write(scratch.path().join(crate::journal::FILE), "x").unwrap();
    assert!(begin(scratch.path()).is_ok(), "a journal makes it one");
    std::fs::write(scratch.path().join("run.json"), "{").unwrap();
    let error = begin(scratch.path()).unwrap_err();
    let usage = error.downcast_ref::<Usage>().unwrap();
    assert!(usage.message.contains("run.json is damaged"), "{usage}");
    assert!(usage.help.contains("horsehead calibrate CASE"));
}

#[test]
fn the_way_to_go_on_names_the_folder_in_hand() {
    let case = crate::case::load(&shipped(), &crate::case::Overrides::default()).unwrap();
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
