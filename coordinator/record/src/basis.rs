//! Coordinates in which curves are compared: orders of a period where the abscissa is periodic with equal
//! steps, samples elsewhere. Callers that whiten or map curves need not know which basis is used.
use crate::measured::Record;
use crate::samples::Samples;
use crate::scatter::unexplained;
use crate::spectrum::{Orders, Spectra};
use nalgebra::Complex;
use protocol::case::{Abscissa, Channel};
use std::ops::RangeInclusive;

type C = Complex<f64>;

/// Maximum number of waves (Fourier orders) computed from a sequence of samples: model errors lie in the slow
/// waves.
const WAVES: usize = 240;
/// Maximum number of channels of a record of one cycle in one group: a covariance matrix for each place of the abscissa took
/// 3.2 GiB for 1,000 channels of 100 places.
const MOST_TOGETHER: usize = 64;

/// Channels of a record that share an abscissa, and the basis in which their curves are compared.
#[derive(Clone, Debug)]
pub struct ChannelGroup {
    /// Indices of the channels in the record, ascending.
    pub channels: Vec<usize>,
    /// Abscissa that all channels of the group share.
    pub abscissa: Abscissa,
    /// Basis in which the curves of the group are compared.
    pub basis: Basis,
}

/// Basis of a group's curves; it includes a curve's constant where its channel has a fixed zero.
#[derive(Clone, Debug)]
pub enum Basis {
    /// Fourier coefficients of a periodic abscissa, by order of the period.
    Orders(Orders),
    /// Innovations of samples, with a correlation length for each channel of the group.
    Samples(Vec<Samples>),
}

impl Basis {
    /// Returns the number of entries (basis coefficients) of a curve.
    pub fn places(&self) -> usize {
        match self {
            Self::Orders(orders) => orders.highest(),
            Self::Samples(samples) => samples.first().map_or(0, Samples::len),
        }
    }

    /// Returns the number of real numbers per basis coefficient: 2 for an order, 1 for a sample.
    pub const fn parts(&self) -> usize {
        match self {
            Self::Orders(_) => 2,
            Self::Samples(_) => 1,
        }
    }

    /// Returns the entries (basis coefficients) of a curve; `row` is the index of its channel in the group.
    pub fn transform(&self, row: usize, curve: &[f64]) -> Vec<C> {
        match self {
            Self::Orders(orders) => orders.transform(curve),
            Self::Samples(samples) => samples[row].transform(curve),
        }
    }

    /// Returns the range of entries about the index `place`, inclusive, over which noise is about equally
    /// strong. Slow curves of a sample basis have ranges of their own: the constant, and both phases of the
    /// first order.
    pub fn neighbours(&self, place: usize) -> RangeInclusive<usize> {
        let (reach, slow) = match self {
            Self::Orders(_) => {
                let reach = match place + 1 {
                    0..=5 => 2,
                    6..=20 => 3,
                    21..=60 => 6,
                    _ => 12,
                };
                (reach, 0)
            }
            Self::Samples(_) => ((self.places() / 8).max(12), self.slow()),
        };
        let last = self.places().saturating_sub(1);
        match place {
            0 if slow > 0 => 0..=0,
            _ if place < slow => 1..=slow - 1,
            _ => place.saturating_sub(reach).max(slow)..=(place + reach).min(last),
        }
    }

    /// Returns the number of leading entries that are slow curves (constant and first order of the span) of a
    /// sample basis; 0 for orders.
    pub fn slow(&self) -> usize {
        match self {
            Self::Orders(_) => 0,
            Self::Samples(samples) => samples.first().map_or(0, Samples::slow),
        }
    }

    /// Returns the root mean square of the curve with the given basis coefficients; `row` is the index of its
    /// channel in the group.
    pub fn rms(&self, row: usize, entries: &[C]) -> f64 {
        match self {
            Self::Orders(_) => (2.0 * entries.iter().map(C::norm_sqr).sum::<f64>()).sqrt(),
            Self::Samples(samples) => samples[row].rms(entries),
        }
    }

