//! Execution of instructions on a model output file.
use super::list::{DUMMY, Instruction, Instructions, Line};
use crate::{Problem, number, problem::clip};

/// Reading position in a model output file.
struct Reader<'a> {
    lines: std::str::Lines<'a>,
    /// Characters of the current line of the model output file; empty before the first line.
    line: Vec<char>,
    /// Number of the current line of the model output file, from 1.
    number: usize,
    /// Number of characters of the current line already consumed.
    at: usize,
}

/// Failure of an instruction: the text found, and a description of what is allowed.
struct Mismatch {
    found: String,
    allowed: String,
}

pub(super) fn read(
    instructions: &Instructions,
    name: &str,
    text: &str,
) -> Result<Vec<(String, f64)>, Problem> {
    let mut reader = Reader {
        lines: text.lines(),
        line: Vec::new(),
        number: 0,
        at: 0,
    };
    let mut values = Vec::new();
    for line in &instructions.lines {
        carry_out(line, &mut reader, &mut values).map_err(|miss| {
            Problem::at(
                &instructions.file,
                line.number,
                format!("{} in {name}, line {}", miss.found, reader.number),
                miss.allowed,
                "check the program's output file, and correct the instruction",
            )
        })?;
    }
    Ok(values)
}

fn carry_out(
    line: &Line,
    reader: &mut Reader<'_>,
    values: &mut Vec<(String, f64)>,
) -> Result<(), Mismatch> {
    let mut at = 0;
    while let Some(instruction) = line.all.get(at) {
        let keep = match instruction {
            Instruction::Marker(text) if at == 0 => {
                reader.search(text)?;
                None
            }
            Instruction::Marker(text) => {
                if !reader.pass(text) {
                    let only_markers = line.all.iter().take(at);
                    if only_markers
                        .clone()
                        .all(|one| matches!(one, Instruction::Marker(_)))
                    {
                        // the line that was found is not the one that is meant
                        at = 0;
                        continue;
                    }
                    return Err(Mismatch {
                        found: format!("no `{}` in the rest of the line", clip(text)),
                        allowed: "a line with that text".to_owned(),
                    });
                }
                None
            }
            Instruction::Lines(count) => {
                for _ in 0..*count {
                    reader.advance()?;
                }
                None
            }
            Instruction::Word => {
                reader.word()?;
                None
            }
            Instruction::Tab(column) => {
                reader.tab(*column)?;
                None
            }
            Instruction::Fixed(name, from, to) => Some((name, reader.fixed(*from, *to))),
            Instruction::SemiFixed(name, from, to) => Some((name, reader.semi_fixed(*from, *to))),
            Instruction::Free(name) => {
                let next = match line.all.get(at + 1) {
                    Some(Instruction::Marker(text)) => Some(text.as_str()),
                    Some(_) | None => None,
                };
                Some((name, reader.free(next)))
            }
        };
        if let Some((name, text)) = keep.filter(|(name, _)| *name != DUMMY) {
            let value = number(&text).ok_or_else(|| Mismatch {
                found: if text.trim().is_empty() {
                    "nothing".to_owned()
                } else {
                    format!("`{}`", clip(text.trim()))
                },
                allowed: format!("a finite number, `{name}`"),
            })?;
            values.push((name.clone(), value));
        }
        at += 1;
    }
    Ok(())
}

impl Reader<'_> {
    fn advance(&mut self) -> Result<(), Mismatch> {
        let line = self.lines.next().ok_or_else(|| Mismatch {
            found: "the end".to_owned(),
            allowed: "a file with further lines".to_owned(),
        })?;
        self.line = line.chars().collect();
        self.number += 1;
        self.at = 0;
        Ok(())
    }

    /// Advances to the next line that contains a text, and to the character after the text.
    fn search(&mut self, text: &str) -> Result<(), Mismatch> {
        loop {
            self.advance().map_err(|_| Mismatch {
                found: format!("no line with `{}`", clip(text)),
                allowed: "a file with such a line".to_owned(),
            })?;
            if self.pass(text) {
                return Ok(());
            }
        }
    }

    /// Advances past the next occurrence of a text in the current line; returns whether there is one.
    fn pass(&mut self, text: &str) -> bool {
        let found = self.place(text);
        if let Some(place) = found {
            self.at = place + text.chars().count();
        }
        found.is_some()
    }

    /// Returns the position of the next occurrence of a text in the current line.
    fn place(&self, text: &str) -> Option<usize> {
        let ahead: String = self.line.get(self.at..)?.iter().collect();
        let (before, _) = ahead.split_once(text)?;
        Some(self.at + before.chars().count())
    }

    fn word(&mut self) -> Result<(), Mismatch> {
        let ahead = self.line.get(self.at..).unwrap_or_default();
        let blank = ahead.iter().position(|letter| letter.is_whitespace());
        let word = blank.and_then(|blank| {
            let from = ahead.get(blank..)?;
            Some(blank + from.iter().position(|letter| !letter.is_whitespace())?)
        });
        let word = word.ok_or_else(|| Mismatch {
            found: "no further word".to_owned(),
            allowed: "a line with another word".to_owned(),
        })?;
        self.at += word;
        Ok(())
    }

    fn tab(&mut self, column: usize) -> Result<(), Mismatch> {
        if column > self.line.len() || column - 1 < self.at {
            return Err(Mismatch {
                found: format!("no column {column} ahead"),
                allowed: "a line that is long enough, and columns in their order".to_owned(),
            });
        }
        self.at = column - 1;
        Ok(())
    }

    fn text(&self, from: usize, to: usize) -> String {
        let to = to.min(self.line.len());
        self.line
            .get(from..to.max(from))
            .unwrap_or_default()
            .iter()
            .collect()
    }

    fn fixed(&mut self, from: usize, to: usize) -> String {
        let text = self.text(from - 1, to);
        self.at = to.min(self.line.len());
        text
    }

    fn semi_fixed(&mut self, from: usize, to: usize) -> String {
        let is_blank = |at: usize| {
            self.line
                .get(at)
                .is_none_or(|letter| letter.is_whitespace())
        };
        let Some(mut begin) = (from - 1..to.min(self.line.len())).find(|at| !is_blank(*at)) else {
            return String::new();
        };
        while begin > 0 && !is_blank(begin - 1) {
            begin -= 1;
        }
        let mut end = begin;
        while !is_blank(end) {
            end += 1;
        }
        let text = self.text(begin, end);
        self.at = end;
        text
    }

    /// Returns the next word of the current line; the word ends before the marker text `next` if it contains
    /// this.
    fn free(&mut self, next: Option<&str>) -> String {
        let is_between = |letter: &char| letter.is_whitespace() || *letter == ',';
        let ahead = self.line.get(self.at..).unwrap_or_default();
        let begin = ahead.iter().position(|letter| !is_between(letter));
        let begin = self.at + begin.unwrap_or(ahead.len());
        let ahead = self.line.get(begin..).unwrap_or_default();
        let length = ahead.iter().position(is_between).unwrap_or(ahead.len());
        let mut end = begin + length;
        self.at = begin;
        let cut = next
            .and_then(|marker| self.place(marker))
            .filter(|place| *place < end);
        end = cut.unwrap_or(end);
        self.at = end;
        self.text(begin, end)
    }
}
