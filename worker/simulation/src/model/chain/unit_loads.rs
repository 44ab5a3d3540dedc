//! Forces of a chain's joints per unit of each coefficient of their law, for motion in the plane.
//!
//! The law is linear in its coefficients: each multiplies one deformation, its rate or, for the preload, 1, and
//! the product acts along the axis of the joint, across it or as a moment.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use crate::element::bushing::{Bushing, LinkLoad, Marker};
use crate::element::plane::{DEFORMATIONS, PlaneJoint};
use crate::linear::Lanes;
use crate::math::real::{Vector, WIDEST};
use crate::model::pose::PlanePoses;
use pulp::{Arch, Simd, WithSimd};

/// Loads of a chain's joints per unit of each coefficient, at one state; buffers are allocated once.
#[derive(Clone, Debug)]
pub(crate) struct UnitLoads {
    count: usize,
    /// Loads of a unit force along, across and of a unit moment, each an array of the joints between two
    /// cylinders: force on the cylinder behind the joint, torques on the cylinders behind and before it.
    loads: [[Vec<f64>; 4]; DEFORMATIONS],
    /// Deformations of these joints, then their rates.
    amounts: [Vec<f64>; 2 * DEFORMATIONS],
    /// Markers I and J of the joint at the chain's base and of the one at its head; `None` for a free end.
    pub(crate) ends: [Option<[Marker; 2]>; 2],
}

impl UnitLoads {
    /// Allocates the loads of a chain's joints.
    pub(crate) fn new(chain: &Chain) -> Self {
        let count = chain.count - 1;
        let zeros = || vec![0.0; count.next_multiple_of(WIDEST)];
        Self {
            count,
            loads: std::array::from_fn(|_| std::array::from_fn(|_| zeros())),
            amounts: std::array::from_fn(|_| zeros()),
            ends: [None; 2],
        }
    }

    /// Computes the loads for the cylinder poses in `state`, and stores the markers of the end joints.
    pub(crate) fn fill(&mut self, chain: &Chain, joints: &Joints<'_>, state: &ChainState) {
        self.ends = [0, chain.count]
            .map(|joint| chain.link(joint, joints, state).map(|(markers, _)| markers));
        Arch::new().dispatch(Fill {
            half: 0.5 * chain.pitch,
            poses: &state.plane,
            units: self,
        });
    }

    /// Adds `factor` times the generalised forces of the joints between two cylinders per unit of a
    /// coefficient, in the order of the law, to those of the chain's cylinders. `entry` selects a number of
    /// an element of `force`.
    pub(crate) fn add_inner<T>(
        &self,
        (coefficient, factor): (usize, f64),
        force: &mut [T],
        entry: impl Fn(&mut T) -> &mut f64,
    ) {
        // the preload comes last: of the axis, times 1
        let loads = &self.loads[coefficient % DEFORMATIONS];
        let amounts = self.amounts.get(coefficient);
        let [x, y, torque_i, torque_j] = loads.each_ref().map(|array| &array[..self.count]);
        let (cylinders, _) = force.as_chunks_mut::<3>();
        let mut carried = [0.0; 3];
        for (k, cylinder) in cylinders.iter_mut().take(self.count + 1).enumerate() {
            let mut sum = carried;
            if k < self.count {
                let amount = factor * amounts.map_or(1.0, |amounts| amounts[k]);
                let [x, y] = [x[k] * amount, y[k] * amount];
                sum = [sum[0] - x, sum[1] - y, sum[2] + torque_j[k] * amount];
                carried = [x, y, torque_i[k] * amount];
            }
            for (to, sum) in cylinder.iter_mut().zip(sum) {
                *entry(to) += sum;
            }
        }
    }

    /// Returns the extension \[m\] and its rate [m/s] of joint `k` of those between two cylinders.
    pub(crate) fn stretch(&self, k: usize) -> [f64; 2] {
        [0, DEFORMATIONS].map(|amount| self.amounts[amount][k])
    }

    /// Returns the derivatives of the extension of joint `k`, one lane per column, from those of the chain's
    /// coordinates.
    pub(crate) fn extension_by(&self, k: usize, coordinates: &[Lanes]) -> Lanes {
        let [x, y, torque_i, torque_j] = self.loads[0].each_ref().map(|array| array[k]);
        let (cylinders, _) = coordinates.as_chunks::<3>();
        let [before, behind] = [cylinders[k], cylinders[k + 1]];
        // a unit tension does the work of -1 times the extension
        (before[0] - behind[0]) * x + (before[1] - behind[1]) * y
            - before[2] * torque_j
            - behind[2] * torque_i
    }

    /// Adds the generalised forces of tensions at the joints between two cylinders, one lane per column, to those of
    /// the chain's cylinders.
    pub(crate) fn add_tensions(&self, tension: impl Fn(usize) -> Lanes, force: &mut [Lanes]) {
        let [x, y, torque_i, torque_j] = self.loads[0].each_ref();
        let (cylinders, _) = force.as_chunks_mut::<3>();
        for k in 0..self.count {
            let own = tension(k);
            let along = [own * x[k], own * y[k]];
            for (axis, along) in along.into_iter().enumerate() {
                cylinders[k][axis] -= along;
                cylinders[k + 1][axis] += along;
            }
            cylinders[k][2] += own * torque_j[k];
            cylinders[k + 1][2] += own * torque_i[k];
        }
    }

    /// Returns the loads of the joints at the base and at the head under the given laws; `None` for a free end
    /// and for a law without coefficients.
    pub(crate) fn end_loads(&self, laws: [&Bushing; 2]) -> [Option<LinkLoad>; 2] {
        std::array::from_fn(|end| {
            let [i, j] = self.ends[end].as_ref()?;
            (!laws[end].is_zero()).then(|| laws[end].load(i, j))
        })
    }
}

/// Evaluation of [`UnitLoads`], compiled for each set of instructions.
struct Fill<'a> {
    half: f64,
    poses: &'a PlanePoses,
    units: &'a mut UnitLoads,
}

impl WithSimd for Fill<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { half, poses, units } = self;
        let vectors = units.count.div_ceil(S::F64_LANES);
        let [before, behind] = [0, 1].map(|first| poses.rods(simd, first, vectors));
        let mut loads = units
            .loads
            .each_mut()
            .map(|load| load.each_mut().map(|array| S::as_mut_simd_f64s(array).0));
        let mut amounts = units
            .amounts
            .each_mut()
            .map(|array| S::as_mut_simd_f64s(array).0);
        let (zero, one) = (Vector::splat(simd, 0.0), Vector::splat(simd, 1.0));
        for k in 0..vectors {
            let joint = PlaneJoint::new(half, &behind.get(k), &before.get(k));
            let directions = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
            for (arrays, direction) in loads.iter_mut().zip(directions) {
                let load = joint.load(direction);
                let [x, y] = load.force;
                let [i, j] = load.torque;
                for (array, value) in arrays.iter_mut().zip([x, y, i, j]) {
                    array[k] = value.lanes();
                }
            }
            let all = joint.deformation.into_iter().chain(joint.rate);
            for (array, value) in amounts.iter_mut().zip(all) {
                array[k] = value.lanes();
            }
        }
    }
}