    /// Returns the curve with the given basis coefficients, up to a constant where constants do not count; `row` is the index
    /// of its channel in the group.
    pub fn curve(&self, row: usize, entries: &[C]) -> Vec<f64> {
        match self {
            Self::Orders(orders) => orders.curve(entries),
            Self::Samples(samples) => samples[row].curve(entries),
        }
    }

    /// Returns the variance of a basis coefficient of correlated noise relative to white noise of the same
    /// standard deviation: first-order autoregressive noise is stronger at low orders; innovations of samples
    /// are as strong as the noise itself.
    pub fn shape_of_noise(&self, correlation: f64, place: usize) -> f64 {
        match self {
            Self::Orders(orders) => {
                let rho = correlation;
                let turn = std::f64::consts::TAU * (place + 1) as f64 / orders.samples() as f64;
                ((1.0 - rho * rho) / (1.0 - 2.0 * rho * libm::cos(turn) + rho * rho)).max(1.0)
            }
            Self::Samples(_) => 1.0,
        }
    }

    /// Returns the variance of a basis coefficient of white noise with a given standard deviation.
    pub fn variance_of_noise(&self, deviation: f64) -> f64 {
        match self {
            Self::Orders(orders) => deviation * deviation / orders.samples() as f64,
            Self::Samples(_) => deviation * deviation,
        }
    }

    /// Returns the standard deviation of a curve from the standard deviations of its basis coefficients.
    pub fn deviation(&self, entries: &[f64]) -> f64 {
        let square: f64 = entries.iter().map(|d| d * d).sum();
        match self {
            Self::Orders(_) => (2.0 * square).sqrt(),
            // innovations are as strong as the noise itself
            Self::Samples(_) => (square / entries.len().max(1) as f64).sqrt(),
        }
    }

    /// Returns the waves (Fourier coefficients) of a channel from its whitened basis coefficients: these
    /// themselves for orders, else a Fourier transform over the samples. Real and imaginary part of a wave
    /// each have the variance of a real basis coefficient.
    pub fn waves(&self, row: usize, entries: Vec<C>) -> Vec<C> {
        match self {
            Self::Orders(_) => entries,
            Self::Samples(samples) => {
                let n = entries.len();
                let row = samples[row].by_sample(&entries);
                // the last wave of an even row has no second part
                let highest = (n.saturating_sub(1) / 2).min(WAVES);
                let waves = Orders::new(n, highest).transform(&row);
                let scale = (2.0 * n as f64).sqrt();
                waves.into_iter().map(|wave| wave * scale).collect()
            }
        }
    }
}

impl ChannelGroup {
    /// Groups a record's channels by abscissa and selects their basis, with orders up to `highest` where they
    /// have a period. `inputs` are curves by which cycles may differ because their input did.
    pub fn of(record: &Record, highest: usize, inputs: &[Vec<Vec<f64>>]) -> Vec<Self> {
        let mut groups: Vec<(Vec<usize>, &Channel)> = Vec::new();
        for (c, own) in record.channels.iter().enumerate() {
            let own = &own.channel;
            let alike = |other: &Channel| {
                other.abscissa == own.abscissa
                    && is_compared_by_orders(other) == is_compared_by_orders(own)
                    && other.offset == own.offset
            };
            // without cycles no covariance between channels is known, and that of a thousand would fill the memory
            let has_room =
                |channels: &[usize]| record.cycles.len() > 1 || channels.len() < MOST_TOGETHER;
            let mut joined = groups.iter_mut();
            match joined.find(|(channels, other)| has_room(channels) && alike(other)) {
                Some((channels, _)) => channels.push(c),
                None => groups.push((vec![c], own)),
            }
        }
        let group = |(channels, first): (Vec<usize>, &Channel)| {
            let abscissa = first.abscissa.clone();
            let n = abscissa.points.len();
            let basis = if is_compared_by_orders(first) {
                Basis::Orders(Orders::new(n, highest))
            } else {
                Basis::Samples(samples(record, &channels, &abscissa, inputs))
            };
            Self {
                channels,
                abscissa,
                basis,
            }
        };
        groups.into_iter().map(group).collect()
    }

