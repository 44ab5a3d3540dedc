//! Tests of records without a period, compared by sample: noise is white in their metric, its maps are empty,
//! and a bump is located correctly.
use crate::trial::{say, trials};
use discrepancy::linear::score::misfit_tail;
use discrepancy::linear::tangent::Tangent;
use discrepancy::localisation::residual::Residual;
use discrepancy::localisation::{order, whiteness, window_test};
use nalgebra::{DMatrix, DVector};
use protocol::case::{Abscissa, Channel, Offset};
use record::basis::ChannelGroup;
use record::metric::Metric;
use record::noise::{Noise, NoiseSource};
use record::{Curves, Record, Recorded, Stated};
use search::least_squares::Linearized;
use search::random::{Phase, Stream, Streams};

/// Number of samples per channel in each test record.
pub(crate) const SAMPLES: usize = 300;
/// Correlation length of the noise of each channel (s); `SIZES` holds its standard deviations.
const LENGTHS: [f64; 2] = [0.05, 0.02];
pub(crate) const SIZES: [f64; 2] = [0.03, 0.2];
/// Weight of the random component that the noise of both channels shares.
const COMMON: f64 = 0.6;

/// Returns the sampling times (s), with unequal steps and a start other than zero.
pub(crate) fn times() -> Vec<f64> {
    let step = |k: usize| 0.01 * (1.0 + 0.4 * (0.3 * k as f64).sin());
    let next = |t: &mut f64, k: usize| {
        *t += step(k);
        Some(*t)
    };
    (0..SAMPLES).scan(1.0, next).collect()
}

fn channel(curve: usize, noise: Option<f64>) -> Recorded {
    Recorded {
        rows: None,
        correlation: None,
        model_error: None,
        curve,
        scored: true,
        held_out: false,
        channel: Channel {
            limit: None,
            name: format!("channel_{curve}"),
            title: format!("channel {curve}"),
            unit: "1".to_owned(),
            condition: 0,
            abscissa: Abscissa {
                name: "time".to_owned(),
                unit: "s".to_owned(),
                points: times(),
                period: None,
            },
            noise,
            step: None,
            weights: Vec::new(),
            offset: Offset::Free,
            record: None,
        },
    }
}

/// Draws noise of two channels, correlated along each and between them, with unknown offsets.
fn noise(stream: &mut Stream) -> Curves {
    let times = times();
    let mut state = [0.0; 2];
    let mut curves: Curves = vec![Vec::new(); 2];
    let zeros = [3.0 * stream.normal(), 3.0 * stream.normal()];
    for (k, t) in times.iter().enumerate() {
        let gap = if k == 0 {
            f64::INFINITY
        } else {
            t - times[k - 1]
        };
        let shared = stream.normal();
        for c in 0..2 {
            let rho = (-gap / LENGTHS[c]).exp();
            let fresh = COMMON * shared + (1.0 - COMMON * COMMON).sqrt() * stream.normal();
            state[c] = rho * state[c] + (1.0 - rho * rho).sqrt() * fresh;
            curves[c].push(zeros[c] + SIZES[c] * state[c]);
        }
    }
    curves
}

/// Creates a record of noisy cycles about the curves `clean`.
pub(crate) fn record(seed: u64, cycles: usize, clean: &Curves, stated: bool) -> Record {
    let mut stream = Streams::new(seed, 21).at(0, Phase::Initial, 0);
    let mut cycle = || {
        let mut noisy = noise(&mut stream);
        for (y, clean) in noisy.iter_mut().flatten().zip(clean.iter().flatten()) {
            *y += clean;
        }
        noisy
    };
    let step = (times()[SAMPLES - 1] - times()[0]) / (SAMPLES - 1) as f64;
    Record {
        condition: 0,
        channels: (0..2)
            .map(|c| Recorded {
                correlation: stated.then(|| (-step / LENGTHS[0]).exp()),
                ..channel(c, stated.then_some(SIZES[c]))
            })
            .collect(),
        cycles: (0..cycles).map(|_| cycle()).collect(),
        held_out: false,
        stated: Stated::default(),
    }
}

fn zero() -> Curves {
    vec![vec![0.0; SAMPLES]; 2]
}

/// Returns, for a test record, the metric of its own noise, the degrees of freedom of the noise variances,
/// and the whitened mean.
fn whitened(record: &Record) -> (Metric, f64, DVector<f64>) {
    let groups = ChannelGroup::of(record, 120, &[]);
    let noise = Noise::estimate(record, &groups, &[]);
    let metric = Metric::new(&groups, &noise);
    let mean = metric.whiten(&record.mean());
    let freedom = metric.freedom();
    (metric, freedom, mean)
}

/// Returns the tangent space of a fit without unknowns.
fn nothing(entries: usize) -> Tangent {
    let at = Linearized {
        x: Vec::new(),
        residual: DVector::zeros(entries),
        jacobian: DMatrix::zeros(entries, 0),
    };
    Tangent::new(&at, &[])
}

