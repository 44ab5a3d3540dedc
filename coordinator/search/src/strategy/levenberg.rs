//! Levenberg-Marquardt least squares as a stage (batch-wise part) of a strategy: descents on the residual
//! vector from the best points so far.
//!
//! The residual of an individual, scaled so that its squared norm is the fitness, gives a derivative for
//! every sample. An iteration costs one point per gene and a fan of steps with different damping, and gains
//! more near a minimum than any search that uses the fitness alone.
use super::{
    archive::{Archive, EvaluatedIndividual, Residual},
    family::DescentEnd,
    proposal::Purpose,
    setting::{AllowedValues, Setting, SettingsError, check, settings},
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::{
    derivative::terms,
    least_squares::{
        Anticipated, EvaluatedPoint, LeastSquares, LeastSquaresSettings, Termination, Variable,
    },
    space::Space,
};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

settings! {
    /// Settings of the least-squares descents.
    pub struct LevenbergSettings, pub(super) table SETTINGS {
        pub starts: usize = "number of concurrent least-squares descents", AllowedValues::Whole(1, 1000);
        pub iterations: u32 = "maximum number of Jacobians per descent", AllowedValues::Whole(1, 1000);
        /// Minimum distance between two starts (coordinate), in at least one gene that counts: the gene with a
        /// narrow minimum, or an unknown that can compensate for it (half of that unknown's shift); all genes
        /// count if no minimum is narrow.
        pub apart: f64 = "minimum distance between two starts in some gene [decade]", AllowedValues::Real(0.0, 10.0);
        pub step: f64 = "first difference step [decade]", AllowedValues::Real(1e-9, 1.0);
        pub longest: f64 = "maximum change of a gene in one step [decade]", AllowedValues::Real(1e-3, 100.0);
        /// Damping added to each gene's own curvature in the normal equations, as a share of the mean curvature
        /// over all genes.
        pub level: f64 =
            "additional damping as a share of the mean curvature, which keeps insensitive genes in place",
            AllowedValues::Real(0.0, 1.0);
        pub heat: u32 =
            "rounds after which the worse half of the descents is abandoned",
            AllowedValues::Whole(1, 1000);
        /// Number of descents that are never abandoned: two with nearly equal fitness may converge to different
        /// minima.
        pub keep: usize = "number of descents that are never abandoned", AllowedValues::Whole(1, 1000);
        pub derivatives: Derivatives =
            "Jacobian columns: from one simulation where the model gives them, or by differences",
            AllowedValues::Words(&["exact", "differences"]);
        /// Convergence tolerance of a descent.
        pub finish: DescentTolerance;
    }
}

/// Number of rounds of steps between eliminations, each of which abandons the worse half of the descents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DescentTolerance {
    /// Ends when a step no longer lowers the fitness by at least 3 parts in 10,000.
    Usual,
    /// Ends within a hundredth of a standard deviation of the minimum in every unknown, with central
    /// differences at the end.
    Exact,
}

/// Source of the columns of a Jacobian.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Derivatives {
    /// One simulation that returns all derivatives; finite differences for columns that the model does not
    /// give.
    Exact,
    /// Finite differences: one further simulation per column.
    Differences,
}

/// Default convergence threshold on the gradient ratio ([`DECREASE`] is that on the relative decrease of the
/// fitness). At 1e-2 and 1e-3 descents of the shipped records stopped up to 5 % above their minimum, along
/// combinations of contact and stiffness.
const GRADIENT: f64 = 2e-3;
const DECREASE: f64 = 3e-4;

/// Typical number of rounds after which descents have converged; caps the estimate of the remaining rounds.
const USUAL: u32 = 10;

/// Least-squares descents as one batch-wise part (stage) of a strategy.
pub struct Levenberg {
    settings: LevenbergSettings,
    space: Space,
    /// Running descents, each with the number of points whose results it awaits; `None` before the first
    /// batch.
    searches: Option<Vec<(LeastSquares, usize)>>,
    round: u32,
}

/// Minimum distance between the starts of descents: along the axis with a narrow minimum and the axes of
/// unknowns that can compensate for it, or along all axes if there is none.
#[derive(Clone, Debug)]
pub struct SpacingRule {
    /// Indices of the axes along which the distance counts, each with the minimum distance (coordinate).
    axes: Vec<(usize, f64)>,
}

impl SpacingRule {
    /// Creates the distance rule: `distance` along an axis with a narrow minimum, and half the declared shift
    /// along the axis of each unknown that can compensate for it; `distance` along all axes if no minimum is
    /// narrow.
    pub fn new(space: &Space, distance: f64) -> Self {
        let mut axes = Vec::new();
        for (k, axis) in space.axes().iter().enumerate() {
            let Some(valley) = &axis.unknown.valley else {
                continue;
            };
            axes.push((k, distance));
            for shift in &valley.stand_ins {
                if let Some(axis) = space.position(&shift.unknown) {
                    axes.push((axis, 0.5 * shift.by.abs()));
                }
            }
        }
        if axes.is_empty() {
            axes = (0..space.dimension()).map(|k| (k, distance)).collect();
        }
        Self { axes }
    }

