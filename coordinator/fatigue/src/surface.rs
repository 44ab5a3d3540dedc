//! Damage of every point on the surface of a body whose stress is a linear function of its loads.
use crate::{
    damage::Assessment,
    rainflow::{Residue, StressCycle, cycles},
    tensor::{Tensor, directions, normal_stress, signed_von_mises, von_mises},
};
use std::{num::NonZero, thread};

/// Number of planes on which the normal stress is judged: one every ten degrees.
const PLANES: u32 = 18;
/// Number of points that a thread takes at a time.
const CHUNK: usize = 64;

/// Surface of a body: p points, and their stress under each of l unit loads.
#[derive(Clone, Copy, Debug)]
pub struct StressedSurface<'a> {
    /// Outward unit normals at the points; length p.
    pub normals: &'a [[f32; 3]],
    /// Stress at the points under each unit load: xx, yy, zz, xy, yz, zx [MPa per unit of the load]; l x p.
    pub unit_stress: &'a [Vec<[f32; 6]>],
}

/// One period of the loads under one condition.
#[derive(Clone, Debug)]
pub struct LoadPeriod<'a> {
    /// Number of such periods in the time by which damage is counted.
    pub count: f64,
    /// Value of each load at each sample of the period; l x s.
    pub loads: Vec<&'a [f32]>,
}

/// Stress whose cycles are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Normal stress on that plane perpendicular to the surface on which it does the most damage.
    NormalStress,
    /// Equivalent stress of von Mises with the sign of the mean normal stress.
    SignedVonMises,
}

/// Damage at one point of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct PointDamage {
    /// Index of the point.
    pub point: usize,
    /// Damage under each condition, all its periods together.
    pub by_condition: Vec<f64>,
    /// Normal of the plane that was judged; `None` for an equivalent stress.
    pub plane: Option<[f64; 3]>,
    /// Largest equivalent stress of von Mises over all conditions \[MPa\].
    pub largest_von_mises: f64,
    /// Largest range of the judged stress over all conditions \[MPa\].
    pub largest_range: f64,
}

impl PointDamage {
    /// Returns the damage under all conditions.
    pub fn damage(&self) -> f64 {
        self.by_condition.iter().sum()
    }
}

