//! Searches small enough for a laptop, as sequences of stages: initial points, line scans of the unknown with
//! a narrow minimum, concurrent descents of which the worse are eliminated (races), a short memetic search,
//! local refinement.
//!
//! A fitness with resonances has a valley in a stiffness: a narrow minimum, a hundred times narrower than the
//! box. A population finds the plateau around it but not the valley; and on the plateau more damping always
//! looks better, because it removes the oscillation whose phase does not fit. `quick` therefore races
//! descents of the residual vector from scattered points, which finds approximate values of the other
//! unknowns, scans the unknown with the narrow minimum around the ends of the best two, on lines along which
//! the valley is visible, and races descents again from the best grid points (stations) about each of them. `memetic`
//! needs the fitness alone: population, scan, refinement, fine scan, refinement. The case states which
//! unknown has a narrow valley and which other unknowns hide it; if it states none, there is no scan.
use super::{
    ask_tell::Strategy,
    definition::{Preset, SettingGroup},
    design::{Points, hypercube, prepend_starts},
    levenberg::{self, Derivatives, DescentTolerance, Levenberg, LevenbergSettings},
    memetic::{
        generations::Memetic,
        settings::{self as memetic_settings, MemeticSettings},
    },
    refine::{self, Refine, RefineSettings},
    scan::{self, Center, Line, Scan, ScanSettings, Share, Shift},
    sequencer::Sequencer,
    setting::{AllowedValues, Setting, SettingsError, require},
    settings::{Settings, StrategySettings, build_as},
    stage::SearchStage,
};
use crate::{
    random::Streams,
    space::{Interval, Space},
};
use protocol::case::Valley;
use serde::{Deserialize, Serialize};

/// Preset with least-squares descents before and after a line scan, of which the worse are eliminated.
pub const QUICK: Preset = Preset {
    name: "quick",
    summary: "least-squares descents from many points, a scan of a narrow valley, more descents",
    strategy: StagedSettings::STRATEGY,
    settings: |plan| Settings::of(&StagedSettings::quick(plan.space)),
    groups: &[
        part("", "/parts/0/points", POINTS),
        SettingGroup {
            excluded: &["apart"],
            ..part("race_", "/parts/1/least_squares", levenberg::SETTINGS)
        },
        part("scan_", "/parts/2/scan", scan::SETTINGS),
        part("descent_", "/parts/3/least_squares", levenberg::SETTINGS),
    ],
    slots: 4,
    build: build_as::<StagedSettings>,
};

/// Preset that uses the fitness alone: memetic search, line scans, refinement.
pub const MEMETIC_AND_SCANS: Preset = Preset {
    name: "memetic",
    summary: "a short memetic search, line scans, refinement: by the objective alone",
    settings: |plan| Settings::of(&StagedSettings::memetic(plan.space)),
    groups: &[
        MEMETIC,
        part("scan_", "/parts/1/scan", scan::SETTINGS),
        part("refine_", "/parts/2/refine", refine::SETTINGS),
        part("fine_scan_", "/parts/3/scan", scan::SETTINGS),
        part("fine_refine_", "/parts/4/refine", refine::SETTINGS),
    ],
    slots: 8,
    ..QUICK
};

/// Preset with a line scan followed by least-squares descents, of which the worse are eliminated.
pub const LEAST_SQUARES: Preset = Preset {
    name: "least-squares",
    summary: "a few points and a line scan, then Levenberg-Marquardt on the residual",
    settings: |plan| Settings::of(&StagedSettings::least_squares(plan.space)),
    groups: &[
        part("", "/parts/0/points", POINTS),
        part("scan_", "/parts/1/scan", scan::SETTINGS),
        part("descent_", "/parts/2/least_squares", levenberg::SETTINGS),
    ],
    slots: 4,
    ..QUICK
};

/// Preset with one descent from the start, as in common calibration programs.
pub const DESCENT: Preset = Preset {
    name: "descent",
    summary: "one Levenberg-Marquardt descent of the residual from the start",
    settings: |plan| Settings::of(&StagedSettings::descent(plan.space)),
    groups: &[SettingGroup {
        prefix: "",
        pointer: "/parts/1/least_squares",
        table: levenberg::SETTINGS,
        excluded: &["starts", "apart", "heat", "keep"],
    }],
    slots: 4,
    ..QUICK
};

