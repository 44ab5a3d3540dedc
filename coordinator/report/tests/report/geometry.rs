//! Closed-form kinematics of a double-horse-head unit with inextensible ropes on rigid arcs, for realistic
//! report samples without a simulation.
use protocol::pumping_unit::{Machine, MachineSnapshot};

/// Length of rod and back rope along their path, from the crank pin to the rope's anchor on the head \[m\].
const PATH_M: f64 = 6.476;
/// Length of the front rope \[m\].
const FRONT_ROPE_M: f64 = 5.70;
/// Crank-pin angle at bottom dead centre \[deg\].
const PIN_AT_BOTTOM_DEG: f64 = 86.78;

/// Pose of the machine at a crank angle.
pub(crate) struct Pose {
    pub turn_deg: f64,
    pub pin: [f64; 2],
    pub beam_rad: f64,
    /// Direction of the contact normal at the point where the back rope leaves the head's arc, ground frame
    /// \[rad\].
    pub normal_rad: f64,
    /// Lever arm of the straight part of the back rope about the beam's pivot \[m\].
    pub arm_m: f64,
    /// Length of the straight part of the back rope between crossbeam and arc \[m\].
    pub free_m: f64,
}

fn residual(machine: &Machine, pin: [f64; 2], beam: f64, normal: f64) -> [f64; 2] {
    let head = &machine.back_head;
    let psi = normal - beam;
    let (sin, cos) = psi.sin_cos();
    let support = head.radius_m + head.center_x_m * cos + head.center_y_m * sin;
    let slope = -head.center_x_m * sin + head.center_y_m * cos;
    let (n, t) = ([normal.cos(), normal.sin()], [-normal.sin(), normal.cos()]);
    let along = pin[0] * t[0] + pin[1] * t[1];
    [
        pin[0] * n[0] + pin[1] * n[1] - support,
        along - slope + head.radius_m * (psi - head.rope_anchor_deg.to_radians()) - PATH_M,
    ]
}

/// Solves the loop closure at a crank angle by Newton's method, starting from the previous beam and normal
/// angles.
fn solve(machine: &Machine, turn_deg: f64, start: [f64; 2]) -> Pose {
    let crank = &machine.crank;
    let angle = (PIN_AT_BOTTOM_DEG - turn_deg).to_radians();
    let pin = [
        crank.center_x_m + crank.radius_m * angle.cos(),
        crank.center_y_m + crank.radius_m * angle.sin(),
    ];
    let [mut beam, mut normal] = start;
    for _ in 0..30 {
        const STEP: f64 = 1e-6;
        let f = residual(machine, pin, beam, normal);
        let by_beam = residual(machine, pin, beam + STEP, normal);
        let by_normal = residual(machine, pin, beam, normal + STEP);
        let (a, c) = ((by_beam[0] - f[0]) / STEP, (by_beam[1] - f[1]) / STEP);
        let (b, d) = ((by_normal[0] - f[0]) / STEP, (by_normal[1] - f[1]) / STEP);
        let det = a * d - b * c;
        beam -= (d * f[0] - b * f[1]) / det;
        normal -= (a * f[1] - c * f[0]) / det;
    }
    let head = &machine.back_head;
    let (sin, cos) = beam.sin_cos();
    let center = [
        cos * head.center_x_m - sin * head.center_y_m,
        sin * head.center_x_m + cos * head.center_y_m,
    ];
    let (n, t) = ([normal.cos(), normal.sin()], [-normal.sin(), normal.cos()]);
    let touch = [
        center[0] + head.radius_m * n[0],
        center[1] + head.radius_m * n[1],
    ];
    let straight = (pin[0] - touch[0]) * t[0] + (pin[1] - touch[1]) * t[1];
    Pose {
        turn_deg,
        pin,
        beam_rad: beam,
        normal_rad: normal,
        arm_m: pin[0] * n[0] + pin[1] * n[1],
        free_m: straight - machine.rod.length_m,
    }
}

