//! Reading of the channels and their measured records.
use super::{
    super::{
        document::{Document, DocumentStep, nearest},
        error::CaseError,
        fitted_conditions::FittedConditions,
        names,
        spread::mean_and_spread,
    },
    file::{AbscissaEntry, ChannelEntry, ConditionEntry, HeldOutEntry, PointsEntry},
    record::{self, Tables},
};
use protocol::case::{Abscissa, Channel, ChannelRecord, Offset};
use std::path::{Path, PathBuf};

/// Maximum number of abscissa points of a channel.
const MOST_POINTS: u32 = 1_000_000;
/// Tolerance, as a share of the spacing, within which abscissa points count as equally spaced.
const SPACING_TOLERANCE: f64 = 1e-6;
/// Binary logarithm of the ratio of a channel's noise to the rounding step of the curves that workers send:
/// 2^10, about a thousand.
const NOISE_TO_STEP_LOG2: f64 = 10.0;

/// Channel of a case with its measured record, as read from the files.
pub(super) struct ReadChannel {
    pub(super) channel: Channel,
    /// Measured values of the channel, cycle by cycle; empty for a channel without a record.
    pub(super) cycles: Vec<Vec<f64>>,
    /// Part of the channel that is held out from the fits of a diagnosis.
    pub(super) held_out: HeldOutEntry,
    /// Correlation of the channel's noise between successive values, if the case states it.
    pub(super) correlation: Option<f64>,
    /// Standard deviation of the model error of this channel, below which no model is expected to fit, if the
    /// case states it.
    pub(super) model_error: Option<f64>,
    /// Name of the record's file and of its condition, if the folder of `--measured` lacks the file.
    pub(super) missing: Option<(String, String)>,
}

/// Folders from which records are read, and defaults for reading them.
pub(super) struct RecordSources<'a> {
    /// Folder of the case.
    pub(super) folder: &'a Path,
    /// Folder whose records replace those of the case, if given.
    pub(super) replacement_folder: Option<&'a Path>,
    /// Conditions used in the calibration, whose records must exist.
    pub(super) calibrated: Option<&'a FittedConditions>,
    /// Default for the treatment of a sensor's zero (free or fixed offset), for channels that do not state
    /// one.
    pub(super) offset: Offset,
}

impl RecordSources<'_> {
    /// Returns the path of a record's file: in the folder of `--measured DIR` under the same name if given,
    /// otherwise in the case's folder.
    fn of(&self, named: &Path) -> PathBuf {
        match (self.replacement_folder, named.file_name()) {
            (Some(measured), Some(name)) => measured.join(name),
            _ => self.folder.join(named),
        }
    }

    /// Returns whether the folder of `--measured` lacks a record that may be missing, because its condition
    /// is not used in the calibration.
    fn may_omit(&self, named: &Path, condition: &str) -> bool {
        let needed = self
            .calibrated
            .is_some_and(|fitted| fitted.names(condition));
        self.replacement_folder.is_some() && !needed && !self.of(named).exists()
    }
}

/// Reads every channel of the case, with its measured record if it has one.
///
/// # Errors
/// Returns an error for an unknown condition, an invalid noise or spacing, and any fault of a record.
pub(super) fn read(
    document: &Document,
    entries: &[ChannelEntry],
    conditions: &[ConditionEntry],
    place: &RecordSources<'_>,
) -> Result<Vec<ReadChannel>, CaseError> {
    let records = entries.iter().filter_map(|entry| entry.record.as_ref());
    let mut tables = Tables::new(&records.collect::<Vec<_>>());
    let mut read = |(index, entry): (usize, &ChannelEntry)| {
        let keys = [
            DocumentStep::Key("channels"),
            DocumentStep::Index(index),
            DocumentStep::Key("name"),
        ];
        let twin =
            |other: &ChannelEntry| other.name == entry.name && other.condition == entry.condition;
        let is_there = entries[..index].iter().any(twin);
        let what = "channel of its condition";
        names::check_one(document, &keys, what, &entry.name, is_there)?;
        let source = ChannelReader {
            document,
            index,
            entry,
        };
        source.read(conditions, place, &mut tables)
    };
    entries.iter().enumerate().map(&mut read).collect()
}

/// `[[channels]]` table of the case file with its index, for reading and checking it.
struct ChannelReader<'a> {
    document: &'a Document,
    index: usize,
    entry: &'a ChannelEntry,
}

