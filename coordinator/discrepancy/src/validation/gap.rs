//! Gap between a record and a simulation at one channel, less the part that the record's own scatter
//! explains, with its distribution over sectors of the abscissa and bands of orders.
//!
//! With the mean over N cycles `y`, its standard error `se` from the scatter between cycles, and the
//! simulated curve `s`, both without their means: `gap = (mean (y - s)^2 - mean se^2) / mean y^2`. A gap of 0
//! means that nothing is left to explain. Shares of sectors and orders are those of the squared residual;
//! they locate the disagreement and do not name its cause.
use protocol::case::ChannelRecord;
use record::power;
use record::spectrum::Orders;
use std::ops::RangeInclusive;

/// Number of equal sectors of an abscissa over which a gap is distributed.
pub const SECTORS: usize = 12;

/// Bands of orders of the period over which a gap is distributed.
pub const BANDS: [RangeInclusive<usize>; 4] = [1..=5, 6..=30, 31..=120, 121..=usize::MAX];

/// Disagreement between record and simulation that remains at one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Mean squared residual, in the channel's unit squared.
    pub mse: f64,
    /// Part of the mean squared residual that the scatter between cycles explains, or with one cycle the stated
    /// noise, in the channel's unit squared; 0 where neither is known.
    pub noise: f64,
    /// Mean square of the measured curve about its mean, in the channel's unit squared.
    pub variance: f64,
    /// Share of the channel's squared residual in each of the [`SECTORS`] sectors of the abscissa, in order.
    pub sectors: Vec<f64>,
    /// Share of the channel's squared residual in each of the [`BANDS`].
    pub bands: [f64; BANDS.len()],
}

impl Gap {
    /// Compares a channel's record with a simulated curve on the same abscissa; `None` if their lengths
    /// differ or are zero. `absolute` says whether a constant offset between the two counts as disagreement;
    /// `stated` is the standard deviation of the noise of one value, if it is stated.
    pub fn between(
        (record, stated): (&ChannelRecord, Option<f64>),
        simulated: &[f64],
        absolute: bool,
    ) -> Option<Self> {
        let n = record.mean.len();
        if n == 0 || simulated.len() != n {
            return None;
        }
        let pairs = record.mean.iter().zip(simulated);
        let mut residual: Vec<f64> = pairs
            .map(|(measured, simulated)| measured - simulated)
            .collect();
        let mean = residual.iter().sum::<f64>() / n as f64;
        if !absolute && n > 1 {
            for x in &mut residual {
                *x -= mean;
            }
        }
        let spread = record.spread.iter().map(|x| x * x).sum::<f64>() / n as f64;
        Some(Self {
            mse: power(&residual, absolute),
            noise: if record.cycles > 1 {
                spread / record.cycles as f64
            } else {
                stated.map_or(0.0, |noise| noise * noise)
            },
            variance: power(&record.mean, absolute),
            sectors: sectors(&residual),
            bands: bands(&residual),
        })
    }

    /// Returns the gap of the channel: mean squared residual above the noise, divided by the measured
    /// variance; 0 where the noise explains everything.
    pub fn share(&self) -> f64 {
        (self.mse - self.noise).max(0.0) / self.variance
    }

    /// Returns the ratio of the residual's root mean square to the noise of the record's mean; `None` where
    /// the noise is unknown.
    pub fn over_noise(&self) -> Option<f64> {
        (self.noise > 0.0).then(|| (self.mse / self.noise).sqrt())
    }

    /// Returns the sector with the largest share of the squared residual: its index from 0, and the share.
    pub fn worst_sector(&self) -> (usize, f64) {
        largest(&self.sectors).unwrap_or_default()
    }

    /// Returns the band with the largest share of the squared residual: its orders, and the share.
    pub fn worst_band(&self) -> (RangeInclusive<usize>, f64) {
        let (k, share) = largest(&self.bands).unwrap_or_default();
        (BANDS[k].clone(), share)
    }
}

fn largest(shares: &[f64]) -> Option<(usize, f64)> {
    let by_size = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0));
    shares.iter().copied().enumerate().max_by(by_size)
}

/// Divides values by their sum, in place; sets them to zero where the sum is zero.
fn shares(parts: &mut [f64]) {
    let sum: f64 = parts.iter().sum();
    if sum > 0.0 {
        for part in parts {
            *part /= sum;
        }
    }
}