impl StressedSurface<'_> {
    /// Returns the stress at a point over a period of the loads; length s.
    pub fn history(&self, point: usize, period: &LoadPeriod<'_>) -> Vec<Tensor> {
        let samples = period.loads.iter().map(|load| load.len()).min();
        let mut history = vec![[0.0; 6]; samples.unwrap_or(0)];
        for (load, unit) in period.loads.iter().zip(self.unit_stress) {
            let unit = unit[point].map(f64::from);
            for (tensor, load) in history.iter_mut().zip(*load) {
                let load = f64::from(*load);
                for (stress, unit) in tensor.iter_mut().zip(&unit) {
                    *stress += load * unit;
                }
            }
        }
        history
    }

    /// Returns the stress that a criterion counts at a point, over the history of its tensor.
    fn counted(history: &[Tensor], plane: Option<&[f64; 3]>) -> Vec<f64> {
        match plane {
            Some(plane) => history
                .iter()
                .map(|own| normal_stress(own, plane))
                .collect(),
            None => history.iter().map(signed_von_mises).collect(),
        }
    }

    /// Returns the cycles at a point over a period of the loads, of the normal stress on a plane, or of the signed
    /// equivalent stress without one.
    pub fn cycles(
        &self,
        point: usize,
        period: &LoadPeriod<'_>,
        plane: Option<&[f64; 3]>,
    ) -> Vec<StressCycle> {
        let history = self.history(point, period);
        cycles(&Self::counted(&history, plane), Residue::Repeating)
    }

    /// Computes the damage at each of the given points under the conditions together.
    pub fn damage(
        &self,
        points: &[usize],
        periods: &[LoadPeriod<'_>],
        (assessment, criterion): (&Assessment, Criterion),
    ) -> Vec<PointDamage> {
        let threads = thread::available_parallelism().map_or(1, NonZero::get);
        let chunks: Vec<&[usize]> = points.chunks(CHUNK).collect();
        let share = chunks.len().div_ceil(threads).max(1);
        let of_chunk = |points: &&[usize]| -> Vec<PointDamage> {
            let one = |&point| self.damage_at(point, periods, (assessment, criterion));
            points.iter().map(one).collect()
        };
        thread::scope(|scope| {
            let workers = chunks.chunks(share).map(|own| {
                scope.spawn(move || own.iter().flat_map(of_chunk).collect::<Vec<PointDamage>>())
            });
            let workers: Vec<_> = workers.collect();
            let done = workers.into_iter().map(thread::ScopedJoinHandle::join);
            done.flat_map(|own| own.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
                .collect()
        })
    }

    fn damage_at(
        &self,
        point: usize,
        periods: &[LoadPeriod<'_>],
        (assessment, criterion): (&Assessment, Criterion),
    ) -> PointDamage {
        let histories: Vec<Vec<Tensor>> =
            periods.iter().map(|own| self.history(point, own)).collect();
        let all = || histories.iter().flatten();
        let judged = |plane: Option<[f64; 3]>| {
            let mut largest_range = 0.0_f64;
            let damage = histories.iter().zip(periods).map(|(history, period)| {
                let counted = cycles(&Self::counted(history, plane.as_ref()), Residue::Repeating);
                let ranges = counted.iter().map(|own| own.range);
                largest_range = ranges.fold(largest_range, f64::max);
                let each = counted.iter().map(|own| assessment.of_cycle(own));
                period.count * each.sum::<f64>()
            });
            PointDamage {
                point,
                by_condition: damage.collect(),
                plane,
                largest_von_mises: all().map(von_mises).fold(0.0, f64::max),
                largest_range,
            }
        };
        match criterion {
            Criterion::SignedVonMises => judged(None),
            Criterion::NormalStress => {
                let planes = directions(&self.normals[point].map(f64::from), PLANES);
                let all = planes.into_iter().map(|plane| judged(Some(plane)));
                // below a cut-off no plane has damage: then the one with the largest range
                let worst = all.max_by(|a, b| {
                    let range = || a.largest_range.total_cmp(&b.largest_range);
                    a.damage().total_cmp(&b.damage()).then_with(range)
                });
                worst.unwrap_or_else(|| judged(None))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{curve::Curve, mean_stress::MeanStress};

    /// Checks that a bar under two loads, one along x and one along y out of phase, is damaged on the plane across the
    /// larger one, as much as by its history alone.
    #[test]
    fn the_worst_plane_is_across_the_largest_range() {
        let unit = [
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        ];
        let unit_stress = unit.map(|own| vec![own; 130]);
        let surface = StressedSurface {
            normals: &vec![[0.0, 0.0, 1.0]; 130],
            unit_stress: &unit_stress,
        };
        let loads = [[0.0, 100.0, 0.0, -100.0], [80.0, 0.0, -80.0, 0.0]];
        let period = LoadPeriod {
            count: 10.0,
            loads: loads.iter().map(<[f32; 4]>::as_slice).collect(),
        };
        let assessment = Assessment {
            curve: Curve::named("en-90").unwrap(),
            mean_stress: MeanStress::Ignored,
            factor: 1.0,
        };
        let points: Vec<usize> = (0..130).collect();
        let found = surface.damage(
            &points,
            std::slice::from_ref(&period),
            (&assessment, Criterion::NormalStress),
        );
        assert!(found.iter().map(|own| own.point).eq(0..130));
        for own in &found {
            let plane = own.plane.unwrap();
            assert!(plane[0].abs() > 0.999, "{plane:?}");
            assert!((own.largest_range - 200.0).abs() < 1e-9);
            assert!((own.largest_von_mises - 100.0).abs() < 1e-9);
            let expected = 10.0 / assessment.curve.cycles(200.0);
            assert!((own.damage() / expected - 1.0).abs() < 1e-9);
        }
    }
}
