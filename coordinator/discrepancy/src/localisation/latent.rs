//! Signatures of periodic probe forces (forces without a physical cause), joint by joint.
use crate::laboratory::Laboratory;
use crate::localisation::joint::{Harmonic, Latent};
use crate::model::derivative::candidate_term;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{absent, at_typical, sizes};
use crate::model::probe;
use crate::model::unknowns::Point;
use nalgebra::{DMatrix, DVector};
use protocol::announce::EffectDescriptor;
use record::Curves;
use std::collections::BTreeMap;

/// Highest harmonic of the probe forces.
const HARMONICS: usize = 5;

/// Whitened signature columns of the probe forces at one joint, with the harmonic of each.
#[derive(Default)]
struct Parts {
    columns: Vec<DVector<f64>>,
    harmonics: Vec<Harmonic>,
    unit: String,
}

/// Computes the signatures of a library's periodic probe forces at a fitted point, by joint.
pub(crate) async fn latents<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    library: &[EffectDescriptor],
) -> Result<Vec<Latent>, L::Error> {
    let generic = library.iter().filter(|effect| effect.generic);
    let probes: Vec<(&EffectDescriptor, usize)> = generic
        .filter_map(|effect| Some((effect, probe::order(&effect.id)?)))
        .filter(|(_, order)| *order <= HARMONICS)
        .collect();
    let metric = &experiments.on.metric;
    let exact = changes(experiments, fit, &probes).await?;
    let open: Vec<&EffectDescriptor> = probes
        .iter()
        .zip(&exact)
        .filter_map(|((effect, _), change)| change.is_none().then_some(*effect))
        .collect();
    let probed = |effect: &&EffectDescriptor| fit.with(effect, &at_typical(effect, &sizes(effect)));
    let points: Vec<Point> = open.iter().map(probed).collect();
    let mut curves = experiments.curves(&points).await?.into_iter();
    let base = metric.whiten(&fit.curves);
    let mut joints: BTreeMap<&str, Parts> = BTreeMap::new();
    for ((effect, order), change) in probes.iter().zip(exact) {
        let column = match change {
            Some(change) => Some(metric.whiten(&change)),
            None => curves
                .next()
                .flatten()
                .map(|curves| metric.whiten(&curves) - &base),
        };
        let (Some(column), Some(own)) = (column, effect.parameters.first()) else {
            continue;
        };
        let parts = joints.entry(effect.joint.as_str()).or_default();
        parts.unit.clone_from(&own.unit);
        parts.columns.push(column);
        parts.harmonics.push(Harmonic {
            order: *order,
            sine: probe::is_sine(&effect.id),
            amplitude: own.typical - own.absent,
        });
    }
    let latents = joints.into_iter().map(|(joint, parts)| Latent {
        joint: joint.to_owned(),
        columns: DMatrix::from_columns(&parts.columns),
        parts: parts.harmonics,
        unit: parts.unit,
    });
    Ok(latents.collect())
}

/// Computes the first-order change of the curves by each probe force at its typical amplitude, as far as the
/// laboratory provides derivatives; forces are linear in their amplitude.
async fn changes<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    probes: &[(&EffectDescriptor, usize)],
) -> Result<Vec<Option<Curves>>, L::Error> {
    let point = fit.point();
    let term = |effect: &EffectDescriptor| candidate_term(&point, effect, &absent(effect), 0);
    let terms = probes.iter().map(|(effect, _)| term(effect)).collect();
    let mut changes = experiments.changes(fit, terms).await?;
    for ((effect, _), change) in probes.iter().zip(&mut changes) {
        let [amount, ..] = at_typical(effect, &sizes(effect))[..] else {
            continue;
        };
        for x in change.iter_mut().flatten().flatten() {
            *x *= amount;
        }
    }
    Ok(changes)
}
