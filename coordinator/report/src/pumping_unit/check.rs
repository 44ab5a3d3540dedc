//! Stroke and crank torque of a pumping unit by which an engineer judges a fit.
use crate::machine_check::{ComparedChannel, MachineCheck};
use crate::number::{fixed, percent};
use crate::words::condition_name;
use protocol::case::Case;
use protocol::job::{Curves, Verdict};
use protocol::pumping_unit::{Machine, Sensor, Simulation};

const KILO: f64 = 1e-3;

/// Share of the measured stroke by which a fit may be off, and more than before, without a flag. The recommended
/// parameters are off by 0.05 and 0.21 % of the shipped records, the instrument's tolerance is 0.2 %; fits without
/// the effect that the records hide are off by 2.5 % (5 rpm) and 5.0 % (4 rpm), those with it by
/// 0.03 %.
const STROKE_ERROR: f64 = 0.01;

/// Share of the largest measured torque below which a misfit is no reason for a flag, four times the instrument's
/// tolerance.
const LEAST_MISFIT: f64 = 0.02;

/// Factor by which the misfit of the torque may grow without a flag. Fits of the shipped records lower it to 0.45 and
/// 0.52 of what the recommended parameters leave.
const MISFIT_GROWTH: f64 = 2.0;

/// Error of the energy balance, relative to the work of the revolution, from which a simulation is not that of the
/// machine. Runs whose contacts do not chatter are off by 1e-5 to 2e-3, runs of long cylinders with strongly damped
/// contacts by up to 2 (docs/measurements.md, *Contacts that chatter*).
const ENERGY_ERROR: f64 = 0.01;

