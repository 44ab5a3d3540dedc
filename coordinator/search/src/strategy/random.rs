//! Individuals drawn evenly from the box of genes, and nothing else: what every other search must
//! beat, and a first look at a case.
//!
//! One batch: a Latin hypercube over the trust intervals or over the whole box, so that every part
//! of every gene's interval is met.
use super::{
    ask_tell::Strategy,
    conductor::Conductor,
    design::{Points, hypercube},
    offer::{Group, Preset, Promise},
    setting::{Setting, SettingsError, Values, check},
    settings::{Recipe, Settings, build_as},
};
use crate::{
    random::Streams,
    space::{Axis, Space},
};
use serde::{Deserialize, Serialize};

/// The preset.
pub const RANDOM: Preset = Preset {
    name: "random",
    summary: "individuals drawn evenly from the box of genes: what a search must beat",
    strategy: RandomSettings::STRATEGY,
    settings: |_| {
        Settings::of(&RandomSettings {
            points: 1000,
            within: Within::Trust,
        })
    },
    groups: &[Group::whole(SETTINGS)],
    promise: Promise {
        one_basin: 1.5,
        many_basins: 3.0,
        distance: 1.5,
        opens_at_recommended: false,
        valley: None,
    },
    build: build_as::<RandomSettings>,
};

/// What can be set by name.
const SETTINGS: &[Setting] = &[
    Setting::new("points", Values::Whole(1, 1_000_000), "individuals"),
    Setting::new(
        "within",
        Values::Words(&["trust", "bounds"]),
        "where they are drawn: where models usually survive, or the whole box",
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
        let points = hypercube(&intervals, self.points, Streams::new(seed, 0));
        let piece = Points::new(space, &points);
        Ok(Box::new(Conductor::new(vec![Box::new(piece)], false)))
    }
}
