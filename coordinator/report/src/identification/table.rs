//! Tables of an identification report.
use super::subject::IdentificationInput;
use super::words::open_ends;
use crate::document::{Row, Table};
use crate::number::{MISSING, fixed, quantity, significant};
use crate::words::{condition_name, interval_cell};
use discrepancy::identify::{Direction, FurtherMeasurement};

/// Builds the table of the unknowns: value, 95 % interval, sides on which the interval is unbounded, and
/// correlated unknowns; values alone where there are no intervals.
pub(super) fn unknowns(subject: &IdentificationInput<'_>) -> Table {
    let has_intervals = subject.identified.has_intervals;
    let rows = subject.identified.unknowns.iter().map(|own| {
        let trades = own.correlated.iter().take(3);
        let trades = trades.map(|(name, c)| format!("{name} ({})", fixed(*c, 2)));
        let mut cells = vec![quantity(own.value, &own.unit)];
        if has_intervals {
            cells.extend([
                interval_cell(own),
                open_ends(own),
                trades.collect::<Vec<_>>().join(", "),
            ]);
        }
        match subject.unknown(&own.name) {
            Some(unknown) => Row::of(unknown, cells),
            None => Row::new(own.name.as_str(), cells),
        }
    });
    if !has_intervals {
        return Table::new("Values of the fit", ["", "fitted"], rows.collect());
    }
    Table::new(
        "What the record says of each unknown",
        ["", "likeliest", "95 % interval", "open ends", "trades off with"],
        rows.collect(),
    )
    .with_notes([
        "An end is where -2 ln L, all else refitted, has risen by what a 95 % interval asks for at this dispersion (drawn as 3.84). An end where \
         simulations fail is one of the model, not of the record.",
        "The value of an unknown that the record does not determine is arbitrary: it is where the fit stopped.",
    ])
}

/// Builds the table of the directions in parameter space (combinations of unknowns) with their standard
/// deviations, best determined first.
pub(super) fn directions(subject: &IdentificationInput<'_>) -> Option<Table> {
    let row = |direction: &Direction| {
        let parts = direction.parts.iter();
        let parts = parts.map(|own| format!("{} {}", fixed(own.part, 2), own.name));
        let deviation = direction.sd_decades;
        let deviation = if deviation.is_finite() {
            significant(deviation)
        } else {
            MISSING.to_owned()
        };
        let cells = [deviation, parts.collect::<Vec<_>>().join(", ")];
        Row::new(direction.words.as_str(), cells)
    };
    Table::new(
        "Directions in which the record sees the unknowns",
        ["", "standard deviation [decade]", "parts"],
        subject.identified.directions.iter().map(row).collect(),
    )
    .with_notes([
        "Eigenvectors of the record's own information at the fit, the instruments' errors taken out: each is \
         seen independently of the others. Of unknowns on linear scales half the interval stands for a decade.",
    ])
    .non_empty()
}

/// Builds the table of the half widths of the prediction bands.
pub(super) fn prediction(subject: &IdentificationInput<'_>) -> Option<Table> {
    let case = subject.case;
    let mut rows = Vec::new();
    for band in &subject.identified.bands {
        rows.push(Row::group(condition_name(case, band.condition)));
        let channels = case.channels_of(band.condition).zip(&band.channels);
        rows.extend(channels.map(|((_, channel), curve)| {
            let ends = curve.low.iter().zip(&curve.high);
            let widest = ends.map(|(low, high)| high - low).fold(0.0, f64::max);
            let of = |x: f64| quantity(x, &channel.unit);
            let cells = [of(curve.half_width()), of(0.5 * widest)];
            Row::new(channel.title.as_str(), cells)
        }));
    }
    Table::new(
        "How far the answer leaves predictions open: half widths of 95 % bands",
        ["", "mean", "widest"],
        rows,
    )
    .with_notes([
        "Of the simulated curve: noise and zeros of instruments are not in it. A band spans the linear one, each \
         unknown within its interval, and the outermost points of the profiles.",
    ])
    .non_empty()
}

/// Builds the table of possible further measurements, with the standard deviations of unknowns that each
/// would reduce.
pub(super) fn further(subject: &IdentificationInput<'_>) -> Option<Table> {
    let row = |one: &FurtherMeasurement| {
        let pins = one.pins.iter().map(|pin| {
            format!(
                "{} from {} to {}",
                pin.name,
                significant(pin.sd_now),
                significant(pin.sd_then)
            )
        });
        Row::new(
            one.measurement.as_str(),
            [pins.collect::<Vec<_>>().join(", ")],
        )
    };
    Table::new(
        "What further measurements would pin down",
        ["", "standard deviation [decade]"],
        subject.identified.further.iter().map(row).collect(),
    )
    .with_notes([
        "Linearised at the fit; only standard deviations that would at least be halved are listed. A channel that was never \
         recorded is assigned the noise of a recorded channel with the same unit.",
    ])
    .non_empty()
}
