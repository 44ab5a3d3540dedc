//! Derivatives of a run compared with Richardson-extrapolated central differences of whole runs on the same
//! list of steps, whose stages are solved to rounding.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulation::effect::{EffectRequest, Parameter, Role, Selection, catalogue};
use simulation::integrator::method::Method;
use simulation::integrator::stepper::Stages;
use simulation::model::description::{Description, RopeLaw};
use simulation::model::{Machine, RopeMachine};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{Observe, RunSettings, simulate, simulate_on};
use simulation::sensitivity::{
    self, Coefficient, Column, ColumnOrigin, Derivative, DerivativePlan, Unavailable,
};
use simulation::system::{State, System};
use simulation::verdict::Verdict;
use std::f64::consts::LN_10;

/// Observer that records the end times of the steps.
#[derive(Default)]
struct Steps(Vec<f64>);

impl Observe for Steps {
    fn sample(&mut self, _: usize, _: &mut System<RopeMachine<'_>>, _: &State) {}

    fn step(&mut self, _: &mut System<RopeMachine<'_>>, ends: [&State; 2], _: Option<Stages<'_>>) {
        self.0.push(ends[1].t);
    }
}

/// Machine with its own effects, rope law and run settings, whose derivatives are tested.
#[derive(Clone)]
struct Subject {
    description: Description,
    effects: Vec<(String, Vec<(String, f64)>)>,
    law: RopeLaw,
    settings: RunSettings,
}

fn asked(effects: &[(String, Vec<(String, f64)>)]) -> Vec<EffectRequest<'_>> {
    effects
        .iter()
        .map(|(id, values)| EffectRequest {
            id,
            parameters: values.iter().map(|(name, x)| (&**name, *x)).collect(),
        })
        .collect()
}

impl Subject {
    fn machine(&self) -> Machine {
        let selection = Selection::new(&asked(&self.effects)).unwrap();
        Machine::with_effects(self.description.clone(), 2, selection.effects()).unwrap()
    }

    /// Computes the derivatives of a run with respect to the given unknowns, and the end times of its steps;
    /// `None` if the run fails or its stages cannot be solved to rounding.
    fn columns(&self, columns: &[Column]) -> Option<(Vec<Derivative>, Vec<f64>)> {
        let machine = self.machine();
        let effects = asked(&self.effects);
        let origin = ColumnOrigin {
            description: &self.description,
            modes: 2,
            effects: &effects,
        };
        let plan = DerivativePlan::new(&origin, &machine, columns).unwrap();
        let mut steps = Steps::default();
        let (law, settings) = (&self.law, &self.settings);
        sensitivity::simulate(&machine, law, settings, &plan, &mut steps).1?;
        let steps = steps.0;
        let mut none = Steps::default();
        let of = (&machine, law);
        let (_, found) = sensitivity::simulate_on(of, settings, &steps, &plan, &mut none);
        Some((found?.columns, steps))
    }

    /// Returns gauge, height and torque curves of a run on given steps, with the unknown of a derivative
    /// changed by `by`; NaN where contact that closes or opens prevents a stage from being solved to
    /// rounding.
    fn moved(&self, column: &Column, by: f64, steps: &[f64]) -> Vec<f64> {
        let mut own = self.clone();
        match column {
            Column::Coefficient(coefficient) => {
                *coefficient.of(&mut own.law) *= (LN_10 * by).exp();
            }
            Column::Parameter {
                effect,
                parameter,
                values,
            } => {
                let at = own.effects.iter().position(|(id, _)| id == effect);
                let at = at.unwrap_or_else(|| {
                    own.effects.push((effect.clone(), values.clone()));
                    own.effects.len() - 1
                });
                let values = &mut own.effects[at].1;
                match values.iter_mut().find(|(name, _)| name == parameter) {
                    Some((_, value)) => *value += by,
                    None => values.push((parameter.clone(), by)),
                }
            }
        }
        let mut recorder = Recorder::everything(0);
        let machine = own.machine();
        let result = simulate_on(&machine, &own.law, &own.settings, steps, &mut recorder);
        if result.verdict != Verdict::Complete {
            return vec![f64::NAN; 6 * self.settings.samples];
        }
        let [height, ..] = recorder.curves.suspension;
        let height = height.iter().map(|y| y - machine.lowest_suspension);
        let gauges = recorder.curves.gauge.concat().into_iter();
        gauges.chain(height).chain(recorder.curves.torque).collect()
    }