/// Preset with a memetic search first, then a line scan and least-squares descents on the residual vector.
pub const HYBRID: Preset = Preset {
    name: "hybrid",
    summary: "a short memetic search and line scans, then several descents of the residual",
    settings: |plan| Settings::of(&StagedSettings::hybrid(plan.space)),
    groups: &[
        MEMETIC,
        part("scan_", "/parts/1/scan", scan::SETTINGS),
        SettingGroup {
            excluded: &["keep"],
            ..part("descent_", "/parts/2/least_squares", levenberg::SETTINGS)
        },
    ],
    slots: 4,
    ..LEAST_SQUARES
};

const POINTS: &[Setting] = &[Setting::new(
    "points",
    AllowedValues::Whole(1, 1_000_000),
    "first points: the start and a Latin hypercube",
)];

const MEMETIC: SettingGroup = part("", "/parts/0/memetic", memetic_settings::SETTINGS);

/// Creates the setting group of one stage of the search.
const fn part(named: &'static str, place: &'static str, table: &'static [Setting]) -> SettingGroup {
    SettingGroup {
        prefix: named,
        pointer: place,
        table,
        excluded: &[],
    }
}

/// Settings of a stage, such as a line scan; the stages of a search are executed in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StageSettings {
    /// Memetic algorithm in the trust box, from the start and a Latin hypercube.
    Memetic(MemeticSettings),
    /// Initial points: the start and a Latin hypercube in the trust box.
    Points {
        /// Total number of initial points, including the start.
        points: usize,
    },
    /// Line scan through the best points found so far.
    Scan(ScanSettings),
    /// Placeholder for a line scan if no unknown has a narrow minimum; does nothing.
    NoScan,
    /// Local refinement around the best point found so far.
    Refine(RefineSettings),
    /// Least-squares descents from the best points found so far.
    LeastSquares(LevenbergSettings),
}

/// Settings of a search that consists of several stages, executed in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StagedSettings {
    /// Trust interval of each axis about the start (coordinate), in which the initial points and the memetic
    /// part are placed.
    pub trust: Vec<Interval>,
    /// Parts of the search with their settings, in order of execution.
    pub parts: Vec<StageSettings>,
}

impl StagedSettings {
    /// Returns the settings of a search by fitness alone, about 900 evaluations. The first axis with a narrow
    /// minimum is scanned through the best point, with every subset of the shifts of other unknowns that may
    /// reveal the minimum.
    pub fn memetic(space: &Space) -> Self {
        let trust: Vec<Interval> = space.axes().iter().map(|axis| axis.trust).collect();
        let scanned = narrow(space);
        // of the scanned axis only the valley's floor is left to refine
        let spread = |floor: f64, share: f64| {
            let all = trust.iter().enumerate();
            all.map(|(axis, interval)| match scanned {
                Some((own, valley)) if own == axis => floor * valley.step,
                _ => share * interval.length(),
            })
            .collect::<Vec<f64>>()
        };
        let scans = scanned.map(|(axis, valley)| scans(space, axis, valley));
        let [coarse, fine] = scans
            .map_or([StageSettings::NoScan, StageSettings::NoScan], |scans| {
                scans.map(StageSettings::Scan)
            });
        let memetic = MemeticSettings {
            population: 32,
            generations: 6,
            crossover_trials: 4,
            mutation_trials: 4,
            ..MemeticSettings::paper()
        };
        Self {
            parts: vec![
                StageSettings::Memetic(memetic),
                coarse,
                StageSettings::Refine(RefineSettings {
                    batch: 16,
                    rounds: 12,
                    spread: spread(0.4, 0.06),
                }),
                fine,
                StageSettings::Refine(RefineSettings {
                    batch: 16,
                    rounds: 8,
                    spread: spread(0.1, 0.02),
                }),
            ],
            trust,
        }
    }

    /// Returns the settings of a memetic search of some 300 evaluations, a coarse scan, and eight descents,
    /// half of which are abandoned at every elimination.
    pub fn hybrid(space: &Space) -> Self {
        let Self { trust, parts } = Self::memetic(space);
        let Self {
            parts: descents, ..
        } = Self::least_squares(space);
        let mut hybrid: Vec<StageSettings> = parts.into_iter().take(1).collect();
        if let Some(StageSettings::Memetic(memetic)) = hybrid.first_mut() {
            memetic.generations = 2;
        }
        hybrid.extend(descents.into_iter().skip(1));
        if let Some(StageSettings::LeastSquares(descent)) = hybrid.last_mut() {
            descent.starts = 8;
        }
        Self {
            trust,
            parts: hybrid,
        }
    }

