//! The three maps of where simulation and measurement part.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage};
use crate::locate::{angle, joint, order};
use crate::model::{Model, absent};
use crate::score::family_wise;
use crate::settings::Settings;
use crate::tangent::Tangent;
use nalgebra::{DMatrix, DVector};
use protocol::announce::EffectDescriptor;
use std::collections::BTreeMap;

/// Where the disagreement lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Where {
    /// Crank angle x channel.
    pub angle: angle::AngleMap,
    /// Channel x order.
    pub order: order::OrderMap,
    /// Joints at which a periodic force would explain it, the most likely first.
    pub joints: Vec<joint::JointEvidence>,
    /// How many of them are not told apart.
    pub equivalent: usize,
}

impl Where {
    /// Whether the map by angle or that by order rejects that only noise is left, each at a level over
    /// all its places.
    pub fn rejects(&self, alpha: f64) -> bool {
        let entries: usize = self.order.ratio.iter().map(Vec::len).sum();
        let mut peaks = self.order.peaks.iter();
        self.angle.windows.iter().any(|w| w.p_value <= alpha)
            || peaks.any(|peak| family_wise(peak.p_value, entries) <= alpha)
    }
}

/// Share of false entries that a map may hold.
const LEVEL: f64 = 0.05;
/// Highest harmonic of the latent forces.
const HARMONICS: usize = 5;

/// Draws the maps of a fit's residual.
///
/// # Errors
/// Of the laboratory.
pub async fn look<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    library: &[EffectDescriptor],
    (settings, freedom): (&Settings, f64),
    phi: f64,
) -> Result<Where, L::Error> {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let residual = &fit.search.settled_residual();
    let latents = latents(lab, bench, fit, library).await?;
    let joints = joint::rank(&latents, residual, &tangent);
    Ok(Where {
        angle: angle::map(
            residual,
            &deviations(bench, &tangent),
            (&bench.metric, &tangent),
            settings.draws,
            LEVEL,
        ),
        order: orders(bench, fit, freedom),
        equivalent: joint::indistinguishable(&joints, phi),
        joints,
    })
}

/// The map by order alone of what a fit leaves; it takes no simulation.
pub fn orders(bench: &Bench, fit: &Fit, freedom: f64) -> order::OrderMap {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let residual = fit.search.settled_residual();
    order::map(&residual, &bench.metric, &tangent, freedom, LEVEL)
}

/// What recalibration leaves of each cycle's deviation from the mean, whitened.
pub fn deviations(bench: &Bench, tangent: &Tangent) -> Vec<DVector<f64>> {
    let cycles = bench.record.cycles.iter();
    cycles
        .map(|cycle| tangent.project(&(bench.metric.whiten(cycle) - &bench.measured)))
        .collect()
}

/// The form of a force without a cause: the last part of its identifier.
pub fn form(id: &str) -> &str {
    id.rsplit_once('.').map_or(id, |(_, form)| form)
}

/// Whether a periodic probe is a sine.
pub fn is_sine(id: &str) -> bool {
    form(id).starts_with("sin")
}

/// The order of a periodic probe, from its identifier `probe.JOINT.cosH`, `.sinH` or `.const`.
pub fn probe_order(id: &str) -> Option<usize> {
    let form = form(id);
    if form == "const" {
        return Some(0);
    }
    let digits = form
        .strip_prefix("cos")
        .or_else(|| form.strip_prefix("sin"))?;
    digits.parse().ok()
}

/// Signatures of the periodic probes, joint by joint.
async fn latents<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    library: &[EffectDescriptor],
) -> Result<Vec<joint::Latent>, L::Error> {
    let probes: Vec<(&EffectDescriptor, usize)> = library
        .iter()
        .filter(|effect| effect.generic)
        .filter_map(|effect| Some((effect, probe_order(&effect.id)?)))
        .filter(|(_, order)| *order <= HARMONICS)
        .collect();
    let models: Vec<(Model, Vec<f64>)> = probes
        .iter()
        .map(|(effect, _)| probed(fit, effect))
        .collect();
    let points: Vec<(&Model, &[f64])> = models.iter().map(|(m, x)| (m, x.as_slice())).collect();
    let curves = bench.curves(lab, Stage::Where, &points).await?;
    let base = bench.metric.whiten(&fit.curves);
    let mut joints: BTreeMap<&str, Parts> = BTreeMap::new();
    for ((effect, order), curves) in probes.iter().zip(curves) {
        let (Some(curves), Some(own)) = (curves, effect.parameters.first()) else {
            continue;
        };
        let parts = joints.entry(effect.joint.as_str()).or_default();
        parts.unit.clone_from(&own.unit);
        parts.columns.push(bench.metric.whiten(&curves) - &base);
        parts.harmonics.push(joint::Harmonic {
            order: *order,
            sine: is_sine(&effect.id),
            amplitude: own.typical - own.absent,
        });
    }
    let latents = joints.into_iter().map(|(joint, parts)| joint::Latent {
        joint: joint.to_owned(),
        columns: DMatrix::from_columns(&parts.columns),
        parts: parts.harmonics,
        unit: parts.unit,
    });
    Ok(latents.collect())
}

/// What is gathered of one joint.
#[derive(Default)]
struct Parts {
    columns: Vec<DVector<f64>>,
    harmonics: Vec<joint::Harmonic>,
    unit: String,
}

/// A fitted point with one effect at its typical size.
fn probed(fit: &Fit, effect: &EffectDescriptor) -> (Model, Vec<f64>) {
    let mut x = fit.x().to_vec();
    let mut own = absent(effect);
    for k in crate::model::sizes(effect) {
        let p = &effect.parameters[k];
        own[k] = (p.typical - p.absent) / p.scale;
    }
    x.extend(own);
    (fit.model.with(effect), x)
}
