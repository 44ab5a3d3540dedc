//! Encoding of a curve as bytes: either the short form, differences of its values as multiples of a step, or
//! doubles.
use super::bits::{BitReader, BitWriter, Malformed, WIDEST, coded_bits};

/// First byte of a curve encoded as doubles; in the short form, the first byte is the order of the
/// differences instead.
const DOUBLES: u8 = 255;
/// Highest order of the differences of a curve's values; at higher orders the rounding error grows faster
/// than the differences of a smooth curve shrink.
const HIGHEST_ORDER: u8 = 4;
/// Maximum magnitude of a curve value as a multiple of the step, such that a double represents all smaller
/// whole numbers exactly.
pub(super) const MOST_MULTIPLE: i64 = 1 << 53;
/// Maximum number of samples in the short form, which bounds the memory needed to decode a message; longer
/// curves are encoded as doubles.
pub(super) const MOST_SAMPLES: usize = 1 << 16;
/// Allowed exponents of the step (a power of two), such that all multiples and the reciprocal are normal
/// numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -512..=400;
const OUT_OF_RANGE: Malformed = Malformed("a value is out of range");

/// Encodes a curve in the shorter of the two forms: differences of multiples of a step, or doubles.
pub(super) fn encode(curve: &[f64]) -> Vec<u8> {
    if curve.is_empty() {
        return Vec::new();
    }
    let short = multiples(curve).map(|(exponent, multiples)| short(exponent, &multiples));
    let doubles = 1 + 8 * curve.len();
    short
        .filter(|short| short.len() < doubles)
        .unwrap_or_else(|| {
            let mut bytes = Vec::with_capacity(doubles);
            bytes.push(DOUBLES);
            bytes.extend(curve.iter().flat_map(|value| value.to_le_bytes()));
            bytes
        })
}

/// Returns the exponent of the greatest power of two that divides all values, and the multiples of it; `None`
/// if the curve has no short form.
fn multiples(curve: &[f64]) -> Option<(i32, Vec<i64>)> {
    let is_plain = |value: &f64| value.is_finite() && (*value != 0.0 || value.is_sign_positive());
    if curve.len() > MOST_SAMPLES || !curve.iter().all(is_plain) {
        return None;
    }
    let steps = curve.iter().filter(|value| **value != 0.0);
    let exponent = steps.map(|value| lowest_bit(*value)).min().unwrap_or(0);
    if !EXPONENTS.contains(&exponent) {
        return None;
    }
    let per_step = power(-exponent);
    let multiple = |value: &f64| {
        let multiple = value * per_step;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a whole number, and what is beyond the limit is refused"
        )]
        let whole = multiple as i64;
        (whole.unsigned_abs() <= MOST_MULTIPLE.unsigned_abs()).then_some(whole)
    };
    let multiples = curve.iter().map(multiple).collect::<Option<_>>()?;
    Some((exponent, multiples))
}

/// Returns the exponent of the lowest set bit of a finite nonzero number.
const fn lowest_bit(value: f64) -> i32 {
    let bits = value.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    // numbers below the normal ones have no hidden bit and the exponent of the least of those
    let (mantissa, exponent) = match exponent {
        0 => (fraction, 1),
        _ => (fraction | 1 << 52, exponent),
    };
    exponent - 1075 + mantissa.trailing_zeros().cast_signed()
}

