//! Data sheet of a gauge record (e.g. `test_5rpm.toml`): sampling, noise and tolerances of the measuring
//! chain.
use super::tolerance::Tolerance;
use crate::{
    document::{Document, DocumentStep},
    error::CaseError,
    note::Note,
};
use protocol::pumping_unit::{Sensor, TurnSense};
use record::{InputScatter, Stated};
use serde::Deserialize;

/// Keys of a data sheet that are read; other keys are allowed and produce a note.
#[derive(Debug, Deserialize)]
pub(super) struct Sheet {
    pub(super) strokes_per_minute: f64,
    pub(super) sample_rate_hz: f64,
    pub(super) samples_recorded: Option<u64>,
    pub(super) samples_lost: Option<u64>,
    pub(super) gauges: Gauges,
    #[serde(default)]
    crank: Crank,
    #[serde(default)]
    load: Load,
    #[serde(default)]
    position: Position,
    #[serde(default)]
    torque: Torque,
    #[serde(default)]
    tolerance: Tolerance,
}

/// `[crank]` table of a data sheet.
#[derive(Debug, Default, Deserialize)]
struct Crank {
    index_tolerance_deg: Option<f64>,
    sense: Option<String>,
}

/// `[load]` table of a data sheet: the load cell.
#[derive(Debug, Default, Deserialize)]
struct Load {
    cycle_to_cycle_variation: Option<f64>,
}

/// `[position]` table of a data sheet: the rod position sensor.
#[derive(Debug, Default, Deserialize)]
struct Position {
    noise_rms_m: Option<f64>,
}

/// `[torque]` table of a data sheet: the crank torque sensor.
#[derive(Debug, Default, Deserialize)]
struct Torque {
    noise_rms_nm: Option<f64>,
}

/// `[gauges]` table of a data sheet.
#[derive(Debug, Deserialize)]
pub(super) struct Gauges {
    pub(super) unit: String,
    pub(super) resolution_mpa: Option<f64>,
    pub(super) noise_rms_mpa: Option<f64>,
    noise_correlation_per_sample: Option<f64>,
}

/// Top-level keys of a data sheet that produce no note: keys that are read, and keys that only inform a human
/// reader.
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
    "tolerance",
];

/// Allowed values of `crank.sense`.
const SENSES: [TurnSense; 2] = [TurnSense::Clockwise, TurnSense::CounterClockwise];

impl Sheet {
    /// Returns the direction in which the crank turns, seen with the well on the right; `None` where the
    /// sheet does not state it.
    ///
    /// # Errors
    /// Any value other than those in [`SENSES`].
    pub(super) fn sense(&self, document: &Document) -> Result<Option<TurnSense>, CaseError> {
        let Some(stated) = &self.crank.sense else {
            return Ok(None);
        };
        let sense = SENSES
            .into_iter()
            .find(|sense| sense.to_string() == *stated);
        sense.map(Some).ok_or_else(|| {
            document.field(
                &[DocumentStep::Key("crank"), DocumentStep::Key("sense")],
                format!("\"{stated}\""),
                SENSES.map(|sense| format!("\"{sense}\"")).join(" or "),
                "write one of the two: how the crank turns while crank_deg grows, seen with the \
                 well on the right",
            )
        })
    }

    /// Returns the standard deviation of the noise of one sample, in the unit of the sensor's channel, if the
    /// sheet states it.
    pub(super) const fn noise(&self, sensor: Sensor) -> Option<f64> {
        match sensor {
            Sensor::Gauge(_) => self.gauges.noise_rms_mpa,
            Sensor::Position => self.position.noise_rms_m,
            Sensor::Torque => self.torque.noise_rms_nm,
        }
    }

    /// Returns the correlation of the noise between neighbouring points of the output grid, if the sheet
    /// states it, for channels whose output grid has `grid` points per sample of the record.
    pub(super) fn correlation(&self, grid: f64) -> Option<f64> {
        let stated = self.gauges.noise_correlation_per_sample;
        stated.map(|rho| libm::pow(rho, 1.0 / grid))
    }

    /// Converts the instrument tolerances and the scatter of the inputs that the sheet states to the form
    /// that a diagnosis uses, for channels of the given sensors.
    pub(super) fn stated(&self, recorded: &[Sensor]) -> Stated {
        let positive = |value: &f64| *value > 0.0;
        let turned = self.crank.index_tolerance_deg.filter(positive);
        let turned = turned.map(|tolerance| InputScatter::Abscissa { tolerance });
        let loaded = self.load.cycle_to_cycle_variation.filter(positive);
        let loaded = loaded.map(|deviation| InputScatter::Effect {
            id: "load_cell_gain".to_owned(),
            deviation,
        });
        Stated {
            input_scatter: turned.into_iter().chain(loaded).collect(),
            nuisances: self.tolerance.nuisances(recorded),
            ..Stated::default()
        }
    }

