//! A search that fits a laptop: a short memetic search in the trust box, line scans of the one
//! gene whose valley is narrow, and local refinement.
//!
//! A fitness with two resonances has a valley in the axial stiffness that is a hundred times
//! narrower than the box, so a population finds the plateau around it but not the valley; and on
//! the plateau more damping always looks better, because it removes the oscillation whose phase
//! does not fit. Hence the order: population, scan at several levels of damping, refinement, fine
//! scan, refinement.
use super::{
    ask_tell::Strategy,
    conductor::Conductor,
    design::hypercube,
    levenberg::{self, Levenberg, LevenbergSettings},
    memetic::{
        generations::Memetic,
        settings::{self as memetic_settings, MemeticSettings},
    },
    offer::{Group, Preset, Promise},
    piece::Piece,
    refine::{self, Refine, RefineSettings},
    scan::{self, Center, Scan, ScanSettings, Shift},
    setting::{Setting, SettingsError, require},
    settings::{Recipe, Settings, build_as},
};
use crate::{
    random::Streams,
    space::{Interval, Space},
};
use protocol::case::Coefficient;
use serde::{Deserialize, Serialize};

/// The search with refinements.
pub const QUICK: Preset = Preset {
    name: "quick",
    summary: "a short memetic search, line scans of the axial stiffness, refinement",
    strategy: QuickSettings::STRATEGY,
    settings: |plan| Settings::of(&QuickSettings::for_space(plan.space)),
    groups: &[
        MEMETIC,
        part("scan_", "/parts/1/scan", scan::SETTINGS),
        part("refine_", "/parts/2/refine", refine::SETTINGS),
        part("fine_scan_", "/parts/3/scan", scan::SETTINGS),
        part("fine_refine_", "/parts/4/refine", refine::SETTINGS),
    ],
    promise: Promise {
        one_basin: 1e-4,
        many_basins: 1.1,
        distance: 0.01,
        opens_at_recommended: true,
        valley: Some(1_100),
    },
    build: build_as::<QuickSettings>,
};

/// The search with descents of the residual vector.
pub const LEAST_SQUARES: Preset = Preset {
    name: "least-squares",
    summary: "a short memetic search and line scans, then Levenberg-Marquardt on the residual",
    settings: |plan| Settings::of(&QuickSettings::least_squares(plan.space)),
    groups: &[
        MEMETIC,
        part("scan_", "/parts/1/scan", scan::SETTINGS),
        part("descent_", "/parts/2/least_squares", levenberg::SETTINGS),
        part("fine_scan_", "/parts/3/scan", scan::SETTINGS),
        part(
            "fine_descent_",
            "/parts/4/least_squares",
            levenberg::SETTINGS,
        ),
    ],
    promise: Promise {
        one_basin: 1e-8,
        distance: 1e-4,
        ..QUICK.promise
    },
    ..QUICK
};

/// The memetic part's table.
const MEMETIC: Group = part("", "/parts/0/memetic", memetic_settings::SETTINGS);

/// A part's table.
const fn part(named: &'static str, place: &'static str, table: &'static [Setting]) -> Group {
    Group {
        named,
        place,
        table,
        without: &[],
    }
}

/// One part of the search, in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The memetic algorithm in the trust box, from the recommended individual and a Latin
    /// hypercube.
    Memetic(MemeticSettings),
    /// A line scan around the best points.
    Scan(ScanSettings),
    /// A refinement around the best point.
    Refine(RefineSettings),
    /// A descent of the residual vector from the best points.
    LeastSquares(LevenbergSettings),
}

/// Settings of the quick search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuickSettings {
    /// Where the memetic part searches, gene by gene, from the recommended value (coordinate).
    pub trust: Vec<Interval>,
    /// What is done, in order.
    pub parts: Vec<Part>,
}

