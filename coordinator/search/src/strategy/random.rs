//! Individuals drawn evenly from the box of genes, and nothing else: what every other search must
//! beat, and a first look at a case.
//!
//! One batch over the trust intervals or over the whole box: by chance alone, as a Latin hypercube, in which
//! every part of every gene's interval is met, or along Sobol's sequence.
use super::{
    ask_tell::Strategy,
    conductor::Conductor,
    design::{Points, hypercube},
    offer::{Group, Preset, Promise},
    setting::{Setting, SettingsError, Values, check, require},
    settings::{Recipe, Settings, build_as},
    sobol,
};
use crate::{
    random::{Phase, Streams},
    space::{Axis, Interval, Space},
};
use serde::{Deserialize, Serialize};

/// The preset.
pub const RANDOM: Preset = Preset {
    name: "random",
    summary: "individuals drawn from the box of genes by chance: what a search must beat",
    strategy: RandomSettings::STRATEGY,
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Chance)),
    groups: &[Group::whole(SETTINGS)],
    promise: Promise {
        one_basin: 1.5,
        many_basins: 3.0,
        distance: 1.5,
        opens_at_recommended: false,
        valley: None,
        chance: true,
    },
    build: build_as::<RandomSettings>,
};

/// The same as a Latin hypercube.
pub const LATIN_HYPERCUBE: Preset = Preset {
    name: "latin-hypercube",
    summary: "the same, every part of every gene's interval met once",
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Hypercube)),
    ..RANDOM
};

/// The same along Sobol's sequence.
pub const SOBOL: Preset = Preset {
    name: "sobol",
    summary: "the same along Sobol's sequence, even in all genes together",
    settings: |_| Settings::of(&RandomSettings::thousand(Design::Sobol)),
    ..RANDOM
};

/// What can be set by name.
const SETTINGS: &[Setting] = &[
    Setting::new("points", Values::Whole(1, 1_000_000), "individuals"),
    Setting::new(
        "within",
        Values::Words(&["trust", "bounds"]),
        "where they are drawn: where models usually survive, or the whole box",
    ),
    Setting::new(
        "design",
        Values::Words(&["chance", "hypercube", "sobol"]),
        "how they are drawn",
    ),
];

/// Settings of the search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomSettings {
    /// How many individuals.
    pub points: usize,
    /// Where they are drawn.
    pub within: Within,
    /// How they are drawn.
    #[serde(default)]
    pub design: Design,
}

impl RandomSettings {
    /// A thousand individuals where models usually survive.
    const fn thousand(design: Design) -> Self {
        Self {
            points: 1000,
            within: Within::Trust,
            design,
        }
    }
}

/// How points fill a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Each by chance.
    Chance,
    /// Every part of every interval is met once.
    #[default]
    Hypercube,
    /// Sobol's sequence, shifted by chance.
    Sobol,
}

/// A part of the box of genes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Within {
    /// The intervals in which models usually survive.
    Trust,
    /// The whole box.
    Bounds,
}

impl Recipe for RandomSettings {
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
                placed(&intervals, (0..self.points).map(unit))
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
                placed(&intervals, sobol::sobol(self.points, &shifts).into_iter())
            }
        };
        let piece = Points::new(space, &points);
        Ok(Box::new(Conductor::new(vec![Box::new(piece)], false)))
    }
}

/// Points of the unit cube in a box.
fn placed(intervals: &[Interval], units: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    let inside = |unit: Vec<f64>| {
        let axes = intervals.iter().zip(unit);
        axes.map(|(own, share)| own.from + share * own.length())
            .collect()
    };
    units.map(inside).collect()
}
