//! Tables, figures' data and JSON object of `horsehead balance`.
use super::{
    options::BalancePlan,
    summary::{AssessedCrank, State, goal_of},
    torque::{Counterweight, Goal, mean_square},
};
use crate::cli::argument::hours::Operation;
use discrepancy::estimate::neighbourhood::QuantityInterval;
use protocol::{
    case::Case,
    pumping_unit::{Counterweights, Machine, Sensor},
};
use report::document::{Row, Table};
use serde_json::{Value, json};
use support::interpolation::periodic;

/// Factor from newton metres, watts and newtons to the units of the tables.
const KILO: f64 = 1e-3;
/// Correlation of the measured with the simulated torque below which the record has the opposite sign.
const OPPOSITE: f64 = -0.5;

/// States the peak against the rating, and what the best counterweight changes.
pub(super) fn lead(plan: &BalancePlan, present: &AssessedCrank, optimum: &AssessedCrank) -> String {
    let peak = goal_of(Goal::Peak, plan, &present.states);
    let rated = plan.rating_n_m.map_or_else(String::new, |rating| {
        format!(
            ", {:.0} % of the reducer's rating of {:.1} kN.m",
            100.0 * peak / rating,
            KILO * rating
        )
    });
    let [before, after] = [present, optimum].map(|own| goal_of(plan.goal, plan, &own.states));
    format!(
        "With the {} parameters the largest torque of the crank is {:.1} kN.m{rated}. A counterweight moment of {:.1} kN.m \
         at {:.1} deg gives the least {} within the bounds, {:.2} kN.m in place of {:.2} ({:+.1}\u{a0}%).",
        present.name,
        KILO * peak,
        KILO * optimum.best.moment_n_m,
        optimum.best.phase_deg,
        plan.goal.name(),
        KILO * after,
        KILO * before,
        100.0 * (after / before - 1.0),
    )
}

/// Returns what a reader must know beside the numbers.
pub(super) fn notes(
    (case, of_run): (&Case, bool),
    plan: &BalancePlan,
    present: &AssessedCrank,
    optimum: &AssessedCrank,
) -> Vec<String> {
    let mut notes = Vec::new();
    if plan.rating_n_m.is_none() {
        // a run belongs to its case as it is
        let remedy = if of_run {
            ""
        } else {
            "`reducer_rating_n_m` in [crank], or "
        };
        notes.push(format!(
            "the case states no rating of its reducer: {remedy}--rating"
        ));
    }
    let moments = plan.present.iter().map(|own| own.moment_n_m);
    let first = plan.present.first().map_or(0.0, |own| own.moment_n_m);
    if moments
        .clone()
        .any(|moment| (moment - first).abs() > 1e-6 * first.abs())
    {
        notes.push(
            "the conditions have counterweight moments of their own; the best one is common to all of them".to_owned(),
        );
    }
    if plan.bounds.step_n_m.is_none() && plan.bounds.ends_at(optimum.best.moment_n_m) {
        notes.push(format!(
            "the best moment, {:.1} kN.m, is the end of those that are possible: beyond it the {} would be less",
            KILO * optimum.best.moment_n_m,
            plan.goal.name()
        ));
    }
    if case
        .effects
        .iter()
        .any(|own| own.id == "counterweight_phase")
    {
        notes.push(
            "the effect counterweight_phase changes the speed of the crank alone: its phase and moment are not in the \
             present counterweight"
                .to_owned(),
        );
    }
    let [before, after] = [present, optimum].map(|own| goal_of(Goal::Peak, plan, &own.states));
    if plan
        .rating_n_m
        .is_some_and(|rating| after > before.max(rating))
    {
        notes.push(format!(
            "the least {} raises the largest torque from {} to {} kN.m, above the rating; `--goal peak` gives the least \
             of it, `--phase` frees the phase",
            plan.goal.name(),
            kilo(before),
            kilo(after)
        ));
    }
    let checked = present.intervals.iter().flat_map(|own| &own.states);
    notes.extend(
        checked
            .flatten()
            .flatten()
            .find_map(QuantityInterval::doubt),
    );
    for (operation, state) in plan.operations.iter().zip(&present.states) {
        let Some(measured) = measured(case, operation.condition) else {
            continue;
        };
        if correlation_at(measured, (&state.turn_deg, &state.torque_n_m)) < OPPOSITE {
            notes.push(format!(
                "the measured torque of {} has the opposite sign of the simulated one: the record counts a torque as \
                 negative that drives the machine; correct its column",
                operation.name
            ));
        }
    }
    notes
}

