//! The points of a chain where contact with its arc is evaluated, side by side: one array per
//! quantity, so that the arithmetic of many points is one plain loop that compilers turn into
//! vectors. It gives what [`Surface::touch`] and [`Impact::push`] give point by point, without what
//! only a tangent asks for.
use super::Chain;
use crate::element::impact::Impact;
use crate::math::spline::{Place, sum::Spread};
use crate::model::contact::{POINTS, Surface, small_angle};
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// A number for each point of a cylinder.
type Each = [f64; POINTS];

/// Points of those cylinders that may touch, of one evaluation; allocated once.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Cylinders with points, in order.
    cylinders: Vec<usize>,
    /// Where along their cylinders they lie \[m\], and their shares of its law.
    along: Each,
    share: Each,
    /// Their cylinders' centres, and they themselves, from the arc's centre \[m\].
    toward: [Vec<Each>; 2],
    place: [Vec<Each>; 2],
    /// Velocity [m/s].
    velocity: [Vec<Each>; 2],
    /// Arc angles of their cylinders and their own, in the beam frame \[rad\]; 0 where the surface is
    /// a circle.
    bearing: Vec<Each>,
    angle: Vec<Each>,
    /// Where on the grid of the arc's shapes they lie, if it has any.
    on_grid: Vec<[Place; POINTS]>,
    /// Height of the surface above its circle \[m\], slope over the arc angle [m/rad], rate [m/s].
    height: Vec<Each>,
    slope: Vec<Each>,
    rising: Vec<Each>,
    /// Penetration \[m\] and its rate [m/s].
    depth: Vec<Each>,
    rate: Vec<Each>,
    /// Derivatives of the penetration by the point and by the beam angle.
    by_point: [Vec<Each>; 2],
    by_beam: Vec<Each>,
    /// Force that presses, never negative \[N\], and the power that the damping takes \[W\].
    force: Vec<Each>,
    lost: Vec<Each>,
}

/// What a cylinder's points add up to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pressed {
    /// How hard the cylinder is pressed \[N\].
    pub(super) total: f64,
    /// Force on it \[N\], and its first moment along the axis [N m].
    pub(super) push: V2,
    pub(super) bend: V2,
    /// Moment that the beam takes up [N m].
    pub(super) beam: f64,
    /// Power that the damping takes \[W\].
    pub(super) lost: f64,
}

impl Points {
    /// Room for a chain.
    pub(super) fn new(chain: &Chain) -> Self {
        let zeros = || vec![[0.0; POINTS]; chain.count];
        let half = 0.5 * chain.pitch;
        Self {
            cylinders: Vec::with_capacity(chain.count),
            along: chain.contact_points.map(|(place, _)| place * half),
            share: chain.contact_points.map(|(_, share)| share),
            toward: [zeros(), zeros()],
            place: [zeros(), zeros()],
            velocity: [zeros(), zeros()],
            bearing: zeros(),
            angle: zeros(),
            on_grid: vec![[Place::default(); POINTS]; chain.count],
            height: zeros(),
            slope: zeros(),
            rising: zeros(),
            depth: zeros(),
            rate: zeros(),
            by_point: [zeros(), zeros()],
            by_beam: zeros(),
            force: zeros(),
            lost: zeros(),
        }
    }

    /// Cylinders with points, in order.
    pub(super) fn cylinders(&self) -> &[usize] {
        &self.cylinders
    }

    /// Collects the points of all cylinders that may touch, and evaluates a law there.
    pub(super) fn evaluate<'a, const A: usize, P: InPlane<A> + 'a>(
        &mut self,
        chain: &Chain,
        surface: &Surface<'_>,
        law: &Impact,
        poses: impl Iterator<Item = &'a P>,
    ) {
        self.collect(chain, surface, poses);
        if surface.asks_for_angle() {
            self.turn();
        }
        self.shape(surface);
        self.penetrate(surface);
        let n = self.cylinders.len();
        let (depth, rate) = (&self.depth[..n], &self.rate[..n]);
        let (force, lost) = (&mut self.force[..n], &mut self.lost[..n]);
        law.push_all(
            [depth.as_flattened(), rate.as_flattened()],
            [force.as_flattened_mut(), lost.as_flattened_mut()],
        );
    }

    fn collect<'a, const A: usize, P: InPlane<A> + 'a>(
        &mut self,
        chain: &Chain,
        surface: &Surface<'_>,
        poses: impl Iterator<Item = &'a P>,
    ) {
        let half = 0.5 * chain.pitch;
        self.cylinders.clear();
        let mut before = None;
        for (j, pose) in poses.enumerate() {
            let center = pose.center();
            let Some(bearing) = surface.bearing_after(before.as_ref(), &center, half) else {
                continue;
            };
            let c = self.cylinders.len();
            self.cylinders.push(j);
            let (velocity, axis, sweep) = (pose.velocity(), pose.axis(), pose.sweep());
            let toward = bearing.toward();
            for k in 0..2 {
                self.place[k][c] = self.along.map(|along| toward[k] + axis[k] * along);
                self.velocity[k][c] = self.along.map(|along| velocity[k] + sweep[k] * along);
                self.toward[k][c] = [toward[k]; POINTS];
            }
            self.bearing[c] = [bearing.angle(); POINTS];
            before = Some(bearing);
        }
    }

