//! What is hidden in a set of records: effects, their sizes and coefficients, all drawn from a seed.
use crate::chain::{MORE_LOAD, MORE_SPEED, Sample, Sensors, Turns, record};
use crate::draw::Draw;
use crate::files::{Channels, Delivered, write};
use crate::law::{CATALOGUE, CUT_CARD, Hidden, Kind, Law, Nuisances, OUTSIDE, Tolerance, by_id};
use crate::machine::{Fineness, Variation, genes, turn};
use anyhow::Context as _;
use protocol::pumping_unit::PumpingUnit;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// What a set of records is to test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stratum {
    /// One effect that the library names, of a size that machines have.
    Single,
    /// Nothing.
    Zero,
    /// Two effects that the library names.
    Double,
    /// One effect that it does not name.
    Outside,
    /// One effect that it names, too small to be seen.
    Below,
    /// A delivered card that lacks the load's higher harmonics.
    Card,
}

impl Stratum {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 6] = [
        Self::Single,
        Self::Zero,
        Self::Double,
        Self::Outside,
        Self::Below,
        Self::Card,
    ];

    /// As it is written.
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

    /// Sizes are drawn log-uniform between these, in units of an effect's typical size.
    const fn sizes(self) -> [f64; 2] {
        match self {
            Self::Single | Self::Double | Self::Outside | Self::Zero | Self::Card => [0.5, 5.0],
            Self::Below => [0.01, 0.1],
        }
    }
}

/// What decides a set of records beside its case.
#[derive(Clone, Debug)]
pub struct Order {
    /// What everything is drawn from.
    pub seed: u64,
    /// What it is to test.
    pub stratum: Stratum,
    /// Effects that are not to be drawn.
    pub asked: Vec<Kind>,
    /// Its size in units of its typical size, if that is not to be drawn.
    pub times: Option<f64>,
    /// Factor on all noise.
    pub noise: f64,
    /// Cycles of each record.
    pub cycles: usize,
    /// How finely the machine is computed.
    pub fineness: Fineness,
    /// How good the instruments are.
    pub tolerance: Tolerance,
    /// What is recorded.
    pub channels: Channels,
}

/// Pairs whose records look alike: no sensible test would ask for both at once.
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

impl Order {
    /// Draws the effects.
    ///
    /// # Errors
    /// An effect that is asked for and does not exist.
    pub fn effects(&self) -> anyhow::Result<Vec<Hidden>> {
        let mut draw = Draw::new(self.seed, "effects");
        if self.stratum == Stratum::Card {
            let harmonics = self.times.unwrap_or(6.0 + draw.index(5) as f64);
            return Ok(vec![CUT_CARD.hide(harmonics, &mut draw)]);
        }
        let any = |draw: &mut Draw, from: &[Kind]| from[draw.index(from.len())];
        let from: &[Kind] = if self.stratum == Stratum::Outside {
            &OUTSIDE
        } else {
            &CATALOGUE
        };
        let mut kinds = self.asked.clone();
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
            let mut draw = Draw::new(self.seed, &format!("effect {k}"));
            let drawn = draw.log_between(lower, upper.min(kind.most));
            let sign = if kind.signed { draw.sign() } else { 1.0 };
            kind.hide(self.times.unwrap_or(drawn * sign), &mut draw)
        });
        Ok(hidden.collect())
    }
}

/// What is sealed of a set of records.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// What everything was drawn from.
    pub seed: u64,
    /// What it tests.
    pub stratum: Stratum,
    /// Name of the case.
    pub case: String,
    /// Factor on all noise.
    pub noise: f64,
    /// Cycles of each record.
    pub cycles: usize,
    /// Coefficients in the case's units.
    pub genes: std::collections::BTreeMap<String, f64>,
    /// What is hidden.
    pub effects: Vec<AnswerEffect>,
    /// By how much instruments, bearing and balance are off.
    #[serde(default)]
    pub nuisances: Nuisances,
    /// What is recorded.
    #[serde(default)]
    pub channels: Channels,
}

