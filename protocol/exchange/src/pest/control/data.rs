//! Conversion of the sections of a control file to [`Control`].
use super::{
    lines::{Lines, Section},
    model::{
        Control, FilePair, IncrementKind, LimitSide, Observation, Parameter, ParameterGroup,
        Transform,
    },
    prior,
    rows::{Row, rows},
};
use crate::{Problem, problem::clip};
use std::collections::{BTreeMap, BTreeSet};

const GROUP: [&str; 7] = [
    "pargpnme",
    "inctyp",
    "derinc",
    "derinclb",
    "forcen",
    "derincmul",
    "dermthd",
];
const PARAMETER: [&str; 10] = [
    "parnme",
    "partrans",
    "parchglim",
    "parval1",
    "parlbnd",
    "parubnd",
    "pargp",
    "scale",
    "offset",
    "dercom",
];
const OBSERVATION: [&str; 4] = ["obsnme", "obsval", "weight", "obgnme"];

/// Names of the control file sections that are read; others are ignored with a note.
const KNOWN: [&str; 12] = [
    "control data",
    "control data keyword",
    "parameter groups",
    "parameter data",
    "observation groups",
    "observation data",
    "model command line",
    "model input/output",
    "model input",
    "model output",
    "prior information",
    "parameter tied data",
];

type Open<'a> = &'a dyn Fn(&str) -> Result<String, String>;

/// Numbers of parameters, observations and files that `control data` of the older format states, to be
/// compared with those found.
#[derive(Default)]
struct Counts {
    parameters: usize,
    observations: usize,
    priors: usize,
    templates: usize,
    instructions: usize,
}

pub(super) fn read(lines: &Lines, open: Open<'_>) -> Result<Control, Problem> {
    let mut control = Control::default();
    for section in &lines.sections {
        let plain = section
            .name
            .strip_suffix(" external")
            .unwrap_or(&section.name);
        if !KNOWN.contains(&plain) {
            let note = format!(
                "section `{}` (line {}) is not supported and is ignored",
                section.name, section.number
            );
            control.notes.push(note);
        }
    }
    for (name, line) in &lines.options {
        control.notes.push(format!(
            "option ++{name} (line {line}) applies to PEST++ only and is ignored"
        ));
    }
    let counts = if let Some(section) = lines.section("control data") {
        Some(counts(lines, section, &mut control)?)
    } else {
        keywords(lines, &mut control);
        None
    };
    let groups = rows(lines, "parameter groups", &GROUP, open)?;
    control.groups = groups.iter().map(group).collect::<Result<_, _>>()?;
    let differences = groups
        .iter()
        .filter(|row| row.word_or("forcen", "switch") != "switch");
    note_rows(
        &mut control,
        &differences.collect::<Vec<_>>(),
        "FORCEN has no effect: differences are one-sided until the search converges, and central then",
    );
    unused_columns(&mut control, &groups, &GROUP);
    parameters(lines, counts.as_ref(), open, &mut control)?;
    let observations = rows(lines, "observation data", &OBSERVATION, open)?;
    for row in &observations {
        control.observations.push(Observation {
            name: row.word("obsnme")?,
            value: row.number("obsval")?,
            weight: row.number("weight")?,
            group: row.word_or("obgnme", "obgnme"),
        });
    }
    unused_columns(&mut control, &observations, &OBSERVATION);
    if let Some(section) = lines.section("model command line") {
        control.commands = section.lines.iter().map(|line| line.text.clone()).collect();
    }
    pairs(lines, counts.as_ref(), open, &mut control)?;
    priors(lines, open, &mut control)?;
    observation_groups(lines, open, &mut control)?;
    if let Some(counts) = counts {
        let found = [
            ("NPAR", counts.parameters, control.parameters.len()),
            ("NOBS", counts.observations, control.observations.len()),
            ("NPRIOR", counts.priors, control.prior.len()),
            ("NTPLFLE", counts.templates, control.inputs.len()),
            ("NINSFLE", counts.instructions, control.outputs.len()),
        ];
        for (name, stated, found) in found {
            if stated != found {
                let line = lines
                    .section("control data")
                    .map_or(1, |section| section.number);
                let what = format!("{name} = {stated}, although the file has {found}");
                return Err(lines.problem(line, what, "the number of items in the file"));
            }
        }
    }
    Ok(control)
}