/// Returns `count` equally spaced poses over one revolution, without repeating the first one at the end.
pub(crate) fn revolution(machine: &Machine, count: usize) -> Vec<Pose> {
    let mut guess = [(-31.8_f64).to_radians(), 176.8_f64.to_radians()];
    (0..count)
        .map(|index| {
            let turn = 360.0 * index as f64 / count as f64;
            let pose = solve(machine, turn, guess);
            guess = [pose.beam_rad, pose.normal_rad];
            pose
        })
        .collect()
}

/// Returns the height of the suspension point in the ground frame \[m\].
pub(crate) fn suspension_y_m(machine: &Machine, pose: &Pose) -> f64 {
    let anchor = machine.front_head.rope_anchor_deg.to_radians();
    machine.front_head.radius_m * (anchor + pose.beam_rad) - FRONT_ROPE_M
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "snapshots are stored short"
)]
fn short([x, y]: [f64; 2]) -> [f32; 2] {
    [x as f32, y as f32]
}

/// Builds a snapshot of the machine in a pose, with ropes under the given tensions \[N\].
#[expect(
    clippy::cast_possible_truncation,
    reason = "snapshots are stored short"
)]
pub(crate) fn snapshot(
    machine: &Machine,
    pose: &Pose,
    back_n: f64,
    front_n: f64,
) -> MachineSnapshot {
    let head = &machine.back_head;
    let (sin, cos) = pose.beam_rad.sin_cos();
    let center = [
        cos * head.center_x_m - sin * head.center_y_m,
        sin * head.center_x_m + cos * head.center_y_m,
    ];
    let t = [-pose.normal_rad.sin(), pose.normal_rad.cos()];
    let length = machine.ropes.cylinder_length_m;
    let on_line = |s: f64| [pose.pin[0] - t[0] * s, pose.pin[1] - t[1] * s];
    let mut motion = MachineSnapshot {
        turn_deg: pose.turn_deg,
        crank_pin_m: short(pose.pin),
        beam_deg: pose.beam_rad.to_degrees() as f32,
        crossbeam_m: short(on_line(machine.rod.length_m)),
        suspension_m: short([machine.front_head.radius_m, suspension_y_m(machine, pose)]),
        back_rope_m: Vec::new(),
        back_tension_n: Vec::new(),
        back_contact_n: Vec::new(),
        front_rope_m: Vec::new(),
        front_tension_n: Vec::new(),
        front_contact_n: Vec::new(),
    };
    for index in 0..machine.ropes.back_cylinders {
        let s = (index as f64 + 0.5) * length;
        let wrapped = s - pose.free_m;
        let at = if wrapped < 0.0 {
            on_line(machine.rod.length_m + s)
        } else {
            let angle = pose.normal_rad - wrapped / head.radius_m;
            [
                center[0] + head.radius_m * angle.cos(),
                center[1] + head.radius_m * angle.sin(),
            ]
        };
        let ripple = 1.0 + 0.03 * (0.9 * index as f64 + 0.2 * pose.turn_deg).sin();
        motion.back_rope_m.push(short(at));
        motion.back_tension_n.push((back_n * ripple) as f32);
        let contact = back_n * ripple * length / head.radius_m;
        let touching = wrapped >= 0.0;
        motion
            .back_contact_n
            .push(if touching { contact as f32 } else { 0.0 });
    }
    let radius = machine.front_head.radius_m;
    let bottom = suspension_y_m(machine, pose);
    for index in 0..machine.ropes.front_cylinders {
        let s = (index as f64 + 0.5) * length;
        let wrapped = s + bottom;
        let at = if wrapped < 0.0 {
            [radius, bottom + s]
        } else {
            let angle = wrapped / radius;
            [radius * angle.cos(), radius * angle.sin()]
        };
        motion.front_rope_m.push(short(at));
        motion.front_tension_n.push(front_n as f32);
        let contact = front_n * length / radius;
        motion
            .front_contact_n
            .push(if wrapped >= 0.0 { contact as f32 } else { 0.0 });
    }
    motion
}
