//! Covariance matrix adaptation over the whole box, restarted with a doubled population after convergence.
//!
//! The distribution is `covariance.rs` with active updates; restarts are those of Auger and Hansen, "A
//! restart CMA evolution strategy with increasing population size" (CEC 2005). Points are mapped into the box
//! as by pycma's `BoxConstraintsLinQuadTransformation` (N. Hansen, github.com/CMA-ES/pycma): for an optimum
//! at a bound, steps towards it keep their size. Only the order of results counts, so failures are merely
//! ranked last.
use super::{
    archive::{Archive, EvaluatedIndividual},
    ask_tell::Strategy,
    covariance::{Distribution, normal, ranked},
    definition::{Preset, SettingGroup},
    proposal::Purpose,
    sequencer::Sequencer,
    setting::{AllowedValues, Setting, SettingsError, check, settings},
    settings::{Settings, StrategySettings, build_as},
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::{
    random::{Phase, Streams},
    space::{Interval, Space},
};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Preset of CMA-ES with restarts.
pub const CMA_ES: Preset = Preset {
    name: "cma-es",
    summary: "covariance matrix adaptation over the whole box, with restarts",
    strategy: CmaEsSettings::STRATEGY,
    settings: |plan| Settings::of(&CmaEsSettings::for_dimension(plan.space.dimension())),
    groups: &[SettingGroup::whole(SETTINGS)],
    slots: 4,
    build: build_as::<CmaEsSettings>,
};

settings! {
    /// Settings of CMA-ES with restarts.
    pub struct CmaEsSettings, table SETTINGS {
        pub population: usize = "individuals per generation", AllowedValues::Whole(4, 100_000);
        pub spread: f64 =
            "first standard deviation, as a share of each unknown's trust interval",
            AllowedValues::Real(1e-6, 10.0);
        pub growth: usize = "factor on the population of every restart", AllowedValues::Whole(1, 10);
        pub evaluations: usize = "total number of evaluations", AllowedValues::Whole(4, 100_000_000);
    }
}

impl CmaEsSettings {
    /// Returns the settings for `n` unknowns: the tutorial's population, `4 + 3 ln n`, and a thousand
    /// evaluations.
    pub fn for_dimension(n: usize) -> Self {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small positive number"
        )]
        let more = (3.0 * libm::log(n.max(1) as f64)) as usize;
        Self {
            population: 4 + more,
            spread: 0.25,
            growth: 2,
            evaluations: 1000,
        }
    }
}

impl StrategySettings for CmaEsSettings {
    const STRATEGY: &'static str = "cma-es";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        check(self, SETTINGS)?;
        let stage = CmaEs {
            settings: self.clone(),
            space: space.clone(),
            streams: Streams::new(seed, 0),
            planned: 0,
            generation: 0,
            restarts: 0,
            course: None,
            running: Vec::new(),
        };
        Ok(Box::new(Sequencer::new(vec![Box::new(stage)], false)))
    }
}

/// CMA-ES with a larger population at every restart, as one batch-wise part (stage) of a strategy.
struct CmaEs {
    settings: CmaEsSettings,
    space: Space,
    streams: Streams,
    planned: usize,
    generation: u32,
    restarts: u32,
    course: Option<RestartRun>,
    /// Standard normal vectors from which the points of the running batch were drawn.
    running: Vec<DVector<f64>>,
}

/// One CMA-ES run from a start to its convergence, between two restarts.
struct RestartRun {
    distribution: Distribution,
    population: usize,
    rounds: u32,
    /// Best fitness of recent generations, the last one at the back.
    recent_best: VecDeque<f64>,
}

/// Convergence threshold on the largest standard deviation of the search distribution, in search coordinates.
const REACH: f64 = 1e-12;
/// Share of a gene's interval, at each bound, in which search coordinates are mapped quadratically into the
/// box.
const BEND: f64 = 0.03;
/// Convergence thresholds on the range of the best fitness over recent generations: relative and absolute.
const FLAT: [f64; 2] = [1e-12, 1e-14];

impl RestartRun {
    /// Creates a CMA-ES run with its mean at `start` and initial standard deviations `spread`.
    fn new(start: Vec<f64>, spread: &DVector<f64>, population: usize) -> Self {
        Self {
            distribution: Distribution::new(DVector::from_vec(start), spread),
            population,
            rounds: 0,
            recent_best: VecDeque::new(),
        }
    }

    /// Updates the distribution with a whole generation; returns whether the run has converged.
    fn absorb(&mut self, drawn: &[DVector<f64>], results: &[EvaluatedIndividual]) -> bool {
        self.rounds += 1;
        if !results.iter().any(|result| result.result.survived()) {
            // says nothing about where to go
            self.distribution.sigma *= 0.5;
            return self.distribution.max_deviation() < REACH;
        }
        let ranked = ranked(drawn, results);
        self.distribution.update(&ranked, self.rounds, true);
        let fitness = results.iter().filter(|result| result.result.survived());
        let best = fitness.map(|result| result.result.fitness);
        self.recent_best
            .push_back(best.fold(f64::INFINITY, f64::min));
        let window = 10 + 30 * self.distribution.mean.len() / self.population;
        if self.recent_best.len() > window {
            self.recent_best.pop_front();
        }
        let (low, high) = self.recent_best.iter().fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high): (f64, f64), y| (low.min(*y), high.max(*y)),
        );
        let flat = high - low <= FLAT[0] * high.abs().max(low.abs()) + FLAT[1];
        let reach = self.distribution.max_deviation();
        (self.recent_best.len() == window && flat) || reach < REACH || !reach.is_finite()
    }
}

