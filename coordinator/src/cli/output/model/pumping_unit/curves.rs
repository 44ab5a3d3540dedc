//! Curves of a revolution in the output object of `horsehead simulate`.
use discrepancy::identify::Band;
use protocol::{
    case::Case,
    job::{Per, Verdict},
    pumping_unit::{Energy, Sensor, Simulation},
};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Returns the derivative curves of a revolution with respect to one parameter: gauge stresses by gauge
/// number (MPa per unit `per` of the parameter), and suspension position and crank torque where the case has
/// these channels.
pub(super) fn derivative(
    case: &Case,
    condition: usize,
    per: &Per,
    curves: &[Vec<f32>],
) -> Map<String, Value> {
    let channels = case.channels_of(condition).zip(curves);
    let gauges = channels.filter_map(|((_, channel), values)| {
        let gauge = Sensor::gauge(&channel.name)?;
        Some((gauge.to_string(), json!(values)))
    });
    let gauges = Value::Object(gauges.collect());
    let mut said = Map::from_iter([
        ("unit".to_owned(), json!(format!("MPa per {per}"))),
        ("gauge_mpa".to_owned(), gauges),
    ]);
    for ((_, channel), values) in case.channels_of(condition).zip(curves) {
        let key = match Sensor::named(&channel.name) {
            Some(Sensor::Position) => "suspension_m",
            Some(Sensor::Torque) => "crank_torque_n_m",
            Some(Sensor::Gauge(_)) | None => continue,
        };
        said.insert(key.to_owned(), json!(values));
    }
    said
}

/// Returns the prediction bands (lowest and highest curve) of the channels: gauges by gauge number in MPa,
/// others in the unit stated in their JSON key.
pub(super) fn predicted(case: &Case, band: &Band) -> Map<String, Value> {
    let mut said = Map::new();
    for ((_, channel), curve) in case.channels_of(band.condition).zip(&band.channels) {
        let key = match Sensor::named(&channel.name) {
            Some(Sensor::Gauge(gauge)) => gauge.to_string(),
            Some(Sensor::Position) => "suspension_m".to_owned(),
            Some(Sensor::Torque) => "crank_torque_n_m".to_owned(),
            None => continue,
        };
        said.insert(key, json!({"low": curve.low, "high": curve.high}));
        said.insert("crank_deg".to_owned(), json!(channel.abscissa.points));
        said.insert("unit".to_owned(), json!("MPa"));
    }
    said
}

/// Curves of a simulated crank revolution, and its energy balance, for JSON output.
#[derive(Debug, Serialize)]
pub(super) struct CurvesOutput<'a> {
    /// Crank angle from bottom dead centre (deg).
    crank_deg: &'a [f64],
    /// Stress curves of the strain gauges by gauge number (MPa).
    gauge_mpa: BTreeMap<String, &'a [f64]>,
    /// Tension of the back rope at the crossbeam (N).
    rope_tension_n: &'a [f64],
    /// Tension of the front rope at the suspension (N).
    front_rope_tension_n: &'a [f64],
    /// Tension of the twin rope at +z minus that at -z (N); absent where there is one rope.
    #[serde(skip_serializing_if = "Option::is_none")]
    twin_tension_difference_n: Option<TwinTensionOutput<'a>>,
    /// Angle of the walking beam (deg).
    beam_deg: &'a [f64],
    /// Suspension height above its lowest design position (m).
    suspension_m: &'a [f64],
    /// Net torque at the crank shaft (N m).
    crank_torque_nm: &'a [f64],
    /// Energy balance of the revolution; null unless the revolution was completed.
    energy: Option<Energy>,
}

/// Tension of the rope at +z minus that at -z over the revolution, for the back and the front pair of ropes
/// (N).
#[derive(Debug, Serialize)]
struct TwinTensionOutput<'a> {
    back: &'a [f64],
    front: &'a [f64],
}

impl<'a> From<&'a Simulation> for CurvesOutput<'a> {
    fn from(simulation: &'a Simulation) -> Self {
        let gauges = (1..).zip(&simulation.gauge_mpa);
        let [back, front] = &simulation.tension_difference_n;
        let twins = || TwinTensionOutput { back, front };
        Self {
            crank_deg: &simulation.turn_deg,
            gauge_mpa: gauges
                .map(|(gauge, curve)| (gauge.to_string(), &curve[..]))
                .collect(),
            rope_tension_n: &simulation.back_rope_tension_n,
            front_rope_tension_n: &simulation.front_rope_tension_n,
            twin_tension_difference_n: (!back.is_empty()).then(twins),
            beam_deg: &simulation.beam_deg,
            suspension_m: &simulation.suspension_m,
            crank_torque_nm: &simulation.crank_torque_n_m,
            energy: (simulation.verdict == Verdict::Complete).then_some(simulation.energy),
        }
    }
}
