//! Random plan of a set of records: hidden effects, their sizes and the rope coefficients, all drawn from a
//! seed.
use crate::draw::RandomStream;
use crate::files::{Channels, Delivered, write};
use crate::law::{
    CATALOGUE, CUT_CARD, EffectKind, HiddenEffect, Nuisances, PlantedEffect, Tolerance, UNLISTED,
    by_id,
};
use crate::machine::{Resolution, Variation, draw_coefficients, turn};
use crate::measuring_chain::{MORE_LOAD, MORE_SPEED, Sample, Sensors, Turns, record};
use anyhow::Context as _;
use protocol::pumping_unit::PumpingUnit;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// Stratum of the suite: the kind of hidden effects in a set of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stratum {
    /// Stratum with one effect that the library contains, of a realistic size.
    Single,
    /// Stratum without a hidden effect.
    Zero,
    /// Stratum with two effects that the library contains.
    Double,
    /// Stratum with one effect that the library does not contain.
    Outside,
    /// Stratum with one effect that the library contains, too small to be detected.
    Below,
    /// Stratum with a delivered load card that lacks the load's higher harmonics.
    Card,
}

impl Stratum {
    /// All strata, in the order of the tables.
    pub const ALL: [Self; 6] = [
        Self::Single,
        Self::Zero,
        Self::Double,
        Self::Outside,
        Self::Below,
        Self::Card,
    ];

    /// Returns the name of the stratum as serialised.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Zero => "zero",
            Self::Double => "double",
            Self::Outside => "outside",
            Self::Below => "below",
            Self::Card => "card",
        }
    }

    /// Returns the bounds of the log-uniform distribution of sizes, as multiples of an effect's typical size.
    const fn sizes(self) -> [f64; 2] {
        match self {
            Self::Single | Self::Double | Self::Outside | Self::Zero | Self::Card => [0.5, 5.0],
            Self::Below => [0.01, 0.1],
        }
    }
}

/// Specification of a set of records to generate for a given case.
#[derive(Clone, Debug)]
pub struct SetSpec {
    /// Seed of all random draws.
    pub seed: u64,
    /// Stratum of the set: the kind of its hidden effects.
    pub stratum: Stratum,
    /// Effects to hide instead of drawn ones.
    pub requested_effects: Vec<EffectKind>,
    /// Size of each effect as a multiple of its typical size; drawn if `None`. In the `card` stratum the
    /// number of harmonics kept.
    pub size_factor: Option<f64>,
    /// Factor on the noise of all sensors.
    pub noise: f64,
    /// Number of cycles of each record.
    pub cycles: usize,
    /// Resolution of the simulation of the true machine in space and time.
    pub fineness: Resolution,
    /// Standard deviations of instrument, bearing and balance errors.
    pub tolerance: Tolerance,
    /// Channels that are recorded in addition to angle and load.
    pub channels: Channels,
}

/// Pairs of effects with similar records, which are never hidden together in a drawn set.
const ALIKE: [[&str; 2]; 8] = [
    ["pivot_friction", "stuffing_box_friction"],
    ["card_time_shift", "load_cell_lag"],
    ["crank_angle_offset", "amplifier_lag"],
    ["front_head_radius", "beam_inertia"],
    ["load_offset", "gauge_gain"],
    ["card_smoothing", "load_cell_lag"],
    ["pivot_friction", "rope_bending_loss"],
    ["stuffing_box_friction", "rope_bending_loss"],
];

impl SetSpec {
    /// Draws the hidden effects.
    ///
    /// # Errors
    /// None at present; unknown identifiers are refused by [`asked_kind`].
    pub fn effects(&self) -> anyhow::Result<Vec<PlantedEffect>> {
        let mut draw = RandomStream::new(self.seed, "effects");
        if self.stratum == Stratum::Card {
            let harmonics = self.size_factor.unwrap_or(6.0 + draw.index(5) as f64);
            return Ok(vec![CUT_CARD.instantiate(harmonics, &mut draw)]);
        }
        let any = |draw: &mut RandomStream, from: &[EffectKind]| from[draw.index(from.len())];
        let from: &[EffectKind] = if self.stratum == Stratum::Outside {
            &UNLISTED
        } else {
            &CATALOGUE
        };
        let mut kinds = self.requested_effects.clone();
        if self.stratum != Stratum::Zero && kinds.is_empty() {
            kinds.push(any(&mut draw, from));
        }
        while self.stratum == Stratum::Double && kinds.len() < 2 {
            let other = any(&mut draw, from);
            let first = kinds[0].id;
            let alike = |pair: &[&str; 2]| pair.contains(&first) && pair.contains(&other.id);
            if other.id != first && !ALIKE.iter().any(alike) {
                kinds.push(other);
            }
        }
        let [lower, upper] = self.stratum.sizes();
        let hidden = kinds.into_iter().enumerate().map(|(k, kind)| {
            let mut draw = RandomStream::new(self.seed, &format!("effect {k}"));
            let drawn = draw.log_between(lower, upper.min(kind.largest_multiple));
            let sign = if kind.signed { draw.sign() } else { 1.0 };
            kind.instantiate(self.size_factor.unwrap_or(drawn * sign), &mut draw)
        });
        Ok(hidden.collect())
    }
}

