//! The data sheet beside a gauge record, `test_5rpm.toml`: what the measuring chain states.
use super::super::{
    document::{Document, Step},
    error::CaseError,
    note::Note,
};
use serde::Deserialize;
use std::path::Path;

/// What is used of a data sheet; other keys are allowed and noted.
#[derive(Debug, Deserialize)]
pub(super) struct Sheet {
    pub(super) strokes_per_minute: f64,
    pub(super) sample_rate_hz: f64,
    pub(super) samples_recorded: Option<u64>,
    pub(super) samples_lost: Option<u64>,
    pub(super) gauges: Gauges,
}

/// The gauges' part of a data sheet.
#[derive(Debug, Deserialize)]
pub(super) struct Gauges {
    pub(super) unit: String,
    pub(super) resolution_mpa: Option<f64>,
    pub(super) noise_rms_mpa: Option<f64>,
}

/// Keys of a sheet that are understood, or known and for the reader only.
const KNOWN: &[&str] = &[
    "name",
    "strokes_per_minute",
    "revolutions",
    "sample_rate_hz",
    "samples_recorded",
    "samples_lost",
    "crank",
    "gauges",
    "load",
    "position",
    "torque",
];

impl Sheet {
    /// Reads and checks a data sheet.
    ///
    /// # Errors
    /// Missing, malformed, another unit than MPa, values out of range.
    pub(super) fn read(path: &Path, role: &str) -> Result<(Self, Document, Vec<Note>), CaseError> {
        let document = Document::read(path, role)?;
        let sheet: Self = document.parse()?;
        document.within(
            "strokes_per_minute",
            sheet.strokes_per_minute,
            0.1..=60.0,
            "1/min",
        )?;
        document.within("sample_rate_hz", sheet.sample_rate_hz, 1.0..=1.0e5, "Hz")?;
        let chain = [
            ("gauges.resolution_mpa", sheet.gauges.resolution_mpa),
            ("gauges.noise_rms_mpa", sheet.gauges.noise_rms_mpa),
        ];
        for (field, value) in chain {
            if let Some(value) = value {
                document.within(field, value, 0.0..=100.0, "MPa")?;
            }
        }
        if sheet.gauges.unit != "MPa" {
            return Err(document.field(
                &[Step::Key("gauges"), Step::Key("unit")],
                format!("\"{}\"", sheet.gauges.unit),
                "\"MPa\" (elastic modulus times vertical strain)",
                "convert the columns stress_1_mpa .. stress_4_mpa to MPa",
            ));
        }
        let notes = document
            .parse::<toml::Table>()?
            .keys()
            .filter(|key| !KNOWN.contains(&key.as_str()))
            .map(|key| Note {
                path: path.to_owned(),
                text: format!("`{key}` is not used"),
            })
            .collect();
        Ok((sheet, document, notes))
    }
}
