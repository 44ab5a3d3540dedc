//! Bar chart of the Bayes factors of an unknown periodic force at each joint.
use super::canvas::{Pen, TextStyle, render};
use crate::color::{BAND, BLUE, GREY, INK};
use crate::document::Figure;
use crate::number::fixed;
use discrepancy::localisation::joint::JointEvidence;

const WIDTH: f64 = 720.0;
const ROW: f64 = 24.0;
const TOP: f64 = 30.0;
const LEFT: f64 = 130.0;
const BAR: f64 = 380.0;

/// Draws the Bayes factors of a ranking of joints, best first; the first `equivalent` joints are
/// indistinguishable. Returns `None` for an empty ranking.
pub(crate) fn joints(ranked: &[JointEvidence], equivalent: usize) -> Option<Figure> {
    let best = ranked.first()?;
    let end = best.log_bayes.max(1.0);
    let height = TOP + ROW * ranked.len() as f64 + 8.0;
    let title = "Where a periodic force would explain the residual";
    let svg = render((WIDTH, height), title, |canvas| {
        let head = TextStyle::new(10.5, GREY);
        canvas.text(
            (LEFT, 14.0),
            "log Bayes factor against no force [nats]",
            head,
        );
        for (index, one) in ranked.iter().enumerate() {
            let y = TOP + (index as f64 + 0.5) * ROW - 2.0;
            let inside = index < equivalent;
            let ink = if inside { INK } else { GREY };
            let name = TextStyle::new(11.0, ink).right();
            canvas.text((LEFT - 10.0, y), &one.joint.replace('_', " "), name);
            let length = BAR * (one.log_bayes / end).clamp(0.0, 1.0);
            let color = if inside { BLUE } else { BAND };
            canvas.rectangle((LEFT, y - 7.0), (LEFT + length, y + 7.0), color);
            let value = fixed(one.log_bayes, 1);
            canvas.text((LEFT + length + 8.0, y), &value, TextStyle::new(11.0, ink));
        }
        // one bracket around those that are not told apart
        let (x, pen) = (LEFT + BAR + 70.0, Pen::new(BLUE, 1.3));
        let (top, bottom) = (TOP, TOP + ROW * equivalent.max(1) as f64 - 4.0);
        canvas.line(
            &[(x - 5.0, top), (x, top), (x, bottom), (x - 5.0, bottom)],
            pen,
        );
        let said = match equivalent {
            0 | 1 => "told apart from the rest",
            _ => "not told apart",
        };
        canvas.text(
            (x + 8.0, 0.5 * (top + bottom)),
            said,
            TextStyle::new(11.0, BLUE),
        );
    });
    Some(Figure {
        name: "where_joint".to_owned(),
        caption: format!(
            "{title}: log Bayes factor of an unknown force pair at each joint against none. On a slow \
             machine all forces along one load path look nearly alike, so this is a hint where to \
             look, not the answer; the joints in blue are one set."
        ),
        svg,
    })
}