/// Returns two to the power of `exponent`, exactly.
pub(super) fn power(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

/// Encodes the multiples of two to the power of `exponent` in the short form, with the difference order and
/// Rice parameter that give the fewest bits.
fn short(exponent: i32, multiples: &[i64]) -> Vec<u8> {
    let forms = (0..=HIGHEST_ORDER).map(|order| {
        let differences = differences(order, multiples);
        let usual = usual_bits(&differences);
        let widths = usual.saturating_sub(3)..=(usual + 1).min(WIDEST);
        let lengths = widths.map(|width| (coded_bits(&differences, width), width));
        let (bits, width) = lengths.min().unwrap_or_default();
        (bits, order, width, differences)
    });
    let (bits, order, width, differences) =
        forms.min_by_key(|(bits, ..)| *bits).unwrap_or_default();
    let mut bytes = vec![order, width];
    bytes.extend(i16::try_from(exponent).unwrap_or_default().to_le_bytes());
    let samples = u32::try_from(multiples.len()).unwrap_or_default();
    bytes.extend(samples.to_le_bytes());
    let mut to = BitWriter::after(bytes, bits);
    for difference in differences {
        to.difference(difference, width);
    }
    to.bytes
}

/// Returns the differences of the given order, with zeros before the first sample; zigzag-coded, i.e. with
/// the sign in the lowest bit.
fn differences(order: u8, multiples: &[i64]) -> Vec<u64> {
    let mut before = [0; HIGHEST_ORDER as usize];
    let difference = |multiple: &i64| {
        let mut difference = *multiple;
        for before in before.iter_mut().take(usize::from(order)) {
            difference -= std::mem::replace(before, difference);
        }
        (difference << 1 ^ difference >> 63).cast_unsigned()
    };
    multiples.iter().map(difference).collect()
}

/// Returns the median bit length of the differences, which is robust against the large differences at the
/// start.
fn usual_bits(differences: &[u64]) -> u8 {
    let mut bits: Vec<u32> = differences
        .iter()
        .map(|it| 64 - it.leading_zeros())
        .collect();
    bits.sort_unstable();
    let middle = bits.get(bits.len() / 2).copied();
    middle
        .and_then(|bits| u8::try_from(bits).ok())
        .map_or(0, |bits| bits.min(WIDEST))
}

/// Decodes a curve; only the canonical encoding is accepted.
///
/// # Errors
/// [`Malformed`] if the bytes are not the encoding of a curve.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<f64>, Malformed> {
    let curve = read(bytes)?;
    if encode(&curve) == bytes {
        Ok(curve)
    } else {
        Err(Malformed("it is not the canonical encoding"))
    }
}

fn read(bytes: &[u8]) -> Result<Vec<f64>, Malformed> {
    match bytes {
        [] => Ok(Vec::new()),
        [DOUBLES, doubles @ ..] => match doubles.as_chunks() {
            (doubles, []) => Ok(doubles.iter().map(|it| f64::from_le_bytes(*it)).collect()),
            _ => Err(Malformed("a double is cut")),
        },
        [order, width, low, high, s0, s1, s2, s3, coded @ ..]
            if *order <= HIGHEST_ORDER && *width <= WIDEST =>
        {
            let exponent = i32::from(i16::from_le_bytes([*low, *high]));
            let samples = u32::from_le_bytes([*s0, *s1, *s2, *s3]) as usize;
            if !EXPONENTS.contains(&exponent) {
                return Err(Malformed("its step is out of range"));
            }
            // each sample takes a bit at least
            if samples > MOST_SAMPLES.min(8 * coded.len()) {
                return Err(Malformed("it has too many samples"));
            }
            let mut from = BitReader::new(coded);
            let mut sums = Sums::of(*order);
            (0..samples)
                .map(|_| Ok(sums.next(from.difference(*width)?)? as f64 * power(exponent)))
                .collect()
        }
        _ => Err(Malformed("it has no such form")),
    }
}

/// Running sums of the given order, which restore a curve's multiples from their differences.
struct Sums {
    before: [i64; HIGHEST_ORDER as usize],
    order: usize,
}

impl Sums {
    fn of(order: u8) -> Self {
        Self {
            before: [0; HIGHEST_ORDER as usize],
            order: usize::from(order),
        }
    }

    fn next(&mut self, difference: u64) -> Result<i64, Malformed> {
        let mut sum = (difference >> 1).cast_signed() ^ -(difference & 1).cast_signed();
        for before in self.before.iter_mut().take(self.order).rev() {
            sum = sum.checked_add(*before).ok_or(OUT_OF_RANGE)?;
            *before = sum;
        }
        if sum.unsigned_abs() > MOST_MULTIPLE.unsigned_abs() {
            return Err(OUT_OF_RANGE);
        }
        Ok(sum)
    }
}
