//! Uniform sampling of the box of genes: the baseline for every other search, and a first look at a case.
//!
//! One batch over the trust intervals or over the whole box: independent random points, a Latin hypercube
//! (exactly one point in every part of every gene's interval), or a Sobol sequence.
use super::{
    ask_tell::Strategy,
    definition::{Preset, SettingGroup},
    design::{Points, hypercube},
    sequencer::Sequencer,
    setting::{AllowedValues, Setting, SettingsError, check, require, settings},
    settings::{Settings, StrategySettings, build_as},
    sobol,
};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Interval, Space},
};
use serde::{Deserialize, Serialize};

/// Preset that samples independent random points.
pub const RANDOM: Preset = Preset {
    name: "random",
    summary: "individuals drawn at random from the box of genes: a baseline for other searches",
    strategy: RandomSettings::STRATEGY,
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Chance)),
    groups: &[SettingGroup::whole(SETTINGS)],
    slots: 128,
    build: build_as::<RandomSettings>,
};

/// Preset that samples a Latin hypercube.
pub const LATIN_HYPERCUBE: Preset = Preset {
    name: "latin-hypercube",
    summary: "Latin hypercube: one individual in every part of every gene's interval",
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Hypercube)),
    ..RANDOM
};

/// Preset that samples a Sobol sequence.
pub const SOBOL: Preset = Preset {
    name: "sobol",
    summary: "Sobol sequence: individuals spread evenly over all genes together",
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Sobol)),
    ..RANDOM
};

settings! {
    /// Settings of the uniform sampling: number of individuals, sampled region, and design.
    pub struct RandomSettings, table SETTINGS {
        pub points: usize = "individuals", AllowedValues::Whole(1, 1_000_000);
        pub within: Within =
            "region of the draw: where simulations usually succeed, or the whole box",
            AllowedValues::Words(&["trust", "bounds"]);
        #[serde(default)]
        pub design: Design = "sampling design", AllowedValues::Words(&["chance", "hypercube", "sobol"]);
    }
}

impl RandomSettings {
    const fn thousand(design: Design) -> Self {
        Self {
            points: 1000,
            within: Within::Trust,
            design,
        }
    }
}

/// Sampling design of points in a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Independent uniform random points.
    Chance,
    /// Latin hypercube of `n` points: exactly one point in each of `n` equal parts of every gene's interval.
    #[default]
    Hypercube,
    /// Sobol sequence with a random digital shift.
    Sobol,
}

/// Region of the box of genes that is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Within {
    /// Trust intervals of all genes, in which simulations usually succeed.
    Trust,
    /// The whole box, between the bounds of all genes.
    Bounds,
}

impl StrategySettings for RandomSettings {
    const STRATEGY: &'static str = "random";

    fn build(&self, space: &Space, seed: u64) -> Result<Box<dyn Strategy>, SettingsError> {
        check(self, SETTINGS)?;
        let interval = |axis: &Axis| match self.within {
            Within::Trust => axis.trust,
            Within::Bounds => axis.interval(),
        };
        let intervals: Vec<_> = space.axes().iter().map(interval).collect();
        let streams = Streams::new(seed, 0);
        let points = match self.design {
            Design::Hypercube => hypercube(&intervals, self.points, streams),
            Design::Chance => {
                let unit = |k| {
                    let mut stream = streams.at(0, Phase::Initial, k);
                    intervals.iter().map(|_| stream.unit()).collect()
                };
                scale_to_box(&intervals, (0..self.points).map(unit))
            }
            Design::Sobol => {
                let genes = intervals.len();
                let most = format!("at most {} for this design", sobol::MOST);
                require(genes <= sobol::MOST, "genes", genes, &most)?;
                let shift = |k| {
                    let bits = streams.at(0, Phase::Initial, k).bits().to_le_bytes();
                    u32::from_le_bytes([bits[0], bits[1], bits[2], bits[3]])
                };
                let shifts: Vec<u32> = (0..genes).map(shift).collect();
                scale_to_box(&intervals, sobol::sobol(self.points, &shifts).into_iter())
            }
        };
        let stage = Points::new(space, &points);
        Ok(Box::new(Sequencer::new(vec![Box::new(stage)], false)))
    }
}

/// Maps points of the unit cube into a box.
fn scale_to_box(intervals: &[Interval], units: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    let inside = |unit: Vec<f64>| {
        let axes = intervals.iter().zip(unit);
        axes.map(|(own, share)| own.from + share * own.length())
            .collect()
    };
    units.map(inside).collect()
}