fn sectors(residual: &[f64]) -> Vec<f64> {
    let mut parts = vec![0.0; SECTORS];
    for (i, r) in residual.iter().enumerate() {
        parts[i * SECTORS / residual.len()] += r * r;
    }
    shares(&mut parts);
    parts
}

/// Returns the share of a residual's power in each of the [`BANDS`]; orders end at half the number of
/// samples.
fn bands(residual: &[f64]) -> [f64; BANDS.len()] {
    let n = residual.len();
    let orders = Orders::new(n, n / 2);
    let mut parts = [0.0; BANDS.len()];
    for order in 1..=orders.highest() {
        // the last order of an even grid has no sine part and counts once
        let weight = if 2 * order == n { 0.5 } else { 1.0 };
        if let Some(k) = BANDS.iter().position(|orders| orders.contains(&order)) {
            parts[k] += weight * orders.coefficient(residual, order).norm_sqr();
        }
    }
    shares(&mut parts);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const N: usize = 720;

    fn wave(order: usize, amplitude: f64) -> Vec<f64> {
        (0..N)
            .map(|i| amplitude * (TAU * (order * i) as f64 / N as f64 + 0.3).sin())
            .collect()
    }

    fn record(mean: Vec<f64>, spread: f64, cycles: usize) -> ChannelRecord {
        ChannelRecord {
            cycles,
            spread: vec![spread; mean.len()],
            mean,
        }
    }

    #[test]
    fn a_perfect_simulation_leaves_no_gap_and_an_offset_is_none() {
        let measured: Vec<f64> = wave(1, 10.0).iter().map(|x| x + 40.0).collect();
        let gap = Gap::between((&record(measured, 0.2, 5), None), &wave(1, 10.0), false).unwrap();
        assert!(gap.share() < 1e-20 && gap.mse < 1e-20);
        assert!((gap.variance - 50.0).abs() < 1e-9);
    }

    #[test]
    fn noise_between_cycles_is_taken_off() {
        // residual of exactly the standard error 0.2 / sqrt 4 = 0.1
        let measured: Vec<f64> = wave(1, 10.0)
            .iter()
            .enumerate()
            .map(|(i, x)| x + if i % 2 == 0 { 0.1 } else { -0.1 })
            .collect();
        let gap = Gap::between((&record(measured, 0.2, 4), None), &wave(1, 10.0), false).unwrap();
        assert!(gap.share() < 1e-12, "{}", gap.share());
        assert!((gap.over_noise().unwrap() - 1.0).abs() < 1e-9);
        assert!((gap.bands[3] - 1.0).abs() < 1e-9, "{:?}", gap.bands);
    }

    #[test]
    fn a_bump_is_found_in_its_sector_and_a_wave_in_its_band() {
        let mut measured = wave(1, 10.0);
        for (i, x) in measured.iter_mut().enumerate() {
            if (2 * 95..2 * 110).contains(&i) {
                *x += 3.0;
            }
        }
        let gap = Gap::between((&record(measured, 0.2, 5), None), &wave(1, 10.0), false).unwrap();
        let (sector, share) = gap.worst_sector();
        assert!(sector == 3 && share > 0.9, "{:?}", gap.sectors);

        let measured: Vec<f64> = wave(1, 10.0)
            .iter()
            .zip(wave(60, 0.5))
            .map(|(a, b)| a + b)
            .collect();
        let gap = Gap::between((&record(measured, 0.2, 5), None), &wave(1, 10.0), false).unwrap();
        assert_eq!(gap.worst_band().0, 31..=120);
        assert!(gap.worst_band().1 > 0.999);
        assert!((gap.share() - (0.125 - 0.008) / 50.0).abs() < 1e-3 * gap.share() + 1e-5);
    }

    #[test]
    fn different_grids_and_one_cycle_are_said() {
        assert!(Gap::between((&record(wave(1, 1.0), 0.0, 5), None), &[1.0], false).is_none());
        let gap =
            Gap::between((&record(wave(1, 1.0), 0.0, 1), None), &wave(2, 1.0), false).unwrap();
        assert!(gap.over_noise().is_none() && gap.share() > 1.0);
        let stated = (&record(wave(1, 1.0), 0.0, 1), Some(0.5));
        let gap = Gap::between(stated, &wave(2, 1.0), false).unwrap();
        assert!((gap.over_noise().unwrap() - 2.0).abs() < 1e-9);
    }
}
