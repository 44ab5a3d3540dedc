//! Motion of the drive, and the conversion between time and crank angle where the crank's speed ripples.
use super::amounts::{Amounts, C};
use super::lags::Lags;
use super::turn::FourierTable;
use crate::case::{SAMPLES, grid};

/// Motion of the crank drive on the grid of crank angles, with t the unit of time: height (m), speed (m/t),
/// acceleration (m/t^2), slope (m/rad).
pub(super) struct Drive {
    pub(super) height: Vec<f64>,
    pub(super) speed: Vec<f64>,
    pub(super) acceleration: Vec<f64>,
    pub(super) slope: Vec<f64>,
}

pub(super) fn drive(amounts: &Amounts<'_>, ratio: f64) -> Drive {
    let offset = amounts.get("crank_angle_offset", 0).to_radians();
    let (a, b) = (
        amounts.get("crank_speed_ripple", 0),
        amounts.get("crank_speed_ripple", 1),
    );
    let mut drive = Drive {
        height: Vec::with_capacity(SAMPLES),
        speed: Vec::with_capacity(SAMPLES),
        acceleration: Vec::with_capacity(SAMPLES),
        slope: Vec::with_capacity(SAMPLES),
    };
    for angle in grid() {
        let p = angle + offset;
        // stroke of 3 m by a crank whose rod is four times as long
        let slope = 1.5 * (p.sin() + 0.125 * (2.0 * p).sin());
        let bend = 1.5 * (p.cos() + 0.25 * (2.0 * p).cos());
        let rate = ratio * (1.0 + a * angle.cos() + b * angle.sin());
        let change = ratio * (b * angle.cos() - a * angle.sin());
        drive
            .height
            .push(1.5 * (1.0 - p.cos() + 0.0625 * (1.0 - (2.0 * p).cos())));
        drive.speed.push(slope * rate);
        drive
            .acceleration
            .push(bend * rate * rate + slope * rate * change);
        drive.slope.push(slope);
    }
    drive
}

/// Maps between crank angle and time where the crank's speed ripples, as the machine's equations are solved
/// in time; `None` at constant speed.
pub(super) struct Warp(pub(super) Option<[Vec<f64>; 2]>);

impl Warp {
    pub(super) fn new(turn: &FourierTable, amounts: &Amounts<'_>) -> Self {
        let (a, b) = (
            amounts.get("crank_speed_ripple", 0),
            amounts.get("crank_speed_ripple", 1),
        );
        if a == 0.0 && b == 0.0 {
            return Self(None);
        }
        let late = |angle: f64| a * angle.sin() - b * angle.cos();
        let to: Vec<f64> = grid().map(|angle| angle - late(angle)).collect();
        let from = grid()
            .map(|time| (0..4).fold(time, |angle, _| time + late(angle)))
            .collect();
        debug_assert_eq!(to.len(), turn.0.len());
        Self(Some([from, to]))
    }

    /// Returns the spectrum over time of a curve given over the crank angle.
    pub(super) fn enter(&self, turn: &FourierTable, curve: &[f64]) -> Vec<C> {
        let spectrum = turn.transform(curve);
        match &self.0 {
            None => spectrum,
            Some([from, _]) => turn.transform(&FourierTable::at(&spectrum, from)),
        }
    }

    /// Converts the spectra of a solution from time to crank angle, in place.
    pub(super) fn leave(
        &self,
        turn: &FourierTable,
        lags: &mut Lags,
        tensions: &mut (Vec<C>, Vec<C>),
    ) {
        let Some([_, to]) = &self.0 else { return };
        let back = |spectrum: &[C]| turn.transform(&FourierTable::at(spectrum, to));
        tensions.0 = back(&tensions.0);
        tensions.1 = back(&tensions.1);
        let rod = back(&lags.0.iter().map(|y| y[0]).collect::<Vec<C>>());
        for (y, rod) in lags.0.iter_mut().zip(rod) {
            y[0] = rod;
        }
    }
}
