//! The three maps of where simulation and measurement part.
use crate::ground::base::Base;
use crate::ground::session::Session;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::score::family_wise;
use crate::linear::tangent::Tangent;
use crate::model::fit::Fit;
use crate::place::latent::latents;
use crate::place::residual::Residual;
use crate::place::{along, joint, order, whiteness};
use crate::record::whitened::WhitenedRecord;
use crate::thresholds::MAPS;
use nalgebra::DVector;

/// Where the disagreement lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Where {
    /// By abscissa and channel.
    pub along: along::AlongMap,
    /// By channel and order of the period, where there is one.
    pub order: order::OrderMap,
    /// Joints at which a periodic force would explain it, the most likely first.
    pub joints: Vec<joint::JointEvidence>,
    /// How many of them are not told apart.
    pub equivalent: usize,
}

impl Where {
    /// Whether the map by abscissa or that by order rejects that only noise is left, each at a level over
    /// all its places.
    pub fn rejects(&self, alpha: f64) -> bool {
        let entries: usize = self.order.ratio.iter().map(Vec::len).sum();
        let mut peaks = self.order.peaks.iter();
        self.along.windows.iter().any(|w| w.p_value <= alpha)
            || peaks.any(|peak| family_wise(peak.p_value, entries) <= alpha)
    }
}

/// Draws the maps of what the recalibrated model leaves.
pub(crate) async fn look<L: Laboratory>(session: &mut Session<'_, L>) -> Result<Where, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let fit = &base.fit;
    let tangent = fit.tangent();
    let left = fit.search.settled_residual();
    let latents = if session.lab.may(Stage::Where) {
        latents(&mut session.experiments(Stage::Where), fit, &inputs.library).await?
    } else {
        Vec::new()
    };
    let joints = joint::rank(&latents, &left, &tangent);
    let residual = Residual {
        left: &left,
        metric: &base.on.metric,
        tangent: &tangent,
    };
    let deviations = deviations(&base.on, &tangent);
    Ok(Where {
        along: along::map::map(&residual, &deviations, inputs.thresholds.draws, MAPS),
        order: order::map(&residual, base.on.metric.freedom(), MAPS),
        equivalent: joint::indistinguishable(&joints, fit.dispersion()),
        joints,
    })
}

/// Tail probability that what a fit leaves is white.
pub(crate) fn white(base: &Base, fit: &Fit) -> f64 {
    let residual = Residual {
        left: &fit.search.settled_residual(),
        metric: &base.on.metric,
        tangent: &fit.tangent(),
    };
    whiteness::p_value(&order::powers(&residual), base.on.metric.freedom())
}

/// What recalibration leaves of each cycle's deviation from the mean, whitened.
fn deviations(on: &WhitenedRecord, tangent: &Tangent) -> Vec<DVector<f64>> {
    let deviation = |cycle| tangent.project(&(on.metric.whiten(cycle) - &on.measured));
    on.record.cycles.iter().map(deviation).collect()
}
