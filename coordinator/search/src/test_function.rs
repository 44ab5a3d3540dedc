//! Test functions with known minima, on which search strategies are tested.
//!
//! Points are given by coordinates of the search space, which reaches 4 decades to either side of the start.
//! The value at every minimum is 0.
use crate::{
    space::{Space, SpaceError},
    strategy::EvaluationResult,
};
use protocol::case::{HeldRatios, Scale, Shift, Unknown, Valley};

/// Value of a test function at a point: the residual vector whose squared norm is the fitness, or, where the
/// simulated run fails, the grade of the failure.
type Value = Result<Vec<f64>, f64>;

/// Trust interval of the resonance's stiffness, relative to its start (decades); [`LOSS`] is that of its
/// damping loss, [`SERIES`] that of a stiffness in series with the first.
const STIFF: [f64; 2] = [-1.0, 1.5];
const LOSS: [f64; 2] = [-1.0, 4.0];
const SERIES: [f64; 2] = [-0.5, 3.5];

/// Test function with a known minimum of 0.
#[derive(Clone, Copy, Debug)]
pub struct TestFunction {
    /// Name of the test function.
    pub name: &'static str,
    /// Coordinates of the minimum, for at most 10 unknowns.
    pub optimum: &'static [f64],
    value: fn(&[f64], &[f64]) -> Value,
}

/// All test functions.
pub const ALL: &[TestFunction] = &[SPHERE, RASTRIGIN, CLIFF, RESONANCE];

/// Sum of squares: one basin of attraction, all unknowns alike.
pub const SPHERE: TestFunction = TestFunction {
    name: "sphere",
    optimum: &[0.7, -1.3, 0.2, 1.9],
    value: sphere,
};

/// Sum of squares with a ripple of half a decade: hundreds of basins of attraction.
pub const RASTRIGIN: TestFunction = TestFunction {
    name: "rastrigin",
    optimum: &[0.7, -1.3, 0.2, 1.9],
    value: rastrigin,
};

/// Sum of squares that fails, returning a grade of the failure, at more than 2.5 decades from the minimum.
pub const CLIFF: TestFunction = TestFunction {
    name: "cliff",
    optimum: &[0.7, -1.3, 0.2, 1.9],
    value: cliff,
};

/// Two resonators excited by many harmonics, like a spring under a periodic load: a valley in stiffness about
/// 0.02 decade wide, on a plateau on which excessive damping lowers the fitness.
pub const RESONANCE: TestFunction = TestFunction {
    name: "resonance",
    optimum: &[0.4, 0.26, 0.27, 0.35, 3.0, 1.03, 0.05, 0.15, 2.6, 1.31],
    value: resonance,
};

impl TestFunction {
    /// Returns this test function with its minimum moved to `optimum` (coordinate).
    #[must_use]
    pub const fn moved(self, optimum: &'static [f64]) -> Self {
        Self { optimum, ..self }
    }

    /// Returns the function's search space: unknowns `x0`, `x1` and so on, +-4 decades wide. `x0` has a
    /// narrow valley, which `x4` and `x8` can hide.
    ///
    /// # Panics
    /// Never: the bounds are ordered.
    pub fn space(&self) -> Space {
        const UNKNOWNS: [(f64, [f64; 2]); 10] = [
            (3.14e8, STIFF),
            (1.25e8, STIFF),
            (110.0, STIFF),
            (137.0, STIFF),
            (400.0, LOSS),
            (410.0, LOSS),
            (40.0, LOSS),
            (41.0, LOSS),
            (1e6, SERIES),
            (50.0, LOSS),
        ];
        let hiding = [(4, -0.8), (8, 1.5)].into_iter();
        let hiding = hiding.filter(|(axis, _)| *axis < self.optimum.len());
        let hiding = hiding.map(|(axis, by)| Shift {
            unknown: format!("x{axis}"),
            by,
        });
        let damped = self.optimum.len() > 4;
        let stand_ins = [1.5, -1.5].into_iter().filter(|_| self.optimum.len() > 8);
        let stand_ins = stand_ins.map(|by| Shift {
            unknown: "x8".to_owned(),
            by,
        });
        let mut valley = Some(Valley {
            from: -0.3,
            to: 1.1,
            step: 0.02,
            uncovered_by: hiding.collect(),
            shares: damped.then(|| HeldRatios {
                unknown: "x4".to_owned(),
                of_scanned: vec![6e-4, 2e-3],
            }),
            stand_ins: stand_ins.collect(),
        });
        let unknowns = UNKNOWNS.iter().take(self.optimum.len()).enumerate();
        let unknowns = unknowns.map(|(axis, &(start, trust))| {
            let bounds = [1e-4 * start, 1e4 * start];
            let name = format!("x{axis}");
            Unknown {
                trust: Some(trust),
                valley: valley.take(),
                ..Unknown::new(name, "1", Scale::Logarithmic, start, bounds)
            }
        });
        let space: Result<Space, SpaceError> = Space::new(&unknowns.collect::<Vec<_>>());
        space.expect("ordered bounds about positive values")
    }

    /// Returns the result of the test function at gene values of [`Self::space`]: its fitness, or a failure.
    pub fn tell(&self, space: &Space, genes: &[f64]) -> EvaluationResult {
        match (self.value)(&space.point(genes), self.optimum) {
            Ok(residual) => EvaluationResult {
                fitness: square(&residual),
                complete: true,
            },
            Err(grade) => EvaluationResult {
                fitness: grade,
                complete: false,
            },
        }
    }

    /// Returns the residual vector at values of [`Self::space`], whose squared norm is the fitness; empty if
    /// the function fails at the values.
    pub fn residual(&self, space: &Space, genes: &[f64]) -> Vec<f64> {
        (self.value)(&space.point(genes), self.optimum).unwrap_or_default()
    }
}