    /// Returns the first `count` of the given points, of which each is far enough from all those kept before
    /// it; `x` returns the coordinates of a point.
    pub fn first<P>(
        &self,
        count: usize,
        points: impl IntoIterator<Item = P>,
        x: impl Fn(&P) -> &[f64],
    ) -> Vec<P> {
        let mut kept: Vec<P> = Vec::new();
        for point in points {
            if kept.len() == count {
                break;
            }
            if !kept.iter().any(|other| self.near(x(other), x(&point))) {
                kept.push(point);
            }
        }
        kept
    }

    /// Returns whether two points are too near each other to start separate descents.
    fn near(&self, a: &[f64], b: &[f64]) -> bool {
        let near = |&(k, distance): &(usize, f64)| (a[k] - b[k]).abs() < distance;
        self.axes.iter().all(near)
    }
}

impl Levenberg {
    /// Creates the least-squares stage from its settings.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(settings: LevenbergSettings, space: &Space) -> Result<Self, SettingsError> {
        check(&settings, SETTINGS)?;
        Ok(Self {
            settings,
            space: space.clone(),
            searches: None,
            round: 0,
        })
    }

    fn begin(&self, archive: &Archive) -> Vec<(LeastSquares, usize)> {
        let apart = SpacingRule::new(&self.space, self.settings.apart);
        let located = |genes: Vec<f64>| {
            let fitness = archive.find(&genes)?.result.fitness;
            Some((self.space.point(&genes), fitness))
        };
        let first = |group: Vec<Vec<f64>>| {
            let all = group.into_iter().filter_map(located);
            apart.first(self.settings.starts, all, |(x, _)| x)
        };
        let groups: Vec<_> = archive.start_groups().into_iter().map(first).collect();
        // the best of each group, then the second of each
        let longest = groups.iter().map(Vec::len).max().unwrap_or(0);
        let places = (0..longest).flat_map(|place| {
            let at = groups.iter().filter_map(move |group| group.get(place));
            at.cloned()
        });
        let starts: Vec<(Vec<f64>, f64)> = places.take(self.settings.starts).collect();
        let search = |(x, fitness): (Vec<f64>, f64)| {
            let usual = LeastSquaresSettings::default();
            let exact = self.settings.finish == DescentTolerance::Exact;
            // steps that the case states are those that suit its model
            let stated = self
                .space
                .axes()
                .iter()
                .any(|axis| axis.unknown.step.is_some());
            let settings = LeastSquaresSettings {
                finish: exact,
                gradient: if exact { 5e-4 } else { GRADIENT },
                decrease: if exact { 1e-6 } else { DECREASE },
                step_range: if stated { 1.0 } else { usual.step_range },
                iterations: self.settings.iterations,
                // a tenth of the residual: far above rounding, within what is nearly linear
                change: 0.1 * libm::sqrt(fitness),
                level: self.settings.level,
                exact: self.settings.derivatives == Derivatives::Exact,
                ..usual
            };
            (LeastSquares::new(self.variables(&x), settings), 0)
        };
        starts.into_iter().map(search).collect()
    }

    /// Returns how many of `descents` descents remain after one elimination: half of them, but at least
    /// `keep`.
    fn survivors(&self, descents: usize) -> usize {
        descents.div_ceil(2).max(self.settings.keep.min(descents))
    }

    /// Abandons the worse half of the descents after every `heat` rounds, down to the number always kept.
    fn select(&mut self) {
        let heat_over = self.round > 0 && self.round.is_multiple_of(self.settings.heat);
        let left = self.survivors(self.searches.as_ref().map_or(0, Vec::len));
        if let Some(searches) = self.searches.as_mut().filter(|_| heat_over) {
            searches.sort_by(|(a, _), (b, _)| a.cost().total_cmp(&b.cost()));
            searches.truncate(left);
        }
    }

    /// Returns the expected number of rounds: two per Jacobian, one for its columns and one for the trial
    /// steps; capped, because most descents converge before the iteration limit.
    fn expected_rounds(&self) -> u32 {
        (1 + 2 * self.settings.iterations).min(USUAL)
    }

    fn variables(&self, x: &[f64]) -> Vec<Variable> {
        let axes = self.space.axes().iter().zip(x);
        axes.map(|(axis, start)| {
            let interval = axis.interval();
            Variable {
                start: *start,
                lower: interval.from,
                upper: interval.to,
                step: axis.unknown.step.unwrap_or(self.settings.step),
                longest: self.settings.longest,
                prior: None,
            }
        })
        .collect()
    }
}

/// Returns the derivatives of a residual by each axis of the space; `None` for an axis if a derivative that
/// it needs is missing.
fn columns(space: &Space, genes: &[f64], residual: &Residual) -> Vec<Option<DVector<f64>>> {
    let x = space.point(genes);
    let column = |axis: usize| {
        let mut sum = DVector::zeros(residual.values.len());
        for term in terms(space, axis, &x, genes) {
            let by = residual.derivatives.get(&term.column.name)?;
            term.add(by, (0, None), sum.as_mut_slice())?;
        }
        Some(sum)
    };
    (0..space.dimension()).map(column).collect()
}