/// Checks that the whitened entries of noise have variance 1 and are uncorrelated along a channel and between
/// channels.
#[test]
fn entries_of_noise_are_white() {
    let (mut square, mut along, mut across, mut count) = (0.0, 0.0, 0.0, 0.0);
    for seed in 0..40 {
        let (metric, _, z) = whitened(&record(seed, 5, &zero(), false));
        assert_eq!(metric.len(), 2 * (SAMPLES - 1));
        // place by place, both channels
        let rows = z.as_slice();
        square += z.norm_squared();
        along += rows.iter().zip(&rows[2..]).map(|(a, b)| a * b).sum::<f64>();
        across += rows.chunks(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
        count += z.len() as f64;
    }
    let (variance, along, across) = (square / count, along / square, 2.0 * across / square);
    say(&format!(
        "by sample: variance {variance:.3}, correlation {along:.3} along and {across:.3} across"
    ));
    assert!((variance - 1.0).abs() < 0.05, "{variance}");
    assert!(
        along.abs() < 0.03 && across.abs() < 0.05,
        "{along} {across}"
    );
}

/// Checks that maps along the abscissa, the test of whiteness and the misfit test reject noise at their
/// levels, with cycles enough for sign flips and with fewer.
#[test]
fn noise_is_rejected_as_often_as_is_said() {
    for cycles in [3, 6] {
        let sets = trials(80);
        let (mut windows, mut coloured, mut long) = (0, 0, 0);
        for seed in 0..sets {
            let own = record(1000 + seed, cycles, &zero(), false);
            let (metric, freedom, z) = whitened(&own);
            let tangent = nothing(z.len());
            let residual = Residual {
                values: &z,
                metric: &metric,
                tangent: &tangent,
            };
            let each = own.cycles.iter();
            let deviations: Vec<DVector<f64>> =
                each.map(|cycle| metric.whiten(cycle) - &z).collect();
            let map = window_test::map(&residual, &deviations, 100, 0.05);
            windows += usize::from(!map.windows.is_empty());
            coloured += usize::from(whiteness::p_value(&order::powers(&residual), freedom) < 0.05);
            let behind = z.len() as f64 * (cycles as f64 - 1.0);
            let tail = misfit_tail(z.norm_squared(), z.len(), 0.0, behind);
            long += usize::from(tail < 0.05);
        }
        let share = |count: usize| 100.0 * count as f64 / sets as f64;
        let said = format!(
            "by sample, {cycles} cycles: windows {:.1} %, not white {:.1} %, misfit {:.1} %",
            share(windows),
            share(coloured),
            share(long)
        );
        say(&said);
        for found in [windows, coloured, long] {
            assert!((0.5..=10.0).contains(&share(found)), "{said}");
        }
    }
}

/// Checks that noise of a single cycle is taken as stated, with a whitened variance of 1, or is marked as
/// guessed.
#[test]
fn noise_of_one_cycle_is_as_stated_or_guessed() {
    let ratio = |stated: bool| {
        let sets = 20;
        let each = (0..sets).map(|seed| {
            let own = record(3000 + seed, 1, &zero(), stated);
            let groups = ChannelGroup::of(&own, 120, &[]);
            let known = Noise::estimate(&own, &groups, &[]).known;
            assert_eq!(
                known,
                if stated {
                    NoiseSource::Stated
                } else {
                    NoiseSource::Estimated
                }
            );
            let (metric, _, z) = whitened(&own);
            // the first channel, whose correlation is the one that is stated
            z.iter().step_by(2).map(|e| e * e).sum::<f64>() / (metric.len() / 2) as f64
        });
        each.sum::<f64>() / sets as f64
    };
    assert!((ratio(true) - 1.0).abs() < 0.1, "{}", ratio(true));
}

/// Checks that a bump in one channel is located in the abscissa's own unit, and that the map of orders is
/// empty.
#[test]
fn a_bump_is_found_where_it_is() {
    let mut clean = zero();
    for (t, y) in times().iter().zip(&mut clean[1]) {
        *y = 0.5 * (-((t - 2.5) / 0.05).powi(2)).exp();
    }
    let own = record(7, 6, &clean, false);
    let (metric, freedom, z) = whitened(&own);
    let tangent = nothing(z.len());
    let residual = Residual {
        values: &z,
        metric: &metric,
        tangent: &tangent,
    };
    let each = own.cycles.iter();
    let deviations: Vec<DVector<f64>> = each.map(|cycle| metric.whiten(cycle) - &z).collect();
    let map = window_test::map(&residual, &deviations, 200, 0.05);
    let orders = order::map(&residual, freedom, 0.05);
    assert!(orders.ratio.iter().all(Vec::is_empty) && orders.peaks.is_empty());
    let first = map.windows.first().expect("a window");
    assert_eq!(first.channel, 1);
    assert!(first.from < 2.5 + 0.1 && first.to > 2.5 - 0.1, "{first:?}");
    assert!(first.to - first.from < 1.0 && first.from > 2.0, "{first:?}");
}