    /// Returns the direction of a one-sided difference with respect to an unknown if its bounds rule out a
    /// central difference with this step; otherwise `None`.
    fn side(&self, column: &Column, step: f64) -> Option<f64> {
        let Column::Parameter {
            effect, parameter, ..
        } = column
        else {
            return None;
        };
        let known = find(effect, parameter);
        let mut own = self.effects.iter().filter(|(id, _)| id == effect);
        let own = own.next().and_then(|(_, values)| {
            let mut values = values.iter();
            values.find(|(name, _)| name == parameter)
        });
        let value = own.map_or(known.absent, |(_, value)| *value);
        match [value - step < known.lower, value + step > known.upper] {
            [true, _] => Some(1.0),
            [_, true] => Some(-1.0),
            [false, false] => None,
        }
    }

    /// Returns the derivative curves by extrapolated differences of whole runs, and the plain differences
    /// with the finer of the two steps.
    fn differenced(&self, column: &Column, step: f64, steps: &[f64]) -> [Vec<f64>; 2] {
        let side = self.side(column, step);
        let step = side.unwrap_or(1.0) * step;
        let run = |by: f64| self.moved(column, by, steps);
        let combine = |terms: &[(f64, f64)]| -> Vec<f64> {
            let mut sum = vec![0.0; 6 * self.settings.samples];
            for (weight, by) in terms {
                for (sum, x) in sum.iter_mut().zip(run(by * step)) {
                    *sum += weight / step * x;
                }
            }
            sum
        };
        let [coarse, fine] = if side.is_some() {
            [
                combine(&[(-1.5, 0.0), (2.0, 1.0), (-0.5, 2.0)]),
                combine(&[(-3.0, 0.0), (4.0, 0.5), (-1.0, 1.0)]),
            ]
        } else {
            [
                combine(&[(0.5, 1.0), (-0.5, -1.0)]),
                combine(&[(1.0, 0.5), (-1.0, -0.5)]),
            ]
        };
        let best = fine
            .iter()
            .zip(&coarse)
            .map(|(fine, coarse)| fine + (fine - coarse) / 3.0)
            .collect();
        [best, fine]
    }
}

fn find(effect: &str, parameter: &str) -> &'static Parameter {
    let descriptor = catalogue().iter().find(|d| d.id == effect).unwrap();
    &descriptor.parameters[descriptor.parameter(parameter).unwrap()]
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Returns the norm of the difference of two derivatives `x` and `y`, relative to the norm of `y`.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    let apart: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
    norm(&apart) / norm(y).max(1e-300)
}

fn fast() -> Subject {
    let mut description = reference::description();
    description.crank.speed *= 3.0;
    description.rope.pitch *= 3.0;
    description.rope.back /= 3;
    description.rope.front /= 3;
    Subject {
        description,
        effects: Vec::new(),
        law: reference::law(),
        settings: RunSettings {
            samples: 72,
            lead_in: 20_f64.to_radians(),
            ramp: 0.3,
            ..RunSettings::default()
        },
    }
}

/// Returns the coarser of the two difference steps for an unknown.
fn step(column: &Column) -> f64 {
    match column {
        Column::Coefficient(_) => 2e-4,
        Column::Parameter {
            effect, parameter, ..
        } => 1e-3 * find(effect, parameter).scale,
    }
}

/// Returns the typical change of an unknown: one decade of a coefficient, the typical value of a parameter.
fn usual(column: &Column) -> f64 {
    match column {
        Column::Coefficient(_) => 1.0,
        Column::Parameter {
            effect, parameter, ..
        } => find(effect, parameter).typical.abs(),
    }
}

/// Summary of the comparison of derivative curves with differences: number of curves above 0.05 `MPa` for a
/// typical change (`of`), number of those that differences resolve well enough to test (`able`), largest
/// deviation, and the list of curves that deviate by more than permitted.
#[derive(Default)]
struct Judged {
    able: usize,
    of: usize,
    /// Number of derivatives compared, including those that correctly have no curves.
    columns: usize,
    worst: f64,
    wrong: Vec<String>,
}

