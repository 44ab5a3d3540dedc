//! Output of a finished diagnosis: files in the run folder, and text or JSON on standard output.
use super::{
    object::diagnosis::answer::{DiagnoseOutput, object},
    terminal,
};
use crate::cli::argument::output::Output;
use ::report::{diagnosis as report, text};
use case::{CaseEffect, Overrides, append_effects, load_with_notes, write_starts};
use run::{
    command_line::quote_path,
    diagnosis::{DiagnosisRun, recorded, report_input},
    folder::{GENES, RESULT},
    message,
};
use std::path::Path;
use study::RecordedDiagnosis;

/// Finished diagnosis, read from its journal.
pub(crate) struct DiagnosisOutput<'a> {
    run: &'a DiagnosisRun,
    recorded: RecordedDiagnosis,
    /// Wall time of the run over all its sessions (s).
    wall_s: f64,
}

impl<'a> DiagnosisOutput<'a> {
    /// Reads a finished diagnosis whose sessions took `wall_s` seconds in total.
    ///
    /// # Errors
    /// As [`recorded`].
    pub(crate) fn read(run: &'a DiagnosisRun, wall_s: f64) -> anyhow::Result<Self> {
        Ok(Self {
            run,
            recorded: recorded(run)?,
            wall_s,
        })
    }

    /// Reads a diagnosis of which nothing is left to compute; `None` if it has no result, or a damaged journal.
    pub(crate) fn read_complete(run: &'a DiagnosisRun) -> Option<Self> {
        let read = || Self::read(run, run.manifest.wall_s).ok();
        let finished = run.folder.is_finished().then(read).flatten();
        finished.filter(|own| own.recorded.damage.is_empty())
    }

    /// Builds the data of the diagnosis's report.
    pub(crate) fn subject(&self) -> anyhow::Result<report::DiagnosisInput<'_>> {
        report_input(self.run, &self.recorded, self.wall_s)
    }

    /// Writes the fitted parameters and effects of the final model as a gene file: simulating them reproduces the
    /// diagnosis's "after" curves, or where no effect was found those of the recalibrated model.
    fn write_genes(&self) -> anyhow::Result<()> {
        let diagnosis = &self.recorded.result.diagnosis;
        let Some(fit) = diagnosis.after.as_ref().or(diagnosis.before.as_ref()) else {
            return Ok(());
        };
        let about = format!("Parameters of {}", self.run.folder.path().display());
        let found = report::effects(&self.subject()?);
        let effects = [&self.run.manifest.effects[..], &found].concat();
        self.run
            .folder
            .write_genes(&self.run.case, &fit.genes, &effects, &about)
    }

    /// Writes the result files of the diagnosis into the run folder and returns the object for `--output
    /// json`.
    pub(crate) fn write(&self) -> anyhow::Result<DiagnoseOutput> {
        message::print_damage(&self.recorded.damage);
        let subject = self.subject()?;
        if let Some(text) = report::effects_toml(&subject) {
            self.run.folder.write("effects.toml", &text)?;
        }
        self.write_genes()?;
        for file in report::write(self.run.folder.path(), &subject)?
            .iter()
            .take(1)
        {
            message::print(&format!("open {}", file.display()));
        }
        let object = object(&subject);
        self.run.folder.write_json(RESULT, &object)?;
        Ok(object)
    }

    /// Prints the diagnosis in the chosen output format.
    pub(crate) fn print(&self, output: Output, object: &DiagnoseOutput) -> anyhow::Result<()> {
        let subject = self.subject()?;
        let whole = || text(&report::report(&subject), terminal::style());
        terminal::print(output, whole, object)
    }

    /// Adds the effects found by the diagnosis to a case file; an unknown of the case that was switched off
    /// gets its fitted value as starting value. Does nothing if the diagnosis found neither.
    pub(crate) fn add(&self, file: &Path) -> anyhow::Result<()> {
        let subject = self.subject()?;
        let (mut new, starts) = (report::effects(&subject), report::starts(&subject));
        if new.is_empty() && starts.is_empty() {
            return Ok(());
        }
        // effects that the run has from a gene file, and the case not yet
        let manifest = &self.run.manifest;
        let overrides = Overrides {
            measured: manifest.replaced_records().map(ToOwned::to_owned),
        };
        let stated = load_with_notes(&manifest.case_folder, &overrides)?.effects;
        let taken = manifest.start.iter().flat_map(|start| &start.effects);
        let lacking = |taken: &&CaseEffect| stated.iter().all(|own| own.id != taken.id);
        new.splice(..0, taken.filter(lacking).cloned());
        if !new.is_empty() {
            append_effects(file, &new)?;
        }
        if !starts.is_empty() {
            write_starts(file, &starts)?;
        }
        message::print(&format!("added to {}", file.display()));
        message::print(&format!(
            "to calibrate the added effects together with all other unknowns, starting from the values found:\n  horsehead calibrate {} --genes {}",
            quote_path(&self.run.manifest.case_folder),
            quote_path(&self.run.folder.file(GENES)),
        ));
        Ok(())
    }
}
