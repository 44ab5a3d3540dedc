//! `horsehead allow`: permits this machine to start the external program of a case.
use crate::cli::{
    argument::{case::case_folder, output::OutputChoice},
    output::{problem::EXIT_CODES, terminal},
};
use case::command::{EntryProposal, propose_entry};
use clap::Args;
use exchange::allow::{self, Allowed};
use run::message;
use serde::Serialize;
use std::path::{Path, PathBuf};
use support::{Problem, atomic_file};

/// Let this machine start the program of a case.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead allow my-model
  horsehead allow my-model --dry-run

A case of the kind `command` only names an entry of an allow list that each machine keeps for
itself: what is started, with which arguments and within what limits stands in that list alone.
This command shows the entry that the case needs, with every file that the program would find in
its folder, and writes it. When the case's files change, review and allow them again.

The list is $HORSEHEAD_ALLOW, else horsehead/allow.toml in $XDG_CONFIG_HOME or ~/.config. It may
be edited: limits of time, memory and output, variables of the environment, runs at a time.
Workers read it when they start; copy the entry to every machine that is to work on the case.

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Case folder, with `case.toml` in it.
    #[arg(value_name = "CASE", value_parser = case_folder)]
    case: PathBuf,
    /// Replace an entry of the same name that starts something else.
    #[arg(long, env = "HORSEHEAD_REPLACE")]
    replace: bool,
    /// Show the entry and write nothing.
    #[arg(long, env = "HORSEHEAD_DRY_RUN")]
    dry_run: bool,
    #[command(flatten)]
    output: OutputChoice,
}

/// JSON object printed by `allow --output json`.
#[derive(Debug, Serialize)]
struct AllowOutput<'a> {
    list: String,
    entry: &'a str,
    /// Content of the entry: program, arguments, files, version and limits.
    #[serde(flatten)]
    allowed: &'a allow::AllowEntry,
    /// Paths of the case files that the external program finds in its working folder.
    case_files: &'a [String],
    /// Whether the entry was written to the allow list; false with `--dry-run`.
    written: bool,
}

/// Returns the error for a case whose program this machine does not have.
fn no_program(case: &Path, entry: &allow::AllowEntry) -> Problem {
    Problem {
        message: format!(
            "{}: `model.command` = \"{}\": there is no such program on this machine",
            case.join("case.toml").display(),
            entry.program.display()
        ),
        remedy: "install it, or correct the name: a program by name or absolute path, or a file of the case, such as \
                 \"./model.sh\""
            .to_owned(),
    }
}

/// Shows the allow list entry that the case needs and, without `--dry-run`, writes it.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let EntryProposal {
        name,
        mut entry,
        is_there,
        files,
    } = propose_entry(&arguments.case)?;
    if !is_there {
        return Err(no_program(&arguments.case, &entry).into());
    }
    let path = allow::path();
    let mut allowed = allow::read(&path).map_err(|problem| Problem {
        message: problem.to_string(),
        remedy: "nothing was written".to_owned(),
    })?;
    if let Some(own) = allowed.entry.get(&name) {
        let started = |entry: &allow::AllowEntry| {
            let program = entry.program.display().to_string();
            [&[program], &entry.arguments[..]].concat().join(" ")
        };
        if started(own) != started(&entry) && !arguments.replace {
            return Err(Problem {
                message: format!(
                    "{}: entry `{name}` starts `{}`, this case wants `{}`",
                    path.display(),
                    started(own),
                    started(&entry)
                ),
                remedy: "give the case an entry of its own with `entry = \"..\"` under [model] of case.toml, or \
                       replace the other with --replace; nothing was written"
                    .to_owned(),
            }
            .into());
        }
        if own.files != entry.files {
            message::print(&format!(
                "note: entry `{name}` was allowed for other files until now; another case that uses it needs an \
                 entry of its own"
            ));
        }
        // limits and variables are this machine's business and stay as they are
        entry = allow::AllowEntry {
            program: entry.program,
            arguments: entry.arguments,
            files: entry.files,
            version: entry.version,
            ..own.clone()
        };
    }
    let alone = Allowed {
        entry: [(name.clone(), entry.clone())].into(),
    };
    let shown = allow::text(&alone);
    allowed.entry.insert(name.clone(), entry.clone());
    if !arguments.dry_run {
        let folder = path.parent().unwrap_or(Path::new(""));
        let written = std::fs::create_dir_all(folder)
            .and_then(|()| atomic_file::replace(&path, allow::text(&allowed).as_bytes()));
        written.map_err(|error| Problem {
            message: format!("cannot write {}: {error}", path.display()),
            remedy: "set HORSEHEAD_ALLOW to the path of a writable file".to_owned(),
        })?;
    }
    let words = ["written to", "would be written to"][usize::from(arguments.dry_run)];
    let table = || {
        let list: String = files.iter().flat_map(|file| ["#   ", file, "\n"]).collect();
        format!(
            "# {words} {}\n{shown}# it finds in its folder:\n{list}",
            path.display()
        )
    };
    let object = AllowOutput {
        list: path.display().to_string(),
        entry: &name,
        allowed: &entry,
        case_files: &files,
        written: !arguments.dry_run,
    };
    terminal::print(arguments.output.output, table, &object)
}