impl Judged {
    /// Fails the test if any derivative is wrong, or if differences could test less than 95 % of the curves.
    fn verdict(&self) {
        let Self {
            able,
            of,
            columns,
            worst,
            wrong,
        } = self;
        println!(
            "{columns} columns; differences can judge {able} of {of}; off by {worst:.1e} at most"
        );
        assert!(wrong.is_empty(), "{wrong:#?}");
        assert!(20 * able >= 19 * of, "{able}/{of}");
    }
}

/// Recorded quantities to compare: unit, range of curve indices, and the factor that scales the curves to a
/// size comparable with megapascals.
const READ: [(&str, std::ops::Range<usize>, f64); 3] =
    [("MPa", 0..4, 1e-6), ("m", 4..5, 10.0), ("kN m", 5..6, 1e-3)];

/// Derivatives that are expected to be unavailable, by effect, parameter and reason; any other unavailable
/// derivative is an error.
const MISSING: &[(&str, &str, Unavailable)] = &[
    // a post that does not yield has no displacement
    ("post_compliance", "compliance", Unavailable::Coordinates),
];

/// Checks a derivative without curves: either a run on the same steps with the unknown changed is identical,
/// or the derivative is listed in [`MISSING`].
fn check_without_curves(
    subject: &Subject,
    steps: &[f64],
    column: &Column,
    found: &Derivative,
    judged: &mut Judged,
) {
    let is_right = match found {
        Derivative::Curves(_) => return,
        Derivative::Zero => {
            let [_, fine] = subject.differenced(column, step(column), steps);
            fine.iter().all(|x| *x == 0.0)
        }
        Derivative::Missing(missing) => {
            matches!(column, Column::Parameter { effect, parameter, .. }
            if MISSING.contains(&(effect, parameter, *missing)))
        }
    };
    println!("{column:?}: {found:?}");
    if !is_right {
        judged.wrong.push(format!("{column:?}: {found:?}"));
    }
}

/// Largest distance of extrapolated and plain differences that can judge a derivative.
const ABLE: f64 = 2e-5;

/// Compares computed derivatives with differences of two step sizes; returns whether the run gave derivatives at
/// all. Where extrapolated and plain differences of the smaller step agree to [`ABLE`], or else those of the larger
/// one, the derivative must agree with them to 1e-4. Where neither do, it must agree to 1e-3 with those that agree
/// better, if a typical change of the unknown moves the curve by more than 0.05. Derivatives without curves are
/// checked, too.
fn compare(subject: &Subject, columns: &[Column], judged: &mut Judged) -> bool {
    let Some((found, steps)) = subject.columns(columns) else {
        return false;
    };
    for (column, found) in columns.iter().zip(found) {
        judged.columns += 1;
        check_without_curves(subject, &steps, column, &found, judged);
        let Derivative::Curves(found) = found else {
            continue;
        };
        let found = [
            found.gauge.concat(),
            found.suspension.clone(),
            found.torque.clone(),
        ];
        let found = found.concat();
        let each =
            [1.0, 0.1].map(|share| subject.differenced(column, share * step(column), &steps));
        for (unit, curves, weight) in READ {
            let of = subject.settings.samples;
            // the first sample lies where two steps meet, whose dense output has no derivative by time there
            let smooth = |x: &[f64]| -> Vec<f64> {
                let own = curves.start * of..curves.end * of;
                let kept = own.filter(|k| k % of > 0);
                kept.map(|k| x[k]).collect()
            };
            let found = smooth(&found);
            let judges = each.each_ref().map(|[best, fine]| {
                let best = smooth(best);
                [distance(&best, &smooth(fine)), distance(&found, &best)]
            });
            // the smaller step first: where contact opens within the larger one, both of its halves can agree on a wrong
            // difference
            let [larger, smaller] = judges;
            let of_both = if larger[0] < smaller[0] {
                larger
            } else {
                smaller
            };
            let [apart, off] = if smaller[0] < ABLE { smaller } else { of_both };
            let size = norm(&found) / (found.len() as f64).sqrt() * weight * usual(column);
            println!("{column:?}: {size:.2e} {unit}, off {off:.1e}, judge {apart:.1e}");
            let able = apart < ABLE;
            if size > 0.05 {
                judged.of += 1;
                judged.able += usize::from(able);
            }
            if able {
                judged.worst = judged.worst.max(off);
            }
            // where contact makes or breaks within the difference its two step sizes differ: such a column is
            // listed, and still may not be far off
            if size > 0.05 && !able {
                println!("not judged to 1e-4: {column:?} {unit}, off {off:.1e}");
            }
            if (able && off >= 1e-4) || (size > 0.05 && off >= 1e-3) {
                let wrong = format!("{column:?} {unit}: {off:e} {apart:e}");
                judged.wrong.push(wrong);
            }
        }
    }
    true
}

