//! Acceptance tests of `identify` on models whose likelihood is known in closed form: which unknowns a record
//! determines, and the coverage of the intervals and bands.
use crate::by_curves::ByCurves;
use crate::trial::{now, say};
use discrepancy::diagnose::Inputs;
use discrepancy::identify::{
    Determination, IdentificationResult, IntervalEnd, UnknownEstimate, identify,
};
use discrepancy::linear::whitened::WhitenedRecord;
use discrepancy::thresholds::Thresholds;
use nalgebra::{DMatrix, DVector};
use protocol::case::{Abscissa, Channel, Offset, Scale, Unknown};
use protocol::job::{Numerics, SimulateSpec};
use record::noise::student;
use record::{Curves, Record, Recorded, Stated};
use search::random::{Phase, Streams};
use search::space::Space;

const SAMPLES: usize = 180;
const NOISE: f64 = 0.5;
const CYCLES: usize = 10;

/// Returns two channels over a turn, as sums of sines weighted by six unknowns; `None` (failed simulation)
/// where the fourth unknown exceeds ten times its start.
///
/// Unknowns 1 and 2 act on the first channel with nearly collinear shapes; unknown 3 acts on both channels;
/// unknown 4 acts on neither; unknown 5 matters only while small, unknown 6 only while large.
fn curves(x: &[f64]) -> Option<Curves> {
    if x[3] > 10.0 {
        return None;
    }
    let at = |k: usize| {
        let t = std::f64::consts::TAU * k as f64 / SAMPLES as f64;
        let alike = (3.0 * t).sin() + 0.2 * (4.0 * t).cos();
        let soft = 1.0 / (1.0 + x[4]);
        let heavy = x[5] / (1.0 + x[5]);
        let first = x[0] * (3.0 * t).sin() + x[1] * alike + x[2] * (2.0 * t).cos();
        (
            first + 30.0 * soft * (6.0 * t).sin() + 30.0 * heavy * (7.0 * t).cos(),
            2.0 * x[2] * t.sin() + x[1] * (5.0 * t).cos(),
        )
    };
    let (first, second) = (0..SAMPLES).map(at).unzip();
    Some(vec![first, second])
}

fn channel(name: &str, condition: usize) -> Channel {
    let point = |k: usize| 360.0 * k as f64 / SAMPLES as f64;
    Channel {
        limit: None,
        name: name.to_owned(),
        title: name.to_owned(),
        unit: "N".to_owned(),
        condition,
        abscissa: Abscissa {
            name: "crank angle".to_owned(),
            unit: "deg".to_owned(),
            points: (0..SAMPLES).map(point).collect(),
            period: Some(360.0),
        },
        noise: None,
        step: None,
        weights: Vec::new(),
        offset: Offset::Free,
        record: None,
    }
}

fn unknowns() -> Vec<Unknown> {
    let linear = |name: &str| Unknown::new(name, "N", Scale::Linear, 0.0, [-20.0, 20.0]);
    let factor = |name: &str, start: f64| {
        let bounds = [1e-4 * start, 1e4 * start];
        Unknown::new(name, "N/m", Scale::Logarithmic, start, bounds)
    };
    vec![
        linear("first"),
        linear("alike"),
        linear("both"),
        factor("blind", 1.0),
        factor("stiff", 1e2),
        factor("light", 1e-2),
    ]
}

/// Returns a noisy record of the first channel under the first condition.
fn record(seed: u64, truth: &[f64]) -> Record {
    let mut stream = Streams::new(seed, 33).at(0, Phase::Initial, 0);
    let clean = &curves(truth).expect("it runs")[0];
    let mut cycle = || vec![clean.iter().map(|y| y + NOISE * stream.normal()).collect()];
    Record {
        condition: 0,
        channels: vec![Recorded {
            scored: true,
            ..Recorded::new(0, &channel("first", 0))
        }],
        cycles: (0..CYCLES).map(|_| cycle()).collect(),
        held_out: false,
        stated: Stated::default(),
    }
}

fn conditions() -> Vec<Vec<Channel>> {
    [0, 1]
        .map(|condition| vec![channel("first", condition), channel("second", condition)])
        .to_vec()
}

const TRUTH: [f64; 6] = [3.0, -2.0, 1.0, 1.0, 3e4, 3e-6];

