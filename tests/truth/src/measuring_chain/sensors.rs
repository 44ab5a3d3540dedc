//! Sensor properties, and models of their noise and of lost samples.
use crate::draw::RandomStream;

/// Sensor properties, as in the case's own records.
#[derive(Clone, Copy, Debug)]
pub struct Sensors {
    /// Sampling rate of all sensors \[Hz\].
    pub rate: f64,
    /// Standard deviation of the noise of a gauge \[MPa\].
    pub gauge_noise: f64,
    /// Autocorrelation of the gauge noise from sample to sample.
    pub correlation: f64,
    /// Share of the noise variance that is common to all gauges.
    pub common: f64,
    /// Resolution (quantisation step) of a gauge's reading \[MPa\].
    pub resolution: f64,
    /// Standard deviation of a gauge's zero offset \[MPa\].
    pub zero: f64,
    /// Standard deviations of the noise of the position \[m\] and of the torque [N m].
    pub position_torque_noise: [f64; 2],
    /// Standard deviation of the crank angle at which the index pulse occurs \[deg\].
    pub index: f64,
    /// Probability that a single sample is lost.
    pub loss_probability: f64,
    /// Relative standard deviations from cycle to cycle of load swing and of speed.
    pub cycle_spread: [f64; 2],
}

impl Sensors {
    /// Returns the default sensors with the noise of all of them multiplied by a factor.
    pub fn with_noise(factor: f64) -> Self {
        Self {
            rate: 100.0,
            gauge_noise: 0.2 * factor,
            correlation: 0.6,
            common: 0.1,
            resolution: 0.206,
            zero: 1.0,
            position_torque_noise: [0.002 * factor, 200.0 * factor],
            index: 0.1,
            loss_probability: 0.0025,
            cycle_spread: [0.004, 0.001],
        }
    }
}

/// First-order autoregressive noise of the gauges, part of which is common to all.
pub(super) struct Noise {
    state: [f64; 5],
    kept: f64,
    fresh: f64,
    own: f64,
    common: f64,
}

impl Noise {
    pub(super) fn new(sensors: &Sensors, draw: &mut RandomStream) -> Self {
        let kept = sensors.correlation;
        Self {
            state: [0.0; 5].map(|_: f64| draw.normal()),
            kept,
            fresh: (1.0 - kept * kept).sqrt(),
            own: sensors.gauge_noise * (1.0 - sensors.common).sqrt(),
            common: sensors.gauge_noise * sensors.common.sqrt(),
        }
    }

    pub(super) fn next(&mut self, draw: &mut RandomStream) -> [f64; 4] {
        for state in &mut self.state {
            *state = self.kept * *state + self.fresh * draw.normal();
        }
        let [a, b, c, d, all] = self.state;
        [a, b, c, d].map(|own| self.own * own + self.common * all)
    }
}

/// Wireless link that loses single samples and one burst of samples.
pub(super) struct Link {
    burst: [f64; 2],
    share: f64,
    pub(super) lost: usize,
}

impl Link {
    pub(super) fn new(samples: f64, share: f64, draw: &mut RandomStream) -> Self {
        let begin = draw.between(0.1, 0.9) * samples;
        Self {
            burst: [begin, begin + draw.between(4.0, 14.0)],
            share,
            lost: 0,
        }
    }

    /// Returns whether the wireless link delivers the next sample; it always delivers the first.
    pub(super) fn delivers(&mut self, number: f64, draw: &mut RandomStream) -> bool {
        let in_burst = (self.burst[0]..self.burst[1]).contains(&number);
        let single = draw.unit() < self.share;
        let lost = number > 0.0 && (in_burst || single);
        self.lost += usize::from(lost);
        !lost
    }
}
