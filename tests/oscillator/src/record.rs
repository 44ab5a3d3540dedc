//! Synthetic measurements: simulated curves with noise, repeated over periods, as a table.
use search::random::{Phase, Stream, Streams};
use std::fmt::Write as _;

/// True curves and noise from which the synthetic record of one condition is generated.
#[derive(Clone, Debug)]
pub struct Measurement<'a> {
    /// Heading and values of the record's abscissa.
    pub places: (&'a str, &'a [f64]),
    /// Heading, true values and standard deviation of the noise of each channel.
    pub channels: &'a [(&'a str, Vec<f64>, f64)],
    /// Number of recorded periods, or of recorded releases of the mass.
    pub repeats: usize,
}

impl Measurement<'_> {
    /// Writes the measurement as a CSV table, one row per abscissa value and repeat; the same seed gives the
    /// same table.
    pub fn table(&self, seed: u64) -> String {
        let mut noise: Stream = Streams::new(seed, 0).at(0, Phase::Resample, 0);
        let names = self.channels.iter().map(|(name, _, _)| *name);
        let header: Vec<&str> = ["cycle", self.places.0].into_iter().chain(names).collect();
        let mut table = header.join(",");
        for repeat in 1..=self.repeats {
            for (row, place) in self.places.1.iter().enumerate() {
                // writing into a string does not fail
                _ = write!(table, "\n{repeat},{place}");
                for (_, curve, deviation) in self.channels {
                    _ = write!(table, ",{:.6}", curve[row] + deviation * noise.normal());
                }
            }
        }
        table + "\n"
    }
}
