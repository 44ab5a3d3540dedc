//! Signatures of periodic forces without a cause, joint by joint.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{at_typical, sizes};
use crate::model::probe;
use crate::model::unknowns::Point;
use crate::place::joint::{Harmonic, Latent};
use nalgebra::{DMatrix, DVector};
use protocol::announce::EffectDescriptor;
use std::collections::BTreeMap;

/// Highest harmonic of the forces.
const HARMONICS: usize = 5;

/// What is gathered of one joint.
#[derive(Default)]
struct Parts {
    columns: Vec<DVector<f64>>,
    harmonics: Vec<Harmonic>,
    unit: String,
}

/// The periodic forces of a library at a fitted point.
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
    let probed = |effect| fit.with(effect, &at_typical(effect, &sizes(effect)));
    let points: Vec<Point> = probes.iter().map(|(effect, _)| probed(effect)).collect();
    let curves = experiments.curves(&points).await?;
    let metric = &experiments.on.metric;
    let base = metric.whiten(&fit.curves);
    let mut joints: BTreeMap<&str, Parts> = BTreeMap::new();
    for ((effect, order), curves) in probes.iter().zip(curves) {
        let (Some(curves), Some(own)) = (curves, effect.parameters.first()) else {
            continue;
        };
        let parts = joints.entry(effect.joint.as_str()).or_default();
        parts.unit.clone_from(&own.unit);
        parts.columns.push(metric.whiten(&curves) - &base);
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