impl QuickSettings {
    /// About 900 evaluations. The axial stiffness of the rope is scanned (the first gene, if
    /// there is none), at the best point, with less axial damping, with a harder contact, and
    /// with both: a soft contact can stand in for a soft rope, and then hides the valley.
    pub fn for_space(space: &Space) -> Self {
        let trust: Vec<Interval> = space.axes().iter().map(|axis| axis.trust).collect();
        let gene = space.position(Coefficient::Kb1).unwrap_or(0);
        let shift = |name, by| space.position(name).map(|gene| Shift { gene, by });
        let damping = shift(Coefficient::Cb1, -0.8);
        let contact = shift(Coefficient::Kc, 1.5);
        let mut lines: Vec<Vec<Shift>> = [
            [None, None],
            [damping, None],
            [None, contact],
            [damping, contact],
        ]
        .map(|shifts| shifts.into_iter().flatten().collect())
        .into();
        lines.dedup();
        let spread = |scanned: f64, share: f64| {
            let all = trust.iter().enumerate();
            all.map(|(axis, interval)| {
                if axis == gene {
                    scanned
                } else {
                    share * interval.length()
                }
            })
            .collect::<Vec<f64>>()
        };
        let coarse = ScanSettings {
            gene,
            center: Center::Recommended,
            below: 0.3,
            above: 1.1,
            step: 0.02,
            points: 1,
            apart: 0.3,
            lines,
        };
        let mut fine = coarse.clone();
        fine.center = Center::Point;
        (fine.below, fine.above, fine.step) = (0.03, 0.03, 0.003);
        fine.lines = vec![Vec::new()];
        let memetic = MemeticSettings {
            population: 32,
            generations: 6,
            crossover_trials: 4,
            mutation_trials: 4,
            ..MemeticSettings::paper()
        };
        Self {
            parts: vec![
                Part::Memetic(memetic),
                Part::Scan(coarse),
                Part::Refine(RefineSettings {
                    batch: 16,
                    rounds: 12,
                    spread: spread(0.008, 0.06),
                }),
                Part::Scan(fine),
                Part::Refine(RefineSettings {
                    batch: 16,
                    rounds: 8,
                    spread: spread(0.002, 0.02),
                }),
            ],
            trust,
        }
    }

    /// The same with descents of the residual vector in place of the refinements.
    pub fn least_squares(space: &Space) -> Self {
        let mut settings = Self::for_space(space);
        let starts = [3, 1];
        let refinements = settings
            .parts
            .iter_mut()
            .filter(|p| matches!(p, Part::Refine(_)));
        for (part, starts) in refinements.zip(starts) {
            *part = Part::LeastSquares(LevenbergSettings {
                starts,
                iterations: 6,
                apart: 0.03,
                step: 0.01,
            });
        }
        settings
    }
}

impl Recipe for QuickSettings {
    const STRATEGY: &'static str = "quick";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        let intervals = self.trust.len();
        let one_each = "one interval per gene";
        require(intervals == space.dimension(), "trust", intervals, one_each)?;
        let mut pieces: Vec<Box<dyn Piece>> = Vec::with_capacity(self.parts.len());
        let mut reuse_clones = true;
        for (scope, part) in (1..).zip(&self.parts) {
            let streams = Streams::new(seed, scope);
            pieces.push(match part {
                Part::Memetic(memetic) => {
                    reuse_clones &= memetic.reuse_clones;
                    let mut start = vec![vec![0.0; space.dimension()]];
                    let others = memetic.population.saturating_sub(1);
                    start.extend(hypercube(&self.trust, others, streams));
                    let inside = (space, self.trust.clone());
                    Box::new(Memetic::new(memetic.clone(), inside, &start, streams)?)
                }
                Part::Scan(scan) => Box::new(Scan::new(scan.clone(), space)?),
                Part::Refine(refine) => Box::new(Refine::new(refine.clone(), space, streams)?),
                Part::LeastSquares(settings) => Box::new(Levenberg::new(settings.clone(), space)?),
            });
        }
        Ok(Box::new(Conductor::new(pieces, reuse_clones)))
    }
}
