//! Simulation of the true machine: the case's drawing with hidden effects, discretised and integrated
//! differently from the program under test.
use crate::draw::RandomStream;
use crate::law::HiddenEffect;
use crate::turn::{Turn, Watch};
use anyhow::{Context as _, anyhow, bail};
use protocol::{
    case::Case,
    job::Failure,
    pumping_unit::{Coefficient, Discretisation, PumpingUnit},
};
use simulation::effect::Effect;
use simulation::integrator::method::Method;
use simulation::integrator::tableau::TR_BDF2;
use simulation::model::Machine;
use simulation::model::description::Description;
use simulation::run::{RunSettings, simulate};
use simulation::verdict::Verdict;
use std::sync::Arc;

/// Resolution of the truth simulation in space and time.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Length of a rope cylinder \[m\].
    pub cylinder: f64,
    /// Longest step of TR-BDF2 \[s\].
    pub step: f64,
    /// Number of head modes simulated in addition to those of the case, limited to those available.
    pub more_modes: usize,
    /// Number of samples per crank revolution at which sensor readings are computed.
    pub samples: usize,
}

impl Resolution {
    /// Resolution for a case with cylinders of 50 mm.
    pub const FULL: Self = Self {
        cylinder: 0.025,
        step: 0.002,
        more_modes: 6,
        samples: 1440,
    };

    /// Resolution for a case with cylinders longer than 75 mm, where a run must be quick.
    pub const COARSE: Self = Self {
        cylinder: 0.075,
        step: 0.004,
        more_modes: 2,
        samples: 1440,
    };
}

/// Median of each drawn coefficient: the optimised column of Table 3 of the paper, except for the axial
/// damping. The paper's 5201 N.s/m leaves axial vibrations of the rope undamped for minutes; a steel rope
/// loses some per cent of its energy per cycle, which the value here gives approximately.
const MEDIAN_COEFFICIENTS: [(Coefficient, f64); 10] = [
    (Coefficient::Kb1, 7.81e8),
    (Coefficient::Kb23, 2.26e8),
    (Coefficient::Kb4, 204.0),
    (Coefficient::Kb56, 308.0),
    (Coefficient::Cb1, 1.0e6),
    (Coefficient::Cb23, 4287.0),
    (Coefficient::Cb4, 45.0),
    (Coefficient::Cb56, 56.0),
    (Coefficient::Kc, 4.01e8),
    (Coefficient::Cc, 1020.0),
];

/// Standard deviation of the natural logarithm of a drawn rope coefficient; the distribution is truncated at
/// twice this value.
const SPREAD: f64 = 0.35;

/// Draws rope coefficients, in the units and the order of the case's unknowns; parameters of the case's
/// effects keep their start values.
///
/// # Errors
/// An unknown of the case that is not among the ten rope coefficients.
pub fn draw_coefficients(case: &Case, draw: &mut RandomStream) -> anyhow::Result<Vec<f64>> {
    let genes = case.unknowns.iter().map(|gene| {
        if gene.of_effect().is_some() {
            return Ok(gene.start);
        }
        let (_, middle) = MEDIAN_COEFFICIENTS
            .iter()
            .find(|(name, _)| gene.name == name.as_str())
            .with_context(|| format!("no median value is known for the unknown {}", gene.name))?;
        let value = middle * libm::exp(SPREAD * draw.clamped_normal());
        Ok(value.clamp(gene.lower, gene.upper))
    });
    genes.collect()
}

/// Relative changes of load and speed under which one crank turn is simulated.
#[derive(Clone, Copy, Debug, Default)]
pub struct Variation {
    /// Relative increase of the load swing: the load's deviation from its mean.
    pub load: f64,
    /// Relative increase of the crank speed.
    pub speed: f64,
}

impl Effect for Variation {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let mean = d.card.iter().sum::<f64>() / d.card.len() as f64;
        for load in &mut d.card {
            *load += self.load * (*load - mean);
        }
    }
}

/// Simulates one crank revolution of the machine under `laws` and returns the readings of ideal sensors,
/// changed by those laws that act on instruments.
///
/// # Errors
/// A case that cannot be refined to `fineness`, or a simulation that does not complete the revolution.
pub fn turn(
    unit: &PumpingUnit,
    condition: usize,
    (genes, laws): (&[f64], &[Arc<dyn HiddenEffect>]),
    variation: Variation,
    fineness: &Resolution,
) -> anyhow::Result<Turn> {
    let available = unit.machine.modal_head.frequencies_hz.len();
    let finer = Discretisation {
        cylinder_length_m: Some(fineness.cylinder),
        modes: Some((unit.machine.run.modes + fineness.more_modes).min(available)),
        ..Discretisation::default()
    };
    let unit = worker::pumping_unit::refined(unit, &finer).map_err(|why| refused(&why))?;
    let law = worker::pumping_unit::rope_law(&unit, genes).map_err(|why| refused(&why))?;
    let plain = worker::pumping_unit::machine(&unit, condition).map_err(|why| refused(&why))?;
    let mut description = plain.description;
    description.crank.speed *= 1.0 + variation.speed;
    let acting = laws.iter().map(|law| {
        let effect: Arc<dyn Effect> = Arc::clone(law) as Arc<dyn Effect>;
        effect
    });
    let varied: Arc<dyn Effect> = Arc::new(variation);
    let effects: Vec<Arc<dyn Effect>> = acting.chain([varied]).collect();
    let machine = Machine::with_effects(description, plain.layout.modes, &effects)?;
    let settings = RunSettings {
        method: Method::from(&TR_BDF2),
        lead_in: 240_f64.to_radians(),
        samples: fineness.samples,
        tolerance: 0.3,
        longest_step: fineness.step,
        budget: 2_000_000,
        head_start: 200_000,
        ..RunSettings::default()
    };
    let mut watch = Watch::default();
    let result = simulate(&machine, &law, &settings, &mut watch);
    if result.verdict != Verdict::Complete {
        bail!(
            "the simulation did not complete a revolution: {:?}",
            result.verdict
        );
    }
    let mut turn = watch.turn(&machine, &law);
    for law in laws {
        law.distort_readings(&mut turn);
    }
    Ok(turn)
}

fn refused(failure: &Failure) -> anyhow::Error {
    anyhow!("the worker refused the case: {failure:?}")
}
