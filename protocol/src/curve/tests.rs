//! Tests of the curve encoding: lossless round trip, length, and refusal of invalid bytes.

use super::form::{MOST_MULTIPLE, MOST_SAMPLES, decode, encode, power};
use super::rounded;
use proptest::{collection::vec, prelude::*};

fn bits(curve: &[f64]) -> Vec<u64> {
    curve.iter().map(|value| value.to_bits()).collect()
}

/// Generates curves: multiples of steps of any size, arbitrary bit patterns, arbitrary doubles, and whole
/// numbers up to the limit.
fn curve() -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        (vec(-1e6..1e6, 0..60), -600..420_i32).prop_map(|(curve, exponent)| {
            curve
                .iter()
                .map(|value: &f64| value.round() * power(exponent))
                .collect()
        }),
        vec(any::<u64>().prop_map(f64::from_bits), 0..20),
        vec(any::<f64>(), 0..20),
        vec(
            (-MOST_MULTIPLE..=MOST_MULTIPLE).prop_map(|whole| whole as f64),
            0..60
        ),
    ]
}

proptest! {
    #[test]
    fn every_bit_of_a_curve_comes_back_and_none_grows(curve in curve()) {
        let bytes = encode(&curve);
        prop_assert!(bytes.len() <= 1 + 8 * curve.len());
        prop_assert_eq!(bits(&decode(&bytes).unwrap()), bits(&curve));
    }

    /// Checks that any bytes are either refused or the canonical encoding of a curve with at most as many
    /// samples as there are bits.
    #[test]
    fn any_bytes_are_a_curve_or_refused(
        mut bytes in vec(any::<u8>(), 8..300),
        (form, width, samples) in (0..8_u8, 0..40_u8, 0..900_u16),
    ) {
        if form < 6 {
            bytes[..3].copy_from_slice(&[form, width, 0]);
            bytes[3] = 0;
            bytes[4..8].copy_from_slice(&u32::from(samples).to_le_bytes());
        }
        if let Ok(curve) = decode(&bytes) {
            prop_assert!(curve.len() <= 8 * bytes.len());
            prop_assert_eq!(encode(&curve), bytes);
        }
    }

    #[test]
    fn rounding_moves_nothing_by_more_than_half_a_step(
        curve in vec(-1e4..1e4, 1..50),
        exponent in -20..4_i32,
    ) {
        for (is, was) in rounded(&curve, exponent).iter().zip(&curve) {
            let step = power(exponent);
            prop_assert!((is - was).abs() <= 0.5 * step);
            prop_assert!((is / step).fract().abs() < f64::EPSILON);
        }
    }
}

#[test]
fn smooth_curves_are_short_and_others_are_never_lost() {
    let turn = (0..720).map(|i| 60.0 * (f64::from(i) / 720.0 * std::f64::consts::TAU).sin());
    let exact: Vec<f64> = turn.collect();
    let short = encode(&rounded(&exact, -13));
    assert!(short.len() < 400, "{} bytes", short.len());
    assert_eq!(encode(&exact).len(), 1 + 8 * 720);
    for odd in [
        f64::NAN,
        f64::INFINITY,
        -0.0,
        1e300,
        f64::MIN_POSITIVE / 8.0,
    ] {
        let mut curve = rounded(&exact, -13);
        curve[300] = odd;
        assert_eq!(
            bits(&decode(&encode(&curve)).unwrap()),
            bits(&curve),
            "{odd}"
        );
    }
    assert_eq!(
        bits(&rounded(&[-1e-9, f64::NAN, -1.0], -13)),
        bits(&[0.0, f64::NAN, -1.0])
    );
}

/// Checks that the number of samples in the short form is limited, so that a hostile message cannot demand
/// far more memory than its own size.
#[test]
fn a_short_form_has_so_many_samples_at_most() {
    let zeros = |samples: usize| {
        let count = u32::try_from(samples).unwrap().to_le_bytes();
        [&[0; 4], &count[..], &vec![0; samples.div_ceil(8)]].concat()
    };
    assert_eq!(decode(&zeros(MOST_SAMPLES)).unwrap().len(), MOST_SAMPLES);
    decode(&zeros(MOST_SAMPLES + 1)).unwrap_err();
    let mut promised = zeros(80);
    promised.truncate(12);
    decode(&promised).expect_err("more than there is");
    assert_eq!(encode(&[0.0; 80]), zeros(80));
    let long = vec![0.0; MOST_SAMPLES + 1];
    assert_eq!(decode(&encode(&long)).unwrap(), long);
}
