//! Text templates whose only fields are `{name}`; templates with expressions need a driver written by the
//! user.
use crate::{Problem, problem::clip};
use std::collections::{BTreeMap, BTreeSet};

/// Parsed text template with `{name}` fields. A literal brace is escaped by a backslash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Template {
    parts: Vec<Part>,
    file: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Field { name: String, line: usize },
}

impl Template {
    /// Parses a text template with `{name}` fields.
    ///
    /// # Errors
    /// A brace without its counterpart, or anything other than a name between braces.
    pub fn parse(file: &str, text: &str) -> Result<Self, Problem> {
        let (mut parts, mut plain, mut line) = (Vec::new(), String::new(), 1);
        let mut letters = text.chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '\\' if letters.peek().is_some_and(|next| matches!(next, '{' | '}')) => {
                    plain.extend(letters.next());
                }
                '{' => {
                    let mut is_closed = false;
                    let inside = letters.by_ref().take_while(|letter| {
                        is_closed = *letter == '}';
                        !is_closed
                    });
                    let name: String = inside.collect();
                    let plain_name = name.trim();
                    let is_name = |letter: char| {
                        letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.')
                    };
                    if !is_closed || plain_name.is_empty() || !plain_name.chars().all(is_name) {
                        let found = format!("`{{{}}}`", clip(&name));
                        let allowed = "the name of one parameter between braces";
                        let remedy =
                            "expressions need a driver of your own; write \\{ for a literal brace";
                        return Err(Problem::at(file, line, found, allowed, remedy));
                    }
                    parts.push(Part::Text(std::mem::take(&mut plain)));
                    parts.push(Part::Field {
                        name: plain_name.to_owned(),
                        line,
                    });
                }
                letter => {
                    line += usize::from(letter == '\n');
                    plain.push(letter);
                }
            }
        }
        parts.push(Part::Text(plain));
        Ok(Self {
            parts,
            file: file.to_owned(),
        })
    }

    /// Returns the names of the parameters used in the template.
    pub fn fields(&self) -> BTreeSet<String> {
        let names = self.parts.iter().filter_map(|part| match part {
            Part::Field { name, .. } => Some(name.clone()),
            Part::Text(_) => None,
        });
        names.collect()
    }

    /// Returns the text with each field replaced by its parameter's text.
    ///
    /// # Errors
    /// A field whose parameter has no text in `texts`.
    pub fn fill(&self, texts: &BTreeMap<String, String>) -> Result<String, Problem> {
        let each = self.parts.iter().map(|part| match part {
            Part::Text(text) => Ok(text.as_str()),
            Part::Field { name, line } => texts.get(name).map(String::as_str).ok_or_else(|| {
                let found = format!("`{{{name}}}`");
                Problem::at(
                    &self.file,
                    *line,
                    found,
                    "the name of a parameter",
                    "correct the name",
                )
            }),
        });
        each.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_between_braces_are_filled_in() {
        let template = Template::parse("t", "k = {k}\nset \\{a\\} { q }\n").unwrap();
        let texts = [
            ("k".to_owned(), "1".to_owned()),
            ("q".to_owned(), "2".to_owned()),
        ];
        assert_eq!(
            template.fill(&BTreeMap::from(texts)).unwrap(),
            "k = 1\nset {a} 2\n"
        );
        let error = template.fill(&BTreeMap::new()).unwrap_err().to_string();
        assert!(error.contains("line 1") && error.contains("{k}"), "{error}");
        for bad in ["{}", "\n{a + 1}", "{a = 3}", "{a"] {
            assert!(Template::parse("t", bad).is_err(), "{bad}");
        }
    }
}
