//! Maps of where simulation and measurement disagree: by abscissa, by order and by joint.
use crate::baseline::base::Baseline;
use crate::baseline::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::score::family_wise;
use crate::linear::tangent::Tangent;
use crate::linear::whitened::WhitenedRecord;
use crate::localisation::latent::latents;
use crate::localisation::residual::Residual;
use crate::localisation::{joint, order, whiteness, window_test};
use crate::model::fit::Fit;
use crate::thresholds::MAPS;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// Maps of the abscissa, orders and joints at which simulation and measurement disagree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Localisation {
    /// Map of the residual by abscissa and channel.
    pub along: window_test::AlongMap,
    /// Map of the residual by channel and order of the period; `None` for a record without a period.
    pub order: order::OrderMap,
    /// Joints at which a periodic force would explain the residual, the most likely first.
    pub joints: Vec<joint::JointEvidence>,
    /// Number of leading joints in `joints` that the record cannot tell apart.
    pub equivalent: usize,
}

impl Localisation {
    /// Returns whether the map by abscissa or the map by order rejects the hypothesis of noise alone, each at
    /// the family-wise level `alpha`.
    pub fn rejects(&self, alpha: f64) -> bool {
        let entries: usize = self.order.ratio.iter().map(Vec::len).sum();
        let mut peaks = self.order.peaks.iter();
        self.along.windows.iter().any(|w| w.p_value <= alpha)
            || peaks.any(|peak| family_wise(peak.p_value, entries) <= alpha)
    }
}

/// Computes the maps of where the residual of the recalibrated model differs from noise.
pub(crate) async fn localise<L: Laboratory>(
    session: &mut Session<'_, L>,
) -> Result<Localisation, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let fit = &base.fit;
    let tangent = fit.tangent();
    let left = fit.search.linear_minimum_residual();
    let latents = if session.lab.has_budget(Stage::Where) {
        latents(&mut session.experiments(Stage::Where), fit, &inputs.library).await?
    } else {
        Vec::new()
    };
    let joints = joint::rank(&latents, &left, &tangent);
    let residual = Residual {
        values: &left,
        metric: &base.record.metric,
        tangent: &tangent,
    };
    let deviations = deviations(&base.record, &tangent);
    Ok(Localisation {
        along: window_test::map::map(&residual, &deviations, inputs.thresholds.draws, MAPS),
        order: order::map(&residual, base.record.metric.freedom(), MAPS),
        equivalent: joint::indistinguishable(&joints, fit.misfit()),
        joints,
    })
}

/// Returns the p-value of the test that the residual of a fit is white.
pub(crate) fn white(base: &Baseline, fit: &Fit) -> f64 {
    let residual = Residual {
        values: &fit.search.linear_minimum_residual(),
        metric: &base.record.metric,
        tangent: &fit.tangent(),
    };
    whiteness::p_value(&order::powers(&residual), base.record.metric.freedom())
}

/// Returns the whitened deviation of each cycle from the mean after projection on the complement of the
/// tangent space.
fn deviations(on: &WhitenedRecord, tangent: &Tangent) -> Vec<DVector<f64>> {
    let deviation = |cycle| tangent.project(&(on.metric.whiten(cycle) - &on.measured));
    on.record.cycles.iter().map(deviation).collect()
}
