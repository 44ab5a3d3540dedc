//! Sections of a diagnosis' report: one file each, one line in the [`SECTIONS`] catalogue.
//!
//! A section turns the diagnosis into markup, or into nothing where it has nothing for it. It does
//! not know its place or its neighbours.
mod addition;
mod certainty;
mod origin;
mod place;
mod proof;
mod suspect;
mod verdict;
mod wander;

use super::Subject;
use super::shown::shown;
use super::words;
use crate::report::ReportError;
use crate::report::chart::{self, Figure};
use maud::Markup;

/// One section.
pub(super) struct Section {
    /// Anchor in the page.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Makes the body; nothing leaves the section out.
    pub render: fn(&Subject<'_>, &Figures) -> Option<Markup>,
}

/// Every section, in the order of the argument.
pub(super) const SECTIONS: &[Section] = &[
    verdict::SECTION,
    place::SECTION,
    wander::SECTION,
    suspect::SECTION,
    addition::SECTION,
    proof::SECTION,
    certainty::SECTION,
    origin::SECTION,
];

/// The figures of a report, drawn once for the page and for their own files.
pub(super) struct Figures {
    /// Where: by angle, by order, by joint.
    place: Vec<Figure>,
    /// The proof: condition by condition, its gauges and its other channels.
    proof: Vec<Proof>,
}

/// The curves of one condition.
struct Proof {
    condition: String,
    gauges: Vec<Figure>,
    others: Vec<Figure>,
}

impl Figures {
    /// Every figure, in the order of the page.
    pub(super) fn all(&self) -> impl Iterator<Item = &Figure> {
        let proofs = self
            .proof
            .iter()
            .flat_map(|proof| proof.gauges.iter().chain(&proof.others));
        self.place.iter().chain(proofs)
    }
}

/// Draws everything.
///
/// # Errors
/// [`ReportError::Chart`] when the drawing library fails.
pub(super) fn figures(subject: &Subject<'_>) -> Result<Figures, ReportError> {
    let mut place = Vec::new();
    if let (Some(seen), Some(record)) = (
        &subject.diagnosed.diagnosis.whereabouts,
        words::calibrated(subject),
    ) {
        let channels: Vec<String> = record.channels.iter().map(|c| c.name()).collect();
        let conditions = &subject.case.conditions;
        let speed = conditions
            .get(record.condition)
            .map_or(f64::NAN, |c| c.speed_rpm);
        place.extend(chart::angle_map(&seen.angle, &channels)?);
        place.extend(chart::order_map(&seen.order, &channels, speed)?);
        place.extend(chart::joints(&seen.joints, seen.equivalent)?);
        place.extend(chart::latent_forces(&seen.joints, seen.equivalent)?);
    }
    let mut proof = Vec::new();
    for shown in shown(subject) {
        let (mut gauges, mut others) = (Vec::new(), Vec::new());
        for c in shown.order() {
            let source = shown.record.channels[c];
            let name = source.name();
            let Some(of) = shown.channel(c, &name) else {
                continue;
            };
            let is_gauge = matches!(source, discrepancy::record::Source::Gauge(_));
            let figures = if is_gauge { &mut gauges } else { &mut others };
            figures.extend(chart::closing(&of)?);
        }
        proof.push(Proof {
            condition: shown.condition.clone(),
            gauges,
            others,
        });
    }
    Ok(Figures { place, proof })
}