/// Returns stroke, peak torque and misfit of the torque under a condition, and the error of the energy balance where
/// it is not small.
pub(super) fn checks(
    case: &Case,
    condition: usize,
    channels: &[ComparedChannel<'_>],
    runs: Option<[&Curves; 2]>,
) -> Vec<MachineCheck> {
    let name = condition_name(case, condition);
    let of = |sensor: Sensor| {
        let mut all = channels.iter();
        all.find(|own| own.channel.name == sensor.name())
    };
    let check = |quantity, unit, [measured, before, after]: [Option<f64>; 3]| MachineCheck {
        condition: name.clone(),
        quantity,
        unit,
        measured,
        before,
        after,
        limit: None,
        flag: None,
    };
    let mut checks = Vec::new();
    if let Some(position) = of(Sensor::Position) {
        let stroke = check("stroke", "m", position.values(peak_to_peak));
        checks.push(MachineCheck {
            flag: lost_stroke(&stroke),
            ..stroke
        });
    }
    if let Some(torque) = of(Sensor::Torque) {
        let machine = Machine::of(case).ok();
        let rating = machine.and_then(|own| own.crank.reducer_rating_n_m);
        checks.push(MachineCheck {
            limit: rating.map(|rating| KILO * rating),
            ..check(
                "peak torque",
                "kN.m",
                torque.values(|curve| KILO * largest(curve)),
            )
        });
        let [before, after] = torque.misfits().map(|own| own.map(|own| KILO * own));
        if before.is_some() || after.is_some() {
            let misfit = check("torque misfit (RMS)", "kN.m", [None, before, after]);
            let [largest, ..] = torque.values(|curve| KILO * largest(curve));
            checks.push(MachineCheck {
                flag: grown_misfit(&misfit, LEAST_MISFIT * largest.unwrap_or(0.0)),
                ..misfit
            });
        }
    }
    let errors = runs
        .map(|runs| runs.map(|run| Simulation::of(run).ok().and_then(|run| energy_error(&run))));
    checks.extend(errors.and_then(|[before, after]| {
        energy(check("energy balance error", "%", [None, before, after]))
    }));
    checks
}

/// Returns the relative error of the energy balance of a simulation that was completed.
fn energy_error(simulation: &Simulation) -> Option<f64> {
    (simulation.verdict == Verdict::Complete).then_some(simulation.energy.relative_error)
}

/// Returns the errors of the energy balance as a quantity, if one of them is not small.
fn energy(error: MachineCheck) -> Option<MachineCheck> {
    let open = |own: Option<f64>| own.is_some_and(is_open);
    let percents = |own: Option<f64>| own.map(|own| 100.0 * own);
    let flag = error.after.filter(|own| is_open(*own));
    let flag = flag.map(|own| format!("Under condition {} {}", error.condition, open_balance(own)));
    (open(error.before) || open(error.after)).then(|| MachineCheck {
        flag,
        before: percents(error.before),
        after: percents(error.after),
        limit: percents(Some(ENERGY_ERROR)),
        ..error
    })
}

/// Returns whether an error of the energy balance is too large for the simulation to be that of the machine.
fn is_open(error: f64) -> bool {
    error.is_nan() || error > ENERGY_ERROR
}

/// Returns why a simulation whose energy balance is open is not to be used; `None` for others.
pub(super) fn warning(simulation: &Simulation) -> Option<String> {
    let error = energy_error(simulation).filter(|own| is_open(*own))?;
    Some(format!(
        "Do not use this simulation: {}",
        open_balance(error)
    ))
}

/// Describes an error of the energy balance that is too large, and its remedy.
fn open_balance(error: f64) -> String {
    format!(
        "the energy balance of the simulation is off by {} of its work: probably a rope chatters on its head, which the \
         steps do not resolve, and the stress is not that of the machine. Simulate with a smaller \
         `tolerance` or shorter cylinders.",
        percent(error)
    )
}

fn peak_to_peak(curve: &[f64]) -> f64 {
    let high = curve.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = curve.iter().copied().fold(f64::INFINITY, f64::min);
    high - low
}

fn largest(curve: &[f64]) -> f64 {
    curve.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Returns the flag of a stroke that the fit takes away from the measured one.
fn lost_stroke(stroke: &MachineCheck) -> Option<String> {
    let (measured, after) = stroke.measured.zip(stroke.after)?;
    let error = after / measured - 1.0;
    let before = stroke.before.map_or(0.0, |before| before / measured - 1.0);
    (error.abs() > STROKE_ERROR && error.abs() > before.abs()).then(|| {
        format!(
            "Under condition {} the fit has a stroke of {} m where {} m were measured ({}): it reproduces the gauges at \
             the cost of the motion, and its values are not those of the machine.",
            stroke.condition,
            fixed(after, 3),
            fixed(measured, 3),
            percent(error)
        )
    })
}

/// Returns the flag of a torque whose misfit the fit multiplies.
fn grown_misfit(misfit: &MachineCheck, least: f64) -> Option<String> {
    let (before, after) = misfit.before.zip(misfit.after)?;
    (after > MISFIT_GROWTH * before && after > least).then(|| {
        format!(
            "Under condition {} the crank torque differs from the measured one by {} kN·m (root mean square) after the \
             fit, {} kN·m before: the fit reproduces the gauges at the cost of the torque.",
            misfit.condition,
            fixed(after, 2),
            fixed(before, 2)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Channel, Condition};

    fn case() -> Case {
        Case {
            conditions: vec![Condition {
                name: "5rpm".to_owned(),
            }],
            ..Case::default()
        }
    }

    fn channel(sensor: Sensor) -> Channel {
        sensor.channel(0, vec![0.0, 90.0, 180.0, 270.0])
    }

    #[test]
    fn a_fit_that_loses_stroke_is_flagged_and_one_that_does_not_is_not() {
        let of = channel(Sensor::Position);
        let stroke = |before: f64, after: f64| {
            let curve = |height: f64| [0.0, 0.5 * height, height, 0.5 * height];
            let compared = ComparedChannel {
                channel: &of,
                measured: &curve(3.97),
                before: &curve(before),
                after: &curve(after),
            };
            checks(&case(), 0, &[compared], None).remove(0)
        };
        let lost = stroke(3.98, 3.67);
        assert_eq!((lost.measured, lost.after), (Some(3.97), Some(3.67)));
        let flag = lost.flag.unwrap();
        for part in ["5rpm", "3.670 m", "3.970 m", "−7.6\u{a0}%"] {
            assert!(flag.contains(part), "{part}: {flag}");
        }
        assert_eq!(stroke(3.98, 3.96).flag, None);
        // what was wrong before is no fault of the fit
        assert_eq!(stroke(3.60, 3.67).flag, None);
    }

    #[test]
    fn a_torque_is_flagged_when_its_misfit_doubles() {
        let of = channel(Sensor::Torque);
        let misfit = |before: f64, after: f64| {
            // a constant difference counts: the torque has an absolute zero
            let curve = |by: f64| [1e3 * by, 38.5e3 + 1e3 * by, 1e3 * by, -20e3 + 1e3 * by];
            let compared = ComparedChannel {
                channel: &of,
                measured: &[0.0, 38.5e3, 0.0, -20e3],
                before: &curve(before),
                after: &curve(after),
            };
            checks(&case(), 0, &[compared], None)
        };
        let [peak, grown] = misfit(1.0, 2.1).try_into().unwrap();
        assert!((peak.measured.unwrap() - 38.5).abs() < 1e-12);
        assert!((grown.before.unwrap() - 1.0).abs() < 1e-12);
        assert!(grown.flag.unwrap().contains("2.10 kN·m"));
        assert_eq!(misfit(1.0, 1.9)[1].flag, None);
        // what no instrument resolves is no reason
        assert_eq!(misfit(0.1, 0.7)[1].flag, None);
    }

    /// Checks that a fit whose simulation does not keep its energy is flagged, and that the balance of others is not
    /// listed.
    #[test]
    fn a_simulation_that_loses_energy_is_flagged() {
        let of = |before: f64, after: f64| {
            energy(MachineCheck {
                condition: "5rpm".to_owned(),
                quantity: "energy balance error",
                unit: "%",
                measured: None,
                before: Some(before),
                after: Some(after),
                limit: None,
                flag: None,
            })
        };
        let open = of(1e-5, 0.12).unwrap();
        assert!((open.after.unwrap() - 12.0).abs() < 1e-9);
        let flag = open.flag.unwrap();
        for part in ["5rpm", "12.0\u{a0}%", "`tolerance`"] {
            assert!(flag.contains(part), "{part}: {flag}");
        }
        assert_eq!(of(0.12, 1e-5).unwrap().flag, None);
        assert_eq!(of(2e-3, 2e-3), None);
    }

    /// Checks that a simulation that failed has no quantities, and that what was not measured is not compared.
    #[test]
    fn incomplete_curves_have_no_values() {
        let of = channel(Sensor::Torque);
        let compared = ComparedChannel {
            channel: &of,
            measured: &[],
            before: &[1e3, 2e3],
            after: &[1e3, -4e3, 2e3, 0.0],
        };
        let all = checks(&case(), 0, &[compared], None);
        assert_eq!(all.len(), 1);
        assert_eq!(
            (all[0].measured, all[0].before, all[0].after),
            (None, None, Some(4.0))
        );
    }
}
