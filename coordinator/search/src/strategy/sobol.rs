//! Sobol sequence: low-discrepancy points in the unit cube.
//!
//! Direction numbers of Joe and Kuo, "Constructing Sobol sequences with better two-dimensional projections"
//! (SIAM J. Sci. Comput. 30, 2008), in Gray-code order; a random digital shift gives a different sequence for
//! every seed and preserves its uniformity.

/// Degree, inner coefficients and first direction numbers of the primitive polynomials of dimensions 2 to 21.
const POLYNOMIALS: [(usize, u32, &[u32]); 20] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

pub(super) const MOST: usize = POLYNOMIALS.len() + 1;

/// Number of bits with which each coordinate of a Sobol point is computed.
const BITS: usize = 32;

/// Returns the direction numbers of one dimension of the sequence, highest bit first.
fn directions(dimension: usize) -> [u32; BITS] {
    let mut v = [0; BITS];
    let polynomial = dimension.checked_sub(1).and_then(|k| POLYNOMIALS.get(k));
    let Some(&(degree, inner, first)) = polynomial else {
        for (bit, v) in v.iter_mut().enumerate() {
            *v = 1 << (BITS - 1 - bit);
        }
        return v;
    };
    for bit in 0..BITS {
        v[bit] = if bit < degree {
            first[bit] << (BITS - 1 - bit)
        } else {
            let mut value = v[bit - degree] ^ (v[bit - degree] >> degree);
            for k in 1..degree {
                if inner >> (degree - 1 - k) & 1 == 1 {
                    value ^= v[bit - k];
                }
            }
            value
        };
    }
    v
}

/// Returns the first `count` points in the unit cube, with one digital shift for each of at most [`MOST`]
/// dimensions.
pub(super) fn sobol(count: usize, shifts: &[u32]) -> Vec<Vec<f64>> {
    let axes: Vec<[u32; BITS]> = (0..shifts.len()).map(directions).collect();
    let mut state = vec![0_u32; shifts.len()];
    let mut points = Vec::with_capacity(count);
    for k in 0..count {
        let unit = |(state, shift): (&u32, &u32)| f64::from(state ^ shift) / 4_294_967_296.0;
        points.push(state.iter().zip(shifts).map(unit).collect());
        // the lowest bit of k that is 0 changes
        let bit = (!k).trailing_zeros() as usize;
        for (state, axis) in state.iter_mut().zip(&axes) {
            *state ^= axis[bit.min(BITS - 1)];
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_the_published_ones() {
        let expected = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
        ];
        for (point, expected) in sobol(8, &[0; 3]).iter().zip(expected) {
            for (x, wanted) in point.iter().zip(expected) {
                assert!((x - wanted).abs() < 1e-9, "{point:?}");
            }
        }
    }

    /// Checks that of 2^k Sobol points exactly one lies in each of 2^k equal parts of every axis, also after
    /// a digital shift.
    #[test]
    fn every_part_of_every_axis_is_met_once() {
        let shifts: Vec<u32> = (0_u32..)
            .map(|k| 0x9e37_79b9_u32.wrapping_mul(k))
            .take(MOST)
            .collect();
        let points = sobol(256, &shifts);
        for axis in 0..MOST {
            let mut seen = [false; 256];
            for point in &points {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a share of 0..256"
                )]
                let part = (point[axis] * 256.0) as usize;
                assert!(!std::mem::replace(&mut seen[part], true), "{axis}: {part}");
            }
        }
    }
}
