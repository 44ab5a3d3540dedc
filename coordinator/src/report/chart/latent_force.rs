//! The periodic force that would explain the residual, over the revolution, at the likeliest joints.
use super::strip::{curve, stack, strip};
use crate::report::color::BLUE;
use crate::report::document::Figure;
use discrepancy::place::joint::JointEvidence;

/// Joints that are drawn at most.
const DRAWN: usize = 3;
/// Spacing of the curves (deg).
const STEP: usize = 2;

/// Draws the forces at the first `equivalent` joints of a ranking, which are not told apart; those that
/// explain anything. None where no force does.
pub(in crate::report) fn latent_forces(
    ranked: &[JointEvidence],
    equivalent: usize,
) -> Option<Figure> {
    let turn: Vec<f64> = (0..=360).step_by(STEP).map(f64::from).collect();
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
            let force: Vec<f64> = turn.iter().map(|turn| one.force_at(*turn)).collect();
            let line = curve("likeliest", BLUE, &turn, &force, 1.0);
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
        &strips,
    );
    Some(figure)
}
