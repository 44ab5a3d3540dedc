//! Least squares as a piece of a strategy: from the best points so far, down the residual vector.
//!
//! The residual of an individual, in units in which its squared length is the fitness, says for
//! every sample which way to go; a step of this piece costs one point per gene and a fan of damped
//! tries, and near a minimum gains more than any search that sees the fitness alone.
use super::{
    archive::{Archive, Evaluated, Residual},
    piece::{Batch, Draft, Piece},
    proposal::Purpose,
    setting::{Setting, SettingsError, Values, check},
};
use crate::{
    derivative::terms,
    least_squares::{self, LeastSquares, Settings, Variable},
    space::Space,
};
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// A descent of the residual vector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevenbergSettings {
    /// Descents side by side, from the best points that lie apart.
    pub starts: usize,
    /// Most Jacobians of each.
    pub iterations: u32,
    /// How far two starts must lie apart (coordinate): in the gene with a narrow valley, where there is one, or half of
    /// a stand-in's shift in that stand-in; else in some gene.
    pub apart: f64,
    /// First difference step (coordinate), where the case states none of its own.
    pub step: f64,
    /// How far one step moves a gene (coordinate).
    pub longest: f64,
    /// What a step is damped by beside a gene's own curvature, as a share of the mean one.
    pub level: f64,
    /// Rounds after which the worse half of the descents is given up.
    pub heat: u32,
    /// Descents that are never given up: two that are nearly alike may have different floors.
    pub keep: usize,
    /// How columns come about.
    pub derivatives: Derivatives,
    /// How near its floor a descent ends.
    pub finish: Finish,
}

/// How near its floor a descent ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Finish {
    /// Where a step no longer lowers the fitness by 3 parts in 10,000.
    Usual,
    /// Within a hundredth of a standard deviation of the unknowns: differences become central ones at the end.
    Exact,
}

/// How the columns of a Jacobian come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Derivatives {
    /// One simulation with all of them; differences for what the model does not give.
    Exact,
    /// A simulation for each.
    Differences,
}

/// What can be set by name.
pub(super) const SETTINGS: &[Setting] = &[
    Setting::new(
        "starts",
        Values::Whole(1, 1000),
        "descents of the residual side by side",
    ),
    Setting::new(
        "iterations",
        Values::Whole(1, 1000),
        "most Jacobians of each descent",
    ),
    Setting::new(
        "apart",
        Values::Real(0.0, 10.0),
        "how far two starts lie apart in some gene [decade]",
    ),
    Setting::new(
        "step",
        Values::Real(1e-9, 1.0),
        "first difference step [decade]",
    ),
    Setting::new(
        "longest",
        Values::Real(1e-3, 100.0),
        "how far one step may move a gene [decade]",
    ),
    Setting::new(
        "level",
        Values::Real(0.0, 1.0),
        "share of the mean curvature that holds genes of next to none where they are",
    ),
    Setting::new(
        "heat",
        Values::Whole(1, 1000),
        "rounds after which the worse half of the descents is given up",
    ),
    Setting::new(
        "keep",
        Values::Whole(1, 1000),
        "descents that are never given up",
    ),
    Setting::new(
        "derivatives",
        Values::Words(&["exact", "differences"]),
        "columns from one simulation where the model gives them, or from one each",
    ),
];

/// Gradient ratio and share of the fitness from which a descent ends as usual. At 1e-2 and 1e-3 descents of the
/// shipped records stopped up to 5 % above their floor, along combinations of contact and stiffness.
const GRADIENT: f64 = 2e-3;
const DECREASE: f64 = 3e-4;

/// Rounds after which most descents are at their floor.
const USUAL: u32 = 10;

/// Descents as a piece of a strategy.
pub struct Levenberg {
    settings: LevenbergSettings,
    space: Space,
    /// The descents with the number of points that each awaits; none before the first batch.
    searches: Option<Vec<(LeastSquares, usize)>>,
    round: u32,
}

/// How far apart the starts of descents lie: along the narrow axis and those that can stand in for it, else along all.
#[derive(Clone, Debug)]
pub struct Apart {
    /// An axis, and the least distance along it (coordinate).
    axes: Vec<(usize, f64)>,
}