    /// Returns the settings of one descent from the start to full convergence.
    pub fn descent(space: &Space) -> Self {
        let Self { trust, mut parts } = Self::least_squares(space);
        if let Some(StageSettings::LeastSquares(descent)) = parts.last_mut() {
            descent.starts = 1;
            descent.iterations = 50;
            descent.finish = DescentTolerance::Exact;
        }
        let descent = parts.pop();
        let mut parts = vec![StageSettings::Points { points: 1 }];
        parts.extend(descent);
        Self { trust, parts }
    }

    /// Returns the settings of ten descents from scattered points, a scan about the ends of the best two, and
    /// eight descents from the grid points of the scan, half of them from each of its base points, two of which
    /// run to convergence: some 450 evaluations, 55 of them with derivatives. Results with these numbers are in
    /// `docs/verdicts.md`.
    pub fn quick(space: &Space) -> Self {
        let Self { trust, mut parts } = Self::least_squares(space);
        parts[0] = StageSettings::Points { points: 16 };
        let starts = if let StageSettings::Scan(scan) = &mut parts[1] {
            scan.points = 2;
            RACE.starts
        } else {
            // the descents that are left go on
            RACE.keep
        };
        if let Some(StageSettings::LeastSquares(descent)) = parts.last_mut() {
            // it decides between families of fits, not how deep each of them is
            let race = StageSettings::LeastSquares(LevenbergSettings {
                starts: 10,
                iterations: 8,
                heat: 2,
                keep: 2,
                ..descent.clone()
            });
            *descent = LevenbergSettings {
                starts,
                apart: RACE.apart,
                heat: RACE.elimination_interval,
                keep: RACE.keep,
                // a longer step may end where an unknown has no effect, from where no step leads back
                longest: 0.8,
                ..descent.clone()
            };
            parts.insert(1, race);
        }
        Self { trust, parts }
    }

    /// Returns the settings of a few points and a scan followed by descents of the residual vector: about 300
    /// evaluations, some 40 of them with derivatives.
    pub fn least_squares(space: &Space) -> Self {
        let Self { trust, mut parts } = Self::memetic(space);
        parts.truncate(2);
        parts[0] = StageSettings::Points { points: 24 };
        parts[1] = coarse_scan(space).map_or(StageSettings::NoScan, StageSettings::Scan);
        parts.push(StageSettings::LeastSquares(LevenbergSettings {
            starts: 4,
            iterations: 25,
            apart: 0.03,
            step: 0.01,
            longest: 1.5,
            level: 1e-3,
            heat: 6,
            keep: 1,
            derivatives: Derivatives::Exact,
            finish: DescentTolerance::Usual,
        }));
        Self { trust, parts }
    }
}

/// Settings of a race: concurrent least-squares descents that start at grid points of a scan and of which the
/// worse are eliminated.
#[derive(Debug)]
pub struct Race {
    /// Number of grid points of the scan from which descents start.
    pub starts: usize,
    /// Minimum distance between the starts along the scanned unknown (coordinate).
    pub apart: f64,
    /// Number of rounds of steps between eliminations, each of which abandons the worse half of the descents.
    pub elimination_interval: u32,
    /// Number of descents that are never abandoned.
    pub keep: usize,
}

/// Settings of the race of descents that start at grid points of a [`coarse_scan`].
pub const RACE: Race = Race {
    starts: 8,
    // half of what the machine's stations lie apart
    apart: 0.07,
    elimination_interval: 2,
    keep: 2,
};

/// Returns the index of the first axis whose unknown has a narrow minimum, and the case's description of that
/// minimum.
fn narrow(space: &Space) -> Option<(usize, &Valley)> {
    let mut axes = space.axes().iter().enumerate();
    axes.find_map(|(axis, own)| Some((axis, own.unknown.valley.as_ref()?)))
}

/// Returns the scan between two sets of descents: its grid is just fine enough that a descent from at least
/// one grid point enters the narrow minimum, on lines along which the minimum is visible. `None` if no
/// unknown has a narrow minimum.
pub fn coarse_scan(space: &Space) -> Option<ScanSettings> {
    let (axis, valley) = narrow(space)?;
    let [mut scan, _] = scans(space, axis, valley);
    // a descent enters the valley from several of its widths away
    scan.step *= 7.0;
    if let Some(lines) = held(space, valley) {
        scan.lines = lines;
    }
    Some(scan)
}

