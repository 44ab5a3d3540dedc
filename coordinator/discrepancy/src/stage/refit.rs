//! The suspects switched on for real: every gene and every parameter of the effect free.
use crate::bench::{Bench, Fit};
use crate::evidence::log_evidence;
use crate::laboratory::{Laboratory, Stage};
use crate::stage::suspect::Suspect;
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

/// Refits of suspects, side by side; those that cannot be simulated are left out.
///
/// # Errors
/// Of the laboratory.
pub async fn refit<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    suspects: &[&Suspect],
) -> Result<Vec<Refitted>, L::Error> {
    let settings = Settings {
        iterations: 8,
        ..Settings::default()
    };
    let starts = suspects
        .iter()
        .map(|suspect| {
            let x = fit.x().iter().chain(&suspect.start).copied().collect();
            (fit.model.with(&suspect.effect), x)
        })
        .collect();
    let fits = bench.fit(lab, Stage::Refit, starts, settings).await?;
    Ok(suspects
        .iter()
        .zip(fits)
        .filter_map(|(suspect, fit)| {
            let fit = fit?;
            Some(Refitted {
                id: suspect.effect.id.clone(),
                log_evidence: log_evidence(fit.search.best(), fit.variables()),
                fit,
            })
        })
        .collect())
}
