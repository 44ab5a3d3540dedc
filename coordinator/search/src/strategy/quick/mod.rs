//! A search that fits a laptop: a short memetic search in the trust box, line scans of the one
//! gene whose valley is narrow, and local refinement.
//!
//! A fitness with two resonances has a valley in the axial stiffness that is a hundred times
//! narrower than the box, so a population finds the plateau around it but not the valley; and on
//! the plateau more damping always looks better, because it removes the oscillation whose phase
//! does not fit. Hence the order: population, scan at several levels of damping, refinement, fine
//! scan, refinement.
use super::{
    Conductor, Piece, SettingsError,
    design::hypercube,
    levenberg::{Levenberg, LevenbergSettings},
    memetic::{Memetic, MemeticSettings},
    refine::{Refine, RefineSettings},
    require,
    scan::{Center, Scan, ScanSettings, Shift},
};
use crate::{
    random::Streams,
    space::{Interval, Space},
};
use protocol::case::Coefficient;
use serde::{Deserialize, Serialize};

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

/// The search over a space.
///
/// # Errors
/// If a setting lies outside its range.
pub fn build(
    settings: &QuickSettings,
    space: &Space,
    seed: u64,
) -> Result<Conductor, SettingsError> {
    let intervals = settings.trust.len();
    let one_each = "one interval per gene";
    require(
        intervals == space.dimension(),
        "trust",
        intervals as f64,
        one_each,
    )?;
    let mut pieces: Vec<Box<dyn Piece>> = Vec::with_capacity(settings.parts.len());
    for (scope, part) in (1..).zip(&settings.parts) {
        let streams = Streams::new(seed, scope);
        pieces.push(match part {
            Part::Memetic(memetic) => {
                let mut start = vec![vec![0.0; space.dimension()]];
                let others = memetic.population.saturating_sub(1);
                start.extend(hypercube(&settings.trust, others, streams));
                let inside = (space, settings.trust.clone());
                Box::new(Memetic::new(memetic.clone(), inside, &start, streams)?)
            }
            Part::Scan(scan) => Box::new(Scan::new(scan.clone(), space)?),
            Part::Refine(refine) => Box::new(Refine::new(refine.clone(), space, streams)?),
            Part::LeastSquares(settings) => Box::new(Levenberg::new(settings.clone(), space)?),
        });
    }
    Ok(Conductor::new(pieces, true))
}
