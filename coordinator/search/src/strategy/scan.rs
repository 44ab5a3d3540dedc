//! Line scans: one unknown is varied over a grid while the others stay fixed or follow a rule of the line.
//!
//! A narrow valley that random steps miss is found by brute force along the one axis that is known to be
//! narrow. All stations are independent, so any number of workers is busy at once.
use super::{
    archive::{Archive, EvaluatedIndividual},
    proposal::Purpose,
    setting::{AllowedValues, Setting, SettingsError, check, require, settings},
    stage::{Batch, ProposalDraft, SearchStage},
};
use crate::space::Space;
use serde::{Deserialize, Serialize};

/// Centre of a scan's grid along the scanned axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Center {
    /// Centre at the start value of the scanned unknown.
    Start,
    /// Centre at the value that the scanned unknown has at the point through which the line passes.
    Point,
}

/// Offset of an unknown from its value at the base point of a scan, the same along a whole scan line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shift {
    /// Index of the axis of the shifted unknown.
    pub axis: usize,
    /// Offset of the unknown from its value at the base point (coordinate).
    pub by: f64,
}

/// Unknown held at a constant ratio to the scanned unknown along a whole scan line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Index of the axis of the unknown that follows the scanned one.
    pub axis: usize,
    /// Ratio of the unknown's value to that of the scanned unknown.
    pub of_scanned: f64,
}

/// Line of grid points (stations) along the scanned axis, through a base point or offset from it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Unknowns that are offset from their values at the base point.
    pub shifts: Vec<Shift>,
    /// Unknown that is held at a constant ratio to the scanned one, if any.
    pub share: Option<Share>,
}

settings! {
    /// Settings of a line scan.
    pub struct ScanSettings, pub(super) table SETTINGS {
        /// Index of the scanned axis.
        pub axis: usize;
        /// Centre of the scan's grid along the scanned axis.
        pub center: Center;
        pub below: f64 = "how far below its centre the scan begins [decade]", AllowedValues::Real(0.0, 10.0);
        pub above: f64 = "how far above its centre the scan ends [decade]", AllowedValues::Real(0.0, 10.0);
        pub step: f64 =
            "spacing of the scan [decade]; a valley narrower than twice this may be missed",
            AllowedValues::Real(2e-4, 1.0);
        pub points: usize = "how many of the best points are scanned", AllowedValues::Whole(1, 1000);
        /// Minimum distance between the base points of the scan, along at least one axis other than the scanned
        /// one (coordinate).
        pub apart: f64;
        /// Scan lines through each base point, or offset from it; at least one.
        pub lines: Vec<Line>;
    }
}

impl ScanSettings {
    fn stations(&self) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked: positive and not above 100,000"
        )]
        let intervals = ((self.below + self.above) / self.step).round() as usize;
        intervals + 1
    }

    /// Returns all grid points of the scan for one base point, line by line (coordinates).
    pub fn points_around(&self, space: &Space, base: &[f64]) -> Vec<Vec<f64>> {
        let middle = match self.center {
            Center::Start => 0.0,
            Center::Point => base[self.axis],
        };
        let point = |line: &Line, station: usize| {
            let mut point = base.to_vec();
            for shift in &line.shifts {
                point[shift.axis] += shift.by;
            }
            point[self.axis] = middle - self.below + self.step * station as f64;
            if let Some(share) = line.share {
                let axes = space.axes();
                let wanted = share.of_scanned * axes[self.axis].value(point[self.axis]);
                point[share.axis] = axes[share.axis].coordinate(wanted);
            }
            point
        };
        let stations = 0..self.stations();
        let along = |line| stations.clone().map(move |station| point(line, station));
        self.lines.iter().flat_map(along).collect()
    }

    pub(super) fn check(&self, space: &Space) -> Result<(), SettingsError> {
        check(self, SETTINGS)?;
        let least = "at least one";
        require(
            self.below + self.above > 0.0,
            "length of a scan",
            0,
            "above 0",
        )?;
        require(!self.lines.is_empty(), "lines of a scan", 0, least)?;
        let shifts = self.lines.iter().flat_map(|line| &line.shifts);
        let shares = self.lines.iter().filter_map(|line| line.share.as_ref());
        let beside = shifts.map(|shift| shift.axis).chain(shares.map(|s| s.axis));
        for axis in beside.chain([self.axis]) {
            let known = axis < space.dimension();
            require(known, "axis of a scan", axis, "one that is searched")?;
        }
        Ok(())
    }
}

