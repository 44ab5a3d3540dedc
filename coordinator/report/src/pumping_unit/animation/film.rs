//! Frames of the animation, made of snapshots of a simulation: thinned, rounded and packed for the JavaScript
//! player. Lengths are whole millimetres, forces tenths of kilonewtons: finer than a pixel, and compact in
//! the file.
use crate::color::{Color, Ramp};
use crate::number::{MISSING, fixed};
use maud::{Markup, html};
use protocol::{
    case::Case,
    pumping_unit::{Machine, MachineSnapshot, Sensor, Simulation},
};
use serde::Serialize;
use support::quantile;

/// Colour scale of the tension, low to high: deep blue over violet and rose to orange.
pub(super) const TENSION: Ramp = Ramp([
    Color(0x1c, 0x2a, 0x7c),
    Color(0x5b, 0x1f, 0x9b),
    Color(0xa6, 0x2a, 0x8e),
    Color(0xdd, 0x51, 0x66),
    Color(0xf4, 0x92, 0x3a),
]);

/// Millimetres per unit of the drawing (1 unit = 1 cm).
pub(super) const MM: f64 = 10.0;
/// Maximum number of frames of the animation: one every two degrees of the crank.
const FRAMES: usize = 181;

/// Scalar that the player shows next to the drawing.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Readout {
    /// Label of the scalar shown next to the drawing.
    pub label: String,
    pub unit: &'static str,
    /// Number of decimals of the scalar shown.
    pub decimals: usize,
    /// Value per frame, rounded to the decimals; `None` where the simulation has no value.
    pub values: Vec<Option<f64>>,
}

/// Path and tension of one rope in one frame.
#[derive(Clone, Debug, Serialize)]
pub(super) struct RopeFrame {
    /// Centres of the rope's cylinders, delta-encoded: first x, y, then differences to the previous cylinder
    /// \[mm\].
    pub path: Vec<i32>,
    /// Axial force in the joint before each cylinder [0.1 kN].
    pub tension: Vec<i32>,
    /// Contact force on each cylinder, as height of the pressure diagram \[mm\].
    pub contact: Vec<i32>,
}

/// Data of the animation, embedded as JSON for the player.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Film {
    /// Crank angle of each frame \[deg\].
    pub turn: Vec<f64>,
    /// Time that the machine takes per degree of crank angle, in seconds.
    pub seconds_per_deg: f64,
    /// Angle of the beam in each frame \[deg\].
    pub beam: Vec<f64>,
    /// Position x, y of the crank pin in each frame \[mm\].
    pub pin: Vec<[i32; 2]>,
    /// Position x, y of the rod's end at the crossbeam in each frame \[mm\].
    pub crossbeam: Vec<[i32; 2]>,
    /// Position x, y of the rope's suspension point in each frame \[mm\].
    pub suspension: Vec<[i32; 2]>,
    /// Path and tension of the back rope in each frame.
    pub back: Vec<RopeFrame>,
    /// Path and tension of the front rope in each frame.
    pub front: Vec<RopeFrame>,
    /// Back head: arc centre x, y in the beam frame \[mm\], anchor x, y in the beam frame \[mm\].
    pub back_head: [i32; 4],
    /// Front head: arc centre x, y and anchor x, y in the beam frame \[mm\].
    pub front_head: [i32; 4],
    /// Crank centre x, y \[mm\], and angle from the crank pin to the counterweight, counter-clockwise
    /// positive \[deg\].
    pub crank: [f64; 3],
    /// Smallest and largest tension on the colour scale [0.1 kN].
    pub tension_range: [f64; 2],
    /// Colours of the tension scale, evenly spaced.
    pub stops: Vec<String>,
    /// Contact force per length that the pressure diagram shows as one metre [kN/m].
    #[serde(skip)]
    pub pressure_kn_per_m: f64,
    /// Scalars shown next to the drawing.
    pub readouts: Vec<Readout>,
}

/// Returns whether all coordinates of a snapshot are finite; other snapshots are left out.
fn is_finite(motion: &MachineSnapshot) -> bool {
    let single = [
        motion.crank_pin_m,
        motion.crossbeam_m,
        motion.suspension_m,
        [motion.beam_deg, 0.0],
    ];
    let ropes = motion.back_rope_m.iter().chain(&motion.front_rope_m);
    let mut places = ropes.chain(&single).flatten();
    motion.turn_deg.is_finite() && places.all(|place| place.is_finite())
}

