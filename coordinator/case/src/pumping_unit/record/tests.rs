//! Tests of the resampling against known curves: the result is neither smeared nor biased.
use super::{
    resample::{self, Cycles},
    samples::{Samples, whole},
};
use protocol::pumping_unit::Sensor;
use std::path::Path;

/// Builds a record of one gauge with a sample every `step_deg`, from `start_deg` on, over `turns`
/// revolutions, of which only the samples accepted by `keep` remain; `stress` is a function of the unwrapped
/// crank angle.
fn sampled(
    (start_deg, step_deg, turns): (f64, f64, f64),
    keep: impl Fn(usize) -> bool,
    stress: impl Fn(f64) -> f64,
) -> Samples {
    let count = floor((360.0 * turns - start_deg) / step_deg);
    let kept: Vec<usize> = (0..count).filter(|at| keep(*at)).collect();
    let angle_deg: Vec<f64> = kept
        .iter()
        .map(|at| start_deg + *at as f64 * step_deg)
        .collect();
    let last = angle_deg.last().unwrap();
    Samples {
        curves: vec![(
            Sensor::Gauge(1),
            angle_deg.iter().map(|angle| stress(*angle)).collect(),
        )],
        unused: Vec::new(),
        pulses_s: (1..=floor(last / 360.0))
            .map(|turn| turn as f64 * 12.0)
            .collect(),
        angle_deg,
        step_s: 0.01,
        lost: 0,
        step_deg,
    }
}

fn floor(value: f64) -> usize {
    usize::try_from(whole(value)).unwrap()
}

/// Returns the largest absolute difference between the mean cycle and a curve, on the grid of 0.5 deg.
fn worst(cycles: &Cycles, curve: impl Fn(f64) -> f64) -> f64 {
    let differences = cycles.mean[0]
        .iter()
        .enumerate()
        .map(|(at, mean)| (mean.unwrap() - curve(at as f64 * 0.5)).abs());
    differences.fold(0.0, f64::max)
}

/// Returns a sine of the given integer order of the crank revolution.
fn ripple(order: f64) -> impl Fn(f64) -> f64 + Copy {
    move |angle: f64| (order * angle).to_radians().sin()
}

#[test]
fn a_parabola_comes_back_exactly_whatever_is_lost() {
    let curve = |angle: f64| 3.0 - 0.7 * angle + 0.013 * angle * angle;
    let lost = |at: usize| at % 7 != 3 && at % 31 != 5;
    let cycles = resample::cycles(&sampled((0.0, 0.3, 0.9999), lost, curve), 0.5);
    assert_eq!(cycles.whole, [0]);
    // both ends of a lone cycle have samples on one side only
    let inner = cycles.mean[0]
        .iter()
        .enumerate()
        .filter_map(|(at, mean)| Some((at, (*mean)?)));
    let inner: Vec<(usize, f64)> = inner.collect();
    assert!(inner.len() > 700, "{}", inner.len());
    for (at, mean) in inner {
        let expected = curve(at as f64 * 0.5);
        assert!(
            (mean - expected).abs() < 1e-8 * expected.abs().max(1.0),
            "{at}: {mean} {expected}"
        );
    }
}

#[test]
fn a_ripple_of_the_rope_is_not_smeared() {
    for (order, loss) in [(60.0, 0.002), (80.0, 0.005)] {
        let curve = ripple(order);
        let cycles = resample::cycles(&sampled((0.13, 0.3, 6.1), |_| true, curve), 0.5);
        // the first cycle lacks angle 0 by 0.13 deg, which its neighbours support
        assert!(cycles.whole.len() >= 5);
        let projection: f64 = cycles.mean[0]
            .iter()
            .enumerate()
            .map(|(at, mean)| mean.unwrap() * curve(at as f64 * 0.5))
            .sum();
        let kept = projection * 2.0 / 720.0;
        assert!(
            (1.0 - loss..1.0 + 1e-3).contains(&kept),
            "order {order}: {kept}"
        );
        assert!(
            worst(&cycles, curve) < 2.0 * loss,
            "order {order}: {}",
            worst(&cycles, curve)
        );
    }
}

#[test]
fn orders_above_the_grid_do_not_alias() {
    // 0.02 deg between samples: order 700 is well sampled, and would alias to order 20
    let cycles = resample::cycles(&sampled((0.0, 0.02, 3.01), |_| true, ripple(700.0)), 0.5);
    let alias: f64 = cycles.mean[0]
        .iter()
        .enumerate()
        .map(|(at, mean)| mean.unwrap() * ripple(20.0)(at as f64 * 0.5))
        .sum();
    assert!(
        (alias * 2.0 / 720.0).abs() < 0.25,
        "{}",
        alias * 2.0 / 720.0
    );
}

