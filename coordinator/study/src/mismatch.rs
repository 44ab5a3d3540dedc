//! Consistency of measured records with their channels: a wrong unit, another zero of the angle, a sensor of
//! reversed sign or exchanged columns cause a bad fit whose numbers do not reveal the reason.
use super::{
    compare::{CompareRequest, Compared, ComparedCurves, NamedIndividual, compare},
    error::StudyError,
    evaluator::Evaluator,
    stop::Stop,
};
use protocol::{case::Case, job::Verdict};
use record::{Record, Recorded, Stated};

/// Minimum amount by which a record must correlate better with another curve than with its own channel. Each
/// of 28 records of the shipped and the practice cases correlates by at least 0.97 with its own channel under
/// the recommended values, and by at most 0.86 with any other, with either sign, except for two channels that
/// mirror each other.
const MARGIN: f64 = 0.2;

/// Minimum correlation between a record and a curve from which the record is taken for one of that curve.
const ALIKE: f64 = 0.8;

/// Factor by which the best explanation of records must leave less of their variance than every other one. A sensor of
/// reversed sign, a record that begins half a turn later and two exchanged columns resemble each other: on the
/// shipped records the right one leaves 2.2 to 7 times less.
const FAR: f64 = 2.0;

/// Ratio of amplitudes that is wrong, as a multiple of what the shape of the curves leaves open, and at least
/// relative: stiffnesses that are not calibrated yet change shape and amplitude alike.
const OPEN: f64 = 5.0;
const LEAST: f64 = 0.05;

/// Largest relative distance of a ratio of amplitudes from a conversion between units that explains it.
const NEAR: f64 = 0.2;

/// Numbers that one of a base unit (first) has in another unit (second).
const UNITS: &[(&str, &str, f64)] = &[
    ("Pa", "um/m of steel", 1.0 / 0.206e6),
    ("Pa", "ksi", 1.450_38e-7),
    ("Pa", "psi", 1.450_38e-4),
    ("Pa", "Pa", 1.0),
    ("m", "ft", 3.280_84),
    ("m", "inch", 39.370_1),
    ("m", "cm", 1e2),
    ("m", "mm", 1e3),
    ("N.m", "kN.m", 1e-3),
    ("N.m", "lbf.ft", 0.737_562),
    ("N.m", "lbf.in", 8.850_75),
    ("N", "kN", 1e-3),
    ("N", "lbf", 0.224_809),
    ("N", "kgf", 0.101_972),
];

/// Factors by which everything that a force drives falls if its numbers are in another unit than newtons.
const FORCES: &[(&str, f64)] = &[("lbf", 4.448_22), ("kgf", 9.806_65), ("kN", 1e3)];

/// Returns requests for the recommended individual under the calibrated condition, with `pictures` snapshots
/// of its motion, followed by every other condition with a measured record.
pub fn recommended(case: &Case, pictures: u32) -> Vec<CompareRequest> {
    let calibrated = case.objective.condition;
    let mut conditions: Vec<usize> = (0..case.conditions.len()).collect();
    conditions.retain(|index| *index == calibrated || case.is_measured(*index));
    conditions.sort_by_key(|index| *index != calibrated);
    let wanted = |condition| CompareRequest {
        condition,
        first: 0,
        individuals: vec![NamedIndividual::new("recommended", case.start())],
        frames: if condition == calibrated { pictures } else { 0 },
        columns: Vec::new(),
    };
    conditions.into_iter().map(wanted).collect()
}