/// Sealed answer to one set of records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Seed of all random draws.
    pub seed: u64,
    /// Stratum of the set: the kind of its hidden effects.
    pub stratum: Stratum,
    /// Name of the case.
    pub case: String,
    /// Factor on the noise of all sensors.
    pub noise: f64,
    /// Number of cycles of each record.
    pub cycles: usize,
    /// Drawn rope coefficients by name, in the case's units.
    pub genes: std::collections::BTreeMap<String, f64>,
    /// Effects hidden in the set of records.
    pub effects: Vec<AnswerEffect>,
    /// Values of the nuisance parameters: errors of instruments, bearing and balance.
    #[serde(default)]
    pub nuisances: Nuisances,
    /// Channels that are recorded in addition to angle and load.
    #[serde(default)]
    pub channels: Channels,
}

/// Hidden effect in a sealed answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnswerEffect {
    /// Identifier of the effect.
    pub id: String,
    /// Whether the library of the program under test contains the effect.
    pub listed: bool,
    /// Name of the parameter that is the effect's size.
    pub parameter: String,
    /// Size of the hidden effect, in `unit`.
    pub value: f64,
    /// Unit of the hidden effect's size.
    pub unit: String,
    /// Size of the effect as a multiple of its typical size.
    pub times_scale: f64,
    /// Further parameters of the effect's law; the names end in the units.
    pub shape: std::collections::BTreeMap<String, f64>,
}

impl AnswerEffect {
    fn of(hidden: &PlantedEffect) -> Self {
        Self {
            id: hidden.kind.id.to_owned(),
            listed: CATALOGUE.iter().any(|kind| kind.id == hidden.kind.id),
            parameter: hidden.kind.parameter.to_owned(),
            value: hidden.size,
            unit: hidden.kind.unit.to_owned(),
            times_scale: hidden.size / hidden.kind.scale,
            shape: hidden.shape.clone(),
        }
    }
}

/// Generates a set of records in an empty folder and returns its answer. Draws new coefficients, up to five
/// times in all, if the simulation of a machine does not complete.
///
/// # Errors
/// Five machines whose simulations do not complete; file system errors.
pub fn make(
    unit: &PumpingUnit,
    order: &SetSpec,
    folder: &Path,
    name: &str,
) -> anyhow::Result<Answer> {
    let hidden = order.effects()?;
    let ids: Vec<&str> = hidden.iter().map(|one| one.kind.id).collect();
    let mut draw = RandomStream::new(order.seed, "nuisances");
    let nuisances = Nuisances::draw(&order.tolerance, &mut draw, &ids);
    let own = hidden.iter().map(|one| Arc::clone(&one.law));
    let laws: Vec<Arc<dyn HiddenEffect>> = own.chain(nuisances.laws()).collect();
    let sensors = Sensors::with_noise(order.noise);
    let mut attempt = 0;
    let (values, all) = loop {
        let mut draw = RandomStream::new(order.seed, &format!("genes {attempt}"));
        let values = draw_coefficients(&unit.case, &mut draw)?;
        let all: anyhow::Result<Vec<Turns>> = (0..unit.case.conditions.len())
            .map(|condition| turns(unit, condition, (&values, &laws), &order.fineness))
            .collect();
        match all {
            Ok(all) => break (values, all),
            Err(error) if attempt == 4 => {
                return Err(error).context("none of five drawn machines completed a revolution; choose another seed or check the case");
            }
            Err(_) => attempt += 1,
        }
    };
    let conditions = unit.case.conditions.iter().zip(&unit.machine.conditions);
    for ((condition, working), turns) in conditions.zip(all) {
        let mut draw = RandomStream::new(order.seed, &format!("sensors {}", condition.name));
        let mut card = working.card.load_n.clone();
        for law in &laws {
            law.distort_card(&mut card, crate::measuring_chain::speed(working.speed_rpm));
        }
        let (samples, lost): (Vec<Sample>, usize) =
            record(&turns, &card, &laws, (&sensors, order.cycles), &mut draw);
        let delivered = Delivered {
            condition: &condition.name,
            rpm: working.speed_rpm,
            cycles: order.cycles,
            card: &card,
            samples: &samples,
            lost,
            channels: order.channels,
        };
        write(folder, name, (&sensors, &order.tolerance), &delivered)?;
    }
    let named = unit.case.unknowns.iter().zip(&values);
    Ok(Answer {
        seed: order.seed,
        stratum: order.stratum,
        case: unit.case.name.clone(),
        noise: order.noise,
        cycles: order.cycles,
        genes: named
            .map(|(gene, value)| (gene.name.clone(), *value))
            .collect(),
        effects: hidden.iter().map(AnswerEffect::of).collect(),
        nuisances,
        channels: order.channels,
    })
}

