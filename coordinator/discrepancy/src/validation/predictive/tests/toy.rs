//! Decisions on a linear model that is a little wrong: how often something is named where nothing is there, and
//! how often rightly where an effect is.
//!
//! A record of 300 samples is the mean of six cycles with unit noise, explained by ten unknowns with unit
//! priors; 25 candidate effects are compared. Another condition has another Jacobian, which resembles the first,
//! and a model error of the same size.
use super::*;
use crate::linear::discrepancy::{Discrepancy, SmoothBasis, Wave};
use crate::linear::evidence::log_evidence;
use crate::linear::waves::curves;
use protocol::case::Abscissa;
use search::random::{Phase, Stream, Streams};

const SAMPLES: usize = 300;
const UNKNOWNS: usize = 10;
const CANDIDATES: usize = 25;

/// Row of the table: what is in the records.
#[derive(Clone, Copy)]
struct Row {
    /// Standard deviation of the model error, in standard deviations of the mean's noise.
    error: f64,
    /// Correlation of the model errors of the two conditions.
    correlation: f64,
    /// Significance of the hidden effect (standard deviations), 0 for none.
    effect: f64,
}

/// Lower Cholesky factor of a squared-exponential covariance over the samples.
fn root(length: f64) -> DMatrix<f64> {
    let kernel = DMatrix::from_fn(SAMPLES, SAMPLES, |i, j| {
        let apart = (i as f64 - j as f64) / length;
        let jitter = if i == j { 1e-8 } else { 0.0 };
        libm::exp(-0.5 * apart * apart) + jitter
    });
    kernel.cholesky().expect("positive definite").unpack()
}

fn smooth(root: &DMatrix<f64>, columns: usize, stream: &mut Stream) -> DMatrix<f64> {
    root * DMatrix::from_fn(SAMPLES, columns, |_, _| stream.normal())
}

fn waves() -> SmoothBasis {
    let abscissa = Abscissa {
        name: "time".to_owned(),
        unit: "s".to_owned(),
        points: (0..SAMPLES).map(|i| i as f64).collect(),
        period: None,
    };
    let (all, columns): (Vec<Wave>, Vec<DVector<f64>>) = curves(&abscissa, true)
        .into_iter()
        .map(|(cycles, curve)| {
            let column = DVector::from_column_slice(&curve);
            let wave = Wave {
                channel: 0,
                cycles,
                curve,
            };
            (wave, column)
        })
        .unzip();
    SmoothBasis::new(DMatrix::from_columns(&columns), all, vec![1.0])
}

/// Linear model fitted to a record, with the smooth discrepancy that it needs.
struct Fitted {
    at: Linearized,
    variables: Vec<Variable>,
    discrepancy: Option<Discrepancy>,
    /// Log evidence if all that the model leaves is noise.
    evidence: f64,
}

impl Fitted {
    fn new(y: &DVector<f64>, columns: &DMatrix<f64>) -> Self {
        let count = columns.ncols();
        let information = columns.tr_mul(columns) + DMatrix::identity(count, count);
        let x = information
            .cholesky()
            .expect("a prior")
            .solve(&columns.tr_mul(y));
        let at = Linearized {
            residual: y - columns * &x,
            x: x.iter().copied().collect(),
            jacobian: -columns,
        };
        let variables = vec![variable(1.0, [-99.0, 99.0]); count];
        Self {
            evidence: log_evidence(&at, &variables),
            at,
            variables,
            discrepancy: None,
        }
    }

    fn competing(mut self, basis: Option<&SmoothBasis>) -> Self {
        let found = basis.and_then(|basis| basis.likeliest(&self.at, &self.variables));
        self.discrepancy = found.map(|(own, _)| own);
        self
    }

    fn discrepancies(&self, other: &Self) -> Vec<Option<Discrepancy>> {
        let mut among = vec![None];
        let needed = [self, other].map(|own| own.discrepancy.clone());
        among.extend(needed.into_iter().flatten().map(Some));
        among
    }

    fn evidence(&self, needed: Option<&Discrepancy>, basis: &SmoothBasis) -> f64 {
        let gained = needed.and_then(|own| basis.gain(&self.at, &self.variables, own));
        self.evidence + gained.unwrap_or(0.0)
    }

    fn evidence_among(&self, among: &[Option<Discrepancy>], basis: &SmoothBasis) -> f64 {
        let each = among.iter().map(|own| self.evidence(own.as_ref(), basis));
        log_mean(&each.collect::<Vec<_>>())
    }

    /// Returns the log density of the record of the other condition.
    fn predicts(
        &self,
        y: &DVector<f64>,
        columns: &DMatrix<f64>,
        (among, basis): (&[Option<Discrepancy>], &SmoothBasis),
    ) -> f64 {
        let waves = |needed: Option<&Discrepancy>| {
            let nothing = DMatrix::zeros(SAMPLES, 0);
            needed.map_or(nothing, |own| basis.scaled(own))
        };
        let each = among.iter().map(|own| {
            let at = Linearized {
                x: self.at.x.clone(),
                residual: self.at.residual.clone(),
                jacobian: self.at.jacobian.clone(),
            };
            let posterior = Posterior::new(at, &self.variables, 1.0, &-waves(own.as_ref()));
            (own.clone(), self.evidence(own.as_ref(), basis), posterior)
        });
        let average = Average {
            each: each.collect(),
        };
        average.predicted(|needed| {
            let own = waves(needed);
            let shared = DMatrix::zeros(SAMPLES, own.ncols());
            Predicted {
                residual: y - columns * DVector::from_column_slice(&self.at.x),
                jacobian: beside(&-columns, &shared),
                own,
            }
        })
    }
}