    /// Arc angles.
    fn turn(&mut self) {
        let c = self.cylinders.len();
        let [ax, ay] = self.toward.each_ref().map(|x| x[..c].as_flattened());
        let [bx, by] = self.place.each_ref().map(|x| x[..c].as_flattened());
        let bearing = self.bearing[..c].as_flattened();
        let angle = self.angle[..c].as_flattened_mut();
        for i in 0..bearing.len() {
            let turned = small_angle([ax[i], ay[i]], [bx[i], by[i]]);
            angle[i] = bearing[i] + turned;
        }
    }

    /// Heights of the surface above its circle.
    fn shape(&mut self, surface: &Surface<'_>) {
        let c = self.cylinders.len();
        let height = self.height[..c].as_flattened_mut();
        let slope = self.slope[..c].as_flattened_mut();
        let rising = self.rising[..c].as_flattened_mut();
        let angle = self.angle[..c].as_flattened();
        if let Some(bend) = &surface.bend {
            let on_grid = self.on_grid[..c].as_flattened_mut();
            for (place, &angle) in on_grid.iter_mut().zip(angle) {
                *place = bend.shapes.place(angle);
            }
            bend.sum
                .heights(bend.shapes, on_grid, [&mut *height, &mut *slope, rising]);
        } else {
            height.fill(0.0);
            slope.fill(0.0);
            rising.fill(0.0);
        }
        if let Some(profile) = surface.profile {
            for ((height, slope), &angle) in height.iter_mut().zip(slope).zip(angle) {
                let [raised, tilted, _] = profile.height(angle);
                *height += raised;
                *slope += tilted;
            }
        }
    }

    /// Penetrations, their rates and derivatives.
    fn penetrate(&mut self, surface: &Surface<'_>) {
        let c = self.cylinders.len();
        let n = c * POINTS;
        let [x, y] = self.place.each_ref().map(|x| &x[..c].as_flattened()[..n]);
        let [vx, vy] = self
            .velocity
            .each_ref()
            .map(|v| &v[..c].as_flattened()[..n]);
        let height = &self.height[..c].as_flattened()[..n];
        let slope = &self.slope[..c].as_flattened()[..n];
        let rising = &self.rising[..c].as_flattened()[..n];
        let [by_x, by_y] = self.by_point.each_mut();
        let by_x = &mut by_x[..c].as_flattened_mut()[..n];
        let by_y = &mut by_y[..c].as_flattened_mut()[..n];
        let depth = &mut self.depth[..c].as_flattened_mut()[..n];
        let rate = &mut self.rate[..c].as_flattened_mut()[..n];
        let by_beam = &mut self.by_beam[..c].as_flattened_mut()[..n];
        let (cx, cy) = (surface.center_by_beam.x, surface.center_by_beam.y);
        let (radius, turning) = (surface.radius, surface.beam[1]);
        let reach = surface.reach * surface.reach;
        for i in 0..n {
            let square = x[i] * x[i] + y[i] * y[i];
            let distance = square.sqrt();
            let inverse = 1.0 / distance;
            let (nx, ny) = (x[i] * inverse, y[i] * inverse);
            let tilt = slope[i] * inverse;
            let (bx, by) = (-ny * tilt - nx, nx * tilt - ny);
            let beam = -(bx * cx + by * cy) - slope[i];
            let inside = radius + height[i] - distance;
            by_x[i] = bx;
            by_y[i] = by;
            by_beam[i] = beam;
            rate[i] = rising[i] + (bx * vx[i] + by * vy[i]) + beam * turning;
            depth[i] = if square < reach { inside } else { -1.0 };
        }
    }

    /// Adds up the points of the `k`-th of [`Self::cylinders`].
    #[inline]
    pub(super) fn pressed(&self, k: usize) -> Pressed {
        let (force, lost) = (&self.force[k], &self.lost[k]);
        let [x, y] = [&self.by_point[0][k], &self.by_point[1][k]];
        let beam = &self.by_beam[k];
        let mut sum = Pressed::default();
        for i in 0..POINTS {
            let force = self.share[i] * force[i];
            let push = V2::new(-force * x[i], -force * y[i]);
            sum.total += force;
            sum.push += push;
            sum.bend += push * self.along[i];
            sum.beam += force * beam[i];
            sum.lost += self.share[i] * lost[i];
        }
        sum
    }

    /// Deepest penetration, not negative \[m\].
    pub(super) fn deepest(&self) -> f64 {
        let depths = self.depth[..self.cylinders.len()].as_flattened();
        let deeper = |deepest: f64, &depth: &f64| if depth > deepest { depth } else { deepest };
        depths.iter().fold(0.0, deeper)
    }

    /// Spreads the forces over the knots of the arc's shapes.
    pub(super) fn spread(&self, pressure: &mut Spread) {
        for (k, places) in self.on_grid[..self.cylinders.len()].iter().enumerate() {
            for (i, place) in places.iter().enumerate() {
                let force = self.share[i] * self.force[k][i];
                if force != 0.0 {
                    pressure.add(place, force);
                }
            }
        }
    }

    /// Arc angles \[rad\] and forces \[N\] of the points.
    pub(crate) fn forces(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let points = self.angle.iter().zip(&self.force);
        let each = points.take(self.cylinders.len());
        each.flat_map(|(angle, force)| {
            std::array::from_fn::<_, POINTS, _>(|i| (angle[i], self.share[i] * force[i]))
        })
    }
}