/// Returns a random individual within half a decade of the reference in each coefficient.
fn individual(seed: u64) -> Subject {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut subject = fast();
    for coefficient in Coefficient::ALL {
        *coefficient.of(&mut subject.law) *= (LN_10 * random.random_range(-0.5..0.5)).exp();
    }
    subject
}

/// Returns every `stride`-th of the size parameters of all effects, as unknowns to differentiate by.
fn sizes(stride: usize) -> Vec<Column> {
    let sizes = catalogue().iter().flat_map(|d| {
        let sizes = d.parameters.iter().filter(|p| p.role == Role::Size);
        sizes.map(|p| of_absent(&d.id, p.name))
    });
    sizes.step_by(stride).collect()
}

/// Returns a machine with one effect at its typical parameters, and all of these parameters as unknowns to
/// differentiate by.
fn present(id: &str) -> (Subject, Vec<Column>) {
    let descriptor = catalogue().iter().find(|d| d.id == id).unwrap();
    let mut subject = fast();
    let typical = |p: &Parameter| (p.name.to_owned(), p.typical);
    let values = descriptor.parameters.iter().map(typical).collect();
    subject.effects.push((id.to_owned(), values));
    let column = |p: &Parameter| Column::Parameter {
        effect: id.to_owned(),
        parameter: p.name.to_owned(),
        values: Vec::new(),
    };
    let own = descriptor.parameters.iter().filter(|p| !p.whole);
    let own = own.map(column).collect();
    (subject, own)
}

/// Returns a parameter of an absent effect as an unknown to differentiate by.
fn of_absent(effect: &str, parameter: &str) -> Column {
    Column::Parameter {
        effect: effect.to_owned(),
        parameter: parameter.to_owned(),
        values: Vec::new(),
    }
}

/// Coefficients that are differentiated beside the parameters of an effect: the one that laws along the ropes ask
/// for, and one of each other kind, which change what these laws remember.
const BESIDE: [Coefficient; 4] = [
    Coefficient::Kb1,
    Coefficient::Kb23,
    Coefficient::Cb1,
    Coefficient::Kc,
];

/// Checks 64 derivatives against differences, a quick selection of those that
/// `every_column_agrees_with_differences_on_the_same_steps` covers.
#[test]
fn columns_agree_with_differences_on_the_same_steps() {
    let mut judged = Judged::default();
    let coefficients = Coefficient::ALL.map(Column::Coefficient);
    assert!(compare(&individual(1), &coefficients, &mut judged));
    assert!(compare(&fast(), &sizes(9), &mut judged));
    for id in [
        "rope_hysteresis",
        "amplifier_lag",
        "pivot_friction",
        "gauge_gain",
    ] {
        let (subject, mut columns) = present(id);
        columns.extend(BESIDE.map(Column::Coefficient));
        columns.push(of_absent("probe.back_rope.d2", "amplitude"));
        assert!(compare(&subject, &columns, &mut judged), "{id}");
    }
    // beside a law with a memory: another law along the ropes, what changes the strain alone, and a reading that uses
    // the tension
    let beside = [
        of_absent("rope_toe", "strain"),
        of_absent("pivot_friction", "moment"),
        of_absent("crank_speed_ripple", "slip"),
        of_absent("pin_clearance", "step_1"),
    ];
    let (subject, _) = present("rope_hysteresis");
    assert!(compare(&subject, &beside, &mut judged));
    judged.verdict();
}