/// An effect that is sealed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnswerEffect {
    /// What it is.
    pub id: String,
    /// Whether the library names it.
    pub listed: bool,
    /// Name of its size.
    pub parameter: String,
    /// Its size.
    pub value: f64,
    /// The unit.
    pub unit: String,
    /// Its size in units of the typical one.
    pub times_scale: f64,
    /// Further numbers of its law, units in the names.
    pub shape: std::collections::BTreeMap<String, f64>,
}

impl AnswerEffect {
    fn of(hidden: &Hidden) -> Self {
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

/// Makes a set of records into an empty folder; what is in it comes back. A machine whose drawn
/// coefficients do not let it come round is drawn anew, up to five times.
///
/// # Errors
/// A machine that never comes round; what the file system refuses.
pub fn make(
    unit: &PumpingUnit,
    order: &Order,
    folder: &Path,
    name: &str,
) -> anyhow::Result<Answer> {
    let hidden = order.effects()?;
    let ids: Vec<&str> = hidden.iter().map(|one| one.kind.id).collect();
    let mut draw = Draw::new(order.seed, "nuisances");
    let nuisances = Nuisances::draw(&order.tolerance, &mut draw, &ids);
    let own = hidden.iter().map(|one| Arc::clone(&one.law));
    let laws: Vec<Arc<dyn Law>> = own.chain(nuisances.laws()).collect();
    let sensors = Sensors::with_noise(order.noise);
    let mut attempt = 0;
    let (values, all) = loop {
        let mut draw = Draw::new(order.seed, &format!("genes {attempt}"));
        let values = genes(&unit.case, &mut draw)?;
        let all: anyhow::Result<Vec<Turns>> = (0..unit.case.conditions.len())
            .map(|condition| turns(unit, condition, (&values, &laws), &order.fineness))
            .collect();
        match all {
            Ok(all) => break (values, all),
            Err(error) if attempt == 4 => {
                return Err(error).context("five machines, and none comes round");
            }
            Err(_) => attempt += 1,
        }
    };
    let conditions = unit.case.conditions.iter().zip(&unit.machine.conditions);
    for ((condition, working), turns) in conditions.zip(all) {
        let mut draw = Draw::new(order.seed, &format!("sensors {}", condition.name));
        let mut card = working.card.load_n.clone();
        for law in &laws {
            law.deliver(&mut card, crate::chain::speed(working.speed_rpm));
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

/// The turn of a condition, and how it changes with load and speed.
fn turns(
    unit: &PumpingUnit,
    condition: usize,
    machine: (&[f64], &[Arc<dyn Law>]),
    fineness: &Fineness,
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

/// The kind of an identifier that was asked for.
///
/// # Errors
/// If there is none.
pub fn asked_kind(id: &str) -> anyhow::Result<Kind> {
    let known = || {
        let all = CATALOGUE.iter().chain(&OUTSIDE).map(|kind| kind.id);
        all.collect::<Vec<_>>().join(", ")
    };
    by_id(id).with_context(|| format!("there is no effect `{id}`; there are {}", known()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(stratum: Stratum, seed: u64) -> Order {
        Order {
            seed,
            stratum,
            asked: Vec::new(),
            times: None,
            noise: 1.0,
            cycles: 5,
            fineness: Fineness::COARSE,
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
            assert!(OUTSIDE.iter().any(|kind| kind.id == outside[0].kind.id));
            let below = order(Stratum::Below, seed).effects().unwrap();
            assert!((below[0].size / below[0].kind.scale).abs() <= 0.1);
            let card = order(Stratum::Card, seed).effects().unwrap();
            assert!((6.0..=10.0).contains(&card[0].size));
            let asked = ["pin_clearance", "crank_speed_ripple"];
            let pair = Order {
                asked: asked.map(|id| by_id(id).unwrap()).to_vec(),
                ..order(Stratum::Double, seed)
            };
            let hidden = pair.effects().unwrap();
            assert_eq!([hidden[0].kind.id, hidden[1].kind.id], asked);
        }
        assert_eq!(ids.len(), CATALOGUE.len(), "all of them come up");
    }
}