/// Returns the measured torque of a condition with the crank angles at which it was measured.
pub(super) fn measured(case: &Case, condition: usize) -> Option<(&[f64], &[f64])> {
    let mut channels = case.channels_of(condition);
    let (_, channel) = channels.find(|(_, own)| own.name == Sensor::Torque.name())?;
    let record = channel.record.as_ref()?;
    Some((&channel.abscissa.points, &record.mean))
}

/// Returns the correlation of a measured with a simulated curve over the crank angles of the latter.
fn correlation_at(measured: (&[f64], &[f64]), (turn_deg, simulated): (&[f64], &[f64])) -> f64 {
    let value = |turn: &f64| periodic(measured.0, measured.1, *turn, 360.0).unwrap_or(f64::NAN);
    let measured: Vec<f64> = turn_deg.iter().map(value).collect();
    correlation(&measured, simulated)
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let centred = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        values.iter().map(|x| x - mean).collect::<Vec<f64>>()
    };
    let (a, b) = (centred(a), centred(b));
    let product: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    let count = a.len().max(1) as f64;
    product / (count * (mean_square(&a) * mean_square(&b)).sqrt())
}

/// Builds the tables: torque and power before and after, what to do at the machine, and the machines that are compared.
pub(super) fn tables(
    (case, machine): (&Case, &Machine),
    plan: &BalancePlan,
    assessed: &[AssessedCrank],
    optimum: &AssessedCrank,
) -> Vec<Table> {
    let Some(present) = assessed.last() else {
        return Vec::new();
    };
    let mut tables: Vec<Table> = plan
        .operations
        .iter()
        .enumerate()
        .map(|(k, operation)| before_and_after((case, operation), k, present, optimum))
        .collect();
    tables.push(practice(machine, plan, optimum));
    if assessed.len() > 1 {
        tables.push(by_parameters(plan, assessed));
    }
    tables
}

fn before_and_after(
    (case, operation): (&Case, &Operation),
    k: usize,
    present: &AssessedCrank,
    optimum: &AssessedCrank,
) -> Table {
    let columns = Columns {
        states: [&present.states[k], &optimum.states[k]],
        intervals: present.intervals.as_ref().map(|own| own.states[k]),
        measured: measured(case, operation.condition).map(|(_, torque)| torque),
    };
    let title = format!(
        "Torque of the crank, {} for {} h a day, {} parameters",
        operation.name, operation.hours_per_day, present.name
    );
    let head = ["", "unit", "measured", "present", "95 %", "best"];
    let mut rows = columns.torque();
    rows.extend(columns.power());
    Table::new(title, head, rows).with_notes([
        "Cyclic load factor: root mean square over mean. Energy and power are those at the crank shaft; the losses of a \
         motor's windings grow with the square of the root mean square.",
    ])
}

/// Columns of the table of torque and power under one condition.
struct Columns<'a> {
    /// With the present and the best counterweight.
    states: [&'a State; 2],
    /// Intervals of largest torque, root mean square and energy.
    intervals: Option<[Option<QuantityInterval>; 3]>,
    measured: Option<&'a [f64]>,
}