fn seen(seed: u64, unknowns: Vec<Unknown>) -> IdentificationResult {
    let space = Space::new(&unknowns).expect("ordered");
    let inputs = Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: false,
        start: Some(vec![0.0; space.dimension()]),
        families: None,
        space,
        unknowns,
        records: vec![record(seed, &TRUTH)],
        library: Vec::new(),
        usual: Numerics::FROM_CASE,
        finer: Vec::new(),
        global_search: "least-squares",
        seed: 1,
        thresholds: Thresholds::default(),
    };
    let mut waves = ByCurves(|spec| curves(&spec.individual.genes));
    now(identify(&mut waves, &inputs, &conditions())).expect("it fits")
}

fn named<'a>(all: &'a IdentificationResult, name: &str) -> &'a UnknownEstimate {
    all.unknowns
        .iter()
        .find(|own| own.name == name)
        .expect("an unknown")
}

/// Checks that linear unknowns have the interval of the closed form, that an unknown without influence is
/// reported as not seen and its profile ends where the model fails, and that an unknown that matters on one
/// side only has one finite end.
#[test]
fn intervals_are_those_of_the_closed_form() {
    let all = seen(5, unknowns());
    let on = WhitenedRecord::under_own_noise(record(5, &TRUTH), 120, Numerics::FROM_CASE);
    let column = |k: usize| {
        let mut x = TRUTH;
        let base = on
            .metric
            .whiten(&vec![curves(&x).expect("it runs").remove(0)]);
        x[k] += 1.0;
        on.metric
            .whiten(&vec![curves(&x).expect("it runs").remove(0)])
            - base
    };
    let columns: Vec<DVector<f64>> = (0..3).map(column).collect();
    let jacobian = DMatrix::from_columns(&columns);
    let covariance = jacobian.tr_mul(&jacobian).try_inverse().expect("regular");
    assert!(all.is_noise, "{}", all.left);
    for (k, name) in ["first", "alike", "both"].into_iter().enumerate() {
        let own = named(&all, name);
        assert_eq!(own.seen, Determination::Both, "{own:?}");
        let [low, high] = own.interval.map(|end| end.expect("an end"));
        let freedom = (on.metric.len() as f64 - 5.0).max(1.0);
        let dispersion = (all.left * on.metric.len() as f64 / freedom).max(1.0);
        let quantile = student(on.metric.freedom_of_intervals());
        let half = quantile * (dispersion * covariance[(k, k)]).sqrt();
        let width = 0.5 * (high - low);
        assert!((width / half - 1.0).abs() < 0.03, "{name}: {width} {half}");
        assert!((own.value - f64::midpoint(low, high)).abs() < 0.03 * half);
        assert!((own.value - TRUTH[k]).abs() < 4.0 * half, "{own:?}");
    }
    let trade = &named(&all, "first").correlated;
    let expected = covariance[(0, 1)] / (covariance[(0, 0)] * covariance[(1, 1)]).sqrt();
    assert_eq!(trade[0].0, "alike");
    assert!((trade[0].1 - expected).abs() < 0.01, "{trade:?} {expected}");
    let blind = named(&all, "blind");
    assert_eq!(
        (blind.seen, blind.interval),
        (Determination::NotSeen, [None; 2])
    );
    assert_eq!(blind.ends, [IntervalEnd::Bound, IntervalEnd::Fails]);
    let stiff = named(&all, "stiff");
    assert_eq!(stiff.seen, Determination::LowerBound, "{stiff:?}");
    // where 30 N / (1 + x) is some standard errors of a sine's amplitude, 0.5 N / sqrt(900)
    let least = stiff.interval[0].expect("an end");
    assert!((300.0..TRUTH[4]).contains(&least), "{stiff:?}");
    let light = named(&all, "light");
    assert_eq!(light.seen, Determination::UpperBound, "{light:?}");
    let last = all.directions.last().expect("six");
    assert!(last.words.contains("not determined"), "{last:?}");
}

