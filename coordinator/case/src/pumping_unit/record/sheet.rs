//! The data sheet beside a gauge record, `test_5rpm.toml`: what the measuring chain states.
use super::tolerance::Tolerance;
use crate::{
    document::{Document, Step},
    error::CaseError,
    note::Note,
};
use discrepancy::record::{InputScatter, Stated};
use protocol::pumping_unit::{Sensor, TurnSense};
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

/// The crank's part of a data sheet.
#[derive(Debug, Default, Deserialize)]
struct Crank {
    index_tolerance_deg: Option<f64>,
    sense: Option<String>,
}

/// The load cell's part of a data sheet.
#[derive(Debug, Default, Deserialize)]
struct Load {
    cycle_to_cycle_variation: Option<f64>,
}

/// The position's part of a data sheet.
#[derive(Debug, Default, Deserialize)]
struct Position {
    noise_rms_m: Option<f64>,
}

/// The torque's part of a data sheet.
#[derive(Debug, Default, Deserialize)]
struct Torque {
    noise_rms_nm: Option<f64>,
}

/// The gauges' part of a data sheet.
#[derive(Debug, Deserialize)]
pub(super) struct Gauges {
    pub(super) unit: String,
    pub(super) resolution_mpa: Option<f64>,
    pub(super) noise_rms_mpa: Option<f64>,
    noise_correlation_per_sample: Option<f64>,
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
    "tolerance",
];

/// Every sense in which a crank may turn.
const SENSES: [TurnSense; 2] = [TurnSense::Clockwise, TurnSense::CounterClockwise];

impl Sheet {
    /// The sense in which the crank turns, seen with the well on the right; none where the sheet says
    /// nothing of it.
    ///
    /// # Errors
    /// Any value that is none of the two, prose too.
    pub(super) fn sense(&self, document: &Document) -> Result<Option<TurnSense>, CaseError> {
        let Some(stated) = &self.crank.sense else {
            return Ok(None);
        };
        let sense = SENSES
            .into_iter()
            .find(|sense| sense.to_string() == *stated);
        sense.map(Some).ok_or_else(|| {
            document.field(
                &[Step::Key("crank"), Step::Key("sense")],
                format!("\"{stated}\""),
                SENSES.map(|sense| format!("\"{sense}\"")).join(" or "),
                "write one of the two: how the crank turns while crank_deg grows, seen with the \
                 well on the right",
            )
        })
    }

    /// The noise of one sample, in the unit of the sensor's channel, if the sheet states it.
    pub(super) const fn noise(&self, sensor: Sensor) -> Option<f64> {
        match sensor {
            Sensor::Gauge(_) => self.gauges.noise_rms_mpa,
            Sensor::Position => self.position.noise_rms_m,
            Sensor::Torque => self.torque.noise_rms_nm,
        }
    }

    /// Correlation of the noise from one value to the next, of channels that are sampled `grid` times as densely on the
    /// output grid as in the record, if the sheet states it.
    pub(super) fn correlation(&self, grid: f64) -> Option<f64> {
        let stated = self.gauges.noise_correlation_per_sample;
        stated.map(|rho| libm::pow(rho, 1.0 / grid))
    }

    /// What the sheet says of the measurement, for channels of these sensors.
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
        check_tolerance(&document, &sheet.tolerance)?;
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

/// Standard deviations are finite and not negative.
fn check_tolerance(document: &Document, tolerance: &Tolerance) -> Result<(), CaseError> {
    for (name, value) in tolerance.stated() {
        if !(value.is_finite() && value >= 0.0) {
            return Err(document.field(
                &[Step::Key("tolerance"), Step::Key(name)],
                value,
                "a standard deviation: a finite number, 0 or greater",
                "state how good the instrument is, or leave the key out",
            ));
        }
    }
    Ok(())
}
