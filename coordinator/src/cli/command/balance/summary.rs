//! Torque and power of a crank over a revolution, in the numbers by which a reducer and a motor are chosen.
use super::{
    options::BalancePlan,
    torque::{Bounds, Counterweight, Goal, Revolution, mean_square},
};
use discrepancy::estimate::neighbourhood::{Neighbourhood, QuantityInterval};
use protocol::pumping_unit::{Machine, Simulation};
use std::f64::consts::TAU;

/// Joules of a kilowatt hour.
const KILOWATT_HOUR: f64 = 3.6e6;

/// Torque and power under one condition.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    pub(super) weight: Counterweight,
    pub(super) turn_deg: Vec<f64>,
    /// Net torque that the reducer supplies [N m].
    pub(super) torque_n_m: Vec<f64>,
    pub(super) most_n_m: f64,
    pub(super) least_n_m: f64,
    pub(super) rms_n_m: f64,
    /// Work of a revolution over its angle [N m].
    pub(super) mean_n_m: f64,
    /// Share of the revolution in which the magnitude exceeds the rating; `None` without a rating.
    pub(super) above_rating: Option<f64>,
    /// Share of the revolution in which the machine drives the gear.
    pub(super) below_zero: f64,
    pub(super) peak_power_w: f64,
    pub(super) mean_power_w: f64,
    pub(super) energy_kwh_per_day: f64,
    /// Polished-rod load that the counterweight holds with the crank level on the upstroke [N].
    pub(super) counterbalance_n: f64,
}

/// Crank with its states, and the best counterweight for it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AssessedCrank {
    pub(super) name: String,
    /// State under each condition of the operation.
    pub(super) states: Vec<State>,
    /// Best counterweight within the bounds.
    pub(super) best: Counterweight,
    /// Intervals of the numbers; `None` where there are none.
    pub(super) intervals: Option<Intervals>,
}

/// 95 % intervals, to first order from the covariance of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Intervals {
    /// Under each condition: of the largest torque, the root mean square [N m] and the energy of a day [kWh].
    pub(super) states: Vec<[Option<QuantityInterval>; 3]>,
    /// Of the best moment [N m].
    pub(super) moment_n_m: Option<QuantityInterval>,
}

impl State {
    /// Returns root mean square over mean of the torque: 1 for a torque that is constant.
    pub(super) fn cyclic_load_factor(&self) -> f64 {
        self.rms_n_m / self.mean_n_m
    }

    /// Returns the largest magnitude of the torque [N m].
    pub(super) const fn peak_n_m(&self) -> f64 {
        self.most_n_m.abs().max(self.least_n_m.abs())
    }
}

impl AssessedCrank {
    pub(super) fn new(name: &str, states: Vec<State>, best: Counterweight) -> Self {
        Self {
            name: name.to_owned(),
            states,
            best,
            intervals: None,
        }
    }

    /// Returns the crank with intervals from the states and the best counterweights of the machines about it; the best
    /// moment of this machine and of those about it is not rounded to a step of the weights [N m].
    pub(super) fn with_intervals(
        self,
        neighbourhood: &Neighbourhood,
        (about, between_steps_n_m): (&[Self], f64),
        bounds: &Bounds,
    ) -> Self {
        // at a bound the best moment does not follow the unknowns
        let mut along = about.iter().take(neighbourhood.along_parameters());
        let inside = along.all(|own| !bounds.ends_at(own.best.moment_n_m));
        let moments: Vec<f64> = about.iter().map(|own| own.best.moment_n_m).collect();
        let interval = |of: &dyn Fn(&Self) -> f64| {
            neighbourhood.interval(of(&self), &about.iter().map(of).collect::<Vec<_>>())
        };
        let states = (0..self.states.len()).map(|k| {
            [
                interval(&|own| own.states[k].most_n_m),
                interval(&|own| own.states[k].rms_n_m),
                interval(&|own| own.states[k].energy_kwh_per_day),
            ]
        });
        Self {
            intervals: Some(Intervals {
                states: states.collect(),
                moment_n_m: neighbourhood
                    .interval(between_steps_n_m, &moments)
                    .filter(|_| inside),
            }),
            ..self
        }
    }
}

/// Returns the value of a goal over the states of an operation [N m].
pub(super) fn goal_of(goal: Goal, plan: &BalancePlan, states: &[State]) -> f64 {
    let hours: f64 = plan.operations.iter().map(|own| own.hours_per_day).sum();
    match goal {
        Goal::RootMeanSquare => {
            let each = plan.operations.iter().zip(states);
            let squares =
                each.map(|(own, state)| own.hours_per_day / hours * state.rms_n_m * state.rms_n_m);
            squares.sum::<f64>().sqrt()
        }
        Goal::Peak => states.iter().map(State::peak_n_m).fold(0.0, f64::max),
    }
}

/// Returns the state of a machine under each condition with the given counterweights.
pub(super) fn states(
    machine: &Machine,
    plan: &BalancePlan,
    (weights, revolutions): (&[Counterweight], &[Revolution]),
    simulations: &[Simulation],
) -> Vec<State> {
    let each = plan.operations.iter().zip(weights).zip(revolutions);
    each.zip(simulations)
        .map(|(((operation, weight), revolution), simulation)| {
            let speed = machine.conditions[operation.condition].speed_rpm * TAU / 60.0;
            let torque_n_m = revolution.with(*weight);
            let count = torque_n_m.len().max(1) as f64;
            let share = |of: &dyn Fn(f64) -> bool| {
                torque_n_m.iter().filter(|torque| of(**torque)).count() as f64 / count
            };
            let fold = |of: fn(f64, f64) -> f64| torque_n_m.iter().copied().reduce(of);
            let most = fold(f64::max).unwrap_or(f64::NAN);
            // of the work of a revolution, which is not that of the mean over time where the crank's speed changes
            let work = revolution.work_j(&torque_n_m);
            let least = fold(f64::min).unwrap_or(f64::NAN);
            State {
                weight: *weight,
                turn_deg: simulation.turn_deg.clone(),
                most_n_m: most,
                least_n_m: least,
                rms_n_m: mean_square(&torque_n_m).sqrt(),
                mean_n_m: work / TAU,
                above_rating: plan
                    .rating_n_m
                    .map(|rating| share(&|torque| torque.abs() > rating)),
                below_zero: share(&|torque| torque < 0.0),
                peak_power_w: speed * most,
                mean_power_w: speed * work / TAU,
                energy_kwh_per_day: work * operation.revolutions_per_day / KILOWATT_HOUR,
                counterbalance_n: counterbalance(&revolution.of_weight(*weight), simulation, speed),
                torque_n_m,
            }
        })
        .collect()
}

/// Returns the polished-rod load that a counterweight holds where it helps most: its torque over the torque factor, by
/// which the rod rises per radian of the crank.
fn counterbalance(of_weight_n_m: &[f64], simulation: &Simulation, speed: f64) -> f64 {
    let both = of_weight_n_m
        .iter()
        .zip(&simulation.suspension_velocity_m_s);
    let level = both.min_by(|a, b| a.0.total_cmp(b.0));
    level.map_or(f64::NAN, |(torque, velocity)| -torque * speed / velocity)
}