/// Checks that prediction bands cover the true curves of unmeasured channels and conditions at their nominal
/// rate, and are narrow where the record determines all unknowns that matter.
#[test]
fn bands_hold_what_was_not_measured() {
    let truth = curves(&TRUTH).expect("it runs");
    let sets = 10;
    let mut inside = 0;
    for seed in 0..sets {
        let all = seen(60 + seed, unknowns());
        assert_eq!(all.bands.len(), 2);
        for band in &all.bands {
            for (channel, truth) in band.channels.iter().zip(&truth) {
                let ends = channel.low.iter().zip(&channel.high).zip(truth);
                inside += ends
                    .filter(|((low, high), y)| (**low..=**high).contains(y))
                    .count();
            }
            // an amplitude is known to 1.96 * 0.5 / sqrt(10 * 180 / 2) = 0.03
            let width = band.channels[0].half_width();
            assert!(width < 0.2, "{width}");
        }
        let second = all
            .further
            .iter()
            .find(|one| one.measurement.starts_with("second"));
        let pins = &second.expect("it tells").pins;
        assert!(pins.iter().any(|pin| pin.name == "alike"), "{pins:?}");
    }
    let share = inside as f64 / (sets as usize * 4 * SAMPLES) as f64;
    say(&format!(
        "identify: bands hold {:.1} % of the truth",
        100.0 * share
    ));
    assert!((0.9..=1.0).contains(&share), "{share}");
}

/// Checks that a prior stated in the case gives an interval to an unknown that the record does not determine.
#[test]
fn what_is_known_beforehand_counts() {
    let mut unknowns = unknowns();
    unknowns[3].prior = Some(protocol::case::Prior {
        value: 2.0,
        deviation: 0.2,
    });
    let all = seen(7, unknowns);
    let blind = named(&all, "blind");
    assert_eq!(blind.seen, Determination::Both, "{blind:?}");
    let [low, high] = blind.interval.map(|end| end.expect("an end"));
    // the quantile is that of the noise, an order of which ten cycles tell
    let factor = 10_f64.powf(student(18.0) * 0.2);
    assert!((blind.value - 2.0).abs() < 0.05, "{blind:?}");
    assert!((low * factor / 2.0 - 1.0).abs() < 0.1 && (high / factor / 2.0 - 1.0).abs() < 0.1);
}

/// Checks that 95 % intervals cover the truth in 90 to 99 % of the cases.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    let sets = 40;
    let mut held = 0;
    for seed in 0..sets {
        let all = seen(100 + seed, unknowns());
        for (k, name) in ["first", "alike", "both"].into_iter().enumerate() {
            let [low, high] = named(&all, name).interval.map(|end| end.expect("an end"));
            held += usize::from((low..=high).contains(&TRUTH[k]));
        }
    }
    let share = held as f64 / (3 * sets) as f64;
    say(&format!(
        "identify: {held} of {} intervals hold the truth",
        3 * sets
    ));
    assert!((0.9..=0.99).contains(&share), "{share}");
}

/// Number of abscissa points of the straight line, a single log without a period.
const PLACES: usize = 60;
/// True constant and slope of the straight line.
const LINE: [f64; 2] = [1.0, -0.7];

fn places() -> Vec<f64> {
    (0..PLACES).map(|k| 0.1 * k as f64).collect()
}

fn line(spec: &SimulateSpec) -> Curves {
    let x = &spec.individual.genes;
    let line = places().into_iter().map(|t| x[0] + x[1] * t);
    vec![line.collect()]
}

