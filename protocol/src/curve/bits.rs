//! Rice coding of whole numbers at the level of bits, independent of curves.

/// Maximum Rice parameter, i.e. number of low bits that are written without unary coding.
pub(super) const WIDEST: u8 = 32;
/// Number of ones that marks an escape in the Rice code: the whole difference follows instead of its upper
/// part.
const LONGEST_RUN: u64 = 24;

/// Error for bytes that are not an encoded curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("invalid curve encoding: {0}")]
pub(super) struct Malformed(pub(super) &'static str);

/// Returns the number of bits that the Rice code of all differences takes with Rice parameter `width`.
pub(super) fn coded_bits(differences: &[u64], width: u8) -> u64 {
    let coded = |difference: &u64| match difference >> width {
        high @ 0..LONGEST_RUN => high + 1 + u64::from(width),
        _ => LONGEST_RUN + 64,
    };
    differences.iter().map(coded).sum()
}

/// Writer of single bits, beginning with the lowest bit of each byte.
pub(super) struct BitWriter {
    pub(super) bytes: Vec<u8>,
    at: usize,
}

impl BitWriter {
    /// Creates a writer that appends to `bytes`, with room for `bits` bits.
    pub(super) fn after(mut bytes: Vec<u8>, bits: u64) -> Self {
        let at = 8 * bytes.len();
        let more = usize::try_from(bits.div_ceil(8)).unwrap_or_default();
        bytes.resize(bytes.len() + more, 0);
        Self { bytes, at }
    }

    /// Appends the Rice code of a difference with `width` low bits.
    pub(super) fn difference(&mut self, difference: u64, width: u8) {
        let high = difference >> width;
        if high < LONGEST_RUN {
            self.put((1 << high) - 1, high + 1);
            self.put(difference, u64::from(width));
        } else {
            self.put((1 << LONGEST_RUN) - 1, LONGEST_RUN);
            self.put(difference, 64);
        }
    }

    /// Appends the lowest `bits` bits of a number.
    fn put(&mut self, number: u64, bits: u64) {
        for place in 0..bits {
            if let Some(byte) = self.bytes.get_mut(self.at / 8) {
                *byte |= u8::from(number >> place & 1 == 1) << (self.at % 8);
            }
            self.at += 1;
        }
    }
}

/// Reader of the output of a [`BitWriter`].
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> BitReader<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn bit(&mut self) -> Result<u64, Malformed> {
        let byte = self
            .bytes
            .get(self.at / 8)
            .ok_or(Malformed("the bytes end too early"))?;
        let bit = byte >> (self.at % 8) & 1;
        self.at += 1;
        Ok(u64::from(bit))
    }

    fn number(&mut self, bits: u64) -> Result<u64, Malformed> {
        let mut number = 0;
        for place in 0..bits {
            number |= self.bit()? << place;
        }
        Ok(number)
    }

    /// Reads the Rice code of a difference with `width` low bits.
    ///
    /// # Errors
    /// [`Malformed`] at the end of the bytes.
    pub(super) fn difference(&mut self, width: u8) -> Result<u64, Malformed> {
        let mut high = 0;
        while self.bit()? == 1 {
            high += 1;
            if high == LONGEST_RUN {
                return self.number(64);
            }
        }
        Ok(high << width | self.number(u64::from(width))?)
    }
}
