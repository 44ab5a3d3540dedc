//! What is never exact about a measurement, constant while it lasts: gains of instruments, marks that are a
//! little off, a friction that everybody knows is there. How good each is is known beforehand, so each
//! is a parameter with a prior in every fit, test and interval, and no discovery while it stays within it.

/// Something that is off by a little, one standard deviation known.
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// The effect of the library that it is, or the name of a channel's gain.
    pub id: String,
    /// Which of the effect's sizes.
    pub parameter: String,
    /// Unit of the deviation.
    pub unit: String,
    /// How it acts.
    pub acts: Acts,
    /// One standard deviation about the absent value.
    pub deviation: f64,
    /// Whether it is never negative: half a normal distribution.
    pub never_negative: bool,
    /// Whether nobody stated the deviation: it is what such instruments usually have.
    pub assumed: bool,
}

/// How a nuisance acts on what is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// As the effect of its name does; where the library lacks it, it is left out.
    Effect,
    /// A channel reads `(1 + x) y`, by the place of its curve among those of its condition.
    Gain {
        /// That place.
        curve: usize,
    },
}
