//! Refits of single parameters on parts of the turn and under other conditions.
use crate::bench::{Bench, Fit};
use crate::laboratory::{Laboratory, Stage, channels};
use crate::locate::wander::{Sheet, Wander, wanders};
use crate::record::{Curves, Record};

/// How the unknowns of a fit would have to wander; the genes come first among them. Each condition
/// takes a simulation per unknown.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn wander<L: Laboratory>(
    lab: &mut L,
    (bench, fit): (&Bench, &Fit),
    others: &[Record],
) -> Result<Vec<Wander>, L::Error> {
    let Some(own) = sheet(lab, (bench, fit), &bench.record).await? else {
        return Ok(Vec::new());
    };
    let mut elsewhere = Vec::new();
    for record in others {
        let other = sheet(lab, (bench, fit), record).await?;
        elsewhere.extend(other.map(|other| (record.condition, other)));
    }
    let prior = |v: &search::least_squares::Variable| v.prior.map_or(1e3, |p| p.deviation);
    let deviations: Vec<f64> = fit.variables().iter().map(prior).collect();
    Ok(wanders(&own, &deviations, &elsewhere))
}

/// A record at the fitted point with the change per unknown; nothing where it has too few cycles, or
/// the point cannot be simulated.
async fn sheet<L: Laboratory>(
    lab: &mut L,
    (bench, fit): (&Bench, &Fit),
    record: &Record,
) -> Result<Option<Sheet>, L::Error> {
    if !Sheet::suits(record) {
        return Ok(None);
    }
    let steps: Vec<f64> = fit
        .variables()
        .iter()
        .zip(fit.x())
        // away from a bound that lies within a step
        .map(|(v, x)| if x + v.step > v.upper { -v.step } else { v.step })
        .collect();
    let mut points = vec![fit.x().to_vec()];
    for (k, step) in steps.iter().enumerate() {
        let mut x = fit.x().to_vec();
        x[k] += step;
        points.push(x);
    }
    let batch = points
        .iter()
        .map(|x| fit.model.experiment(x, record.condition, bench.refinement))
        .collect();
    let observed = lab.observe(Stage::Show, batch).await?;
    let mut curves = observed
        .iter()
        .map(|o| channels(o.as_ref()?, &record.channels));
    let Some(fitted) = curves.next().flatten() else {
        return Ok(None);
    };
    let changes: Vec<Curves> = curves
        .zip(&steps)
        // a point that fails tells nothing of its unknown
        .map(|(moved, step)| change(&fitted, moved.as_ref().unwrap_or(&fitted), *step))
        .collect();
    Ok(Some(Sheet::new(record, &fitted, &changes)))
}

/// Change per unit.
fn change(from: &Curves, to: &Curves, step: f64) -> Curves {
    let channels = from.iter().zip(to);
    let slope = |(from, to): (&f64, &f64)| (to - from) / step;
    channels
        .map(|(from, to)| from.iter().zip(to).map(slope).collect())
        .collect()
}
