//! Parser of instruction files.
use super::super::first_line::FirstLine;
use super::list::{DUMMY, Instruction, Instructions, Line};
use crate::{Problem, problem::clip};
use std::collections::BTreeSet;

/// Requirements on the first line of an instruction file.
const FIRST: FirstLine = FirstLine {
    word: "pif",
    forbidden_delimiters: "!:&[](),",
    allowed: "`pif` and one delimiter that is no letter, no digit and none of ! : & [ ] ( ) ,",
    remedy: "write it as the first line of the instructions",
};

/// Maximum column number, and maximum number of lines that one instruction may advance.
const FARTHEST: usize = 100_000_000;

pub(super) fn parse(file: &str, text: &str) -> Result<Instructions, Problem> {
    let (mark, body) = FIRST.read(file, text)?;
    let mut lines: Vec<Line> = Vec::new();
    let mut names = BTreeSet::new();
    for (at, text) in body.lines().enumerate() {
        let number = at + 2;
        let refused = |found: String, allowed: &str| {
            Problem::at(file, number, found, allowed, "correct the instruction")
        };
        let all = tokens(text, mark).map_err(|found| {
            let allowed = "a marker, lN, w, tN, [name]a:b, (name)a:b or !name!";
            refused(format!("`{}`", clip(&found)), allowed)
        })?;
        if all.is_empty() {
            continue;
        }
        for name in all
            .iter()
            .filter_map(|token| token.as_ref().ok()?.observation())
        {
            if name != DUMMY && !names.insert(name.to_owned()) {
                return Err(refused(
                    format!("`{name}` once more"),
                    "a name that no other observation has",
                ));
            }
        }
        let goes_on = matches!(all.first(), Some(Err(Continued)));
        let own = all.into_iter().skip(usize::from(goes_on));
        let Ok(all) = own.collect::<Result<Vec<Instruction>, Continued>>() else {
            return Err(refused(
                "`&` after the beginning of the line".to_owned(),
                "`&` only at the beginning of a line",
            ));
        };
        match (goes_on, lines.last_mut()) {
            (true, Some(line)) => line.all.extend(all),
            (true, None) => {
                return Err(refused(
                    "`&`".to_owned(),
                    "a line that begins with a marker or lN",
                ));
            }
            (false, _) => {
                if !matches!(
                    all.first(),
                    Some(Instruction::Marker(_) | Instruction::Lines(_))
                ) {
                    return Err(refused(
                        format!("`{}`", clip(text)),
                        "a line that begins with a marker, lN or `&`",
                    ));
                }
                lines.push(Line { number, all });
            }
        }
    }
    Ok(Instructions {
        file: file.to_owned(),
        lines,
    })
}

/// Continuation token `&`: the line continues the preceding line of instructions.
struct Continued;

/// Splits a line into instructions; the error is the text that is not an instruction.
fn tokens(line: &str, mark: char) -> Result<Vec<Result<Instruction, Continued>>, String> {
    let mut all = Vec::new();
    let mut rest = line.trim_start();
    while let Some(first) = rest.chars().next() {
        let (token, after) = if first == mark {
            let inside = rest.get(first.len_utf8()..).unwrap_or_default();
            let (text, after) = inside.split_once(mark).ok_or(rest)?;
            if text.is_empty() {
                return Err(rest.to_owned());
            }
            (Ok(Instruction::Marker(text.to_owned())), after)
        } else {
            // a marker may stand directly behind
            let end = rest.find(|letter: char| letter.is_whitespace() || letter == mark);
            let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
            (instruction(word).ok_or(word)?, after)
        };
        all.push(token);
        rest = after.trim_start();
    }
    Ok(all)
}

fn instruction(word: &str) -> Option<Result<Instruction, Continued>> {
    let number = |text: &str| {
        let number = text.parse::<usize>().ok()?;
        (1..=FARTHEST).contains(&number).then_some(number)
    };
    let lower = word.to_lowercase();
    let mut letters = lower.chars();
    let first = letters.next()?;
    let rest = letters.as_str();
    let name = |text: &str| {
        let name = text.trim();
        (!name.is_empty()).then(|| name.to_owned())
    };
    let between = |close: char| {
        // a name may have brackets itself
        let (own, columns) = rest.rsplit_once(close)?;
        let (from, to) = columns.split_once(':')?;
        let (from, to) = (number(from)?, number(to)?);
        (from <= to).then_some((name(own)?, from, to))
    };
    Some(Ok(match first {
        '&' if rest.is_empty() => return Some(Err(Continued)),
        'w' if rest.is_empty() => Instruction::Word,
        'l' => Instruction::Lines(number(rest)?),
        't' => Instruction::Tab(number(rest)?),
        '!' => Instruction::Free(name(rest.strip_suffix('!')?)?),
        '[' => between(']').map(|(name, from, to)| Instruction::Fixed(name, from, to))?,
        '(' => between(')').map(|(name, from, to)| Instruction::SemiFixed(name, from, to))?,
        _ => return None,
    }))
}