impl ChannelReader<'_> {
    /// Builds an error about a field of the channel entry.
    fn field_error(&self, keys: &[&str], value: String, allowed: &str, help: &str) -> CaseError {
        let entry = [
            DocumentStep::Key("channels"),
            DocumentStep::Index(self.index),
        ];
        let below = keys.iter().map(|key| DocumentStep::Key(key));
        let keys: Vec<DocumentStep<'_>> = entry.into_iter().chain(below).collect();
        self.document.field(&keys, value, allowed, help)
    }

    fn read(
        &self,
        conditions: &[ConditionEntry],
        place: &RecordSources<'_>,
        tables: &mut Tables,
    ) -> Result<ReadChannel, CaseError> {
        let entry = self.entry;
        let names = conditions.iter().map(|condition| condition.name.as_str());
        let Some(condition) = names.clone().position(|name| name == entry.condition) else {
            let list: Vec<&str> = names.clone().collect();
            let near = nearest(&entry.condition, names);
            return Err(self.field_error(
                &["condition"],
                format!("\"{}\"", entry.condition),
                &format!("the name of a condition: {}", list.join(", ")),
                &near.map_or("add it as [[conditions]]".to_owned(), |near| {
                    format!("did you mean `{near}`?")
                }),
            ));
        };
        if entry
            .noise
            .is_some_and(|noise| !(noise > 0.0 && noise.is_finite()))
        {
            return Err(self.field_error(
                &["noise"],
                entry.noise.unwrap_or_default().to_string(),
                &format!("above 0 {}", entry.unit),
                "give the standard deviation of one value, or leave it out",
            ));
        }
        self.check_errors()?;
        let record::ChannelData {
            abscissa: points,
            mut cycles,
            weights,
        } = self.places_and_cycles(place, tables)?;
        let file = entry.record.as_ref().map(|record| &record.file);
        let missing = file
            .filter(|file| place.may_omit(file, &entry.condition))
            .map(|file| {
                // the places stand, the values are another test's
                cycles.clear();
                let name = file.file_name().unwrap_or_default().display().to_string();
                (name, entry.condition.clone())
            });
        self.check_segment(&points)?;
        let offset = entry.offset.unwrap_or(place.offset);
        self.check_limit(offset)?;
        let record = (!cycles.is_empty()).then(|| averaged(&cycles));
        if entry.limit.is_some() {
            // no measurement of the channel, so that no interval and no discrepancy follows from it
            cycles.clear();
        }
        let AbscissaEntry {
            name, unit, period, ..
        } = &entry.abscissa;
        Ok(ReadChannel {
            channel: Channel {
                name: entry.name.clone(),
                title: entry.title.clone().unwrap_or_else(|| entry.name.clone()),
                unit: entry.unit.clone(),
                condition,
                abscissa: Abscissa {
                    name: name.clone(),
                    unit: unit.clone(),
                    points,
                    period: *period,
                },
                noise: entry.noise,
                step: entry.noise.map(|noise| step(noise, &weights)),
                weights,
                offset,
                limit: entry.limit,
                record,
            },
            cycles,
            held_out: entry.held_out,
            correlation: entry.correlation,
            model_error: entry.model_error,
            missing,
        })
    }

    /// Checks that a held-out segment contains some of the abscissa points, but not all.
    fn check_segment(&self, points: &[f64]) -> Result<(), CaseError> {
        let HeldOutEntry::Segment(part) = self.entry.held_out else {
            return Ok(());
        };
        let inside = points.iter().filter(|x| (part.from..=part.to).contains(x));
        let inside = inside.count();
        if inside > 0 && inside < points.len() {
            return Ok(());
        }
        let ends = [points.first(), points.last()].map(|x| x.copied().unwrap_or_default());
        Err(self.field_error(
            &["held_out"],
            format!("from {} to {}", part.from, part.to),
            &format!(
                "a part of the record, which reaches from {} to {} {}",
                ends[0], ends[1], self.entry.abscissa.unit
            ),
            "give a part with some of the values in it, or hold out the whole channel: held_out = true",
        ))
    }

    /// Checks that a channel with a limit has a record and an absolute zero.
    fn check_limit(&self, offset: Offset) -> Result<(), CaseError> {
        if self.entry.limit.is_none() || (self.entry.record.is_some() && offset == Offset::Fixed) {
            return Ok(());
        }
        Err(self.field_error(
            &["limit"],
            format!("stated for channel `{}`", self.entry.name),
            "absent, unless the channel has a record and offset = \"fixed\"",
            "state the limit's values as the record, and offset = \"fixed\"; or remove `limit`",
        ))
    }

    /// Checks that the noise correlation and the model error that a channel states are in range.
    fn check_errors(&self) -> Result<(), CaseError> {
        let entry = self.entry;
        let correlation = entry.correlation.filter(|rho| !(0.0..1.0).contains(rho));
        if let Some(rho) = correlation {
            return Err(self.field_error(
                &["correlation"],
                rho.to_string(),
                "from 0 to below 1",
                "give the correlation of the noise from one value to the next, or leave it out",
            ));
        }
        let error = entry
            .model_error
            .filter(|own| !(*own > 0.0 && own.is_finite()));
        if let Some(error) = error {
            return Err(self.field_error(
                &["model_error"],
                error.to_string(),
                &format!("above 0 {}", entry.unit),
                "give the standard deviation of the model error, or remove `model_error`",
            ));
        }
        Ok(())
    }

    /// Returns the abscissa points of the channel and the measured values at them, cycle by cycle.
    fn places_and_cycles(
        &self,
        place: &RecordSources<'_>,
        tables: &mut Tables,
    ) -> Result<record::ChannelData, CaseError> {
        let offset = self.entry.offset.unwrap_or(place.offset);
        // single values that a program computes may be residuals, whose target is 0
        let named = self.entry.source.as_ref();
        let is_named = named.is_some_and(|source| source.contains_key("named"));
        let may_be_constant = self.entry.limit.is_some() || (is_named && offset == Offset::Fixed);
        let read = match (&self.entry.record, &self.entry.abscissa.points) {
            (Some(entry), None) => {
                let role = format!(
                    "the record of channel `{}` in {}",
                    self.entry.name,
                    self.document.path.display()
                );
                let path = if place.may_omit(&entry.file, &self.entry.condition) {
                    place.folder.join(&entry.file)
                } else {
                    place.of(&entry.file)
                };
                record::read(tables, &path, (entry, may_be_constant), &role)?
            }
            (None, Some(points)) => record::ChannelData {
                abscissa: self.spaced(*points)?,
                cycles: Vec::new(),
                weights: Vec::new(),
            },
            (record, _) => {
                let both = record.is_some();
                return Err(self.field_error(
                    &["abscissa", "points"],
                    if both {
                        "stated beside a record"
                    } else {
                        "absent"
                    }
                    .to_owned(),
                    "a record, which states its own places, or points = { first, step, count }",
                    if both {
                        "remove one of them"
                    } else {
                        "add one of them"
                    },
                ));
            }
        };
        self.check_period(&read.abscissa)?;
        let least = match offset {
            Offset::Fixed => 1,
            Offset::Free => 2,
        };
        if read.abscissa.len() < least {
            return Err(self.field_error(
                &["abscissa"],
                format!("{} value", read.abscissa.len()),
                "two or more values: with offset = \"free\" the mean difference is removed before the comparison",
                "state offset = \"fixed\" if the values have an absolute zero",
            ));
        }
        Ok(read)
    }

    /// Returns equally spaced abscissa points from the first point, the spacing and the number that the case
    /// states.
    fn spaced(&self, points: PointsEntry) -> Result<Vec<f64>, CaseError> {
        let PointsEntry { first, step, count } = points;
        let ascends = step > 0.0 && step.is_finite() && first.is_finite();
        if !ascends || !(1..=MOST_POINTS).contains(&count) {
            return Err(self.field_error(
                &["abscissa", "points"],
                format!("{{ first = {first}, step = {step}, count = {count} }}"),
                &format!("finite numbers, step above 0, count 1 to {MOST_POINTS}"),
                "state where the curve is to be computed",
            ));
        }
        Ok((0..count).map(|at| first + step * f64::from(at)).collect())
    }

    /// Checks that the abscissa points of a periodic channel are equally spaced and fill one period.
    fn check_period(&self, points: &[f64]) -> Result<(), CaseError> {
        let Some(period) = self.entry.abscissa.period else {
            return Ok(());
        };
        let step = period / points.len() as f64;
        let first = points.first().copied().unwrap_or_default();
        let off = |(at, point): (usize, &f64)| (point - first - step * at as f64).abs();
        let furthest = points.iter().enumerate().map(off).fold(0.0, f64::max);
        if period > 0.0 && furthest <= SPACING_TOLERANCE * step {
            return Ok(());
        }
        let unit = &self.entry.abscissa.unit;
        Err(self.field_error(
            &["abscissa", "period"],
            format!("{period} {unit}"),
            &format!(
                "the span of {} equally spaced places from {first} {unit} on, without the one at which \
                 the curve begins anew",
                points.len()
            ),
            "interpolate the record to equal steps that divide the period, or leave `period` out",
        ))
    }
}

/// Returns the rounding step of the curves that workers send for a channel, as an exponent of two: the
/// greatest power of two that does not exceed 1/1024 of the noise of the value with the largest weight.
fn step(noise: f64, weights: &[f64]) -> i32 {
    let noise = noise / weights.iter().copied().fold(1.0, f64::max);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the logarithm of a finite number"
    )]
    let power = (noise.log2() - NOISE_TO_STEP_LOG2).floor() as i32;
    power
}

/// Returns the mean and the standard deviation over the cycles at each abscissa point.
fn averaged(cycles: &[Vec<f64>]) -> ChannelRecord {
    let places = 0..cycles.first().map_or(0, Vec::len);
    let statistics = places.map(|at| mean_and_spread(cycles.iter().map(move |cycle| cycle[at])));
    let (mean, spread) = statistics
        .map(|(mean, spread, _)| (mean.unwrap_or_default(), spread))
        .unzip();
    ChannelRecord {
        cycles: cycles.len(),
        mean,
        spread,
    }
}