/// Checks the derivatives of thirty random individuals against differences, with every effect both absent and
/// at its typical size, and with every fifth size beside a present hysteresis of the ropes: `cargo test -p
/// simulation --test numerics -- --ignored --nocapture every_column`.
#[test]
#[ignore = "minutes"]
fn every_column_agrees_with_differences_on_the_same_steps() {
    let mut judged = Judged::default();
    let coefficients = Coefficient::ALL.map(Column::Coefficient);
    let own = |seed: &u64| compare(&individual(*seed), &coefficients, &mut judged);
    let seeds: Vec<_> = (0..60).filter(own).take(30).collect();
    println!("individuals {seeds:?}");
    assert!(compare(&fast(), &sizes(1), &mut judged));
    // beside a law with a memory
    let (subject, _) = present("rope_hysteresis");
    assert!(compare(&subject, &sizes(5), &mut judged));
    for descriptor in catalogue().iter().filter(|d| !d.generic) {
        let (subject, mut columns) = present(&descriptor.id);
        columns.extend(BESIDE.map(Column::Coefficient));
        assert!(
            compare(&subject, &columns, &mut judged),
            "{}",
            descriptor.id
        );
    }
    judged.verdict();
}

/// Checks that the run and its counters equal those of a run without derivatives, and that a derivative has
/// the same bits regardless of which others are computed.
#[test]
fn columns_change_no_bit_of_the_run_nor_of_each_other() {
    let subject = fast();
    let machine = subject.machine();
    let origin = ColumnOrigin {
        description: &subject.description,
        modes: 2,
        effects: &[],
    };
    let mut plain = Recorder::gauges_only();
    let expected = simulate(&machine, &subject.law, &subject.settings, &mut plain);
    let all = [
        Coefficient::ALL.map(Column::Coefficient).to_vec(),
        sizes(11),
    ]
    .concat();
    let found = |columns: &[Column]| {
        let plan = DerivativePlan::new(&origin, &machine, columns).unwrap();
        let mut recorder = Recorder::gauges_only();
        let (law, settings) = (&subject.law, &subject.settings);
        let (result, found) = sensitivity::simulate(&machine, law, settings, &plan, &mut recorder);
        assert_eq!(result, expected);
        assert_eq!(recorder.curves, plain.curves);
        found.unwrap().columns
    };
    let together = found(&all);
    for (k, column) in all.iter().enumerate().step_by(4) {
        assert_eq!(
            found(std::slice::from_ref(column))[0],
            together[k],
            "{column:?}"
        );
    }
    assert_eq!(together[2], Derivative::Zero, "nothing twists in the plane");
    let post = Column::Parameter {
        effect: "post_compliance".to_owned(),
        parameter: "compliance".to_owned(),
        values: Vec::new(),
    };
    let shape = Column::Parameter {
        effect: "pivot_friction".to_owned(),
        parameter: "creep".to_owned(),
        values: Vec::new(),
    };
    let [post, shape] = found(&[post, shape]).try_into().unwrap();
    assert_eq!(post, Derivative::Missing(Unavailable::Coordinates));
    assert_eq!(shape, Derivative::Zero, "the shape of an absent size");
}

/// Checks that a failing run has the same verdict as without derivatives and returns none, and that for a
/// method without stages the derivatives are reported as unavailable.
#[test]
fn a_run_that_fails_has_no_columns() {
    let mut subject = fast();
    subject.settings.budget = 400;
    let machine = subject.machine();
    let origin = ColumnOrigin {
        description: &subject.description,
        modes: 2,
        effects: &[],
    };
    let columns = [Column::Coefficient(Coefficient::Kb1)];
    let plan = DerivativePlan::new(&origin, &machine, &columns).unwrap();
    let run = |settings: &RunSettings| {
        let mut recorder = Recorder::gauges_only();
        sensitivity::simulate(&machine, &subject.law, settings, &plan, &mut recorder)
    };
    let (result, found) = run(&subject.settings);
    let mut recorder = Recorder::gauges_only();
    let plain = simulate(&machine, &subject.law, &subject.settings, &mut recorder);
    assert_eq!((result, found), (plain, None));
    assert_ne!(result.verdict, Verdict::Complete);
    let method = RunSettings {
        method: Method::Rosenbrock,
        ..fast().settings
    };
    let missing = Derivative::Missing(Unavailable::Method);
    assert_eq!(run(&method).1.unwrap().columns, [missing]);
}
