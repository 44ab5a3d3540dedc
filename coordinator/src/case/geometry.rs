//! Rigid kinematics of the machine, only as far as a case is checked: does the rope reach, and
//! does it stay on the arcs?
//!
//! For a crank angle, beam angle `theta` and contact normal `Psi` (ground frame) follow from
//! tangency `P.n = h(psi)` and length `P.t - h'(psi) + R (psi - psi_a) = L`, with `psi = Psi - theta`,
//! the support function `h = R + C.n(psi)` and the crank pin P; Newton on both. The dynamics in
//! the worker know nothing of this file.
use super::schema::CaseFile;
use protocol::case::TurnSense;

/// Extremes over one turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Lowest and highest beam angle \[deg\].
    pub beam_deg: [f64; 2],
    /// Least and greatest angle of the contact normal on the back head, beam frame \[deg\].
    pub contact_deg: [f64; 2],
    /// Shortest and longest free back rope, from crossbeam to head \[m\].
    pub free_rope_m: [f64; 2],
    /// Shortest and longest front rope below the head \[m\].
    pub hang_m: [f64; 2],
    /// Travel of the suspension \[m\].
    pub stroke_m: f64,
}

/// Crank angles that are tried: every two degrees.
const STEPS: u32 = 180;

/// Extremes over one turn; or the crank-pin angle \[deg\] at which the loop cannot be closed.
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
        let solved = close(case, phi, guess, back_rope + case.rod.length_m);
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

/// Beam angle and contact normal for a crank-pin angle \[rad\]; none where Newton does not converge.
fn close(case: &CaseFile, phi: f64, guess: [f64; 2], length: f64) -> Option<[f64; 2]> {
    let head = &case.back_head;
    let pin = [
        case.crank.center_x_m + case.crank.radius_m * phi.cos(),
        case.crank.center_y_m + case.crank.radius_m * phi.sin(),
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
