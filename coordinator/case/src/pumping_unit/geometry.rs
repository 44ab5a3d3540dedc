//! Rigid kinematics of the machine for checking a case: whether the ropes are long enough and stay on their
//! arcs.
//!
//! For a crank angle, beam angle `theta` and contact normal `Psi` (ground frame) follow from tangency `P.n =
//! h(psi)` and length `P.t - h'(psi) + R (psi - psi_a) = L`, with `psi = Psi - theta`, the support function
//! `h = R + C.n(psi)` and the crank pin P, solved by Newton's method. The worker's dynamics do not use this
//! module.
use super::schema::CaseFile;
use protocol::pumping_unit::{BackHead, Crank, Machine, TurnSense, WorkingCondition};
use support::interpolation::periodic;

/// Extreme values of the rigid kinematics over one crank turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Lowest and highest beam angle \[deg\].
    pub beam_deg: [f64; 2],
    /// Smallest and largest angle of the contact normal on the back head, beam frame \[deg\].
    pub contact_deg: [f64; 2],
    /// Smallest and largest length of the free part of the back rope, from crossbeam to head \[m\].
    pub free_rope_m: [f64; 2],
    /// Smallest and largest length of the front rope that hangs below the head \[m\].
    pub hang_m: [f64; 2],
    /// Travel of the suspension \[m\].
    pub stroke_m: f64,
}

/// Number of crank angles evaluated over one turn: every two degrees.
const STEPS: u32 = 180;

/// Returns the extreme values of the rigid kinematics over one crank turn; on failure the crank-pin angle
/// \[deg\] at which the mechanism cannot be closed.
pub(super) fn envelope(case: &CaseFile) -> Result<Envelope, f64> {
    let back_rope = case.ropes.back_cylinders as f64 * case.ropes.cylinder_length_m;
    let front_rope = case.ropes.front_cylinders as f64 * case.ropes.cylinder_length_m;
    let wide = [f64::INFINITY, f64::NEG_INFINITY];
    let (mut beam, mut contact, mut free) = (wide, wide, wide);
    let sense = match case.crank.sense {
        TurnSense::Clockwise => -1.0,
        TurnSense::CounterClockwise => 1.0,
    };
    // the first angle starts from a level beam with the rope leaving downwards; after it the
    // solution of the angle before is near
    let mut guess = [0.0, std::f64::consts::PI];
    for step in 0..=STEPS {
        let phi = sense * f64::from(step * 360 / STEPS).to_radians();
        let loop_bodies = (&case.crank, &case.back_head);
        let solved = solve_loop(loop_bodies, phi, guess, back_rope + case.rod.length_m);
        let Some([theta, normal]) = solved else {
            return Err(phi.to_degrees());
        };
        guess = [theta, normal];
        let psi = (normal - theta).to_degrees();
        let wrapped = case.back_head.radius_m * (psi - case.back_head.rope_anchor_deg).to_radians();
        widen(&mut beam, theta.to_degrees());
        widen(&mut contact, psi);
        widen(&mut free, back_rope - wrapped);
    }
    let arm = case.front_head.radius_m;
    let hang = |theta_deg: f64| {
        front_rope - arm * (case.front_head.rope_anchor_deg + theta_deg).to_radians()
    };
    let [low, high] = beam;
    Ok(Envelope {
        beam_deg: beam,
        contact_deg: contact,
        free_rope_m: free,
        hang_m: [hang(high), hang(low)],
        stroke_m: arm * (high - low).to_radians(),
    })
}

fn widen([low, high]: &mut [f64; 2], value: f64) {
    *low = low.min(value);
    *high = high.max(value);
}

/// Solves the rigid mechanism for a crank-pin angle \[rad\]; returns beam angle and contact normal, `None` if
/// Newton's method does not converge.
fn solve_loop(
    (crank, head): (&Crank, &BackHead),
    phi: f64,
    guess: [f64; 2],
    length: f64,
) -> Option<[f64; 2]> {
    let pin = [
        crank.center_x_m + crank.radius_m * phi.cos(),
        crank.center_y_m + crank.radius_m * phi.sin(),
    ];
    let anchor = head.rope_anchor_deg.to_radians();
    let [mut theta, mut normal] = guess;
    for _ in 0..50 {
        let (sin, cos) = normal.sin_cos();
        let across = pin[0] * cos + pin[1] * sin;
        let along = -pin[0] * sin + pin[1] * cos;
        let psi = normal - theta;
        let support = head.radius_m + head.center_x_m * psi.cos() + head.center_y_m * psi.sin();
        let slope = -head.center_x_m * psi.sin() + head.center_y_m * psi.cos();
        let tangency = across - support;
        let excess = along - slope + head.radius_m * (psi - anchor) - length;
        if tangency.abs() + excess.abs() < 1e-10 {
            return Some([theta, normal]);
        }
        // [[h', P.t - h'], [-h, h - P.n]] (d theta, d Psi) = -(tangency, excess)
        let [a, b, c, d] = [slope, along - slope, -support, support - across];
        let determinant = a * d - b * c;
        let step_theta = (-tangency * d + excess * b) / determinant;
        let step_normal = (-excess * a + tangency * c) / determinant;
        // half a radian at most: a start far away must not leap to another branch
        let limit = (0.5 / step_theta.abs().max(step_normal.abs())).min(1.0);
        theta += limit * step_theta;
        normal += limit * step_normal;
        if !(theta.is_finite() && normal.is_finite()) {
            return None;
        }
    }
    None
}