impl Columns<'_> {
    fn row(
        &self,
        [label, unit]: [&str; 2],
        of: &dyn Fn(&State) -> String,
        [read, half]: [String; 2],
    ) -> Row {
        let [before, after] = self.states.map(of);
        Row::new(label, [unit.to_owned(), read, before, half, after])
    }

    fn plain(&self, words: [&str; 2], of: &dyn Fn(&State) -> String) -> Row {
        self.row(words, of, [const { String::new() }; 2])
    }

    fn half(&self, which: usize, factor: f64, digits: usize) -> String {
        let own = self.intervals.and_then(|own| own[which]);
        own.map_or_else(String::new, |own| {
            format!("± {:.digits$}", factor * own.half_width)
        })
    }

    fn torque(&self) -> Vec<Row> {
        let read = |of: &dyn Fn(&[f64]) -> f64| {
            self.measured
                .map_or_else(String::new, |torque| kilo(of(torque)))
        };
        let extreme = |of: fn(f64, f64) -> f64| {
            read(&|torque| torque.iter().copied().reduce(of).unwrap_or(f64::NAN))
        };
        let none = String::new;
        let mean = read(&|torque| torque.iter().sum::<f64>() / torque.len().max(1) as f64);
        let rms = read(&|torque| mean_square(torque).sqrt());
        let percent = |share: f64| format!("{:.1}", 100.0 * share);
        let mut rows = vec![
            self.plain(["counterweight moment", "kN.m"], &|own| {
                kilo(own.weight.moment_n_m)
            }),
            self.plain(["counterweight phase", "deg"], &|own| {
                format!("{:.2}", own.weight.phase_deg)
            }),
            self.row(
                ["largest torque", "kN.m"],
                &|own| kilo(own.most_n_m),
                [extreme(f64::max), self.half(0, KILO, 2)],
            ),
            self.row(
                ["least torque", "kN.m"],
                &|own| kilo(own.least_n_m),
                [extreme(f64::min), none()],
            ),
            self.row(
                ["root mean square", "kN.m"],
                &|own| kilo(own.rms_n_m),
                [rms, self.half(1, KILO, 2)],
            ),
            self.row(
                ["mean torque", "kN.m"],
                &|own| kilo(own.mean_n_m),
                [mean, none()],
            ),
            self.plain(["cyclic load factor", ""], &|own| {
                format!("{:.3}", own.cyclic_load_factor())
            }),
            self.plain(["revolution below zero", "%"], &|own| {
                percent(own.below_zero)
            }),
        ];
        if self.states[0].above_rating.is_some() {
            rows.push(self.plain(["revolution above the rating", "%"], &|own| {
                own.above_rating.map_or_else(String::new, percent)
            }));
        }
        rows
    }

    fn power(&self) -> [Row; 4] {
        [
            self.plain(["peak power", "kW"], &|own| kilo(own.peak_power_w)),
            self.plain(["mean power", "kW"], &|own| kilo(own.mean_power_w)),
            self.row(
                ["energy", "kWh a day"],
                &|own| format!("{:.1}", own.energy_kwh_per_day),
                [String::new(), self.half(2, 1.0, 1)],
            ),
            self.plain(["counterbalance effect", "kN"], &|own| {
                kilo(own.counterbalance_n)
            }),
        ]
    }
}

/// Returns a torque, power or force in thousands of its unit.
fn kilo(value: f64) -> String {
    format!("{:.2}", KILO * value)
}

/// Builds the table of what to do at the machine under each condition.
fn practice(machine: &Machine, plan: &BalancePlan, optimum: &AssessedCrank) -> Table {
    let rows = plan
        .operations
        .iter()
        .zip(&plan.present)
        .map(|(operation, present)| {
            let change = optimum.best.moment_n_m - present.moment_n_m;
            let mut cells = vec![
                format!("{:+.2}", KILO * change),
                format!("{:+.2}", optimum.best.phase_deg - present.phase_deg),
            ];
            let weights = machine.crank.counterweights.as_ref();
            let own = weights.and_then(|own| Move::of(own, machine.gravity_m_s2, *present, change));
            cells.extend(own.map_or([const { String::new() }; 3], |own| {
                [
                    format!("{:.0}", 1e3 * own.radius_m),
                    format!("{:+.0}", 1e3 * own.by_m),
                    format!("{:+.0}", own.mass_kg),
                ]
            }));
            Row::new(operation.name.clone(), cells)
        });
    let head = [
        "",
        "moment kN.m",
        "phase deg",
        "weights are at mm",
        "move all by mm",
        "or add in all kg",
    ];
    let note = if machine.crank.counterweights.is_some() {
        "Outwards positive; the mass is added at the present distance from the shaft. A phase is set by weights of unequal \
         distance on the leading and the trailing side of the cranks."
    } else {
        "State `counterweights` in [crank] of case.toml to read the change as a move of the weights."
    };
    Table::new("What to do at the machine", head, rows.collect()).with_notes([note])
}

