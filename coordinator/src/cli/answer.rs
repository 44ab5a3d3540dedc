//! The files and the output of a finished diagnosis.
use super::{
    Output, bus, diagnosis_json, output,
    run_folder::{Manifest, RunFolder, quote},
};
use crate::{
    case::{Loaded, write_genes},
    report::diagnosis as report,
    study::Diagnosed,
};
use anyhow::Context as _;
use protocol::announce::EffectDescriptor;
use std::path::Path;

/// A finished diagnosis with everything that its files name.
pub(super) struct Answer<'a, S> {
    pub(super) folder: &'a RunFolder,
    pub(super) manifest: &'a Manifest<S>,
    pub(super) loaded: &'a Loaded,
    pub(super) diagnosed: &'a Diagnosed,
    pub(super) library: &'a [EffectDescriptor],
    pub(super) wall_s: f64,
}

impl<S> Answer<'_, S> {
    fn subject(&self) -> anyhow::Result<report::Subject<'_>> {
        let manifest = self.manifest;
        Ok(report::Subject {
            case: &self.loaded.case,
            records: &self.loaded.cycles,
            library: self.library,
            diagnosed: self.diagnosed,
            provenance: crate::report::Provenance {
                program: manifest.program.clone(),
                command: manifest.command.clone(),
                run: self.folder.path().display().to_string(),
                case_hash: bus::case_hash(&self.loaded.case)?,
                measured_name: manifest.measured.clone(),
                synthetic: manifest.synthetic,
                preset: None,
                seed: Some(manifest.seed),
                digest: String::new(),
            },
            notes: &manifest.notes,
            wall_s: self.wall_s,
        })
    }

    /// Writes the parameters that the answer rests on: with the effects in the case, a simulation of
    /// them is the diagnosis's "after".
    fn write_genes(&self) -> anyhow::Result<()> {
        let Some(fit) = &self.diagnosed.diagnosis.after else {
            return Ok(());
        };
        let about = format!("Parameters of {}", self.folder.path().display());
        let genes = write_genes(&self.loaded.case, &fit.model.genes(fit.x()), &about);
        self.folder.write("calibrated.toml", &genes)
    }

    /// Writes the files into the run folder; returns the object of `--output json`.
    pub(super) fn write(&self) -> anyhow::Result<diagnosis_json::DiagnoseOutput> {
        let subject = self.subject()?;
        if let Some(text) = report::effects_toml(&subject) {
            self.folder.write("effects.toml", &text)?;
        }
        self.write_genes()?;
        for file in report::write(self.folder.path(), &subject)?.iter().take(1) {
            output::tell(&format!("open {}", file.display()));
        }
        let object = diagnosis_json::object(&subject);
        self.folder.write_json("result.json", &object)?;
        Ok(object)
    }

    /// Prints the answer as the user wants it.
    pub(super) fn print(
        &self,
        output: Output,
        object: &diagnosis_json::DiagnoseOutput,
    ) -> anyhow::Result<()> {
        let subject = self.subject()?;
        output::print(output, || report::text(&subject), object)
    }

    /// Appends what was found to a case file, if anything was.
    pub(super) fn add(&self, file: &Path) -> anyhow::Result<()> {
        let Some(text) = report::effects_toml(&self.subject()?) else {
            return Ok(());
        };
        append(file, &text)?;
        let (case, found) = (
            &self.manifest.case_folder,
            self.folder.file("calibrated.toml"),
        );
        output::tell(&format!(
            "to search it with everything else, from what was found:\n  horsehead calibrate {} --genes {}",
            quote(&case.display().to_string()),
            quote(&found.display().to_string()),
        ));
        Ok(())
    }
}

/// Appends effects to a case file.
fn append(file: &Path, text: &str) -> anyhow::Result<()> {
    let mut whole =
        std::fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    if !whole.ends_with('\n') {
        whole.push('\n');
    }
    whole.push('\n');
    whole.push_str(text);
    std::fs::write(file, whole).with_context(|| format!("cannot write {}", file.display()))?;
    output::tell(&format!("added to {}", file.display()));
    Ok(())
}