/// Converts metres to whole millimetres; zero for a value that is not finite.
#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to a range that fits"
)]
pub(super) fn mm(metres: f64) -> i32 {
    let mm = (1e3 * metres).round().clamp(-1e6, 1e6);
    if mm.is_finite() { mm as i32 } else { 0 }
}

fn point_mm([x, y]: [f32; 2]) -> [i32; 2] {
    [mm(f64::from(x)), mm(f64::from(y))]
}

fn rounded(value: f64, decimals: usize) -> Option<f64> {
    let scale = 10_f64.powi(i32::try_from(decimals).unwrap_or(0));
    let rounded = (value * scale).round() / scale;
    rounded.is_finite().then_some(rounded)
}

impl RopeFrame {
    fn new(points: &[[f32; 2]], tension_n: &[f32], contact_n: &[f32], mm_per_newton: f64) -> Self {
        let mut path = Vec::with_capacity(2 * points.len());
        let mut before = [0, 0];
        for &point in points {
            let [x, y] = point_mm(point);
            path.extend([x - before[0], y - before[1]]);
            before = [x, y];
        }
        // hundreds of newtons, through the same rounding as lengths
        let force = |newtons: f32| mm(1e-5 * f64::from(newtons));
        let contact = |newtons: f32| mm(1e-3 * mm_per_newton * f64::from(newtons)).clamp(0, 1500);
        let count = points.len();
        Self {
            path,
            tension: (0..count)
                .map(|index| tension_n.get(index).map_or(0, |&t| force(t)))
                .collect(),
            contact: (0..count)
                .map(|index| contact_n.get(index).map_or(0, |&c| contact(c)))
                .collect(),
        }
    }

    /// Decodes the centres of the cylinders \[mm\].
    pub(super) fn points(&self) -> Vec<[i32; 2]> {
        let mut at = [0, 0];
        self.path
            .chunks_exact(2)
            .map(|step| {
                at = [at[0] + step[0], at[1] + step[1]];
                at
            })
            .collect()
    }
}