impl Apart {
    /// A distance along the narrow axis, and half of each stand-in's shift along its own.
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

    /// The first `count` points that lie apart from those before them; `x` is a point's coordinates.
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

    /// Whether one of two points is too near the other to begin a descent of its own.
    fn near(&self, a: &[f64], b: &[f64]) -> bool {
        let near = |&(k, distance): &(usize, f64)| (a[k] - b[k]).abs() < distance;
        self.axes.iter().all(near)
    }
}

impl Levenberg {
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

    /// Descents from the best points that lie apart.
    fn begin(&self, archive: &Archive) -> Vec<(LeastSquares, usize)> {
        let ranked = archive.ranked().into_iter();
        let ranked = ranked.map(|one| (self.space.point(&one.genes), one.told.fitness));
        let apart = Apart::new(&self.space, self.settings.apart);
        let starts = apart.first(self.settings.starts, ranked, |(x, _)| x);
        let search = |(x, fitness): (Vec<f64>, f64)| {
            let usual = Settings::default();
            let exact = self.settings.finish == Finish::Exact;
            // steps that the case states are those that suit its model
            let stated = self
                .space
                .axes()
                .iter()
                .any(|axis| axis.unknown.step.is_some());
            let settings = Settings {
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

    /// Descents that are left of so many after a heat.
    fn left(&self, descents: usize) -> usize {
        descents.div_ceil(2).max(self.settings.keep.min(descents))
    }

    /// Gives up the worse half of the descents after every heat, as far as they are not to be kept.
    fn select(&mut self) {
        let heat_over = self.round > 0 && self.round.is_multiple_of(self.settings.heat);
        let left = self.left(self.searches.as_ref().map_or(0, Vec::len));
        if let Some(searches) = self.searches.as_mut().filter(|_| heat_over) {
            searches.sort_by(|(a, _), (b, _)| a.cost().total_cmp(&b.cost()));
            searches.truncate(left);
        }
    }

    /// Two rounds per Jacobian, its columns and the fan; most descents end long before the last.
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

/// Derivatives of a residual by the axes; none by one of which a part is not known.
fn columns(space: &Space, genes: &[f64], residual: &Residual) -> Vec<Option<DVector<f64>>> {
    let x = space.point(genes);
    let column = |axis: usize| {
        let mut sum = DVector::zeros(residual.values.len());
        for term in terms(space, axis, &x, genes) {
            let by = residual.by.get(&term.column.name)?;
            term.add(by, (0, None), sum.as_mut_slice())?;
        }
        Some(sum)
    };
    (0..space.dimension()).map(column).collect()
}

impl Piece for Levenberg {
    fn plan(&mut self, archive: &Archive) -> Option<Batch> {
        if self.searches.is_none() {
            self.searches = Some(self.begin(archive));
        }
        self.select();
        let mut drafts = Vec::new();
        for (search, awaited) in self.searches.iter_mut().flatten() {
            let points = search.plan();
            *awaited = points.len();
            let purpose = if search.wants_columns() {
                Purpose::Derivatives
            } else {
                Purpose::LeastSquares
            };
            drafts.extend(points.iter().map(|x| Draft {
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

    fn absorb(&mut self, results: &[Evaluated]) {
        let mut results = results.iter();
        for (search, awaited) in self.searches.iter_mut().flatten() {
            if *awaited > 0 {
                let own = results.by_ref().take(*awaited);
                let (space, wanted) = (&self.space, search.wants_columns());
                let residual = |one: &Evaluated| {
                    let residual = one.residual.as_ref().filter(|_| one.told.survived())?;
                    Some(least_squares::Evaluated {
                        residual: DVector::from_column_slice(&residual.values),
                        columns: if wanted {
                            columns(space, &one.genes, residual)
                        } else {
                            Vec::new()
                        },
                    })
                };
                search.absorb(own.map(residual).collect::<Vec<_>>());
            }
        }
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
                live = self.left(live);
            }
            ahead += live * per_round;
        }
        (running + ahead) as u64
    }
}
