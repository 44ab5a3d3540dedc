//! Kinematics and rope tension of the ideal mechanism over one turn of the crank: inextensible ropes,
//! quasi-static motion, uniform crank speed.
//!
//! Effects use these curves where they are defined by a reference motion or by the tension that the load
//! alone causes: `T = (F A + J theta'' + M_g cos theta) / h`, with load `F`, front arm `A`, beam inertia `J`,
//! beam angle `theta`, gravity moment `M_g` and back arm `h`. The net crank torque is `T h dtheta/dturn +
//! Q + M_cw cos(phi + tau)`, with the torque `Q` by which the crank lifts and accelerates connecting rods and
//! crossbeam, counterweight moment `M_cw`, crank pin angle `phi` and phase `tau`.
use crate::math::elementary::sin_cos;
use crate::math::spline::{Splines, ValueAndDerivatives};
use crate::model::description::{Crank, Description};
use crate::model::kinematics::{DoesNotClose, Mechanism, Position};
use std::f64::consts::TAU;

/// Number of samples of each curve over one turn of the crank.
const NODES: usize = 360;

/// Curves of the ideal mechanism (inextensible ropes, quasi-static motion) as functions of the turn angle.
#[derive(Clone, Debug)]
pub struct Cycle {
    curves: Splines,
    tension: Splines,
    /// Torque by which the crank lifts and accelerates connecting rods and crossbeam [N m].
    rod: Splines,
    /// Crank pin angle at turn angle 0 \[rad\].
    bottom: f64,
    /// Parameters of the crank, used for computing its net torque.
    crank: Crank,
}

/// Index of the beam angle among the splines of the cycle; [`TANGENT`] and [`ARM`] index the tangent point
/// and the effective back arm.
const BEAM: usize = 0;
const TANGENT: usize = 1;
const ARM: usize = 2;

impl Cycle {
    /// Solves one turn of the mechanism, starting from the position at turn angle 0.
    ///
    /// # Errors
    /// [`DoesNotClose`] if the mechanism cannot be closed at some turn angle.
    pub fn new(
        d: &Description,
        mechanism: &Mechanism,
        bottom: &Position,
    ) -> Result<Self, DoesNotClose> {
        let step = TAU / NODES as f64;
        let mut curves: [Vec<f64>; 3] = [const { Vec::new() }; 3];
        // position and direction of rods and crossbeam, which continue the straight rope
        let mut rod: [Vec<f64>; 3] = [const { Vec::new() }; 3];
        let mut at = *bottom;
        for k in 0..NODES {
            let pin = bottom.pin + d.crank.sense * step * k as f64;
            at = mechanism.position(pin, at.beam, at.tangent)?;
            curves[BEAM].push(at.beam);
            curves[TANGENT].push(at.tangent);
            curves[ARM].push(at.arm);
            let direction = at.beam + at.tangent;
            let ([x, y], (s, c)) = (mechanism.pin(pin), sin_cos(direction));
            rod[0].push(x + d.rod.center_of_mass * s);
            rod[1].push(y - d.rod.center_of_mass * c);
            rod[2].push(direction);
        }
        let rod = Splines::periodic(0.0, step, &rod);
        let curves = Splines::periodic(0.0, step, &curves);
        let card = Splines::periodic(
            0.0,
            TAU / d.card.len() as f64,
            std::slice::from_ref(&d.card),
        );
        let speed2 = d.crank.speed * d.crank.speed;
        let tension: Vec<f64> = (0..NODES)
            .map(|k| {
                let turn = step * k as f64;
                let place = curves.place(turn);
                let beam = curves.jet(&place, BEAM);
                let arm = curves.jet(&place, ARM).value;
                let front = d.front_arc.radius;
                let acceleration = beam.second * speed2;
                let pull =
                    card.value(turn, 0) + d.suspension_mass * (d.gravity + front * acceleration);
                (pull * front + d.beam_inertia * acceleration + d.beam_moment(sin_cos(beam.value)))
                    / arm
            })
            .collect();
        let of_rod = |k: usize| {
            let place = rod.place(step * k as f64);
            let [x, y, angle] = [0, 1, 2].map(|curve| rod.jet(&place, curve));
            let (mass, inertia) = (d.rod.mass, d.rod.inertia);
            let lifted = mass * (d.gravity + speed2 * y.second) * y.first;
            lifted + speed2 * (mass * x.second * x.first + inertia * angle.second * angle.first)
        };
        Ok(Self {
            rod: Splines::periodic(0.0, step, &[(0..NODES).map(of_rod).collect()]),
            curves,
            tension: Splines::periodic(0.0, step, &[tension]),
            bottom: bottom.pin,
            crank: d.crank,
        })
    }

    /// Solves one turn of the mechanism of a description, starting from its own bottom dead centre.
    ///
    /// # Errors
    /// [`DoesNotClose`] if the mechanism cannot be closed at some turn angle.
    pub fn of(d: &Description) -> Result<Self, DoesNotClose> {
        let mechanism = Mechanism::of(d);
        Self::new(d, &mechanism, &mechanism.bottom_dead_centre()?)
    }

    /// Returns the turn angle \[rad\] during the downstroke at which the front head has descended by the
    /// given share (0 to 1) of its stroke.
    pub fn turn_at_descent(&self, share: f64) -> f64 {
        let beam = |turn: f64| self.curves.value(turn, BEAM);
        let step = TAU / NODES as f64;
        let at = |k: usize| beam(step * k as f64);
        let highest = (0..NODES).fold(0, |best, k| if at(k) > at(best) { k } else { best });
        let (top, bottom) = (at(highest), (0..NODES).map(at).fold(f64::MAX, f64::min));
        let wanted = top - share * (top - bottom);
        let (mut low, mut high) = (step * highest as f64, TAU);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if beam(middle) > wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Returns the beam angle \[rad\] and its first and second derivatives with respect to the turn angle.
    pub fn beam(&self, turn: f64) -> ValueAndDerivatives {
        self.curves.jet(&self.curves.place(turn), BEAM)
    }

    /// Returns the arc angle \[rad\], in the beam frame, of the point where the rope leaves the back head,
    /// with derivatives with respect to the turn angle.
    pub fn tangent(&self, turn: f64) -> ValueAndDerivatives {
        self.curves.jet(&self.curves.place(turn), TANGENT)
    }

    /// Returns the effective lever arm of the back rope about the pivot \[m\] at a turn angle.
    pub fn arm(&self, turn: f64) -> f64 {
        self.curves.value(turn, ARM)
    }

    /// Returns the tension of the back rope \[N\] caused by the load alone, at a turn angle.
    pub fn tension(&self, turn: f64) -> f64 {
        self.tension.value(turn, 0)
    }

    /// Returns the tension of the back rope \[N\] caused by the load alone, as a spline over the turn angle.
    pub const fn tensions(&self) -> &Splines {
        &self.tension
    }

    /// Returns the net torque [N m] that the reducer must supply in the sense of rotation, for a
    /// counterweight with the given phase \[rad\] and moment [N m].
    pub fn torque(&self, turn: f64, phase: f64, moment: f64) -> f64 {
        let place = self.curves.place(turn);
        let rope = self.tension.value(turn, 0)
            * self.curves.jet(&place, ARM).value
            * self.curves.jet(&place, BEAM).first;
        let sense = self.crank.sense;
        let angle = self.bottom + sense * (turn + phase);
        rope + self.rod.value(turn, 0) + sense * moment * sin_cos(angle).1
    }

    /// Returns the parameters of the mechanism's crank.
    pub const fn crank(&self) -> &Crank {
        &self.crank
    }
}
