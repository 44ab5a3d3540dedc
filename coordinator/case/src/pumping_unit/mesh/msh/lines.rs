//! Reading of the lines of a mesh file as numbers, with the line number in errors.
use crate::error::{CaseError, damaged};
use std::path::Path;

/// Remedy text for an unreadable mesh: to save it again as ASCII of a known version.
pub(super) const SAVE_AGAIN: &str = "save the mesh again as ASCII of MSH 4.1 or 2.2 \
                          (gmsh -format msh41 or msh22), of bricks or of 10-node tetrahedra";

/// Lines of the mesh file with the current line number.
pub(super) struct Lines<'a> {
    path: &'a Path,
    rest: std::str::Lines<'a>,
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        Self {
            path,
            rest: text.lines(),
            number: 0,
        }
    }

    pub(super) fn next(&mut self) -> Option<&'a str> {
        self.number += 1;
        self.rest.next()
    }

    /// Returns the line number, from 1, of the mesh-file line that was read last.
    pub(super) const fn number(&self) -> usize {
        self.number
    }

    pub(super) const fn path(&self) -> &'a Path {
        self.path
    }

    /// Builds an error at the mesh-file line that was read last, with the remedy [`SAVE_AGAIN`].
    pub(super) fn wrong(&self, problem: &str) -> CaseError {
        self.wrong_with(problem, SAVE_AGAIN)
    }

    /// Builds an error at the mesh-file line that was read last, with a given remedy.
    pub(super) fn wrong_with(&self, problem: &str, help: &str) -> CaseError {
        damaged(self.path, format!("line {}: {problem}", self.number), help)
    }

    /// Returns the next line of the mesh file; an error at the end of the file.
    pub(super) fn line(&mut self) -> Result<&'a str, CaseError> {
        self.next()
            .ok_or_else(|| self.wrong("the file ends inside a section"))
    }

    /// Parses the numbers of the mesh file's next line, of which there must be at least `least`.
    pub(super) fn numbers<T: std::str::FromStr>(
        &mut self,
        least: usize,
    ) -> Result<Vec<T>, CaseError> {
        let line = self.line()?;
        let words = line.split_ascii_whitespace();
        let numbers: Result<Vec<T>, _> = words.map(str::parse).collect();
        match numbers {
            Ok(numbers) if numbers.len() >= least => Ok(numbers),
            _ => Err(self.wrong(&format!("at least {least} numbers are expected here"))),
        }
    }

    /// Parses `N` integers of the mesh file's next line; further numbers are ignored.
    pub(super) fn integers<const N: usize>(&mut self) -> Result<[i64; N], CaseError> {
        let numbers = self.numbers::<i64>(N)?;
        numbers
            .first_chunk::<N>()
            .copied()
            .ok_or_else(|| self.wrong("numbers are missing"))
    }

    /// Reads the tag that ends a section of the mesh file.
    pub(super) fn end(&mut self, tag: &str) -> Result<(), CaseError> {
        if self.line()?.trim() == tag {
            Ok(())
        } else {
            Err(self.wrong(&format!("`{tag}` is expected here")))
        }
    }
}
