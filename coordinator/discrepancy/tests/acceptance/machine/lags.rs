//! Lags of the masses behind the drive, order by order, and the forces between the masses.
use super::amounts::{C, HIGHEST, MASSES};
use super::fineness::is_shorter;
use crate::case::RECOMMENDED;
use nalgebra::{Matrix3, Vector3};
use protocol::job::SimulateSpec;

/// Lags of the three masses behind the drive in one solution: a vector of Fourier coefficients per order.
pub(super) struct Lags(pub(super) Vec<Vector3<C>>);

/// Stiffness and loss coefficients of the equations of motion, converted from the searched parameter values.
pub(super) struct Genes {
    pub(super) back: f64,
    pub(super) back_loss: f64,
    pub(super) front: f64,
    pub(super) front_loss: f64,
    pub(super) contact: f64,
    pub(super) contact_loss: f64,
    pub(super) bending: f64,
    pub(super) bending_loss: f64,
    pub(super) torsion: f64,
}

impl Genes {
    pub(super) fn new(spec: &SimulateSpec) -> Self {
        let g = &spec.individual.genes;
        // longer elements are a little too stiff
        let length = if is_shorter(&spec.numerics) {
            0.025
        } else {
            0.05
        };
        let rough = 1.0 + 0.4 * length * length;
        Self {
            back: g[0] * rough,
            front: g[1] * rough,
            torsion: g[2] / RECOMMENDED[2],
            bending: (g[3] / RECOMMENDED[3]).powf(0.3),
            back_loss: g[4],
            front_loss: g[5],
            bending_loss: (g[7] / RECOMMENDED[7]).powf(0.3),
            contact: g[8],
            contact_loss: g[9],
        }
    }
}

impl Lags {
    /// Returns the spectrum of the back rope's tension.
    pub(super) fn rope(&self, g: &Genes, ratio: f64) -> Vec<C> {
        let part =
            |(h, y): (usize, &Vector3<C>)| C::new(g.back, h as f64 * ratio * g.back_loss) * y[2];
        self.0.iter().enumerate().map(part).collect()
    }

    /// Returns the spectrum of the force between beam and head.
    pub(super) fn pin(&self, g: &Genes, ratio: f64) -> Vec<C> {
        let part = |(h, y): (usize, &Vector3<C>)| {
            C::new(g.contact, h as f64 * ratio * g.contact_loss) * (y[1] - y[2])
        };
        self.0.iter().enumerate().map(part).collect()
    }
}

/// Solves `(K + i w C - w^2 M) y = f` for the lags at every order.
pub(super) fn solve(g: &Genes, ratio: f64, spectra: &[Vec<C>; 3], beam: f64) -> Lags {
    let at = |h: usize| {
        let w = h as f64 * ratio;
        let (f, c, b) = (
            C::new(g.front, w * g.front_loss),
            C::new(g.contact, w * g.contact_loss),
            C::new(g.back, w * g.back_loss),
        );
        let w2 = w * w;
        let zero = C::new(0.0, 0.0);
        let matrix = Matrix3::new(
            f - w2 * MASSES[0],
            -f,
            zero,
            -f,
            f + c - w2 * (MASSES[1] + beam),
            -c,
            zero,
            -c,
            c + b - w2 * MASSES[2],
        );
        let force = Vector3::new(spectra[0][h], spectra[1][h], spectra[2][h]);
        matrix
            .lu()
            .solve(&force)
            .unwrap_or_else(|| Vector3::from_element(zero))
    };
    Lags((0..=HIGHEST).map(at).collect())
}