/// Simulates the recommended individual and returns its [`mismatches`]; returns none if it cannot be
/// simulated.
///
/// # Errors
/// If no job can be done, no evaluator is left, or the user stops it.
pub async fn check_records<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    records: &[Record],
    stop: &mut Stop,
) -> Result<Vec<String>, StudyError> {
    match compare(evaluator, case, &recommended(case, 0), stop).await {
        Ok(compared) => Ok(mismatches(case, records, &compared)),
        Err(StudyError::Unavailable { .. }) => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

/// Returns one sentence for everything that measured records (those of the objective where `records` has none for a
/// condition) do not have in common with their simulation: a wrong
/// amplitude, another zero of the angle, a reversed sign, an exchanged column. A remedy is given where it explains a
/// record far better than every other one.
pub fn mismatches(case: &Case, records: &[Record], compared: &[Compared]) -> Vec<String> {
    let first = |one: &Compared| Some((one.condition, one.individuals.first()?.clone()));
    let simulated = compared.iter().filter_map(first);
    let said = simulated.flat_map(|(condition, curves)| {
        let mut own = records.iter().filter(|own| own.condition == condition);
        let record = own.find(|own| !own.cycles.is_empty());
        let record = record.map_or_else(|| of_objective(case, condition), Record::clone);
        of_condition(case, &record, &curves)
    });
    said.collect()
}

/// Returns the part of a condition's record with which the objective compares.
fn of_objective(case: &Case, condition: usize) -> Record {
    let channels = case.channels_of(condition).enumerate();
    let recorded = channels.filter_map(|(curve, (_, channel))| {
        let record = channel.record.as_ref()?;
        Some((Recorded::new(curve, channel), record.mean.clone()))
    });
    let (channels, mean) = recorded.unzip();
    Record {
        condition,
        channels,
        cycles: vec![mean],
        held_out: false,
        stated: Stated::default(),
    }
}

fn of_condition(case: &Case, record: &Record, curves: &ComparedCurves) -> Vec<String> {
    if curves.drawn.verdict != Verdict::Complete {
        return Vec::new();
    }
    let name = case.conditions.get(record.condition);
    let name = name.map_or("", |condition| condition.name.as_str());
    let mean = record.mean();
    let channels = record.channels.iter().zip(mean);
    let drawn: Vec<Drawn<'_>> = channels
        .filter_map(|(of, record)| {
            let simulated = curves.drawn.channels.get(of.curve)?;
            Some(Drawn {
                simulated: of.pick(simulated)?,
                record,
                of,
            })
        })
        .collect();
    let all: Vec<Agreement<'_>> = drawn
        .iter()
        .filter_map(|own| Agreement::new(own, &drawn))
        .collect();
    let (mut notes, explained) = shapes(&all);
    let rest: Vec<&Agreement<'_>> = all
        .iter()
        .filter(|own| !explained.contains(&own.title()))
        .collect();
    notes.extend(rest.iter().filter_map(|own| own.unlike()));
    notes.extend(amplitudes(&rest));
    let said = notes.into_iter().map(|note| format!("{name}: {note}"));
    said.collect()
}

/// Measured mean and simulated curve of a channel.
struct Drawn<'a> {
    of: &'a Recorded,
    record: Vec<f64>,
    simulated: Vec<f64>,
}

/// Agreement of a record with the simulation of its channel.
struct Agreement<'a> {
    drawn: &'a Drawn<'a>,
    /// Correlation with the simulation.
    own: f64,
    /// Ratio of the amplitudes (standard deviations) of record and simulation.
    ratio: f64,
    /// Title of the other channel of the same unit with whose simulation the record correlates best, with that
    /// correlation.
    other: Option<(&'a str, f64)>,
}

impl<'a> Agreement<'a> {
    /// Compares a record with the simulation of its channel and with those of the other channels of its unit; `None`
    /// for a constant one.
    fn new(drawn: &'a Drawn<'a>, all: &'a [Drawn<'a>]) -> Option<Self> {
        let channel = &drawn.of.channel;
        let others = all.iter().filter_map(|other| {
            let of = &other.of.channel;
            let alike = of.name != channel.name
                && of.unit == channel.unit
                && of.abscissa == channel.abscissa;
            let correlation = correlation(&drawn.record, &other.simulated)?;
            alike.then_some((of.title.as_str(), correlation))
        });
        Some(Self {
            own: correlation(&drawn.record, &drawn.simulated)?,
            ratio: deviation(&drawn.record) / deviation(&drawn.simulated),
            other: others.max_by(|a, b| a.1.total_cmp(&b.1)),
            drawn,
        })
    }

    fn title(&self) -> &'a str {
        &self.drawn.of.channel.title
    }

    fn unit(&self) -> &'a str {
        &self.drawn.of.channel.unit
    }

    /// Returns the correlation with the simulation if the record began a number of samples later in its period.
    fn turned(&self, shift: usize) -> f64 {
        let mut record = self.drawn.record.clone();
        let count = record.len().max(1);
        record.rotate_left(shift % count);
        correlation(&record, &self.drawn.simulated).unwrap_or(0.0)
    }

    /// Returns what is wrong with a record that resembles its simulation in no way.
    fn unlike(&self) -> Option<String> {
        let (own, title) = (self.own, self.title());
        (own < ALIKE).then(|| {
            format!(
                "the record of {title} correlates by {own:.2} with its simulation and has {:.2} times its amplitude: check its \
                 column and unit, and the values of the case that it depends on",
                self.ratio
            )
        })
    }
}

/// Explanation of the shape of some records.
#[derive(Clone, Copy, PartialEq)]
enum Cause {
    /// The records begin a number of samples later in the period.
    Turned(usize),
    Reversed,
    Exchanged,
}