/// Identifies a straight line from one log with AR(1) noise of the given correlation and stated noise;
/// returns the result and the half-widths of the textbook's least-squares intervals.
fn of_line(seed: u64, correlation: f64, stated: Option<f64>) -> (IdentificationResult, [f64; 2]) {
    let mut stream = Streams::new(seed, 34).at(0, Phase::Initial, 0);
    let mut noise = stream.normal();
    let mut next = || {
        noise = correlation * noise + (1.0 - correlation * correlation).sqrt() * stream.normal();
        noise
    };
    let measured: Vec<f64> = places()
        .iter()
        .map(|t| LINE[0] + LINE[1] * t + NOISE * next())
        .collect();
    let mut own = channel("line", 0);
    own.abscissa.points = places();
    own.abscissa.period = None;
    own.offset = Offset::Fixed;
    own.noise = stated;
    let recorded = Recorded {
        scored: true,
        ..Recorded::new(0, &own)
    };
    let unknowns = ["constant", "slope"]
        .map(|name| Unknown::new(name, "N", Scale::Linear, 0.0, [-20.0, 20.0]))
        .to_vec();
    let inputs = Inputs {
        conditions: Vec::new(),
        differentiates: true,
        differences: false,
        start: Some(vec![0.0; 2]),
        families: None,
        space: Space::new(&unknowns).expect("ordered"),
        unknowns,
        records: vec![Record {
            condition: 0,
            channels: vec![recorded],
            cycles: vec![vec![measured.clone()]],
            held_out: false,
            stated: Stated::default(),
        }],
        library: Vec::new(),
        usual: Numerics::FROM_CASE,
        finer: Vec::new(),
        global_search: "least-squares",
        seed: 1,
        thresholds: Thresholds::default(),
    };
    let all = now(identify(
        &mut ByCurves(|spec| Some(line(spec))),
        &inputs,
        &[vec![own]],
    ))
    .expect("it fits");
    let x = DMatrix::from_fn(PLACES, 2, |i, k| if k == 0 { 1.0 } else { places()[i] });
    let y = DVector::from_vec(measured);
    let inverse = x.tr_mul(&x).try_inverse().expect("regular");
    let left = &y - &x * (&inverse * x.tr_mul(&y));
    let freedom = (PLACES - 2) as f64;
    let variance = left.norm_squared() / freedom;
    let half = [0, 1].map(|k| student(freedom) * (variance * inverse[(k, k)]).sqrt());
    (all, half)
}

/// Returns, for constant and slope of the straight line, the half-width of the interval and whether the
/// interval contains the true value.
fn ends_of_line(all: &IdentificationResult) -> [(f64, bool); 2] {
    let of = |k: usize| {
        let own = named(all, ["constant", "slope"][k]);
        let [low, high] = own.interval.map(|end| end.expect("an end"));
        (0.5 * (high - low), (low..=high).contains(&LINE[k]))
    };
    [of(0), of(1)]
}

/// Checks that the intervals of a linear model with white residuals equal those of textbook least squares,
/// whether the noise is not stated or stated at a fifth of its true size, and that they cover the truth at
/// their nominal rate.
#[test]
fn intervals_of_white_residuals_are_the_textbooks() {
    let sets = 200;
    for stated in [None, Some(0.2 * NOISE)] {
        let (mut held, mut alike) = (0, 0);
        for seed in 0..sets {
            let (all, half) = of_line(200 + seed, 0.0, stated);
            for ((own, holds), half) in ends_of_line(&all).into_iter().zip(half) {
                held += usize::from(holds);
                alike += usize::from((own / half - 1.0).abs() < 0.01);
            }
        }
        say(&format!(
            "a line, noise {stated:?}: {alike} intervals are the textbook's, {held} hold the truth of {}",
            2 * sets
        ));
        let share = held as f64 / (2 * sets) as f64;
        assert!((0.92..=0.98).contains(&share), "{share}");
        // one white residual in a hundred looks coloured, and is taken for that
        assert!(alike as f64 >= 0.97 * (2 * sets) as f64, "{alike}");
    }
}

/// Checks that intervals widen where the residual is coloured (autocorrelated), and that a note says so; the
/// textbook's intervals would cover the truth half the time.
#[test]
fn intervals_of_coloured_residuals_grow_by_what_the_colour_costs() {
    let sets = 100;
    let (mut held, mut by_the_book, mut said) = (0, 0, 0);
    for seed in 0..sets {
        let (all, half) = of_line(500 + seed, 0.7, Some(NOISE));
        said += usize::from(all.notes.iter().any(|note| note.contains("not white")));
        for (k, (_, holds)) in ends_of_line(&all).into_iter().enumerate() {
            held += usize::from(holds);
            let value = named(&all, ["constant", "slope"][k]).value;
            by_the_book += usize::from((value - LINE[k]).abs() <= half[k]);
        }
    }
    say(&format!(
        "a line with coloured noise: {held} of {} intervals hold the truth, {by_the_book} by the textbook; {said} of \
         {sets} say so",
        2 * sets
    ));
    assert!(said >= 80, "{said}");
    assert!(held as f64 >= 0.75 * (2 * sets) as f64, "{held}");
    assert!(3 * held >= 4 * by_the_book, "{held} {by_the_book}");
}
