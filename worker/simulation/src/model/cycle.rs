//! One turn of the ideal mechanism: inextensible ropes, slow motion, uniform crank.
//!
//! What effects refer to that are defined by a reference motion or by the tension that the load
//! alone gives: `T = (F A + J theta'' + M_g cos theta) / h` and the crank's net torque
//! `T h dtheta/dturn + M_cw cos(phi + tau)`.
use crate::math::elementary::sin_cos;
use crate::math::spline::{Jet, Splines};
use crate::model::description::{Crank, Description};
use crate::model::kinematics::{DoesNotClose, Mechanism, Position};
use std::f64::consts::TAU;

/// Samples of the turn.
const NODES: usize = 360;

/// Curves of the ideal mechanism over the turn angle.
#[derive(Clone, Debug)]
pub struct Cycle {
    curves: Splines,
    tension: Splines,
    /// Pin angle at turn 0 \[rad\].
    bottom: f64,
    /// Crank, for the torque.
    crank: Crank,
}

/// Places among the curves.
const BEAM: usize = 0;
const TANGENT: usize = 1;
const ARM: usize = 2;

impl Cycle {
    /// Solves one turn, from a position at turn 0.
    ///
    /// # Errors
    /// [`DoesNotClose`] where the mechanism does.
    pub fn new(
        d: &Description,
        mechanism: &Mechanism,
        bottom: &Position,
    ) -> Result<Self, DoesNotClose> {
        let step = TAU / NODES as f64;
        let mut curves: [Vec<f64>; 3] = [const { Vec::new() }; 3];
        let mut at = *bottom;
        for k in 0..NODES {
            let pin = bottom.pin + d.crank.sense * step * k as f64;
            at = mechanism.position(pin, at.beam, at.tangent)?;
            curves[BEAM].push(at.beam);
            curves[TANGENT].push(at.tangent);
            curves[ARM].push(at.arm);
        }
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
        Ok(Self {
            curves,
            tension: Splines::periodic(0.0, step, &[tension]),
            bottom: bottom.pin,
            crank: d.crank,
        })
    }

    /// One turn of a description from its own bottom dead centre.
    ///
    /// # Errors
    /// [`DoesNotClose`] where the mechanism does.
    pub fn of(d: &Description) -> Result<Self, DoesNotClose> {
        let mechanism = Mechanism::of(d);
        Self::new(d, &mechanism, &mechanism.bottom_dead_centre()?)
    }

    /// Turn angle of the downstroke at which the front has come down by a share of its stroke
    /// \[rad\].
    pub fn descent(&self, share: f64) -> f64 {
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

    /// Beam angle \[rad\] with its derivatives by the turn angle.
    pub fn beam(&self, turn: f64) -> Jet {
        self.curves.jet(&self.curves.place(turn), BEAM)
    }

    /// Where the rope leaves the back head, arc angle in the beam frame \[rad\].
    pub fn tangent(&self, turn: f64) -> Jet {
        self.curves.jet(&self.curves.place(turn), TANGENT)
    }

    /// Effective back arm \[m\].
    pub fn arm(&self, turn: f64) -> f64 {
        self.curves.value(turn, ARM)
    }

    /// Tension of the back rope under the load alone \[N\].
    pub fn tension(&self, turn: f64) -> f64 {
        self.tension.value(turn, 0)
    }

    /// The same as a curve over the turn.
    pub const fn tensions(&self) -> &Splines {
        &self.tension
    }

    /// Net torque that the reducer must give in the sense of rotation [N m], the counterweight's
    /// phase \[rad\] and moment [N m] being what is given.
    pub fn torque(&self, turn: f64, phase: f64, moment: f64) -> f64 {
        let place = self.curves.place(turn);
        let rope = self.tension.value(turn, 0)
            * self.curves.jet(&place, ARM).value
            * self.curves.jet(&place, BEAM).first;
        let sense = self.crank.sense;
        let angle = self.bottom + sense * (turn + phase);
        rope + sense * moment * sin_cos(angle).1
    }

    /// The crank.
    pub const fn crank(&self) -> &Crank {
        &self.crank
    }
}