/// Reads the stated numbers of parameters, observations and files from section `control data` of the older
/// format, where each has a fixed position.
fn counts(lines: &Lines, section: &Section, control: &mut Control) -> Result<Counts, Problem> {
    let word = |line: usize, place: usize, name: &str| {
        let found = section.lines.get(line);
        let number = found.map_or(section.number, |line| line.number);
        let word = found.and_then(|line| line.text.split_whitespace().nth(place));
        word.map(str::to_owned).ok_or_else(|| {
            lines.problem(
                number,
                "a line that is too short",
                format!("a line that contains {name}"),
            )
        })
    };
    let count = |line: usize, place: usize, name: &str| {
        let word = word(line, place, name)?;
        word.parse::<usize>().map_err(|_| {
            let number = section
                .lines
                .get(line)
                .map_or(section.number, |line| line.number);
            lines.problem(
                number,
                format!("{name} = `{}`", clip(&word)),
                "a whole number",
            )
        })
    };
    if let Some(mode) = word(0, 1, "PESTMODE")
        .ok()
        .filter(|mode| !mode.eq_ignore_ascii_case("estimation"))
    {
        control.notes.push(format!(
            "PESTMODE is {mode}: parameters are estimated here, without regularisation"
        ));
    }
    if let (Some(from), Some(to)) = (section.lines.get(3), section.lines.last()) {
        control.notes.push(format!(
            "the settings of PEST's own algorithm (lines {} to {}) and PARCHGLIM have no effect: the presets have theirs",
            from.number, to.number
        ));
    }
    Ok(Counts {
        parameters: count(1, 0, "NPAR")?,
        observations: count(1, 1, "NOBS")?,
        priors: count(1, 3, "NPRIOR")?,
        templates: count(2, 0, "NTPLFLE")?,
        instructions: count(2, 1, "NINSFLE")?,
    })
}

/// Reads the keywords of `control data keyword` in the newer format.
fn keywords(lines: &Lines, control: &mut Control) {
    let section = lines.section("control data keyword");
    for line in section.into_iter().flat_map(|section| &section.lines) {
        let mut words = line.text.split_whitespace();
        let (Some(name), value) = (words.next(), words.next().unwrap_or_default()) else {
            continue;
        };
        match name.to_lowercase().as_str() {
            "pestmode" if value.eq_ignore_ascii_case("estimation") => {}
            name => control.notes.push(format!(
                "keyword {name} = {value} (line {}) has no effect here",
                line.number
            )),
        }
    }
}

fn group(row: &Row) -> Result<ParameterGroup, Problem> {
    let kind = match row.one_of("inctyp", &["relative", "absolute", "rel_to_max"])? {
        "absolute" => IncrementKind::Absolute,
        "rel_to_max" => IncrementKind::RelativeToMax,
        _ => IncrementKind::Relative,
    };
    let _checked = row.one_of(
        "forcen",
        &["switch", "switch_5", "always_2", "always_3", "always_5"],
    )?;
    Ok(ParameterGroup {
        name: row.word("pargpnme")?,
        increment_kind: kind,
        increment: row.number_or("derinc", 0.01)?,
        floor: row.number_or("derinclb", 0.0)?,
    })
}

/// Adds a note on rows of the control file that have something in common, if there are any.
fn note_rows(control: &mut Control, rows: &[&Row], note: &str) {
    let more = match rows.len() {
        0 | 1 => String::new(),
        count => format!(" and {} more", count - 1),
    };
    if let Some(first) = rows.first() {
        control
            .notes
            .push(format!("{}, line {}{more}: {note}", first.file, first.line));
    }
}

/// Adds a note on the columns of an external table that are not used.
fn unused_columns(control: &mut Control, rows: &[Row], used: &[&str]) {
    let unused = |name: &&str| !used.contains(name) && *name != "partied";
    let names = rows.iter().flat_map(|row| row.columns().filter(unused));
    let names: BTreeSet<&str> = names.collect();
    let names: Vec<&str> = names.into_iter().collect();
    if let Some(row) = rows
        .iter()
        .find(|row| row.columns().any(|name| unused(&name)))
    {
        control.notes.push(format!(
            "{}, line 1: columns without effect: {}",
            row.file,
            names.join(", ")
        ));
    }
}

/// Reads the observation groups: those with covariance files or targets are noted, as are those that limit the model on one
/// side.
fn observation_groups(lines: &Lines, open: Open<'_>, control: &mut Control) -> Result<(), Problem> {
    let groups = rows(
        lines,
        "observation groups",
        &["obgnme", "gtarg", "covfle"],
        open,
    )?;
    let others = |row: &&Row| row.columns().any(|name| name != "obgnme");
    let others: Vec<&Row> = groups.iter().filter(others).collect();
    for row in &others {
        let more: Vec<String> = ["gtarg", "covfle"]
            .iter()
            .filter_map(|name| row.plain(name).ok())
            .collect();
        control.notes.push(format!(
            "{}, line {}: `{}` of observation group `{}` is ignored: its observations count with their weights, as if \
             independent",
            row.file,
            row.line,
            more.join(" "),
            row.word("obgnme")?
        ));
    }
    let observed = control.observations.iter().map(|it| (&it.group, it.weight));
    let priors = control.prior.iter().map(|it| (&it.group, it.weight));
    let counted = observed.chain(priors).filter(|(_, weight)| *weight > 0.0);
    let limits: BTreeSet<(&str, &str)> = counted
        .filter_map(|(group, _)| {
            let words = match LimitSide::of_group(group)? {
                LimitSide::AtMost => "exceeds",
                LimitSide::AtLeast => "stays below",
            };
            Some((group.as_str(), words))
        })
        .collect();
    let notes = limits.iter().map(|(name, words)| {
        let row = groups.iter().find(|row| row.word_or("obgnme", "") == *name);
        let line = row.map_or_else(String::new, |row| format!("{}, line {}: ", row.file, row.line));
        format!("{line}observation group `{name}` is one-sided: a residual only where the model {words} the observation")
    });
    let notes: Vec<String> = notes.collect();
    control.notes.extend(notes);
    Ok(())
}