    /// Returns whether the group's curves are compared by orders of a period.
    pub const fn is_periodic(&self) -> bool {
        matches!(self.basis, Basis::Orders(_))
    }

    /// Returns the basis coefficients of the curves of this group's channels; `curves` holds those of all
    /// channels.
    pub fn transform(&self, curves: &[Vec<f64>]) -> Spectra {
        let channels = self.channels.iter().enumerate();
        channels
            .map(|(row, &c)| self.basis.transform(row, &curves[c]))
            .collect()
    }

    /// Returns the derivative of a curve by its abscissa.
    pub fn slope(&self, curve: &[f64]) -> Vec<f64> {
        if let (Basis::Orders(orders), Some(period)) = (&self.basis, self.abscissa.period) {
            let per_unit = std::f64::consts::TAU / period;
            let entries = orders.transform(curve).into_iter().enumerate();
            let steep: Vec<C> = entries
                .map(|(k, f)| f * Complex::new(0.0, (k + 1) as f64 * per_unit))
                .collect();
            return orders.curve(&steep);
        }
        let x = &self.abscissa.points;
        let last = x.len().saturating_sub(1);
        let slope = |i: usize| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            if b > a {
                (curve[b] - curve[a]) / (x[b] - x[a])
            } else {
                0.0
            }
        };
        (0..curve.len()).map(slope).collect()
    }
}

/// Returns whether a channel is compared by the orders of its period: it has a period in equal steps, equal
/// weights and no fixed zero.
fn is_compared_by_orders(channel: &Channel) -> bool {
    let abscissa = &channel.abscissa;
    if channel.is_absolute() || !channel.weights.is_empty() {
        return false;
    }
    let (Some(period), Some(first)) = (abscissa.period, abscissa.points.first()) else {
        return false;
    };
    let step = period / abscissa.points.len() as f64;
    let mut points = abscissa.points.iter().enumerate();
    points.all(|(i, x)| (x - first - step * i as f64).abs() < 1e-6 * step)
}

/// Builds the sample basis of each channel of a group: the noise's correlation length is estimated from the
/// scatter between cycles where there are several, else taken as stated.
fn samples(
    record: &Record,
    channels: &[usize],
    abscissa: &Abscissa,
    inputs: &[Vec<Vec<f64>>],
) -> Vec<Samples> {
    let points = &abscissa.points;
    if record.cycles.len() < 2 {
        let span = points
            .last()
            .zip(points.first())
            .map_or(0.0, |(b, a)| b - a);
        let step = span / (points.len() as f64 - 1.0).max(1.0);
        let own = |c: &usize| {
            let rho = record.correlation(*c);
            let length = if rho > 0.0 {
                -step / libm::log(rho)
            } else {
                0.0
            };
            Samples::of(&record.channels[*c].channel, length)
        };
        return channels.iter().map(own).collect();
    }
    let own = |curves: &Vec<Vec<f64>>| -> Spectra {
        let curve = |c: &usize| curves[*c].iter().map(|y| C::from(*y)).collect();
        channels.iter().map(curve).collect()
    };
    let inputs: Vec<Spectra> = inputs.iter().map(own).collect();
    let deviations = unexplained(record.cycles.iter().map(own).collect(), &inputs);
    let of = |row: usize| -> Vec<Vec<f64>> {
        let cycles = deviations.iter();
        cycles
            .map(|cycle| cycle[row].iter().map(|y| y.re).collect())
            .collect()
    };
    let channels = channels.iter().enumerate();
    channels
        .map(|(row, &c)| Samples::likeliest(&record.channels[c].channel, &of(row)))
        .collect()
}

/// Returns the powers of a curve's basis coefficients, each averaged over the neighbouring coefficients at
/// which noise is about as strong.
pub fn smoothed(basis: &Basis, powers: &[f64]) -> Vec<f64> {
    let mean = |place: usize| {
        let about = basis.neighbours(place);
        let count = about.clone().count();
        powers[about].iter().sum::<f64>() / count as f64
    };
    (0..powers.len()).map(mean).collect()
}