/// Returns the purpose for which a descent proposes its next points.
const fn purpose(search: &LeastSquares) -> Purpose {
    if search.wants_columns() {
        Purpose::Derivatives
    } else {
        Purpose::LeastSquares
    }
}

/// Converts a result to a point of a descent, with the derivatives by each axis if they are `wanted`; `None`
/// if its simulation failed or there is no residual.
fn evaluated(space: &Space, one: &EvaluatedIndividual, wanted: bool) -> Option<EvaluatedPoint> {
    let residual = one.residual.as_ref().filter(|_| one.result.survived())?;
    Some(EvaluatedPoint {
        residual: DVector::from_column_slice(&residual.values),
        columns: if wanted {
            columns(space, &one.genes, residual)
        } else {
            Vec::new()
        },
    })
}

impl SearchStage for Levenberg {
    fn plan(&mut self, archive: &Archive) -> Option<Batch> {
        if self.searches.is_none() {
            self.searches = Some(self.begin(archive));
        }
        self.select();
        let mut drafts = Vec::new();
        for (search, awaited) in self.searches.iter_mut().flatten() {
            let points = search.plan();
            *awaited = points.len();
            let purpose = purpose(search);
            drafts.extend(points.iter().map(|x| ProposalDraft {
                genes: self.space.values(x),
                purpose,
            }));
        }
        if drafts.is_empty() {
            return None;
        }
        self.round += 1;
        Some(Batch {
            generation: self.round,
            drafts,
        })
    }

    fn absorb(&mut self, results: &[EvaluatedIndividual]) {
        let mut results = results.iter();
        for (search, awaited) in self.searches.iter_mut().flatten() {
            if *awaited > 0 {
                let own = results.by_ref().take(*awaited);
                let wanted = search.wants_columns();
                let found = own.map(|one| evaluated(&self.space, one, wanted));
                search.absorb(found.collect::<Vec<_>>());
            }
        }
    }

    fn anticipate(
        &self,
        result: &dyn Fn(usize) -> Option<EvaluatedIndividual>,
    ) -> Vec<ProposalDraft> {
        let (mut first, mut ranked) = (0, Vec::new());
        for (search, awaited) in self.searches.iter().flatten() {
            let own = first..first + awaited;
            first = own.end;
            if own.is_empty() {
                continue;
            }
            let wanted = search.wants_columns();
            let found = |index| Some(evaluated(&self.space, &result(index)?, wanted));
            match search.anticipate(own.map(found).collect()) {
                Anticipated::Certain(next) => {
                    let purpose = purpose(&next);
                    ranked.extend(next.plan().into_iter().map(|x| (0, x, purpose)));
                }
                Anticipated::Candidates(points) => {
                    let ranks = (1..).zip(points);
                    ranked.extend(ranks.map(|(rank, x)| (rank, x, Purpose::Derivatives)));
                }
            }
        }
        // stable: of equal rank in the order of the descents
        ranked.sort_by_key(|(rank, ..)| *rank);
        let draft = |(_, x, purpose): (usize, Vec<f64>, Purpose)| ProposalDraft {
            genes: self.space.values(&x),
            purpose,
        };
        ranked.into_iter().map(draft).collect()
    }

    fn start_groups(&self, _archive: &Archive) -> Vec<Vec<Vec<f64>>> {
        let left = self.searches.iter().flatten().map(|(search, _)| search);
        let mut left: Vec<&LeastSquares> = left.filter(|one| one.cost().is_finite()).collect();
        left.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        let genes = |search: &LeastSquares| vec![self.space.values(&search.best().x)];
        left.into_iter().map(genes).collect()
    }

    fn descent_ends(&self) -> Vec<DescentEnd> {
        let converged = |search: &&(LeastSquares, usize)| {
            let ended = search.0.ended();
            matches!(ended, Some(Termination::Converged | Termination::Stalled))
        };
        let converged = self.searches.iter().flatten().filter(converged);
        let end = converged.map(|(search, _)| DescentEnd {
            genes: self.space.values(&search.best().x),
            fitness: search.cost(),
        });
        end.collect()
    }

    fn generations(&self) -> u32 {
        match &self.searches {
            Some(searches) if searches.iter().all(|(s, _)| s.ended().is_some()) => self.round,
            Some(_) | None => self.expected_rounds().max(self.round),
        }
    }

    fn remaining(&self) -> u64 {
        let mut live = self.settings.starts;
        let mut running = 0;
        if let Some(searches) = &self.searches {
            let going = searches
                .iter()
                .filter(|(search, _)| search.ended().is_none());
            live = going.count();
            running = searches.iter().map(|(_, awaited)| *awaited).sum();
        }
        let per_round = usize::midpoint(self.space.dimension(), 5);
        let mut ahead = 0;
        for round in self.round..self.generations() {
            if round > 0 && round.is_multiple_of(self.settings.heat) {
                live = self.survivors(live);
            }
            ahead += live * per_round;
        }
        (running + ahead) as u64
    }
}