/// Change of a moment as a move of all weights, or as mass that is added where they are.
struct Move {
    /// Present distance of the weights from the shaft \[m\].
    radius_m: f64,
    by_m: f64,
    mass_kg: f64,
}

impl Move {
    /// Returns the move for a change of the moment; `None` where the present moment is not that of the stated weights.
    fn of(
        weights: &Counterweights,
        gravity: f64,
        present: Counterweight,
        change: f64,
    ) -> Option<Self> {
        let weight = f64::from(weights.count) * weights.mass_kg * gravity;
        let radius_m = (present.moment_n_m - weights.crank_moment_n_m) / weight;
        (radius_m > 0.0 && radius_m.is_finite()).then(|| Self {
            radius_m,
            by_m: change / weight,
            mass_kg: change / (gravity * radius_m),
        })
    }
}

/// Builds the table of the machines that are compared, with what each effect costs.
fn by_parameters(plan: &BalancePlan, assessed: &[AssessedCrank]) -> Table {
    let of_last = assessed.last().map_or(f64::NAN, energy);
    let rows = assessed.iter().map(|own| {
        let cells = [
            format!("{:.2}", KILO * goal_of(Goal::Peak, plan, &own.states)),
            format!(
                "{:.2}",
                KILO * goal_of(Goal::RootMeanSquare, plan, &own.states)
            ),
            format!("{:.1}", energy(own)),
            format!("{:+.1}", energy(own) - of_last),
            format!("{:.1}", KILO * own.best.moment_n_m),
        ];
        Row::new(own.name.clone(), cells)
    });
    let head = [
        "",
        "peak kN.m",
        "RMS kN.m",
        "kWh a day",
        "less the last",
        "best moment kN.m",
    ];
    Table::new("Torque and energy by parameters", head, rows.collect())
}

/// Returns the energy of a day over all conditions [kWh].
fn energy(own: &AssessedCrank) -> f64 {
    own.states
        .iter()
        .map(|state| state.energy_kwh_per_day)
        .sum()
}

