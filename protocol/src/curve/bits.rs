//! Rice's code of whole numbers, bit by bit; it knows nothing of curves.

/// The most bits of a difference below its run of ones.
pub(super) const WIDEST: u8 = 32;
/// So many ones announce a whole difference instead of its upper part.
const LONGEST_RUN: u64 = 24;

/// Why bytes are no curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("bytes that are no curve: {0}")]
pub(super) struct Malformed(pub(super) &'static str);

/// Bits that the code of numbers takes whose lower parts have so many.
pub(super) fn coded_bits(differences: &[u64], width: u8) -> u64 {
    let coded = |difference: &u64| match difference >> width {
        high @ 0..LONGEST_RUN => high + 1 + u64::from(width),
        _ => LONGEST_RUN + 64,
    };
    differences.iter().map(coded).sum()
}

/// Bits one after the other, the lowest of a byte first.
pub(super) struct BitWriter {
    pub(super) bytes: Vec<u8>,
    at: usize,
}

impl BitWriter {
    /// Behind bytes, with room for so many bits.
    pub(super) fn after(mut bytes: Vec<u8>, bits: u64) -> Self {
        let at = 8 * bytes.len();
        let more = usize::try_from(bits.div_ceil(8)).unwrap_or_default();
        bytes.resize(bytes.len() + more, 0);
        Self { bytes, at }
    }

    /// Adds a difference whose lower part has so many bits.
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

    /// Adds the lowest bits of a number.
    fn put(&mut self, number: u64, bits: u64) {
        for place in 0..bits {
            if let Some(byte) = self.bytes.get_mut(self.at / 8) {
                *byte |= u8::from(number >> place & 1 == 1) << (self.at % 8);
            }
            self.at += 1;
        }
    }
}

/// Reads what a [`BitWriter`] wrote.
pub(super) struct BitReader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> BitReader<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn bit(&mut self) -> Result<u64, Malformed> {
        let byte = self.bytes.get(self.at / 8).ok_or(Malformed("it is cut"))?;
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

    /// Takes a difference whose lower part has so many bits.
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