impl Cause {
    /// Returns the correlation of a record with its simulation once the cause is removed.
    fn correlation(self, of: &Agreement<'_>) -> f64 {
        match self {
            Self::Turned(shift) => of.turned(shift),
            Self::Reversed => -of.own,
            Self::Exchanged => of.other.map_or(-1.0, |(_, alike)| alike),
        }
    }

    /// Returns the share of the variance of records that their simulations leave once the cause is removed.
    fn left(self, of: &[&Agreement<'_>]) -> f64 {
        of.iter().map(|own| left(self.correlation(own))).sum()
    }
}

/// Returns what is wrong with the shape of records, and the titles of those that it explains. First all records
/// together are turned, since one angle belongs to all of them; then the records of each unit are explained.
fn shapes<'a>(all: &[Agreement<'a>]) -> (Vec<String>, Vec<&'a str>) {
    let every: Vec<&Agreement<'_>> = all.iter().collect();
    let wrong = every.iter().filter(|own| own.own < ALIKE).count();
    if 2 * wrong > every.len()
        && let Some((cause, angle)) = best_turn(&every)
        && every.iter().all(|own| cause.correlation(own) >= ALIKE)
        && FAR * cause.left(&every) < Cause::Reversed.left(&every)
    {
        let note = format!(
            "every record fits its simulation from {angle} on: is the angle counted from another point, such as the other dead \
             centre? subtract {angle} from it"
        );
        return (vec![note], all.iter().map(Agreement::title).collect());
    }
    let mut notes = Vec::new();
    let mut explained = Vec::new();
    let mut units: Vec<&str> = all.iter().map(Agreement::unit).collect();
    units.dedup();
    for unit in units {
        let own = all.iter().filter(|own| own.unit() == unit);
        let (note, titles) = of_unit(own.collect(), all);
        notes.extend(note);
        explained.extend(titles);
    }
    (notes, explained)
}

/// Explains the shapes of the records of one unit; returns the note and the titles of the records that it is about.
fn of_unit<'a>(own: Vec<&Agreement<'a>>, all: &[Agreement<'_>]) -> (Option<String>, Vec<&'a str>) {
    let mut faulty = own;
    faulty.retain(|own| own.own < ALIKE);
    let turn = best_turn(&faulty);
    let mut causes = vec![Cause::Reversed, Cause::Exchanged];
    causes.extend(turn.as_ref().map(|(cause, _)| *cause));
    let explains = |own: &&Agreement<'_>, cause: &Cause| {
        let there = cause.correlation(own);
        there >= ALIKE && there - own.own >= MARGIN
    };
    faulty.retain(|own| causes.iter().any(|cause| explains(own, cause)));
    if faulty.is_empty() {
        return (None, Vec::new());
    }
    causes.sort_by(|a, b| a.left(&faulty).total_cmp(&b.left(&faulty)));
    let certain = FAR * causes[0].left(&faulty) < causes[1].left(&faulty);
    let titles: Vec<&str> = faulty.iter().map(|own| own.title()).collect();
    let angle = turn.map_or_else(String::new, |(_, angle)| angle);
    let of = |own: &&Agreement<'_>| match causes[0] {
        Cause::Exchanged => {
            let (other, alike) = own.other.unwrap_or_default();
            format!(
                "the record of {} correlates by {alike:.2} with the simulated {other}, and by {:.2} with its own",
                own.title(),
                own.own
            )
        }
        Cause::Reversed | Cause::Turned(_) => format!(
            "the record of {} correlates by {:.2} with its simulation",
            own.title(),
            own.own
        ),
    };
    let facts: Vec<String> = faulty.iter().map(of).collect();
    let others: Vec<&str> = all
        .iter()
        .filter(|own| own.own >= ALIKE)
        .map(Agreement::title)
        .collect();
    let remedy = match causes[0] {
        _ if !certain => format!(
            "the sign may be reversed, columns exchanged, or the record, or what drives the simulation such as a measured load, \
             begin at another point (best at {angle}); the curves do not tell which"
        ),
        Cause::Reversed => "the sign is reversed; multiply the column by -1".to_owned(),
        Cause::Exchanged => "were two columns exchanged? correct their names".to_owned(),
        Cause::Turned(_) if others.is_empty() => {
            format!("it fits from {angle} on: is the angle counted from another point?")
        }
        Cause::Turned(_) => format!(
            "it fits from {angle} on, while {} fit as they are: does what drives the simulation, such as a measured load, begin at \
             another point?",
            others.join(", ")
        ),
    };
    (Some(format!("{}: {remedy}", facts.join("; "))), titles)
}

