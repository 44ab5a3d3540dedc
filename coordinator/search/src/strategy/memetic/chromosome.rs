//! Chromosomes (one code of `bits` bits per gene) and their conversion to gene values.
use super::settings::{CodeScale, Encoding, MemeticSettings};
use crate::{
    random::Stream,
    space::{Interval, Space},
};

/// Genes of an individual encoded as integers of `bits` bits each. Bit k of the bit string is bit `k % bits`
/// of gene `k / bits`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chromosome(pub(super) Vec<u32>);

/// Codec that translates between chromosomes and gene values.
#[derive(Clone, Debug)]
pub(super) struct Codec {
    space: Space,
    /// Interval of each gene over which its codes are spread (coordinate).
    intervals: Vec<Interval>,
    encoding: Encoding,
    scale: CodeScale,
    bits: u32,
}

impl Codec {
    pub(super) fn new(space: &Space, intervals: Vec<Interval>, settings: &MemeticSettings) -> Self {
        Self {
            space: space.clone(),
            intervals,
            encoding: settings.encoding,
            scale: settings.scale,
            bits: match settings.encoding {
                Encoding::Real => 30,
                Encoding::Binary | Encoding::Gray => settings.bits_per_gene,
            },
        }
    }

    pub(super) const fn encoding(&self) -> Encoding {
        self.encoding
    }

    pub(super) const fn bits(&self) -> u32 {
        self.bits
    }

    pub(super) fn length(&self) -> usize {
        self.intervals.len() * self.bits as usize
    }

    /// Returns the largest code that a gene can have.
    pub(super) const fn largest(&self) -> u32 {
        (1 << self.bits) - 1
    }

    pub(super) fn random(&self, stream: &mut Stream) -> Chromosome {
        let code = |_| {
            let bits = stream.bits() >> (u64::BITS - self.bits);
            u32::try_from(bits).unwrap_or(u32::MAX)
        };
        Chromosome((0..self.intervals.len()).map(code).collect())
    }

    /// Decodes a chromosome to the values of all unknowns [declared units], within their bounds.
    pub(super) fn decode(&self, chromosome: &Chromosome) -> Vec<f64> {
        let genes = chromosome
            .0
            .iter()
            .zip(&self.intervals)
            .zip(self.space.axes());
        let own: Vec<f64> = genes
            .map(|((&code, interval), axis)| {
                let number = if self.encoding == Encoding::Gray {
                    from_gray(code)
                } else {
                    code
                };
                let share = f64::from(number) / f64::from(self.largest());
                match self.scale {
                    CodeScale::Logarithmic => axis.value(interval.from + share * interval.length()),
                    CodeScale::Linear => {
                        let (low, high) = (axis.value(interval.from), axis.value(interval.to));
                        let bounds = &axis.unknown;
                        (low + share * (high - low)).clamp(bounds.lower, bounds.upper)
                    }
                }
            })
            .collect();
        self.space.expand(&own)
    }

    /// Returns the chromosome nearest to starting point number `index` of the space; `None` if the space has
    /// fewer starting points.
    pub(super) fn start(&self, index: usize) -> Option<Chromosome> {
        let point = self.space.starts().get(index)?;
        Some(self.encode(point))
    }

    /// Returns the chromosome that is nearest to a point given by its coordinates.
    pub(super) fn encode(&self, point: &[f64]) -> Chromosome {
        let genes = point.iter().zip(&self.intervals).zip(self.space.axes());
        let codes = genes.map(|((&x, interval), axis)| {
            let share = match self.scale {
                CodeScale::Logarithmic => (x - interval.from) / interval.length(),
                CodeScale::Linear => {
                    let (low, high) = (axis.value(interval.from), axis.value(interval.to));
                    (axis.value(x) - low) / (high - low)
                }
            };
            let code = self.code(share);
            if self.encoding == Encoding::Gray {
                code ^ (code >> 1)
            } else {
                code
            }
        });
        Chromosome(codes.collect())
    }

    /// Returns the integer code nearest to a position in a gene's interval, given as a share of its length;
    /// shares outside 0..1 give the codes of the ends.
    pub(super) fn code(&self, share: f64) -> u32 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and a number of 30 bits; not a number becomes 0"
        )]
        let code = (share.clamp(0.0, 1.0) * f64::from(self.largest())).round() as u32;
        code
    }

    /// Flips one bit of the chromosome's bit string.
    pub(super) fn flip(&self, chromosome: &mut Chromosome, bit: usize) {
        let bits = self.bits as usize;
        if let Some(code) = chromosome.0.get_mut(bit / bits) {
            *code ^= 1 << (bit % bits);
        }
    }
}

pub(super) fn distance(a: &Chromosome, b: &Chromosome) -> u32 {
    a.0.iter()
        .zip(&b.0)
        .map(|(a, b)| (a ^ b).count_ones())
        .sum()
}

fn from_gray(gray: u32) -> u32 {
    let mut number = gray;
    for shift in [16, 8, 4, 2, 1] {
        number ^= number >> shift;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_function;

    fn codec(encoding: Encoding, scale: CodeScale) -> (Space, Codec) {
        let space = test_function::SPHERE.space();
        let settings = MemeticSettings {
            encoding,
            scale,
            ..MemeticSettings::paper()
        };
        let intervals = space
            .axes()
            .iter()
            .map(crate::space::Axis::interval)
            .collect();
        let codec = Codec::new(&space, intervals, &settings);
        (space, codec)
    }

    #[test]
    fn codes_cover_the_interval_and_come_back() {
        for encoding in [Encoding::Binary, Encoding::Gray, Encoding::Real] {
            let (space, codec) = codec(encoding, CodeScale::Logarithmic);
            for x in [-4.0, -1.234, 0.0, 2.5, 4.0] {
                let point = vec![x; space.dimension()];
                let back = space.point(&codec.decode(&codec.encode(&point)));
                for y in back {
                    assert!((x - y).abs() < 0.62e-4, "{encoding:?}: {x} became {y}");
                }
            }
        }
    }

    #[test]
    fn neighbours_in_gray_code_differ_in_one_bit() {
        let (_, codec) = codec(Encoding::Gray, CodeScale::Logarithmic);
        for code in [0_u32, 7, 255, 32767] {
            let low = codec.encode(&[8.0 * f64::from(code) / 65535.0 - 4.0]);
            let high = codec.encode(&[8.0 * f64::from(code + 1) / 65535.0 - 4.0]);
            assert_eq!(distance(&low, &high), 1, "{code}");
        }
    }

    #[test]
    fn a_linear_scale_is_linear_in_the_value() {
        let (space, codec) = codec(Encoding::Binary, CodeScale::Linear);
        let half = Chromosome(vec![32768; space.dimension()]);
        for (value, axis) in codec.decode(&half).iter().zip(space.axes()) {
            assert!((value / (0.5 * (axis.unknown.lower + axis.unknown.upper)) - 1.0).abs() < 1e-4);
        }
    }
}
