//! Splitting of a control file into sections of lines, without comments; options are collected separately.
use crate::{Problem, problem::clip};

#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) text: String,
}

/// Section of a control file: the lines from one `*` heading to the next.
#[derive(Clone, Debug)]
pub(super) struct Section {
    /// Name of the section in lower case.
    pub(super) name: String,
    /// Line number of the section's heading in the control file.
    pub(super) number: usize,
    pub(super) lines: Vec<Line>,
}

/// Control file split into sections.
#[derive(Debug)]
pub(super) struct Lines {
    pub(super) file: String,
    pub(super) sections: Vec<Section>,
    /// Options of PEST++ in the control file, written `++name(value)`, each with its line number.
    pub(super) options: Vec<(String, usize)>,
}

impl Lines {
    pub(super) fn of(file: &str, text: &str) -> Result<Self, Problem> {
        let mut all = Self {
            file: file.to_owned(),
            sections: Vec::new(),
            options: Vec::new(),
        };
        let mut begun = false;
        for (at, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let number = at + 1;
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() {
                continue;
            }
            if !begun {
                let word = line.split_whitespace().next().unwrap_or_default();
                if !word.eq_ignore_ascii_case("pcf") {
                    let found = format!("`{}`", clip(line));
                    return Err(Problem::at(
                        file,
                        number,
                        found,
                        "`pcf`",
                        "name a control file of PEST",
                    ));
                }
                begun = true;
            } else if let Some(options) = line.strip_prefix("++") {
                all.options
                    .extend(self::options(options).map(|name| (name, number)));
            } else if let Some(name) = line.strip_prefix('*') {
                let name: Vec<&str> = name.split_whitespace().collect();
                let name = name.join(" ").to_lowercase();
                if let Some(other) = all.section(&name).filter(|_| !name.ends_with(" external")) {
                    let found = format!("section `{name}` again, after line {}", other.number);
                    let allowed = "each section once";
                    return Err(all.problem(number, found, allowed));
                }
                all.sections.push(Section {
                    name,
                    number,
                    lines: Vec::new(),
                });
            } else if let Some(section) = all.sections.last_mut() {
                section.lines.push(Line {
                    number,
                    text: line.to_owned(),
                });
            } else {
                let found = format!("`{}`", clip(line));
                return Err(Problem::at(
                    file,
                    number,
                    found,
                    "a section, as `* control data`",
                    "remove the line",
                ));
            }
        }
        if begun {
            return Ok(all);
        }
        Err(Problem::at(
            file,
            1,
            "nothing",
            "`pcf` and sections",
            "name a control file of PEST",
        ))
    }

    pub(super) fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.name == name)
    }

    /// Creates the error for a fault at a line of the control file.
    pub(super) fn problem(
        &self,
        number: usize,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Problem {
        Problem::at(
            &self.file,
            number,
            found,
            allowed,
            "correct the control file",
        )
    }
}

/// Returns the names of all `name(value)` options in a line of the control file.
fn options(line: &str) -> impl Iterator<Item = String> + '_ {
    let each = line.split(')').filter_map(|part| part.split_once('('));
    each.map(|(name, _)| {
        let name = name.trim().trim_start_matches('+').trim();
        name.to_lowercase()
    })
}