/// Simulates a crank revolution under one condition three times: as given, with more load swing, and with
/// more speed.
fn turns(
    unit: &PumpingUnit,
    condition: usize,
    machine: (&[f64], &[Arc<dyn HiddenEffect>]),
    fineness: &Resolution,
) -> anyhow::Result<Turns> {
    let with = |load: f64, speed: f64| {
        turn(
            unit,
            condition,
            machine,
            Variation { load, speed },
            fineness,
        )
    };
    Ok(Turns {
        plain: with(0.0, 0.0)?,
        loaded: with(MORE_LOAD, 0.0)?,
        fast: with(0.0, MORE_SPEED)?,
    })
}

/// Returns the effect kind with the identifier `id`.
///
/// # Errors
/// An identifier of no effect; the message lists all known identifiers.
pub fn asked_kind(id: &str) -> anyhow::Result<EffectKind> {
    let known = || {
        let all = CATALOGUE.iter().chain(&UNLISTED).map(|kind| kind.id);
        all.collect::<Vec<_>>().join(", ")
    };
    by_id(id).with_context(|| {
        format!(
            "there is no effect `{id}`; the known effects are {}",
            known()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(stratum: Stratum, seed: u64) -> SetSpec {
        SetSpec {
            seed,
            stratum,
            requested_effects: Vec::new(),
            size_factor: None,
            noise: 1.0,
            cycles: 5,
            fineness: Resolution::COARSE,
            tolerance: Tolerance::USUAL,
            channels: Channels::default(),
        }
    }

    #[test]
    fn strata_hide_what_they_say() {
        let mut ids = std::collections::BTreeSet::new();
        for seed in 0..200 {
            let single = order(Stratum::Single, seed).effects().unwrap();
            let [one] = single.as_slice() else {
                unreachable!("one effect")
            };
            let times = (one.size / one.kind.scale).abs();
            assert!((0.5..=5.0).contains(&times));
            assert!(one.kind.signed || one.size > 0.0);
            ids.insert(one.kind.id);
            assert!(order(Stratum::Zero, seed).effects().unwrap().is_empty());
            let double = order(Stratum::Double, seed).effects().unwrap();
            assert!(double.len() == 2 && double[0].kind.id != double[1].kind.id);
            let outside = order(Stratum::Outside, seed).effects().unwrap();
            assert!(UNLISTED.iter().any(|kind| kind.id == outside[0].kind.id));
            let below = order(Stratum::Below, seed).effects().unwrap();
            assert!((below[0].size / below[0].kind.scale).abs() <= 0.1);
            let card = order(Stratum::Card, seed).effects().unwrap();
            assert!((6.0..=10.0).contains(&card[0].size));
            let asked = ["pin_clearance", "crank_speed_ripple"];
            let pair = SetSpec {
                requested_effects: asked.map(|id| by_id(id).unwrap()).to_vec(),
                ..order(Stratum::Double, seed)
            };
            let hidden = pair.effects().unwrap();
            assert_eq!([hidden[0].kind.id, hidden[1].kind.id], asked);
        }
        assert_eq!(ids.len(), CATALOGUE.len(), "all of them come up");
    }
}
