//! Fourier filtering of a periodic table by direct sums, which suffice because tables are short and filtered
//! once.
use crate::math::elementary::sin_cos;

/// Returns the table reduced to its mean and its first `kept` harmonics.
pub fn low_pass(values: &[f64], kept: u32) -> Vec<f64> {
    filter(values, kept, |_| [1.0, 0.0])
}

/// Returns a periodic table whose harmonic `h`, as an amplitude of `exp(i h phi)`, is multiplied by the
/// complex `gain(h)` (real and imaginary part); the mean is kept, harmonics above `highest` are dropped.
pub fn filter(values: &[f64], highest: u32, gain: impl Fn(u32) -> [f64; 2]) -> Vec<f64> {
    let n = values.len();
    let count = n.max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    let mut filtered = vec![mean; n];
    let phases: Vec<(f64, f64)> = (0..n)
        .map(|step| sin_cos(std::f64::consts::TAU * step as f64 / count))
        .collect();
    for harmonic in 1..=highest {
        if 2 * harmonic as usize > n {
            break;
        }
        // reduced in integers, so that far samples lose no precision
        let phase = |i: usize| phases[(harmonic as usize * i) % n];
        let (mut a, mut b) = (0.0, 0.0);
        for (i, value) in values.iter().enumerate() {
            let (s, c) = phase(i);
            a += value * c;
            b += value * s;
        }
        let scale = if 2 * harmonic as usize == n { 1.0 } else { 2.0 } / count;
        let [re, im] = gain(harmonic);
        let (cosine, sine) = (a * re + b * im, b * re - a * im);
        for (i, out) in filtered.iter_mut().enumerate() {
            let (s, c) = phase(i);
            *out += scale * (cosine * c + sine * s);
        }
    }
    filtered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_harmonics_pass_and_others_do_not() {
        let n = 48;
        let wave = |h: usize| -> Vec<f64> {
            (0..n)
                .map(|i| sin_cos(std::f64::consts::TAU * (h * i) as f64 / n as f64 + 0.4).0)
                .collect()
        };
        let sum: Vec<f64> = wave(3)
            .iter()
            .zip(wave(9))
            .map(|(a, b)| 7.0 + a + b)
            .collect();
        let cut = low_pass(&sum, 5);
        for (cut, wave) in cut.iter().zip(wave(3)) {
            assert!((cut - 7.0 - wave).abs() < 1e-13);
        }
        // a third of the derivative of the third harmonic is its cosine
        let turned = filter(&wave(3), 24, |h| [0.0, f64::from(h) / 3.0]);
        for (i, turned) in turned.iter().enumerate() {
            let c = sin_cos(std::f64::consts::TAU * (3 * i) as f64 / n as f64 + 0.4).1;
            assert!((turned - c).abs() < 1e-13);
        }
        let all = low_pass(&sum, 24);
        assert!(all.iter().zip(&sum).all(|(a, b)| (a - b).abs() < 1e-13));
    }
}
