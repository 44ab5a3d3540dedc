//! PEST templates: texts with fixed-width fields for the values of parameters.
use super::first_line::FirstLine;
use crate::{Problem, problem::clip};
use std::collections::BTreeMap;

/// Maximum size of a template (bytes).
const MOST: usize = 64 << 20;

/// Requirements on the first line of a template.
const FIRST: FirstLine = FirstLine {
    word: "ptf",
    forbidden_delimiters: "",
    allowed: "`ptf` and one delimiter that is neither letter nor digit",
    remedy: "write it as the first line of the template",
};

/// Parsed PEST template: text with fixed-width fields for parameter values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Template {
    file: String,
    parts: Vec<Part>,
}

/// Field of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TemplateField {
    /// Width of the field including both delimiters (characters).
    pub width: usize,
    /// Line number of the field in the template.
    pub line: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Field {
        /// Name in lower case of the parameter whose value fills the field.
        name: String,
        /// Width of the template field including both delimiters (characters).
        width: usize,
        /// Line number of the field in the template.
        line: usize,
    },
}

impl Template {
    /// Parses a template: `ptf` and a delimiter in the first line, then a text in which the names of
    /// parameters stand between two delimiters.
    ///
    /// # Errors
    /// An invalid first line, an unpaired delimiter, or a field without a name.
    pub fn parse(file: &str, text: &str) -> Result<Self, Problem> {
        let (mark, body) = FIRST.read(file, text)?;
        if text.len() > MOST {
            let found = format!("{} bytes", text.len());
            let allowed = format!("at most {MOST}");
            return Err(Problem::at(
                file,
                1,
                found,
                allowed,
                "fill in a smaller file",
            ));
        }
        let mut parts = Vec::new();
        for (number, line) in body.split_inclusive('\n').enumerate() {
            let number = number + 2;
            let mut pieces = line.split(mark);
            parts.push(Part::Text(pieces.next().unwrap_or_default().to_owned()));
            while let Some(field) = pieces.next() {
                let name = field.trim().to_lowercase();
                let Some(after) = pieces.next() else {
                    let found = format!("a `{mark}` without a second one");
                    let allowed = "two delimiters about each parameter's name";
                    return Err(Problem::at(
                        file,
                        number,
                        found,
                        allowed,
                        "add the second delimiter, or declare another delimiter in the first line",
                    ));
                };
                if name.is_empty() || name.contains(char::is_whitespace) {
                    let found = format!("`{mark}{}{mark}`", clip(field));
                    let allowed = "one parameter's name between the delimiters";
                    return Err(Problem::at(
                        file,
                        number,
                        found,
                        allowed,
                        "write the name into the field",
                    ));
                }
                parts.push(Part::Field {
                    name,
                    width: field.chars().count() + 2,
                    line: number,
                });
                parts.push(Part::Text(after.to_owned()));
            }
        }
        Ok(Self {
            file: file.to_owned(),
            parts,
        })
    }

    /// Returns the names of the parameters in the template, each with its narrowest field.
    pub fn fields(&self) -> BTreeMap<String, TemplateField> {
        let mut fields: BTreeMap<String, TemplateField> = BTreeMap::new();
        for part in &self.parts {
            if let Part::Field { name, width, line } = part {
                let field = TemplateField {
                    width: *width,
                    line: *line,
                };
                let narrowest = fields.entry(name.clone()).or_insert(field);
                if field.width < narrowest.width {
                    *narrowest = field;
                }
            }
        }
        fields
    }

    /// Returns the text with each field replaced by its parameter's text, right-aligned.
    ///
    /// # Errors
    /// A parameter without a text, or a text that is wider than its field.
    pub fn fill(&self, texts: &BTreeMap<String, String>) -> Result<String, Problem> {
        let mut filled = String::new();
        for part in &self.parts {
            match part {
                Part::Text(text) => filled.push_str(text),
                Part::Field { name, width, line } => {
                    let text = texts
                        .get(name)
                        .filter(|text| text.chars().count() <= *width);
                    let Some(text) = text else {
                        let found = format!("the field of `{name}`, {width} wide");
                        let allowed = "the field of a known parameter, wide enough for its value";
                        return Err(Problem::at(
                            &self.file,
                            *line,
                            found,
                            allowed,
                            "correct the name, or widen the field",
                        ));
                    };
                    filled.extend(std::iter::repeat_n(' ', width - text.chars().count()));
                    filled.push_str(text);
                }
            }
        }
        Ok(filled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fields_are_filled_at_their_own_width() {
        let text = "ptf #\nk = #K     #\nboth #k# and # Q #\n";
        let template = Template::parse("a.tpl", text).unwrap();
        let fields = [("k", 3), ("q", 5)].map(|(name, width)| {
            let field = TemplateField { width, line: 3 };
            (name.to_owned(), field)
        });
        assert_eq!(template.fields(), BTreeMap::from(fields));
        let texts = [
            ("k".to_owned(), "2.5".to_owned()),
            ("q".to_owned(), "7".to_owned()),
        ];
        let filled = template.fill(&BTreeMap::from(texts)).unwrap();
        assert_eq!(filled, "k =      2.5\nboth 2.5 and     7\n");
        let wide = [("k".to_owned(), "2.55".to_owned())];
        let error = template
            .fill(&BTreeMap::from(wide))
            .unwrap_err()
            .to_string();
        assert!(error.contains("line 3") && error.contains("`k`"), "{error}");
    }

    #[test]
    fn what_is_no_template_is_refused_by_line() {
        for (text, words) in [
            ("", "line 1"),
            ("ptf\n", "line 1"),
            ("ptf a\n", "line 1"),
            ("pif #\n", "line 1"),
            ("ptf #\nx #a\n", "line 2"),
            ("ptf #\n\n##\n", "line 3"),
            ("ptf #\n#a b#\n", "line 2"),
        ] {
            let error = Template::parse("a.tpl", text).unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }

    proptest! {
        #[test]
        fn nothing_panics(text in "(ptf #\n)?[a-c# \n]{0,60}") {
            if let Ok(template) = Template::parse("t", &text) {
                let texts = template.fields().into_keys().map(|name| (name, "1".to_owned())).collect();
                prop_assert!(template.fill(&texts).is_ok());
            }
        }
    }
}