/// Line scan as one batch-wise part (stage) of a strategy.
pub struct Scan {
    settings: ScanSettings,
    space: Space,
    done: bool,
    running: usize,
    /// Genes of each base point and of the stations on its lines, in the order of the base points.
    groups: Vec<Vec<Vec<f64>>>,
}

impl Scan {
    /// Creates a scan from its settings.
    ///
    /// # Errors
    /// If a setting lies outside its range.
    pub fn new(settings: ScanSettings, space: &Space) -> Result<Self, SettingsError> {
        settings.check(space)?;
        Ok(Self {
            settings,
            space: space.clone(),
            done: false,
            running: 0,
            groups: Vec::new(),
        })
    }

    /// Returns the base points of the scan: the best of each group, or the best points found so far that are
    /// far enough apart (coordinate).
    fn bases(&self, archive: &Archive) -> Vec<Vec<f64>> {
        let groups = archive.start_groups();
        if groups.len() > 1 {
            let best = groups.iter().filter_map(|group| group.first());
            let best = best.map(|genes| self.space.point(genes));
            return best.take(self.settings.points).collect();
        }
        let mut bases: Vec<Vec<f64>> = Vec::new();
        for entry in archive.ranked() {
            let point = self.space.point(&entry.genes);
            let far = |base: &Vec<f64>| {
                let pairs = base.iter().zip(&point).enumerate();
                let others = pairs.filter(|(own, _)| *own != self.settings.axis);
                others.fold(0.0, |far: f64, (_, (a, b))| far.max((a - b).abs()))
                    >= self.settings.apart
            };
            if bases.iter().all(far) {
                bases.push(point);
            }
            if bases.len() >= self.settings.points {
                break;
            }
        }
        bases
    }
}

impl SearchStage for Scan {
    fn plan(&mut self, archive: &Archive) -> Option<Batch> {
        if std::mem::replace(&mut self.done, true) {
            return None;
        }
        let mut drafts = Vec::new();
        for base in self.bases(archive) {
            let stations = self.settings.points_around(&self.space, &base).into_iter();
            let stations: Vec<_> = stations.map(|point| self.space.values(&point)).collect();
            drafts.extend(stations.iter().map(|genes| ProposalDraft {
                genes: genes.clone(),
                purpose: Purpose::Scan,
            }));
            let base = self.space.values(&base);
            self.groups.push([vec![base], stations].concat());
        }
        self.running = drafts.len();
        (!drafts.is_empty()).then_some(Batch {
            generation: 1,
            drafts,
        })
    }

    fn absorb(&mut self, _results: &[EvaluatedIndividual]) {
        self.running = 0;
    }

    fn start_groups(&self, archive: &Archive) -> Vec<Vec<Vec<f64>>> {
        if self.groups.len() < 2 {
            return Vec::new();
        }
        let ranked = |group: &Vec<Vec<f64>>| {
            let known = group.iter().filter_map(|genes| archive.find(genes));
            let mut known: Vec<_> = known.filter(|one| one.result.survived()).collect();
            known.sort_by(|a, b| a.result.order(b.result));
            known.into_iter().map(|one| one.genes.clone()).collect()
        };
        self.groups.iter().map(ranked).collect()
    }

    fn generations(&self) -> u32 {
        1
    }

    fn remaining(&self) -> u64 {
        if self.done {
            return self.running as u64;
        }
        (self.settings.points * self.settings.lines.len() * self.settings.stations()) as u64
    }
}