#[test]
fn lost_samples_do_not_bias() {
    let curve = ripple(3.0);
    let all = resample::cycles(&sampled((0.07, 0.3, 5.1), |_| true, curve), 0.5);
    let some = resample::cycles(&sampled((0.07, 0.3, 5.1), |at| at % 11 != 0, curve), 0.5);
    assert_eq!(all.whole, some.whole);
    assert!(worst(&some, curve) < 1e-4, "{}", worst(&some, curve));
}

#[test]
fn a_burst_leaves_its_angles_to_the_other_cycles() {
    // cycle 1 lacks 25 deg, and is off by 1 MPa
    let stress = |angle: f64| {
        ripple(2.0)(angle)
            + if (360.0..720.0).contains(&angle) {
                1.0
            } else {
                0.0
            }
    };
    let kept = |at: usize| !(1500..1583).contains(&at);
    let samples = sampled((0.0, 0.3, 4.001), kept, stress);
    let missing = (1500.0 * 0.3 - 360.0, 1583.0 * 0.3 - 360.0);
    let cycles = resample::cycles(&samples, 0.5);
    assert_eq!(cycles.whole, [0, 1, 2, 3]);
    let inside = floor(missing.0 + missing.1) & !1;
    let mean = cycles.mean[0][inside].unwrap();
    let expected = ripple(2.0)(inside as f64 * 0.5);
    assert!(
        (mean - expected).abs() < 1e-3,
        "only the other cycles count: {mean} {expected}"
    );
    assert!(cycles.spread[0][inside] < 1e-3);
    // elsewhere one cycle of four is 1 MPa higher: mean + 0.25, standard deviation 0.5
    assert!((cycles.mean[0][100].unwrap() - ripple(2.0)(50.0) - 0.25).abs() < 1e-3);
    assert!(
        (cycles.spread[0][100] - 0.5).abs() < 1e-3,
        "{}",
        cycles.spread[0][100]
    );
    assert!(
        (45..55).contains(&cycles.gaps),
        "{} of the grid",
        cycles.gaps
    );
}

#[test]
fn noise_is_averaged() {
    // a fixed sequence that no period of the record repeats
    let mut state = 12345_u64;
    let samples = sampled((0.0, 0.3, 8.001), |_| true, |_| 0.0);
    let noisy = Samples {
        curves: vec![(
            Sensor::Gauge(1),
            samples
                .angle_deg
                .iter()
                .map(|_| {
                    state = state
                        .wrapping_mul(6364136223846793005)
                        .wrapping_add(1442695040888963407);
                    (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
                })
                .collect(),
        )],
        ..samples
    };
    let cycles = resample::cycles(&noisy, 0.5);
    let squares: f64 = cycles.mean[0]
        .iter()
        .map(|mean| mean.unwrap().powi(2))
        .sum();
    let single = (1.0 / 12.0_f64).sqrt();
    let ours = (squares / 720.0).sqrt() * (8.0_f64).sqrt() / single;
    println!("noise {ours}");
    // linear interpolation between two samples keeps 0.82 of the noise; so do we, at least
    assert!((0.4..0.82).contains(&ours), "{ours}");
}

/// Builds a CSV table with the given columns, in which every gauge and sensor varies.
fn table(columns: &[&str]) -> String {
    let row = |at: usize| {
        let angle = 0.5 * at as f64 % 360.0;
        let of = |name: &&str| match *name {
            "time_s" => format!("{}", 0.01 * at as f64),
            "crank_deg" => format!("{angle}"),
            _ => format!("{}", 30.0 + angle.to_radians().sin()),
        };
        columns.iter().map(of).collect::<Vec<_>>().join(",")
    };
    let rows = (0..2000).map(row);
    std::iter::once(columns.join(","))
        .chain(rows)
        .collect::<Vec<_>>()
        .join("\n")
}

/// Checks that any subset of the gauges is accepted, that position and torque are optional, and that a record
/// without a gauge is rejected.
#[test]
fn any_gauges_make_a_record() {
    let read = |columns: &[&str]| Samples::read(Path::new("test.csv"), table(columns).as_bytes());
    let two = read(&["time_s", "stress_3_mpa", "crank_deg", "stress_1_mpa"]).unwrap();
    let cycles = resample::cycles(&two, 0.5);
    assert_eq!(cycles.channels, [Sensor::Gauge(1), Sensor::Gauge(3)]);
    assert_eq!((cycles.mean.len(), cycles.single[0].len()), (2, 2));
    let one = read(&["time_s", "crank_deg", "stress_4_mpa", "crank_torque_nm"]).unwrap();
    let cycles = resample::cycles(&one, 0.5);
    assert_eq!(cycles.channels, [Sensor::Gauge(4), Sensor::Torque]);
    assert_eq!((cycles.mean.len(), cycles.single[0].len()), (2, 2));
    let none = read(&["time_s", "crank_deg", "crank_torque_nm"]).unwrap_err();
    assert!(none.to_string().contains("stress_1_mpa"), "{none}");
}
