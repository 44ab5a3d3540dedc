//! True and indicated start times of cycles, and their variation in load and speed.
use super::Sensors;
use crate::draw::RandomStream;

/// True and indicated start times of the cycles, and the load and speed variation of each cycle.
pub(super) struct CycleTimes {
    /// True start time of each cycle, with some cycles more than are recorded \[s\].
    begin: Vec<f64>,
    /// Start time of each cycle as marked by the index pulse \[s\].
    pulse: Vec<f64>,
    variations: Vec<[f64; 2]>,
}

impl CycleTimes {
    /// Draws the start times and variations of the cycles; time zero is the first pulse.
    pub(super) fn new(
        period: f64,
        sensors: &Sensors,
        cycles: usize,
        draw: &mut RandomStream,
    ) -> Self {
        let varied: Vec<[f64; 2]> = (0..cycles + 2)
            .map(|_| {
                sensors
                    .cycle_spread
                    .map(|spread| spread * draw.clamped_normal())
            })
            .collect();
        let mut begin = vec![0.0];
        let mut sum = 0.0;
        for [_, speed] in &varied {
            sum += period / (1.0 + speed);
            begin.push(sum);
        }
        let mut pulse: Vec<f64> = begin
            .iter()
            .map(|begin| begin + sensors.index / 360.0 * period * draw.clamped_normal())
            .collect();
        let first = pulse[0];
        for time in begin.iter_mut().chain(&mut pulse) {
            *time -= first;
        }
        Self {
            begin,
            pulse,
            variations: varied,
        }
    }

    /// Returns the true number of crank turns from the start of the first cycle to a time \[s\].
    pub(super) fn turns_at(&self, at: f64) -> f64 {
        Self::share(&self.begin, at)
    }

    /// Returns the crank angle at a time as interpolated between index pulses \[deg\].
    pub(super) fn indicated(&self, at: f64) -> f64 {
        let turned = Self::share(&self.pulse, at);
        360.0 * (turned - turned.floor())
    }

    /// Returns the index of the interval between two cycle start marks that contains a time, plus the elapsed
    /// fraction of that interval.
    fn share(marks: &[f64], at: f64) -> f64 {
        let left = marks
            .partition_point(|mark| *mark <= at)
            .clamp(1, marks.len() - 1)
            - 1;
        left as f64 + (at - marks[left]) / (marks[left + 1] - marks[left])
    }

    /// Returns the relative variations of load and speed, interpolated linearly between the middles of
    /// consecutive cycles.
    pub(super) fn variation_at(&self, turned: f64) -> [f64; 2] {
        let place = (turned - 0.5).max(0.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of cycles, not negative"
        )]
        let left = (place as usize).min(self.variations.len() - 2);
        let share = (place - left as f64).min(1.0);
        let (a, b) = (self.variations[left], self.variations[left + 1]);
        [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_goes_over_gently() {
        let sensors = Sensors::with_noise(1.0);
        let time = CycleTimes::new(12.0, &sensors, 5, &mut RandomStream::new(1, "time"));
        for k in 0..500 {
            let [a, b] = [0.0, 0.01].map(|more| time.variation_at(0.01 * f64::from(k) + more));
            assert!((a[0] - b[0]).abs() < 3e-4);
        }
        assert!(
            time.begin
                .windows(2)
                .all(|w| (w[1] - w[0] - 12.0).abs() < 0.05)
        );
    }
}