/// Returns the coarse scan of an axis for its narrow minimum, and the fine scan around the minimum found by
/// the coarse one.
fn scans(space: &Space, axis: usize, valley: &Valley) -> [ScanSettings; 2] {
    let coarse = ScanSettings {
        axis,
        center: Center::Start,
        below: -valley.from,
        above: valley.to,
        step: valley.step,
        points: 1,
        apart: 0.3,
        lines: uncovered(space, valley),
    };
    let mut fine = coarse.clone();
    fine.center = Center::Point;
    fine.below = 1.5 * valley.step;
    fine.above = fine.below;
    fine.step = 0.15 * valley.step;
    fine.lines = vec![Line::default()];
    [coarse, fine]
}

/// Converts the shifts declared in the case to those of a scan, with axis indices in place of names; shifts
/// of unknowns that are not searched are dropped.
fn shifts(space: &Space, of: &[protocol::case::Shift]) -> Vec<Shift> {
    let known = of.iter().filter_map(|shift| {
        let axis = space.position(&shift.unknown)?;
        Some(Shift { axis, by: shift.by })
    });
    known.collect()
}

/// Returns one scan line for every subset of the declared shifts of other unknowns that can reveal the narrow
/// minimum.
fn uncovered(space: &Space, valley: &Valley) -> Vec<Line> {
    let mut lines = vec![Line::default()];
    for shift in shifts(space, &valley.uncovered_by) {
        let with = |line: &Line| Line {
            shifts: line.shifts.iter().copied().chain([shift]).collect(),
            share: None,
        };
        let more: Vec<Line> = lines.iter().map(with).collect();
        lines.extend(more);
    }
    lines
}

/// Returns scan lines through a base point and through points at which an unknown that can compensate for the
/// scanned one is shifted. On each line, the unknown that hides the minimum is held at one of the declared
/// ratios to the scanned unknown. `None` if the case states no ratios.
fn held(space: &Space, valley: &Valley) -> Option<Vec<Line>> {
    let shares = valley.shares.as_ref()?;
    let axis = space.position(&shares.unknown)?;
    let stand_ins = shifts(space, &valley.stand_ins);
    let beside = stand_ins.into_iter().map(|shift| vec![shift]);
    let lines = [Vec::new()].into_iter().chain(beside).flat_map(|shifts| {
        let of = shares.of_scanned.iter().map(move |&of_scanned| Line {
            shifts: shifts.clone(),
            share: Some(Share { axis, of_scanned }),
        });
        of.collect::<Vec<Line>>()
    });
    Some(lines.collect())
}

impl StrategySettings for StagedSettings {
    const STRATEGY: &'static str = "quick";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        let intervals = self.trust.len();
        let one_each = "one interval per axis";
        require(intervals == space.dimension(), "trust", intervals, one_each)?;
        let mut stages: Vec<Box<dyn SearchStage>> = Vec::with_capacity(self.parts.len());
        let mut reuse_clones = true;
        let start = |points: usize, streams| {
            let others = points.saturating_sub(1);
            prepend_starts(space, hypercube(&self.trust, others, streams))
        };
        for (scope, part) in (1..).zip(&self.parts) {
            let streams = Streams::new(seed, scope);
            stages.push(match part {
                StageSettings::Memetic(memetic) => {
                    reuse_clones &= memetic.reuse_clones;
                    let inside = (space, self.trust.clone());
                    let start = start(memetic.population, streams);
                    Box::new(Memetic::new(memetic.clone(), inside, &start, streams)?)
                }
                StageSettings::Points { points } => {
                    Box::new(Points::new(space, &start(*points, streams)))
                }
                StageSettings::Scan(scan) => Box::new(Scan::new(scan.clone(), space)?),
                StageSettings::NoScan => continue,
                StageSettings::Refine(refine) => {
                    Box::new(Refine::new(refine.clone(), space, streams)?)
                }
                StageSettings::LeastSquares(settings) => {
                    Box::new(Levenberg::new(settings.clone(), space)?)
                }
            });
        }
        Ok(Box::new(Sequencer::new(stages, reuse_clones)))
    }
}
