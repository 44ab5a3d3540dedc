//! Conversion of the sections of a control file to [`Control`].
use super::{
    lines::{Lines, Section},
    model::{
        Control, FilePair, IncrementKind, IncrementMethod, Observation, Parameter, ParameterGroup,
        Transform,
    },
    prior,
    rows::{Row, rows},
};
use crate::{Problem, problem::clip};

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
    let mut control = Control {
        options: lines.options.clone(),
        ..Control::default()
    };
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
    for (name, _) in &lines.options {
        control.notes.push(format!(
            "option ++{name} applies to PEST++ only and is ignored"
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
    if let Some(section) = lines.section("model command line") {
        control.commands = section.lines.iter().map(|line| line.text.clone()).collect();
    }
    pairs(lines, counts.as_ref(), open, &mut control)?;
    priors(lines, open, &mut control)?;
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
    // PEST++ goes on with what it can do where numbers of its other methods are missing
    control.iterations = word(6, 0, "NOPTMAX")
        .ok()
        .and_then(|word| word.parse().ok())
        .unwrap_or(0);
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
            "noptmax" => control.iterations = value.parse().unwrap_or(0),
            "pestmode" if value.eq_ignore_ascii_case("estimation") => {}
            name => control
                .notes
                .push(format!("keyword {name} = {value} has no effect here")),
        }
    }
}

fn group(row: &Row) -> Result<ParameterGroup, Problem> {
    let kind = match row.word_or("inctyp", "relative").as_str() {
        "absolute" => IncrementKind::Absolute,
        "rel_to_max" => IncrementKind::RelativeToMax,
        _ => IncrementKind::Relative,
    };
    let method = match row.word_or("forcen", "switch").as_str() {
        "always_2" => IncrementMethod::Two,
        "always_3" | "always_5" => IncrementMethod::Three,
        _ => IncrementMethod::Switch,
    };
    Ok(ParameterGroup {
        name: row.word("pargpnme")?,
        increment_kind: kind,
        increment: row.number_or("derinc", 0.01)?,
        floor: row.number_or("derinclb", 0.0)?,
        method,
        multiplier: row.number_or("derincmul", 2.0)?,
    })
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
    let tied = |name: &str| {
        let tie = ties
            .iter()
            .find(|row| row.word("parnme").is_ok_and(|own| own == name));
        tie.and_then(|row| row.word("partrans").ok())
    };
    for row in &all {
        let name = row.word("parnme")?;
        let transform = match row.word_or("partrans", "none").as_str() {
            "log" => Transform::Log,
            "fixed" => Transform::Fixed,
            "tied" => {
                let to = tied(&name).or_else(|| row.word("partied").ok());
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
