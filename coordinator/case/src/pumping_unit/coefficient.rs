//! Recommended coefficients by formula: stiffness of a rope (paper, Eq. 3) and of the contact of two elastic
//! bodies (paper, Eq. 5). Only material and dimensions are used; there is no formula for damping.
use super::{recommended::Formula, schema::CaseFile};
use protocol::pumping_unit::Coefficient;
use std::f64::consts::PI;

/// Elastic constants of an isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Elastic {
    /// Young's modulus \[Pa\].
    young: f64,
    /// Poisson's ratio \[1\].
    poisson: f64,
}

impl Elastic {
    /// Returns the shear modulus \[Pa\].
    fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Returns the elastic compliance `h = (1 - nu^2) / (pi E)` of Eq. 5 [1/Pa].
    fn contact_compliance(&self) -> f64 {
        (1.0 - self.poisson * self.poisson) / (PI * self.young)
    }
}

/// Dimensions and materials of a rope and of the horse head on which it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bodies {
    /// Diameter of the rope \[m\].
    diameter: f64,
    /// Length of the piece of rope that one joint of the rope model represents \[m\].
    length: f64,
    rope: Elastic,
    /// Radius of the back head's surface at the gauges \[m\].
    head_radius: f64,
    head: Elastic,
    /// Exponent of the penetration in the contact force law of rope and head.
    exponent: f64,
}

impl Bodies {
    pub(super) fn of(case: &CaseFile) -> Self {
        let elastic = |young_gpa: f64, poisson| Elastic {
            young: 1e9 * young_gpa,
            poisson,
        };
        let diameter = case.ropes.diameter_m;
        Self {
            diameter,
            length: case.ropes.reference_length_m,
            rope: elastic(case.rope_material.young_gpa, case.rope_material.poisson),
            // that of the case is the rope's centre line
            head_radius: case.back_head.radius_m - 0.5 * diameter,
            head: elastic(case.flexible_head.young_gpa, case.flexible_head.poisson),
            exponent: case.contact.exponent,
        }
    }

    /// Returns a recommended rope or contact coefficient computed by a formula, in SI units; `None` if the
    /// formula does not apply to it.
    pub(super) fn evaluate(&self, formula: Formula, name: Coefficient) -> Option<f64> {
        match formula {
            Formula::Eq3 => self.eq3(name),
            Formula::Hertz => (name == Coefficient::Kc).then(|| self.hertz()).flatten(),
        }
    }

    /// Returns the stiffness of a joint between two rope cylinders, treated as a solid round bar [N/m,
    /// N.m/rad] (paper, Eq. 3).
    fn eq3(&self, name: Coefficient) -> Option<f64> {
        let Self {
            diameter: d,
            length,
            rope,
            ..
        } = self;
        let area = PI * d * d / 4.0;
        let second_moment = PI * d * d * d * d / 64.0;
        match name {
            Coefficient::Kb1 => Some(rope.young * area / length),
            Coefficient::Kb23 => Some(rope.shear() * area / length),
            Coefficient::Kb4 => Some(rope.shear() * 2.0 * second_moment / length),
            Coefficient::Kb56 => Some(rope.young * second_moment / length),
            Coefficient::Cb1
            | Coefficient::Cb23
            | Coefficient::Cb4
            | Coefficient::Cb56
            | Coefficient::Kc
            | Coefficient::Cc => None,
        }
    }

    /// Returns the contact stiffness of two elastic spheres with the radii of rope and head [N/m^1.5] (paper,
    /// Eq. 5); `None` if the contact exponent is not 1.5.
    fn hertz(&self) -> Option<f64> {
        let own = 0.5 * self.diameter;
        let radius = own * self.head_radius / (own + self.head_radius);
        let stiffness = 4.0
            / (3.0 * PI * (self.rope.contact_compliance() + self.head.contact_compliance()))
            * radius.sqrt();
        ((self.exponent - 1.5).abs() < 1e-9).then_some(stiffness)
    }
}

#[cfg(test)]
mod tests {
    use super::super::recommended::Formula;
    use super::{Bodies, Elastic};
    use protocol::{pumping_unit::Coefficient, unit::Unit};

    const STEEL: Elastic = Elastic {
        young: 200e9,
        poisson: 0.25,
    };
    const BODIES: Bodies = Bodies {
        diameter: 0.010,
        length: 0.050,
        rope: STEEL,
        head_radius: 1.895,
        head: STEEL,
        exponent: 1.5,
    };

    /// Checks against the recommended values of Table 3: Eq. 3 for translational stiffnesses, and four times
    /// Eq. 3 in N.m/deg for rotational ones.
    #[test]
    fn eq_3_gives_the_papers_recommended_values() {
        let per_degree = Unit::NewtonMetrePerDegree.si_factor();
        for (name, printed) in [
            (Coefficient::Kb1, 3.14e8),
            (Coefficient::Kb23, 1.25e8),
            (Coefficient::Kb4, 110.0 / 4.0 * per_degree),
            (Coefficient::Kb56, 137.0 / 4.0 * per_degree),
        ] {
            let given = BODIES.evaluate(Formula::Eq3, name).unwrap();
            assert!((given / printed - 1.0).abs() < 6e-3, "{name:?}: {given}");
        }
        for name in [Coefficient::Cb1, Coefficient::Kc, Coefficient::Cc] {
            assert_eq!(BODIES.evaluate(Formula::Eq3, name), None);
        }
    }

    /// Checks Eq. 5 against the usual form of Hertz contact, K = 4/3 E* sqrt(R) with 1/E* = 2 (1 - nu^2) / E.
    #[test]
    fn eq_5_is_the_hertz_contact() {
        let effective = 200e9 / (2.0 * (1.0 - 0.0625));
        let radius: f64 = 1.0 / (1.0 / 0.005 + 1.0 / 1.895);
        let expected = 4.0 / 3.0 * effective * radius.sqrt();
        let given = BODIES.evaluate(Formula::Hertz, Coefficient::Kc).unwrap();
        assert!((given / expected - 1.0).abs() < 1e-12, "{given}");
        let other = Bodies {
            exponent: 2.0,
            ..BODIES
        };
        assert_eq!(other.evaluate(Formula::Hertz, Coefficient::Kc), None);
        assert_eq!(BODIES.evaluate(Formula::Hertz, Coefficient::Kb1), None);
    }
}