fn square(residual: &[f64]) -> f64 {
    residual.iter().map(|r| r * r).sum()
}

#[expect(clippy::unnecessary_wraps, reason = "the type of those that may fail")]
fn sphere(x: &[f64], optimum: &[f64]) -> Value {
    Ok(x.iter().zip(optimum).map(|(x, o)| x - o).collect())
}

#[expect(clippy::unnecessary_wraps, reason = "the type of those that may fail")]
fn rastrigin(x: &[f64], optimum: &[f64]) -> Value {
    let ripple = |d: f64| d * d + 0.5 - 0.5 * libm::cos(4.0 * std::f64::consts::PI * d);
    let distances = x.iter().zip(optimum).map(|(x, o)| x - o);
    Ok(distances
        .map(|d| libm::copysign(libm::sqrt(ripple(d)), d))
        .collect())
}

fn cliff(x: &[f64], optimum: &[f64]) -> Value {
    let residual = sphere(x, optimum)?;
    let distance = libm::sqrt(square(&residual));
    if distance > 2.5 {
        Err(1e6 * distance)
    } else {
        Ok(residual)
    }
}

/// Computes the residual between two steady-state responses; its squared norm is a mean square.
///
/// The load excites two modes near its 60th and 80th harmonic. Their frequency follows the stiffnesses `x0`
/// and `x8` in series, their damping the loss `x4`. The response is `H_n = 1 / (1 - r^2 + 2 i zeta r)`, `r =
/// n / order`, and the fitness the sum over harmonics of `a_n^2 |H_n - H*_n|^2 / 2`: a valley about 0.02
/// decade wide in `x0`, and a plateau near 0.3 on which excessive damping lowers the fitness. `x3` matters a
/// little, the other unknowns not at all; far from the start the simulation fails.
fn resonance(x: &[f64], optimum: &[f64]) -> Value {
    let limits = [
        (0, -1.2, 2.2),
        (3, -3.0, 2.5),
        (7, -3.0, 3.3),
        (8, -1.0, 3.9),
        (4, -3.0, 3.95),
    ];
    let beyond = limits
        .iter()
        .map(|&(gene, low, high)| (low - x[gene]).max(x[gene] - high))
        .fold(0.0, f64::max);
    if beyond > 0.0 {
        return Err(1e6 * (1.0 + beyond));
    }
    let (here, truth) = (modes(x), modes(optimum));
    let mut residual = Vec::with_capacity(962);
    for n in 1..=240 {
        let n = f64::from(n);
        for (mode, truth) in here.iter().zip(&truth) {
            let (re, im) = response(n, *mode);
            let (re_0, im_0) = response(n, *truth);
            let scale = libm::sqrt(0.11) / n;
            residual.extend([scale * (re - re_0), scale * (im - im_0)]);
        }
    }
    let sink = libm::exp10(-x[8] / 1.5) - libm::exp10(-optimum[8] / 1.5);
    let bending = (x[3] - optimum[3]).clamp(-1.0, 1.0);
    residual.extend([libm::sqrt(0.05) * sink, libm::sqrt(0.02) * bending]);
    Ok(residual)
}

/// Returns the order [harmonics of the load] and damping ratio of both modes of the resonance function.
fn modes(x: &[f64]) -> [(f64, f64); 2] {
    let compliance = libm::exp10(0.4 - x[0]) + 0.015 * libm::exp10((2.6 - x[8]) / 1.5);
    let root = libm::sqrt(1.015 / compliance);
    [60.0, 80.0].map(|order| {
        let relative = order / 60.0 * libm::exp10(x[4] - 3.0 - (x[0] - 0.4) / 2.0);
        (order * root, 0.003 + 0.012 * relative)
    })
}

fn response(n: f64, (order, damping): (f64, f64)) -> (f64, f64) {
    let ratio = n / order;
    let (re, im) = (1.0 - ratio * ratio, 2.0 * damping * ratio);
    let square = re * re + im * im;
    (re / square, -im / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_minimum_is_where_it_is_said_to_be() {
        for function in ALL {
            let space = function.space();
            let at = |point: &[f64]| function.tell(&space, &space.values(point));
            let least = at(function.optimum);
            assert!(least.complete && least.fitness < 1e-12, "{}", function.name);
            for axis in 0..space.dimension() {
                for step in [-0.01, 0.01] {
                    let mut point = function.optimum.to_vec();
                    point[axis] += step;
                    assert!(
                        at(&point).fitness >= least.fitness,
                        "{} {axis}",
                        function.name
                    );
                }
            }
        }
    }

    #[test]
    fn the_resonance_has_a_narrow_valley_on_a_plateau() {
        let space = RESONANCE.space();
        let along = |axis: usize, step: f64| {
            let mut point = RESONANCE.optimum.to_vec();
            point[axis] += step;
            RESONANCE.tell(&space, &space.values(&point)).fitness
        };
        for side in [-1.0, 1.0] {
            assert!((0.05..0.15).contains(&along(0, side * 0.02)));
            assert!((0.15..0.25).contains(&along(0, side * 0.04)));
            assert!((0.25..0.40).contains(&along(0, side * 0.1)));
        }
        assert!((0.2..0.4).contains(&along(0, 0.3)));
        assert!(along(4, 0.4) < 0.06 && along(4, -0.4) < 0.11);
        assert!(along(8, 0.4) < 0.02 && along(8, -0.4) < 0.03);
        assert!(RESONANCE.tell(&space, &space.values(&[0.0; 10])).fitness > 1.0);
    }
}