/// Writes the torque with the present and the best counterweight as CSV, a line for each crank angle and condition.
///
/// # Errors
/// None that memory does not have.
pub(super) fn csv(
    plan: &BalancePlan,
    (present, optimum): (&AssessedCrank, &AssessedCrank),
) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["condition", "crank_deg", "present_n_m", "best_n_m"])?;
    let states = present.states.iter().zip(&optimum.states);
    for (operation, (before, after)) in plan.operations.iter().zip(states) {
        let torques = before.torque_n_m.iter().zip(&after.torque_n_m);
        for (turn, (before, after)) in before.turn_deg.iter().zip(torques) {
            writer.write_record([
                operation.name.clone(),
                turn.to_string(),
                before.to_string(),
                after.to_string(),
            ])?;
        }
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Builds the output object.
pub(super) fn object(
    (case, machine): (&Case, &Machine),
    plan: &BalancePlan,
    (assessed, optimum): (&[AssessedCrank], &AssessedCrank),
    wall_s: f64,
) -> Value {
    let [low, high] = [plan.bounds.moment_n_m.start(), plan.bounds.moment_n_m.end()];
    let [from, to] = [plan.bounds.phase_deg.start(), plan.bounds.phase_deg.end()];
    let variants = assessed.iter().map(|own| crank(case, plan, own));
    let practice = plan
        .operations
        .iter()
        .zip(&plan.present)
        .map(|(operation, present)| {
            let change = optimum.best.moment_n_m - present.moment_n_m;
            let own = machine.crank.counterweights.as_ref();
            let own = own.and_then(|own| Move::of(own, machine.gravity_m_s2, *present, change));
            json!({
                "condition": operation.name,
                "moment_n_m": change,
                "phase_deg": optimum.best.phase_deg - present.phase_deg,
                "weights_at_m": own.as_ref().map(|own| own.radius_m),
                "move_by_m": own.as_ref().map(|own| own.by_m),
                "add_kg": own.as_ref().map(|own| own.mass_kg),
            })
        });
    json!({
        "case": case.name,
        "rating_n_m": plan.rating_n_m,
        "goal": match plan.goal {
            Goal::RootMeanSquare => "rms",
            Goal::Peak => "peak",
        },
        "bounds": {"moment_n_m": [low, high], "phase_deg": [from, to], "step_n_m": plan.bounds.step_n_m},
        "present": assessed.last().map(|own| crank(case, plan, own)),
        "best": crank(case, plan, optimum),
        "practice": practice.collect::<Vec<_>>(),
        "variants": variants.collect::<Vec<_>>(),
        "wall_s": wall_s,
    })
}

/// Builds the object of a crank: its goal, its best counterweight, and its state under each condition.
fn crank(case: &Case, plan: &BalancePlan, own: &AssessedCrank) -> Value {
    let with_interval = |value: f64, interval: Option<QuantityInterval>| {
        json!({
            "value": value,
            "ci95": interval.map(|own| [value - own.half_width, value + own.half_width]),
            "drawn": interval.map(|own| own.drawn),
            "drawn_inside": interval.map(|own| own.inside),
        })
    };
    let intervals = own.intervals.as_ref();
    let conditions = plan.operations.iter().zip(&own.states).enumerate();
    let conditions = conditions.map(|(k, (operation, state))| {
        let with_interval = |value: f64, which: usize| {
            with_interval(value, intervals.and_then(|own| own.states[k][which]))
        };
        let measured = measured(case, operation.condition).map(|(_, torque)| {
            let most = torque.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            json!({"largest_n_m": most, "rms_n_m": mean_square(torque).sqrt()})
        });
        json!({
            "condition": operation.name,
            "hours_per_day": operation.hours_per_day,
            "moment_n_m": state.weight.moment_n_m,
            "phase_deg": state.weight.phase_deg,
            "largest_n_m": with_interval(state.most_n_m, 0),
            "least_n_m": state.least_n_m,
            "rms_n_m": with_interval(state.rms_n_m, 1),
            "mean_n_m": state.mean_n_m,
            "cyclic_load_factor": state.cyclic_load_factor(),
            "above_rating": state.above_rating,
            "below_zero": state.below_zero,
            "peak_power_w": state.peak_power_w,
            "mean_power_w": state.mean_power_w,
            "energy_kwh_per_day": with_interval(state.energy_kwh_per_day, 2),
            "counterbalance_n": state.counterbalance_n,
            "measured": measured,
        })
    });
    json!({
        "name": own.name,
        "goal_n_m": goal_of(plan.goal, plan, &own.states),
        "best_moment_n_m": with_interval(
            own.best.moment_n_m,
            intervals.and_then(|own| own.moment_n_m),
        ),
        "best_phase_deg": own.best.phase_deg,
        "conditions": conditions.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a record of another sampling, whose first angle is not 0, is recognised by its sign.
    #[test]
    fn a_record_of_the_opposite_sign_is_recognised() {
        let at = |step: f64, first: f64, count: u32| -> Vec<f64> {
            (0..count).map(|k| first + step * f64::from(k)).collect()
        };
        let curve = |turn: &[f64]| -> Vec<f64> {
            let of = |turn: &f64| 14e3 + 9e3 * turn.to_radians().sin();
            turn.iter().map(of).collect()
        };
        let (turn, record) = (at(0.5, 0.0, 720), at(3.0, 1.5, 120));
        let measured = curve(&record);
        let simulated = curve(&turn);
        let same = turn
            .iter()
            .map(|turn| periodic(&record, &measured, *turn, 360.0).unwrap());
        let apart = same.zip(&simulated).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 10.0);
        assert!(correlation_at((&record, &measured), (&turn, &simulated)) > 0.999);
        let opposite: Vec<f64> = measured.iter().map(|x| -x).collect();
        assert!(correlation_at((&record, &opposite), (&turn, &simulated)) < OPPOSITE);
    }
}