    /// Parses and checks a data sheet; returns it with one note per unused key.
    ///
    /// # Errors
    /// A malformed file, a gauge unit other than MPa, or values out of range.
    pub(super) fn of(document: &Document) -> Result<(Self, Vec<Note>), CaseError> {
        let sheet: Self = document.parse()?;
        document.within(
            "strokes_per_minute",
            sheet.strokes_per_minute,
            0.1..=60.0,
            "1/min",
        )?;
        document.within("sample_rate_hz", sheet.sample_rate_hz, 1.0..=1.0e5, "Hz")?;
        let chain = [
            (
                "gauges.resolution_mpa",
                sheet.gauges.resolution_mpa,
                100.0,
                "MPa",
            ),
            (
                "gauges.noise_rms_mpa",
                sheet.gauges.noise_rms_mpa,
                100.0,
                "MPa",
            ),
            (
                "gauges.noise_correlation_per_sample",
                sheet.gauges.noise_correlation_per_sample,
                0.999,
                "1",
            ),
            (
                "crank.index_tolerance_deg",
                sheet.crank.index_tolerance_deg,
                90.0,
                "deg",
            ),
            (
                "load.cycle_to_cycle_variation",
                sheet.load.cycle_to_cycle_variation,
                1.0,
                "1",
            ),
            (
                "position.noise_rms_m",
                sheet.position.noise_rms_m,
                10.0,
                "m",
            ),
            (
                "torque.noise_rms_nm",
                sheet.torque.noise_rms_nm,
                1.0e6,
                "N m",
            ),
        ];
        for (field, value, highest, unit) in chain {
            if let Some(value) = value {
                document.within(field, value, 0.0..=highest, unit)?;
            }
        }
        check_tolerance(document, &sheet.tolerance)?;
        if sheet.gauges.unit != "MPa" {
            return Err(document.field(
                &[DocumentStep::Key("gauges"), DocumentStep::Key("unit")],
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
                path: document.path.clone(),
                text: format!("`{key}` is not used"),
            })
            .collect();
        Ok((sheet, notes))
    }
}

/// Checks that the standard deviations of a data sheet's `[tolerance]` table are finite and not negative.
fn check_tolerance(document: &Document, tolerance: &Tolerance) -> Result<(), CaseError> {
    for (name, value) in tolerance.stated() {
        if !(value.is_finite() && value >= 0.0) {
            return Err(document.field(
                &[DocumentStep::Key("tolerance"), DocumentStep::Key(name)],
                value,
                "a standard deviation: a finite number, 0 or greater",
                "state how good the instrument is, or leave the key out",
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{super::tolerance::KEYS, Sheet};
    use crate::document::Document;
    use std::{fs, path::Path};

    /// Checks that the template of a data sheet states every key with the value that holds without it, and
    /// that the manual has them all.
    #[test]
    fn every_key_of_a_data_sheet_is_documented() {
        let template = include_str!("template.toml");
        let sheet = |text: &str| {
            let document = Document::new("sheet.toml".into(), text.to_owned());
            Sheet::of(&document).map(|(sheet, notes)| {
                assert!(notes.is_empty(), "{notes:?}");
                sheet
            })
        };
        sheet(template).unwrap();
        let is_key = |line: &&str| {
            line.split_once('=')
                .is_some_and(|(key, _)| !key.trim().contains(' '))
        };
        let lines = template.lines().map(|line| {
            let bare = line.strip_prefix("# ").unwrap_or(line);
            Some(bare).filter(is_key).unwrap_or(line).to_owned() + "\n"
        });
        let full = sheet(&lines.collect::<String>()).unwrap();
        let chain = [
            full.samples_recorded.is_some(),
            full.samples_lost.is_some(),
            full.gauges.resolution_mpa.is_some(),
            full.gauges.noise_rms_mpa.is_some(),
            full.gauges.noise_correlation_per_sample.is_some(),
            full.crank.index_tolerance_deg.is_some(),
            full.crank.sense.is_some(),
            full.load.cycle_to_cycle_variation.is_some(),
            full.position.noise_rms_m.is_some(),
            full.torque.noise_rms_nm.is_some(),
        ];
        assert_eq!(chain, [true; 10]);
        let stated: Vec<(&str, f64)> = full.tolerance.stated().collect();
        let usual: Vec<(&str, f64)> = KEYS.iter().map(|key| (key.0, key.1)).collect();
        assert_eq!(stated, usual);
        let manual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/records.md");
        let manual = fs::read_to_string(manual).unwrap();
        let mut table = String::new();
        for line in template.lines() {
            if let Some(name) = line.strip_prefix('[') {
                table = name.split(']').next().unwrap().to_owned() + ".";
            }
            let bare = line.strip_prefix("# ").unwrap_or(line);
            if let Some((key, _)) = Some(bare)
                .filter(is_key)
                .and_then(|line| line.split_once('='))
            {
                let key = format!("`{table}{}`", key.trim());
                assert!(manual.contains(&key), "docs/records.md has no {key}");
            }
        }
    }
}