/// Reads the parameters of a control file; in the older format the rows after them state to which parameter
/// each tied one is tied.
fn parameters(
    lines: &Lines,
    counts: Option<&Counts>,
    open: Open<'_>,
    control: &mut Control,
) -> Result<(), Problem> {
    let mut all = rows(lines, "parameter data", &PARAMETER, open)?;
    let behind = counts
        .map(|counts| counts.parameters)
        .filter(|count| *count < all.len());
    let ties = behind.map_or_else(Vec::new, |count| all.split_off(count));
    let stated = rows(lines, "parameter tied data", &["parnme", "partied"], open)?;
    let stated = stated
        .iter()
        .filter_map(|row| Some((row.word("parnme").ok()?, row.word("partied").ok()?)));
    let behind = ties.iter();
    let tied: BTreeMap<String, String> = behind
        .filter_map(|row| Some((row.word("parnme").ok()?, row.word("partrans").ok()?)))
        .chain(stated)
        .collect();
    let commands = |row: &&Row| row.word_or("dercom", "1") != "1";
    note_rows(
        control,
        &all.iter().filter(commands).collect::<Vec<_>>(),
        "DERCOM has no effect: every derivative is taken from runs of the model command line",
    );
    unused_columns(control, &all, &PARAMETER);
    for row in &all {
        let name = row.word("parnme")?;
        let transform = match row.one_of("partrans", &["none", "log", "fixed", "tied"])? {
            "log" => Transform::Log,
            "fixed" => Transform::Fixed,
            "tied" => {
                let to = tied
                    .get(&name)
                    .cloned()
                    .or_else(|| row.word("partied").ok());
                Transform::Tied(to.unwrap_or_default())
            }
            _ => Transform::None,
        };
        control.parameters.push(Parameter {
            initial: row.number("parval1")?,
            lower: row.number_or("parlbnd", f64::NEG_INFINITY)?,
            upper: row.number_or("parubnd", f64::INFINITY)?,
            group: row.word_or("pargp", "pargp"),
            scale: row.number_or("scale", 1.0)?,
            offset: row.number_or("offset", 0.0)?,
            transform,
            name,
        });
    }
    Ok(())
}

/// Reads the pairs of files: a template with a model input file, or an instruction file with a model output
/// file.
fn pairs(
    lines: &Lines,
    counts: Option<&Counts>,
    open: Open<'_>,
    control: &mut Control,
) -> Result<(), Problem> {
    let pair = |row: &Row| {
        Ok(FilePair {
            own: row.plain("pest_file")?,
            program: row.plain("model_file")?,
        })
    };
    let columns = ["pest_file", "model_file"];
    let of = |name: &str| -> Result<Vec<FilePair>, Problem> {
        rows(lines, name, &columns, open)?
            .iter()
            .map(pair)
            .collect()
    };
    let mut both = of("model input/output")?;
    let templates = counts.map_or_else(
        || {
            both.iter()
                .take_while(|pair| !pair.own.to_lowercase().ends_with(".ins"))
                .count()
        },
        |counts| counts.templates.min(both.len()),
    );
    control.outputs = both.split_off(templates);
    control.inputs = both;
    control.inputs.extend(of("model input")?);
    control.outputs.extend(of("model output")?);
    Ok(())
}

fn priors(lines: &Lines, open: Open<'_>, control: &mut Control) -> Result<(), Problem> {
    let mut joined: Vec<(usize, String)> = Vec::new();
    let section = lines.section("prior information");
    for line in section.into_iter().flat_map(|section| &section.lines) {
        match (line.text.strip_prefix('&'), joined.last_mut()) {
            (Some(more), Some((_, text))) => *text = format!("{text} {}", more.trim()),
            _ => joined.push((line.number, line.text.clone())),
        }
    }
    for (number, text) in joined {
        let refused = |found: String, allowed: &str| lines.problem(number, found, allowed);
        control.prior.push(prior::read(&text, &refused)?);
    }
    let external: Vec<&Section> = lines
        .sections
        .iter()
        .filter(|section| section.name == "prior information external")
        .collect();
    if external.is_empty() {
        return Ok(());
    }
    // the lines themselves are read already
    let only = Lines {
        file: lines.file.clone(),
        sections: external.into_iter().cloned().collect(),
        options: Vec::new(),
    };
    for row in rows(&only, "prior information", &[], open)? {
        let weight = row.number("weight")?;
        let text = format!(
            "{} {} {weight} {}",
            row.word("pilbl")?,
            row.word("equation")?,
            row.word_or("obgnme", "prior")
        );
        let refused = |found: String, allowed: &str| {
            Problem::at(&row.file, row.line, found, allowed, "correct the file")
        };
        control.prior.push(prior::read(&text, &refused)?);
    }
    Ok(())
}
