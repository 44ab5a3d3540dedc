//! The suspects switched on for real: every unknown and every parameter of the effect free.
use crate::cause::suspect::Suspect;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::Settings;

/// A suspect after its refit.
#[derive(Clone, Debug)]
pub struct Refitted {
    /// Identifier of the effect.
    pub id: String,
    /// The fit.
    pub fit: Fit,
    /// Log evidence (nats).
    pub log_evidence: f64,
}

impl Refitted {
    /// A fit whose last effect is the suspect.
    pub(crate) fn new(id: String, fit: Fit) -> Self {
        Self {
            id,
            log_evidence: fit.log_evidence(),
            fit,
        }
    }
}

/// Refits of suspects, side by side; those that cannot be simulated are left out.
///
/// # Errors
/// Those of the laboratory.
pub async fn refit<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    suspects: &[&Suspect],
) -> Result<Vec<Refitted>, L::Error> {
    let start = |suspect: &&Suspect| fit.with(&suspect.effect, &suspect.start);
    let starts: Vec<Point> = suspects.iter().map(start).collect();
    let fits = experiments.fits(starts, Settings::short(8)).await?;
    let refits = suspects.iter().zip(fits);
    Ok(refits
        .filter_map(|(suspect, fit)| Some(Refitted::new(suspect.effect.id.clone(), fit?)))
        .collect())
}