/// Tension and contact angle of the back rope over one crank turn, equally spaced from bottom dead centre;
/// computed by rigid kinematics, without the rope's own weight and vibration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuasiStaticTurn {
    /// Crank angle from bottom dead centre \[deg\].
    pub turn_deg: Vec<f64>,
    /// Angle at which the rope leaves the back head, beam frame \[deg\].
    pub contact_deg: Vec<f64>,
    /// Rope tension \[N\].
    pub tension_n: Vec<f64>,
}

/// Number of equally spaced crank angles of the quasi-static turn.
const SAMPLES: u32 = 720;

/// Returns beam angle and contact normal \[rad\] at equally spaced crank angles from bottom dead centre, where
/// the front arm is lowest; `None` if the crank cannot complete a turn.
fn turn_from_bottom(crank: &Crank, head: &BackHead, length: f64) -> Option<Vec<[f64; 2]>> {
    let sense = match crank.sense {
        TurnSense::Clockwise => -1.0,
        TurnSense::CounterClockwise => 1.0,
    };
    let step = std::f64::consts::TAU / f64::from(SAMPLES);
    let turn = |start: f64, mut guess: [f64; 2]| {
        let mut angles = Vec::new();
        for k in 0..SAMPLES {
            let phi = start + sense * step * f64::from(k);
            guess = solve_loop((crank, head), phi, guess, length)?;
            angles.push(guess);
        }
        Some(angles)
    };
    let first = turn(0.0, [0.0, std::f64::consts::PI])?;
    // a parabola through three samples
    let n = first.len();
    let low = (0..n).min_by(|a, b| first[*a][0].total_cmp(&first[*b][0]))?;
    let [before, here, after] = [first[(low + n - 1) % n], first[low], first[(low + 1) % n]];
    let bend = before[0] - 2.0 * here[0] + after[0];
    let shift = 0.5 * (before[0] - after[0]) / bend;
    turn(sense * step * (low as f64 + shift), here)
}

/// Returns the position of the polished rod above its lowest one \[m\] at equally spaced crank angles from
/// bottom dead centre; `None` if the crank cannot complete a turn.
pub(super) fn rod_position(case: &CaseFile) -> Option<Vec<f64>> {
    let back_rope = case.ropes.back_cylinders as f64 * case.ropes.cylinder_length_m;
    let length = back_rope + case.rod.length_m;
    let turn = turn_from_bottom(&case.crank, &case.back_head, length)?;
    let lowest = turn.first()?[0];
    let arm = case.front_head.radius_m;
    Some(
        turn.iter()
            .map(|[theta, _]| arm * (theta - lowest))
            .collect(),
    )
}

/// Computes the back rope's tension and contact angle over one turn. The rope balances the load on the front
/// arm, the beam's unbalance and its inertia, with the moment arm `h(psi)`. Returns `None` if the crank
/// cannot complete a turn.
pub fn quasi_static(machine: &Machine, condition: &WorkingCondition) -> Option<QuasiStaticTurn> {
    let length = machine.ropes.back_cylinders as f64 * machine.ropes.cylinder_length_m
        + machine.rod.length_m;
    let angles = turn_from_bottom(&machine.crank, &machine.back_head, length)?;
    let n = angles.len();
    let step = std::f64::consts::TAU / f64::from(SAMPLES);
    let speed = condition.speed_rpm * std::f64::consts::TAU / 60.0;
    let mut result = QuasiStaticTurn::default();
    for (k, [theta, normal]) in angles.iter().enumerate() {
        let neighbours = angles[(k + n - 1) % n][0] + angles[(k + 1) % n][0];
        let acceleration = (neighbours - 2.0 * theta) / (step * step) * speed * speed;
        let turn_deg = 360.0 * k as f64 / n as f64;
        let psi = normal - theta;
        let head = &machine.back_head;
        let arm = head.radius_m + head.center_x_m * psi.cos() + head.center_y_m * psi.sin();
        let card = &condition.card;
        let load = periodic(&card.turn_deg, &card.load_n, turn_deg, 360.0).unwrap_or_default();
        let moment = load * machine.front_head.radius_m
            + machine.beam.gravity_moment_n_m * theta.cos()
            - machine.beam.gravity_height_moment_n_m * theta.sin()
            + machine.beam.inertia_kg_m2 * acceleration;
        result.turn_deg.push(turn_deg);
        result.contact_deg.push(psi.to_degrees());
        result.tension_n.push(moment / arm);
    }
    Some(result)
}