impl CmaEs {
    /// Creates the next CMA-ES run: the first from the start of the case, later ones from random points of
    /// the trust intervals.
    fn begin(&self) -> RestartRun {
        let axes = self.space.axes().iter();
        let spread = axes.map(|axis| self.settings.spread * axis.trust.length());
        let spread = DVector::from_iterator(self.space.dimension(), spread);
        let mut stream = self.streams.at(self.restarts, Phase::Initial, 0);
        let start = if self.restarts == 0 {
            self.space.origin()
        } else {
            let axes = self.space.axes().iter();
            axes.map(|axis| axis.trust.from + stream.unit() * axis.trust.length())
                .collect()
        };
        let grown = self.settings.growth.saturating_pow(self.restarts);
        let population = self.settings.population.saturating_mul(grown);
        let most = self.settings.evaluations.max(4);
        let axes = self.space.axes().iter().zip(start);
        let start = axes.map(|(axis, x)| from_box(axis.interval(), x));
        RestartRun::new(start.collect(), &spread, population.min(most))
    }
}

impl SearchStage for CmaEs {
    fn plan(&mut self, _archive: &Archive) -> Option<Batch> {
        let left = self.settings.evaluations.saturating_sub(self.planned);
        if left == 0 {
            return None;
        }
        if self.course.is_none() {
            self.course = Some(self.begin());
        }
        let course = self.course.as_ref()?;
        self.generation += 1;
        let mut drafts = Vec::new();
        for index in 0..course.population.min(left) {
            let mut stream = self.streams.at(self.generation, Phase::Refinement, index);
            let z = normal(self.space.dimension(), &mut stream);
            let x = course.distribution.point(&z);
            let axes = self.space.axes().iter().zip(x.iter());
            let inside: Vec<f64> = axes
                .map(|(axis, x)| into_box(axis.interval(), *x))
                .collect();
            self.running.push(z);
            drafts.push(ProposalDraft {
                genes: self.space.values(&inside),
                purpose: Purpose::Offspring,
            });
        }
        self.planned += drafts.len();
        Some(Batch {
            generation: self.generation,
            drafts,
        })
    }

    fn absorb(&mut self, results: &[EvaluatedIndividual]) {
        let drawn = std::mem::take(&mut self.running);
        let Some(course) = &mut self.course else {
            return;
        };
        // the last generation of all may be a part of one
        let whole = drawn.len() == course.population;
        if whole && course.absorb(&drawn, results) {
            self.course = None;
            self.restarts += 1;
        }
    }

    fn generations(&self) -> u32 {
        let left = self.settings.evaluations.saturating_sub(self.planned);
        let population = self
            .course
            .as_ref()
            .map_or_else(|| self.settings.population, |course| course.population);
        self.generation + u32::try_from(left.div_ceil(population)).unwrap_or(u32::MAX)
    }

    fn remaining(&self) -> u64 {
        let left = self.settings.evaluations.saturating_sub(self.planned);
        (left + self.running.len()) as u64
    }
}

/// Maps an unbounded search coordinate into the box: quadratic near a bound, so that the bound is the vertex
/// of a parabola, and mirrored beyond it.
fn into_box(interval: Interval, y: f64) -> f64 {
    let length = interval.length();
    if length <= 0.0 || !y.is_finite() {
        return interval.clamp(y);
    }
    let bend = BEND * length;
    let period = 2.0 * (length + 2.0 * bend);
    let around = (y - interval.from + bend).rem_euclid(period);
    // from wall to wall, 0 at the lower one
    let inside = around.min(period - around) - bend;
    let near = |x: f64| (x + bend) * (x + bend) / (4.0 * bend);
    interval.clamp(if inside < bend {
        interval.from + near(inside)
    } else if inside > length - bend {
        interval.to - near(length - inside)
    } else {
        interval.from + inside
    })
}

/// Inverse of [`into_box`]: returns the search coordinate that is mapped to `x` in the box.
fn from_box(interval: Interval, x: f64) -> f64 {
    let bend = BEND * interval.length();
    let (low, high) = (x - interval.from, interval.to - x);
    if low < bend {
        interval.from - bend + 2.0 * libm::sqrt(bend * low.max(0.0))
    } else if high < bend {
        interval.to + bend - 2.0 * libm::sqrt(bend * high.max(0.0))
    } else {
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_bent_to_the_box_and_mirrored_beyond() {
        let interval = Interval { from: 1.0, to: 3.0 };
        for y in [1.06, 2.0, 2.94] {
            assert!(
                (into_box(interval, y) - y).abs() < 1e-12,
                "{y}: the middle is as it was"
            );
        }
        let bend = 2.0 * BEND;
        for (y, inside) in [
            (1.0 - bend, 1.0),
            (3.0 + bend, 3.0),
            (1.0, 1.0 + 0.25 * bend),
        ] {
            assert!((into_box(interval, y) - inside).abs() < 1e-12, "{y}");
            assert!((from_box(interval, inside) - y).abs() < 1e-6, "{y}");
        }
        // the same far from either side of a wall, and once around
        for offset in [0.01, 0.3, 1.7] {
            let [below, above] = [1.0 - bend - offset, 1.0 - bend + offset];
            assert!((into_box(interval, below) - into_box(interval, above)).abs() < 1e-12);
            let around = above + 2.0 * (2.0 + 2.0 * bend);
            assert!((into_box(interval, around) - into_box(interval, above)).abs() < 1e-12);
        }
        for step in -400..400 {
            let x = into_box(interval, f64::from(step) / 50.0);
            assert!((1.0..=3.0).contains(&x), "{step}");
        }
        assert!(into_box(interval, f64::INFINITY) <= 3.0);
    }
}
