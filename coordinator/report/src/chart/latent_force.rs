//! Unknown periodic force that would explain the residual, over one period, at the likeliest joints.
use super::axis::ChartAxis;
use super::strip::{curve, stack, strip};
use crate::color::BLUE;
use crate::document::Figure;
use discrepancy::localisation::joint::JointEvidence;
use protocol::case::Abscissa;

/// Maximum number of joints whose force is drawn.
const DRAWN: usize = 3;
/// Spacing of the points of a force curve, in 360ths of the period.
const STEP: usize = 2;

/// Draws the unknown force over one period of the abscissa at each of the first `equivalent`,
/// indistinguishable joints of a ranking where a force improves the fit. Returns `None` if it does at no
/// joint.
pub(crate) fn latent_forces(
    ranked: &[JointEvidence],
    equivalent: usize,
    (abscissa, axis): (&Abscissa, &ChartAxis),
) -> Option<Figure> {
    let period = abscissa.period?;
    let phases: Vec<f64> = (0..=360).step_by(STEP).map(f64::from).collect();
    let at: Vec<f64> = phases
        .iter()
        .map(|phase| period * (phase / 360.0))
        .collect();
    let drawn: Vec<(String, &JointEvidence)> = ranked
        .iter()
        .take(equivalent)
        .filter(|one| one.log_bayes > 0.0 && !one.force.is_empty())
        .take(DRAWN)
        .map(|one| {
            (
                format!("{} [{}]", one.joint.replace('_', " "), one.unit),
                one,
            )
        })
        .collect();
    if drawn.is_empty() {
        return None;
    }
    let strips: Vec<_> = drawn
        .iter()
        .map(|(title, one)| {
            let force: Vec<f64> = phases.iter().map(|phase| one.force_at(*phase)).collect();
            let line = curve("likeliest", BLUE, &at, &force, 1.0);
            strip(title, 110.0, vec![line])
        })
        .collect();
    let title = "The periodic force that would explain the residual";
    let figure = stack(
        "where_force",
        title,
        format!(
            "{title}, were it at that joint: the likeliest amplitudes of its first harmonics, each alone \
             explaining what is left. Its shape says more than its place: a step where the motion turns is \
             friction, a bump at one angle a spot, a wave with the load a stiffness."
        ),
        axis,
        &strips,
    );
    Some(figure)
}
