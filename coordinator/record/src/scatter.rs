//! Scatter of cycles about their mean, less the part that their input explains. The module knows no noise
//! model.
use crate::spectrum::Spectra;
use nalgebra::{Complex, DMatrix, DVector};

type C = Complex<f64>;

/// Returns the deviations of the cycles' entries from their mean, less the part that the inputs explain, by
/// cycle, channel and entry.
pub(crate) fn unexplained(cycles: Vec<Spectra>, inputs: &[Spectra]) -> Vec<Spectra> {
    let n = cycles.len() as f64;
    let mean = |c: usize, k: usize| cycles.iter().map(|cycle| cycle[c][k]).sum::<C>() / C::from(n);
    let first = cycles.first().map_or(&[][..], |cycle| cycle);
    let means: Spectra = first
        .iter()
        .enumerate()
        .map(|(c, curve)| (0..curve.len()).map(|k| mean(c, k)).collect())
        .collect();
    cycles
        .into_iter()
        .map(|mut cycle| {
            for (curve, mean) in cycle.iter_mut().zip(&means) {
                for (f, mean) in curve.iter_mut().zip(mean) {
                    *f -= mean;
                }
            }
            regress_out(&mut cycle, inputs, &means);
            cycle
        })
        .collect()
}

/// Subtracts from a cycle its least-squares fit by the input curves; each channel is weighted by the inverse
/// power of its mean.
fn regress_out(cycle: &mut [Vec<C>], inputs: &[Spectra], means: &[Vec<C>]) {
    if inputs.is_empty() {
        return;
    }
    let weights: Vec<f64> = means
        .iter()
        .map(|mean| {
            1.0 / mean
                .iter()
                .map(C::norm_sqr)
                .sum::<f64>()
                .max(f64::MIN_POSITIVE)
        })
        .collect();
    let dot = |a: &[Vec<C>], b: &[Vec<C>]| -> f64 {
        let channels = a.iter().zip(b).zip(&weights);
        channels
            .map(|((a, b), w)| w * a.iter().zip(b).map(|(a, b)| (a.conj() * b).re).sum::<f64>())
            .sum()
    };
    let matrix = DMatrix::from_fn(inputs.len(), inputs.len(), |i, j| {
        dot(&inputs[i], &inputs[j])
    });
    let right = DVector::from_fn(inputs.len(), |i, _| dot(&inputs[i], cycle));
    let Some(factor) = matrix.cholesky() else {
        return;
    };
    let amounts = factor.solve(&right);
    for (input, amount) in inputs.iter().zip(amounts.iter()) {
        for (curve, input) in cycle.iter_mut().zip(input) {
            for (f, input) in curve.iter_mut().zip(input) {
                *f -= input * C::from(*amount);
            }
        }
    }
}