/// Returns the turn by which records of one abscissa fit their simulations best, with the angle in words; `None`
/// without a period.
fn best_turn(all: &[&Agreement<'_>]) -> Option<(Cause, String)> {
    let abscissa = &all.first()?.drawn.of.channel.abscissa;
    let count = abscissa.points.len();
    let period = abscissa.period?;
    let mut others = all.iter().map(|own| &own.drawn.of.channel.abscissa);
    if !others.all(|own| own == abscissa) {
        return None;
    }
    let total = |shift: usize| all.iter().map(|own| own.turned(shift)).sum::<f64>();
    let best = (0..count)
        .map(|shift| (shift, total(shift)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let (shift, _) = best?;
    let angle = period * shift as f64 / count as f64;
    Some((
        Cause::Turned(shift),
        format!("{angle:.0} {}", abscissa.unit),
    ))
}

/// Returns the share of a record's variance that a curve of a given correlation leaves.
fn left(correlation: f64) -> f64 {
    1.0 - correlation.max(0.0).powi(2)
}

/// Returns one sentence for each wrong ratio of amplitudes, with the channels that share it and the units that
/// would explain it: units of the records where records of other units fit, else of what drives the simulation.
fn amplitudes(all: &[&Agreement<'_>]) -> Vec<String> {
    let wrong = |own: &&Agreement<'_>| {
        let open = OPEN * left(own.own).sqrt();
        own.own >= ALIKE && libm::log(own.ratio).abs() > open.max(LEAST)
    };
    let mut wrong: Vec<&Agreement<'_>> = all.iter().copied().filter(wrong).collect();
    let mut notes = Vec::new();
    while let Some(first) = wrong.first().copied() {
        let same =
            |own: &&Agreement<'_>| own.unit() == first.unit() && near(own.ratio, first.ratio);
        let (own, rest): (Vec<_>, Vec<_>) = wrong.into_iter().partition(same);
        wrong = rest;
        let mean = own.iter().map(|own| libm::log(own.ratio)).sum::<f64>() / own.len() as f64;
        let ratio = libm::exp(mean);
        let driven = all
            .iter()
            .any(|other| other.unit() != first.unit() && other.own < ALIKE);
        let units = UNITS.iter().filter_map(|(base, other, factor)| {
            let scale = if *base == first.unit() {
                Some(1.0)
            } else {
                case::conversion::factor(first.unit(), base)
            };
            Some((other, scale? * factor))
        });
        let of_record = units
            .filter(|(_, factor)| !driven && near(ratio, *factor))
            .map(|(other, factor)| format!("its values are in {other} (factor {factor:.3})"));
        let of_load = FORCES
            .iter()
            .filter(|(_, factor)| driven && near(ratio, *factor))
            .map(|(other, factor)| {
                format!("the load that drives the simulation is in {other} (factor {factor:.3})")
            });
        let explained: Vec<String> = of_record.chain(of_load).collect();
        let titles: Vec<&str> = own.iter().map(|own| own.title()).collect();
        let reason = if explained.is_empty() {
            "check its unit, and the lengths, masses and loads of the case that it depends on"
                .to_owned()
        } else {
            format!("as if {}", explained.join(", or "))
        };
        notes.push(format!(
            "the record of {} has {ratio:.3} times the amplitude of its simulation: {reason}",
            titles.join(", ")
        ));
    }
    notes
}

/// Returns whether two ratios are the same within [`NEAR`].
fn near(a: f64, b: f64) -> bool {
    libm::log(a / b).abs() < NEAR
}

/// Returns the standard deviation of a curve.
fn deviation(curve: &[f64]) -> f64 {
    let n = curve.len().max(1) as f64;
    let mean = curve.iter().sum::<f64>() / n;
    (curve.iter().map(|y| (y - mean) * (y - mean)).sum::<f64>() / n).sqrt()
}

/// Returns Pearson's correlation of two curves at the same points; none if the curves are constant, differ in
/// length, or have fewer than 8 points.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    if a.len() != b.len() || a.len() < 8 {
        return None;
    }
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let sums = a.iter().zip(b).fold([0.0; 3], |[ab, aa, bb], (a, b)| {
        let (a, b) = (a - mean_a, b - mean_b);
        [ab + a * b, aa + a * a, bb + b * b]
    });
    let [ab, aa, bb] = sums;
    let size = (aa * bb).sqrt();
    (size > 0.0 && size.is_finite()).then(|| ab / size)
}