impl Film {
    /// Packs the snapshots of a simulation into an animation; `None` if the simulation has none.
    pub(super) fn new(
        case: &Case,
        machine: &Machine,
        condition: usize,
        simulation: &Simulation,
    ) -> Option<Self> {
        let usable: Vec<&MachineSnapshot> = simulation
            .motion
            .iter()
            .filter(|motion| is_finite(motion))
            .collect();
        let every = usable.len().div_ceil(FRAMES).max(1);
        let frames: Vec<&MachineSnapshot> = usable.iter().copied().step_by(every).collect();
        frames.first()?;
        let speed_rpm = machine.conditions.get(condition)?.speed_rpm;
        let sorted = |values: &mut dyn Iterator<Item = f32>| {
            let mut values: Vec<f64> = values.map(f64::from).filter(|v| v.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let tensions = sorted(
            &mut frames
                .iter()
                .flat_map(|m| m.back_tension_n.iter().chain(&m.front_tension_n).copied()),
        );
        let contacts = sorted(
            &mut frames
                .iter()
                .flat_map(|m| m.back_contact_n.iter().chain(&m.front_contact_n).copied())
                .filter(|&force| force > 0.0),
        );
        let end = |percent| quantile::of(&tensions, percent).map_or(0.0, |newtons| 1e-2 * newtons);
        let (low, high) = (
            (end(2) / 50.0).floor() * 50.0,
            (end(98) / 50.0).ceil() * 50.0,
        );
        // the strong contacts of ordinary running are drawn about 0.35 m high
        let strong_n = quantile::of(&contacts, 90).unwrap_or(1.0).max(1.0);
        let mm_per_newton = 350.0 / strong_n;
        let rope = |points: &[[f32; 2]], tension: &[f32], contact: &[f32]| {
            RopeFrame::new(points, tension, contact, mm_per_newton)
        };
        let phase = machine.crank.counterweight_phase_deg;
        let phase = match machine.crank.sense {
            protocol::pumping_unit::TurnSense::Clockwise => -phase,
            protocol::pumping_unit::TurnSense::CounterClockwise => phase,
        };
        let (back, front) = (&machine.back_head, &machine.front_head);
        Some(Self {
            turn: frames.iter().map(|m| m.turn_deg).collect(),
            seconds_per_deg: 60.0 / (360.0 * speed_rpm.abs().max(0.1)),
            beam: frames
                .iter()
                .filter_map(|m| rounded(f64::from(m.beam_deg), 3))
                .collect(),
            pin: frames.iter().map(|m| point_mm(m.crank_pin_m)).collect(),
            crossbeam: frames.iter().map(|m| point_mm(m.crossbeam_m)).collect(),
            suspension: frames.iter().map(|m| point_mm(m.suspension_m)).collect(),
            back: frames
                .iter()
                .map(|m| rope(&m.back_rope_m, &m.back_tension_n, &m.back_contact_n))
                .collect(),
            front: frames
                .iter()
                .map(|m| rope(&m.front_rope_m, &m.front_tension_n, &m.front_contact_n))
                .collect(),
            back_head: head(
                (back.center_x_m, back.center_y_m),
                back.radius_m,
                back.rope_anchor_deg,
            ),
            front_head: head((0.0, 0.0), front.radius_m, front.rope_anchor_deg),
            crank: [
                f64::from(mm(machine.crank.center_x_m)),
                f64::from(mm(machine.crank.center_y_m)),
                phase,
            ],
            tension_range: [low, if high > low { high } else { low + 50.0 }],
            stops: TENSION.0.map(|stop| stop.to_string()).to_vec(),
            pressure_kn_per_m: 1e-3 * strong_n / machine.ropes.cylinder_length_m / 0.35,
            readouts: readouts(case, simulation, &frames),
        })
    }

    /// Serialises the animation's data as JSON, escaped for inline HTML.
    pub(super) fn json(&self) -> String {
        // a list of numbers and strings always serialises
        serde_json::to_string(self)
            .unwrap_or_default()
            .replace('<', "\\u003c")
            .replace('&', "\\u0026")
    }

    /// Renders the scalars shown next to the drawing, for the first frame, as a table.
    pub(super) fn readouts(&self) -> Markup {
        html! {
            table.readouts {
                tbody {
                    @for (index, readout) in self.readouts.iter().enumerate() {
                        tr {
                            th scope="row" { (readout.label) }
                            td id=(format!("machine-value-{index}")) {
                                (readout.values.first().copied().flatten().map_or_else(
                                    || MISSING.to_owned(),
                                    |value| fixed(value, readout.decimals)
                                ))
                            }
                            td.unit { (readout.unit) }
                        }
                    }
                }
            }
        }
    }
}

/// Returns the arc centre and the rope anchor of a horse head in the beam frame, as x, y of each \[mm\].
fn head((x, y): (f64, f64), radius_m: f64, anchor_deg: f64) -> [i32; 4] {
    let (sin, cos) = anchor_deg.to_radians().sin_cos();
    [mm(x), mm(y), mm(x + radius_m * cos), mm(y + radius_m * sin)]
}

fn readouts(case: &Case, simulation: &Simulation, frames: &[&MachineSnapshot]) -> Vec<Readout> {
    let sampled = |label: String, unit, decimals, factor: f64, values: &[f64]| Readout {
        label,
        unit,
        decimals,
        values: frames
            .iter()
            .map(|frame| {
                let turn = &simulation.turn_deg;
                let value = support::interpolation::interpolated(turn, values, frame.turn_deg)?;
                rounded(factor * value, decimals)
            })
            .collect(),
    };
    let mut readouts = vec![
        Readout {
            label: "crank angle".to_owned(),
            unit: "deg",
            decimals: 1,
            values: frames.iter().map(|m| rounded(m.turn_deg, 1)).collect(),
        },
        Readout {
            label: "beam angle".to_owned(),
            unit: "deg",
            decimals: 1,
            values: frames
                .iter()
                .map(|m| rounded(f64::from(m.beam_deg), 1))
                .collect(),
        },
    ];
    let curves: [(&str, &'static str, usize, f64, &[f64]); 4] = [
        ("suspension height", "m", 2, 1.0, &simulation.suspension_m),
        (
            "back rope tension",
            "kN",
            1,
            1e-3,
            &simulation.back_rope_tension_n,
        ),
        (
            "front rope tension",
            "kN",
            1,
            1e-3,
            &simulation.front_rope_tension_n,
        ),
        (
            "crank torque",
            "kN m",
            1,
            1e-3,
            &simulation.crank_torque_n_m,
        ),
    ];
    for (label, unit, decimals, factor, values) in curves {
        readouts.push(sampled(label.to_owned(), unit, decimals, factor, values));
    }
    for gauge in case
        .objective
        .terms
        .iter()
        .filter_map(|term| Sensor::gauge(&term.channel))
    {
        readouts.push(sampled(
            format!("stress at gauge {gauge}"),
            "MPa",
            1,
            1.0,
            &simulation.gauge_mpa[usize::from(gauge) - 1],
        ));
    }
    readouts
}