/// Returns how many of `sets` records get a name, a right one where an effect is hidden.
fn named(row: Row, sets: usize, root: &DMatrix<f64>, with_discrepancy: bool) -> usize {
    let basis = waves();
    let streams = Streams::new(3, 7);
    let draw = |set: usize| {
        let mut stream = streams.at(0, Phase::Initial, set);
        let [jacobian, candidates] = [UNKNOWNS, CANDIDATES].map(|n| smooth(root, n, &mut stream));
        let jacobian = jacobian * 3.0;
        let other = [
            &jacobian * 0.8 + smooth(root, UNKNOWNS, &mut stream) * 1.8,
            &candidates * 0.8 + smooth(root, CANDIDATES, &mut stream) * 0.6,
        ];
        let error = smooth(root, 2, &mut stream) * row.error;
        let second = error.column(0) * row.correlation
            + error.column(1) * (1.0 - row.correlation * row.correlation).sqrt();
        let truth = stream.index(CANDIDATES);
        let g = candidates.column(truth).into_owned();
        let inner = jacobian.tr_mul(&jacobian) + DMatrix::identity(UNKNOWNS, UNKNOWNS);
        let absorbed = &jacobian
            * inner
                .cholesky()
                .expect("a prior")
                .solve(&jacobian.tr_mul(&g));
        let size = row.effect / g.dot(&(&g - absorbed)).sqrt();
        let x = DVector::from_fn(UNKNOWNS, |_, _| 0.3 * stream.normal());
        let mut noise = || DVector::from_fn(SAMPLES, |_, _| stream.normal());
        let y = &jacobian * &x + &g * size + error.column(0) + noise();
        let there = &other[0] * &x + other[1].column(truth) * size + second + noise();
        let competes = with_discrepancy.then_some(&basis);
        let without = Fitted::new(&y, &jacobian).competing(competes);
        let with = |k: usize| {
            let columns = beside(&jacobian, &candidates.columns(k, 1).into_owned());
            (k, Fitted::new(&y, &columns))
        };
        let mut fits: Vec<(usize, Fitted)> = (0..CANDIDATES).map(with).collect();
        let mut among = vec![None];
        // as a round of tests ranks its refits
        for _ in 0..2 {
            let evidence = |fit: &Fitted| fit.evidence_among(&among, &basis);
            fits.sort_by(|a, b| evidence(&b.1).total_cmp(&evidence(&a.1)));
            let (k, likeliest) = fits.swap_remove(0);
            fits.push((k, likeliest.competing(competes)));
            among = fits[CANDIDATES - 1].1.discrepancies(&without);
        }
        let evidence = |fit: &Fitted| fit.evidence_among(&among, &basis);
        fits.sort_by(|a, b| evidence(&b.1).total_cmp(&evidence(&a.1)));
        let (k, best) = fits.swap_remove(0);
        let best = best.competing(competes);
        let among = best.discrepancies(&without);
        let gain = best.evidence_among(&among, &basis) - without.evidence_among(&among, &basis);
        let elsewhere = beside(&other[0], &other[1].columns(k, 1).into_owned());
        let score = best.predicts(&there, &elsewhere, (&among, &basis))
            - without.predicts(&there, &other[0], (&among, &basis));
        let needed = Thresholds::default();
        let claims = gain >= needed.gain && score >= needed.prediction;
        claims && (row.effect == 0.0 || k == truth)
    };
    (0..sets).filter(|set| draw(*set)).count()
}

/// Checks the table of the decision rule: with a smooth model error nothing is named where nothing is there,
/// and effects are still found. Of 200 sets a row at most one is named falsely; 78, 48 and 78 % are named rightly.
#[test]
fn a_model_that_is_a_little_wrong_names_nothing_that_is_not_there() {
    const EMPTY: usize = 20;
    const HIDDEN: usize = 20;
    let root = root(15.0);
    let row = |error: f64, correlation: f64, effect: f64| Row {
        error,
        correlation,
        effect,
    };
    for (error, correlation) in [(0.6, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.8)] {
        let count = named(row(error, correlation, 0.0), EMPTY, &root, true);
        assert!(
            20 * count <= EMPTY,
            "{count} of {EMPTY}: {error} {correlation}"
        );
    }
    // without a discrepancy it names what is not there
    let count = named(row(1.0, 0.8, 0.0), EMPTY, &root, false);
    assert!(5 * count >= EMPTY, "{count} of {EMPTY}");
    for (effect, error, least) in [(6.0, 0.0, 0.75), (8.0, 0.6, 0.4), (15.0, 1.0, 0.6)] {
        let count = named(row(error, 0.5, effect), HIDDEN, &root, true);
        let share = count as f64 / HIDDEN as f64;
        assert!(share >= least, "{share}: {effect} sigma, {error}");
    }
}
