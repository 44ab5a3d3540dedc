//! The files and the output of a finished diagnosis.
use super::{
    object::diagnosis::answer::{DiagnoseOutput, object},
    terminal,
};
use crate::cli::{
    argument::output::Output,
    run::{
        command_line::quote_path,
        diagnosis::{Diagnosis, Found},
        folder::{GENES, RESULT},
    },
};
use ::report::{diagnosis as report, text};
use case::{Loaded, append_effects, write_starts};
use std::path::Path;

/// A finished diagnosis with everything that its files name.
pub(crate) struct Answer<'a> {
    /// How it was begun, and where its files go.
    pub(crate) run: &'a Diagnosis,
    /// Its case with the cycles of the records.
    pub(crate) loaded: &'a Loaded,
    /// What was found.
    pub(crate) found: &'a Found,
    /// Wall time of all sessions (s).
    pub(crate) wall_s: f64,
}

impl Answer<'_> {
    fn subject(&self) -> anyhow::Result<report::Subject<'_>> {
        Ok(report::Subject {
            case: &self.loaded.case,
            records: &self.loaded.cycles,
            library: &self.found.library,
            diagnosed: &self.found.diagnosed,
            origin: self.run.origin(String::new())?,
            notes: &self.found.notes,
            wall_s: self.wall_s,
        })
    }

    /// Writes the parameters that the answer rests on: with the effects in the case, a simulation of
    /// them is the diagnosis's "after".
    fn write_genes(&self) -> anyhow::Result<()> {
        let Some(fit) = &self.found.diagnosed.diagnosis.after else {
            return Ok(());
        };
        let about = format!("Parameters of {}", self.run.folder.path().display());
        let genes = fit.model.genes(fit.x());
        self.run
            .folder
            .write_genes(&self.loaded.case, &genes, &about)
    }

    /// Writes the files into the run folder; returns the object of `--output json`.
    pub(crate) fn write(&self) -> anyhow::Result<DiagnoseOutput> {
        let subject = self.subject()?;
        if let Some(text) = report::effects_toml(&subject) {
            self.run.folder.write("effects.toml", &text)?;
        }
        self.write_genes()?;
        for file in report::write(self.run.folder.path(), &subject)?
            .iter()
            .take(1)
        {
            terminal::tell(&format!("open {}", file.display()));
        }
        let object = object(&subject);
        self.run.folder.write_json(RESULT, &object)?;
        Ok(object)
    }

    /// Prints the answer as the user wants it.
    pub(crate) fn print(&self, output: Output, object: &DiagnoseOutput) -> anyhow::Result<()> {
        let subject = self.subject()?;
        let whole = || text(&report::report(&subject), terminal::styled());
        terminal::print(output, whole, object)
    }

    /// Adds what was found to a case file, if anything was: an unknown of the case that was off starts from
    /// there, the rest is new to it.
    pub(crate) fn add(&self, file: &Path) -> anyhow::Result<()> {
        let subject = self.subject()?;
        let (new, starts) = (report::effects(&subject), report::starts(&subject));
        if new.is_empty() && starts.is_empty() {
            return Ok(());
        }
        if !new.is_empty() {
            append_effects(file, &new)?;
        }
        if !starts.is_empty() {
            write_starts(file, &starts)?;
        }
        terminal::tell(&format!("added to {}", file.display()));
        terminal::tell(&format!(
            "to search it with everything else, from what was found:\n  horsehead calibrate {} --genes {}",
            quote_path(&self.run.manifest.case_folder),
            quote_path(&self.run.folder.file(GENES)),
        ));
        Ok(())
    }
}
