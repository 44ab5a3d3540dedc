//! Prototype: joints, residual and block solution of four machines of one layout, one machine in each SIMD lane,
//! against the same work for one machine after the other, with neighbouring cylinders in the lanes.
//!
//! The machine is the chain of the pumping unit: 72 cylinders of which the last 50 couple to seven unknowns of
//! the border (beam and modes), and 114 of which the last 70 couple to the beam. Poses are given, contact is left
//! out. The verdict is in `docs/measurements.md`.
#![expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
use criterion::{Criterion, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};
use simulation::element::law::ForceLaw;
use simulation::element::plane::{PlaneJoint, PlaneRod};
use simulation::linear::Bordered;
use simulation::math::real::{Vector, WIDEST};
use simulation::reference;

/// Values of the four machines.
type Each = [f64; WIDEST];

const CHAINS: [usize; 2] = [72, 114];
const CYLINDERS: usize = CHAINS[0] + CHAINS[1];
const BORDER: usize = 7;
/// Number of cylinders at the end of each chain that couple to the border, and number of border unknowns that
/// they couple to.
const COUPLED: [(usize, usize); 2] = [(50, BORDER), (70, 1)];
const HALF: f64 = 0.025;
const MASS: [f64; 3] = [0.03, 0.03, 6e-6];

/// Deterministic numbers around zero in place of a state or a matrix entry.
fn number(seed: usize) -> f64 {
    ((seed * 7_919 + 17) % 1_013) as f64 / 1_013.0 - 0.5
}

/// Returns cylinder `j` of machine `lane` as a rod: a slightly bent rope in motion.
fn rod(lane: usize, j: usize) -> PlaneRod<f64> {
    let angle = 0.01 * number(11 * j + lane);
    PlaneRod {
        place: [j as f64 * 2.0 * HALF, 1e-4 * number(5 * j + lane)],
        velocity: [0.1 * number(j + lane), 0.1 * number(3 * j + lane)],
        axis: [cosine_of(angle), angle],
        angle,
        rate: number(j + 31 * lane),
    }
}

/// Cosine of a small angle by its series.
fn cosine_of(x: f64) -> f64 {
    1.0 - 0.5 * x * x
}

/// Returns the seven coefficients of the joints of machine `lane`.
fn coefficients(lane: usize) -> [f64; 7] {
    let mut all = reference::law().bushing.coefficients();
    for (k, x) in all.iter_mut().enumerate() {
        *x *= 1.0 + 0.1 * number(k + 7 * lane);
    }
    all
}

/// Returns the entry of machine `lane`'s matrix in the rows of block `b`, the columns of block or border `of`.
fn entry(lane: usize, b: usize, of: usize, [row, column]: [usize; 2]) -> f64 {
    let own = if b == of && row == column { 4.0 } else { 0.0 };
    own + 0.5 * number(1 + lane + 13 * b + 101 * of + 3 * row + column)
}

/// First block of each chain that couples to border unknown `k`, the end of the chain if none does.
fn coupled_from(chain: usize, k: usize) -> usize {
    let end: usize = CHAINS[..=chain].iter().sum();
    let (count, unknowns) = COUPLED[chain];
    if k < unknowns { end - count } else { end }
}

/// Calls `set` with every entry of the matrix of machine `lane`, by its row and column.
fn entries(lane: usize, mut set: impl FnMut(usize, usize, f64)) {
    let mut start = 0;
    for (chain, count) in CHAINS.into_iter().enumerate() {
        for b in start..start + count {
            let beside = [b.checked_sub(1), Some(b), Some(b + 1)];
            for c in beside
                .into_iter()
                .flatten()
                .filter(|c| (start..start + count).contains(c))
            {
                for row in 0..3 {
                    for column in 0..3 {
                        set(
                            3 * b + row,
                            3 * c + column,
                            entry(lane, b, c, [row, column]),
                        );
                    }
                }
            }
            for k in (0..BORDER).filter(|&k| coupled_from(chain, k) <= b) {
                for i in 0..3 {
                    set(
                        3 * b + i,
                        3 * CYLINDERS + k,
                        entry(lane, b, 1000 + k, [i, 0]),
                    );
                    set(
                        3 * CYLINDERS + k,
                        3 * b + i,
                        entry(lane, b, 2000 + k, [0, i]),
                    );
                }
            }
        }
        start += count;
    }
    for row in 0..BORDER {
        for column in 0..BORDER {
            let at = 3 * CYLINDERS;
            let own = if row == column { 40.0 } else { 0.0 };
            set(at + row, at + column, own + number(row + 3 * column + lane));
        }
    }
}

/// One machine with neighbouring cylinders in the lanes: the arrays of its rods, and its matrix.
struct Single {
    arrays: [Vec<f64>; 8],
    law: simulation::element::bushing::Bushing,
    acceleration: Vec<f64>,
    matrix: Bordered,
    /// Forces and torques of the joints.
    loads: [Vec<f64>; 4],
}

impl Single {
    fn new(lane: usize) -> Self {
        let mut arrays: [Vec<f64>; 8] = std::array::from_fn(|_| vec![0.0; CYLINDERS + 2 * WIDEST]);
        for j in 0..CYLINDERS {
            let PlaneRod {
                place,
                velocity,
                axis,
                angle,
                rate,
            } = rod(lane, j);
            let all = [
                place[0],
                place[1],
                velocity[0],
                velocity[1],
                axis[0],
                axis[1],
                angle,
                rate,
            ];
            for (array, x) in arrays.iter_mut().zip(all) {
                array[j] = x;
            }
        }
        let mut matrix = Bordered::plane(&CHAINS, [0, BORDER]);
        entries(lane, |row, column, x| matrix.add(row, column, x));
        matrix.factorize().expect("a regular matrix");
        Self {
            arrays,
            law: reference::law()
                .bushing
                .with_coefficients(coefficients(lane)),
            acceleration: (0..3 * CYLINDERS).map(|i| number(i + lane)).collect(),
            matrix,
            loads: std::array::from_fn(|_| vec![0.0; CYLINDERS.next_multiple_of(WIDEST)]),
        }
    }

    /// Computes the solution of the machine's matrix with the residual of joints and inertia.
    fn solve(&mut self, x: &mut [f64]) {
        for (out, a) in x
            .as_chunks_mut::<3>()
            .0
            .iter_mut()
            .zip(self.acceleration.as_chunks::<3>().0)
        {
            for i in 0..3 {
                out[i] = -MASS[i] * a[i];
            }
        }
        x[3 * CYLINDERS..].fill(0.0);
        let mut start = 0;
        for count in CHAINS {
            Arch::new().dispatch(Joints {
                machine: self,
                start,
                count: count - 1,
            });
            let [fx, fy, ti, tj] = &self.loads;
            for k in 0..count - 1 {
                let at = 3 * (start + k);
                let load = [-fx[k], -fy[k], tj[k], fx[k], fy[k], ti[k]];
                for (x, load) in x[at..at + 6].iter_mut().zip(load) {
                    *x += load;
                }
            }
            start += count;
        }
        self.matrix.solve(x);
    }
}

/// Loads of the joints of one chain of one machine.
struct Joints<'a> {
    machine: &'a mut Single,
    start: usize,
    count: usize,
}

impl WithSimd for Joints<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let vectors = self.count.div_ceil(S::F64_LANES);
        let Single {
            arrays, law, loads, ..
        } = self.machine;
        let view = |first: usize| {
            arrays
                .each_ref()
                .map(|array| &S::as_simd_f64s(&array[first..]).0[..vectors])
        };
        let (before, behind) = (view(self.start), view(self.start + 1));
        let out = loads
            .each_mut()
            .map(|array| &mut S::as_mut_simd_f64s(array).0[..vectors]);
        let [fx, fy, ti, tj] = out;
        for k in 0..vectors {
            let rods =
                [behind, before].map(|arrays| rod_of(arrays.map(|a| Vector::new(simd, a[k]))));
            let joint = PlaneJoint::new(HALF, &rods[0], &rods[1]);
            let load = joint.load(law.response(joint.deformation, joint.rate).force);
            fx[k] = load.force[0].lanes();
            fy[k] = load.force[1].lanes();
            ti[k] = load.torque[0].lanes();
            tj[k] = load.torque[1].lanes();
        }
    }
}

#[inline(always)]
fn rod_of<T>([px, py, vx, vy, cosine, sine, angle, rate]: [T; 8]) -> PlaneRod<T> {
    PlaneRod {
        place: [px, py],
        velocity: [vx, vy],
        axis: [cosine, sine],
        angle,
        rate,
    }
}

/// Four machines, one per lane: every number is four numbers.
struct Four {
    rods: Vec<[Each; 8]>,
    coefficients: [Each; 7],
    acceleration: Vec<[Each; 3]>,
    /// Inverse of each diagonal block of the factorised matrix, coupling handed on to the next block, and
    /// coupling with the next block; by rows.
    inverse: Vec<[[Each; 3]; 3]>,
    handed: Vec<[[Each; 3]; 3]>,
    upper: Vec<[[Each; 3]; 3]>,
    /// Couplings with the border, border unknown by border unknown, and the inverse of the border's corner.
    right: [Vec<[Each; 3]>; BORDER],
    bottom: [Vec<[Each; 3]>; BORDER],
    corner: [[Each; BORDER]; BORDER],
}

impl Four {
    /// Builds the machines and takes their factors from elimination without pivots, lane by lane.
    fn new() -> Self {
        let zero = [[[0.0; WIDEST]; 3]; 3];
        let mut four = Self {
            rods: vec![[[0.0; WIDEST]; 8]; CYLINDERS],
            coefficients: [[0.0; WIDEST]; 7],
            acceleration: vec![[[0.0; WIDEST]; 3]; CYLINDERS],
            inverse: vec![zero; CYLINDERS],
            handed: vec![zero; CYLINDERS],
            upper: vec![zero; CYLINDERS],
            right: std::array::from_fn(|_| vec![[[0.0; WIDEST]; 3]; CYLINDERS]),
            bottom: std::array::from_fn(|_| vec![[[0.0; WIDEST]; 3]; CYLINDERS]),
            corner: [[[0.0; WIDEST]; BORDER]; BORDER],
        };
        for lane in 0..WIDEST {
            for (k, x) in coefficients(lane).into_iter().enumerate() {
                four.coefficients[k][lane] = x;
            }
            for j in 0..CYLINDERS {
                let PlaneRod {
                    place,
                    velocity,
                    axis,
                    angle,
                    rate,
                } = rod(lane, j);
                let all = [
                    place[0],
                    place[1],
                    velocity[0],
                    velocity[1],
                    axis[0],
                    axis[1],
                    angle,
                    rate,
                ];
                for (each, x) in four.rods[j].iter_mut().zip(all) {
                    each[lane] = x;
                }
                for i in 0..3 {
                    four.acceleration[j][i][lane] = number(3 * j + i + lane);
                }
            }
            four.factorize(lane);
        }
        four
    }

    fn factorize(&mut self, lane: usize) {
        use nalgebra::{Matrix3, SMatrix, Vector3};
        let n = 3 * CYLINDERS + BORDER;
        let mut dense = vec![vec![0.0; n]; n];
        entries(lane, |row, column, x| dense[row][column] += x);
        let block = |dense: &[Vec<f64>], b: usize, c: usize| {
            Matrix3::from_fn(|i, j| dense[3 * b + i][3 * c + j])
        };
        let mut corner = SMatrix::<f64, BORDER, BORDER>::from_fn(|i, j| {
            dense[3 * CYLINDERS + i][3 * CYLINDERS + j]
        });
        let mut start = 0;
        for count in CHAINS {
            let mut fill = Matrix3::zeros();
            let mut rights = [Vector3::zeros(); BORDER];
            let mut bottoms = [Vector3::zeros(); BORDER];
            for b in start..start + count {
                let last = b + 1 == start + count;
                let inverse = (block(&dense, b, b) - fill).try_inverse().expect("regular");
                let (upper, lower) = if last {
                    (Matrix3::zeros(), Matrix3::zeros())
                } else {
                    (inverse * block(&dense, b, b + 1), block(&dense, b + 1, b))
                };
                let handed = lower * inverse;
                fill = lower * upper;
                for k in 0..BORDER {
                    let at = 3 * CYLINDERS + k;
                    let own = Vector3::from_fn(|i, _| dense[3 * b + i][at]);
                    let below = Vector3::from_fn(|i, _| dense[at][3 * b + i]);
                    let right = own - rights[k];
                    bottoms[k] = below - bottoms[k];
                    rights[k] = handed * right;
                    let solved = inverse * right;
                    for i in 0..3 {
                        self.right[k][b][i][lane] = solved[i];
                        self.bottom[k][b][i][lane] = bottoms[k][i];
                    }
                }
                for row in 0..BORDER {
                    for column in 0..BORDER {
                        let right = self.right[column][b].map(|x| x[lane]);
                        corner[(row, column)] -= bottoms[row].dot(&Vector3::from(right));
                    }
                }
                for bottom in &mut bottoms {
                    *bottom = upper.transpose() * *bottom;
                }
                for i in 0..3 {
                    for j in 0..3 {
                        self.inverse[b][i][j][lane] = inverse[(i, j)];
                        self.handed[b][i][j][lane] = handed[(i, j)];
                        self.upper[b][i][j][lane] = upper[(i, j)];
                    }
                }
            }
            start += count;
        }
        let corner = corner.try_inverse().expect("regular");
        for row in 0..BORDER {
            for column in 0..BORDER {
                self.corner[row][column][lane] = corner[(row, column)];
            }
        }
    }
}

/// Returns the `k`-th vector of the lanes of the four machines.
#[inline(always)]
fn read<S: Simd>(simd: S, k: usize, each: &Each) -> Vector<S> {
    Vector::new(simd, S::as_simd_f64s(each).0[k])
}

/// Returns the `k`-th vectors of several numbers.
#[inline(always)]
fn read_all<S: Simd, const N: usize>(simd: S, k: usize, all: &[Each; N]) -> [Vector<S>; N] {
    let mut vectors = [Vector::splat(simd, 0.0); N];
    for (vector, each) in vectors.iter_mut().zip(all) {
        *vector = read(simd, k, each);
    }
    vectors
}

/// Stores the `k`-th vectors of several numbers.
#[inline(always)]
fn write_all<S: Simd, const N: usize>(k: usize, all: &mut [Each; N], vectors: [Vector<S>; N]) {
    for (each, vector) in all.iter_mut().zip(vectors) {
        S::as_mut_simd_f64s(each).0[k] = vector.lanes();
    }
}

/// Returns the product of a block of each machine and a vector.
#[inline(always)]
fn product<S: Simd>(simd: S, k: usize, a: &[[Each; 3]; 3], x: &[Vector<S>; 3]) -> [Vector<S>; 3] {
    let mut y = *x;
    for (y, row) in y.iter_mut().zip(a) {
        let row = read_all(simd, k, row);
        *y = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
    }
    y
}

/// Solution of the four matrices with the residuals of joints and inertia, of blocks and border.
struct SolveFour<'a>(&'a Four, &'a mut [[Each; 3]], &'a mut [Each; BORDER]);

impl WithSimd for SolveFour<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(four, x, border) = self;
        for k in 0..WIDEST / S::F64_LANES {
            let zero = Vector::splat(simd, 0.0);
            let [k1, k2, k5, c1, c2, c5, preload] = read_all(simd, k, &four.coefficients);
            let mut sums = [zero; BORDER];
            let mut start = 0;
            for (chain, count) in CHAINS.into_iter().enumerate() {
                let mut before = rod_of(read_all(simd, k, &four.rods[start]));
                let (mut force, mut handed) = ([zero; 3], [zero; 3]);
                for b in start..start + count {
                    let a = read_all(simd, k, &four.acceleration[b]);
                    let mut right = force;
                    for i in 0..3 {
                        right[i] = force[i] - a[i] * MASS[i] - handed[i];
                    }
                    if b + 1 < start + count {
                        let behind = rod_of(read_all(simd, k, &four.rods[b + 1]));
                        let joint = PlaneJoint::new(HALF, &behind, &before);
                        let ([u, s, t], [du, ds, dt]) = (joint.deformation, joint.rate);
                        let along = u * k1 + du * c1 + preload;
                        let load = joint.load([along, s * k2 + ds * c2, t * k5 + dt * c5]);
                        let [fx, fy] = load.force;
                        right = [right[0] - fx, right[1] - fy, right[2] + load.torque[1]];
                        force = [fx, fy, load.torque[0]];
                        before = behind;
                    }
                    handed = product(simd, k, &four.handed[b], &right);
                    let y = product(simd, k, &four.inverse[b], &right);
                    write_all(k, &mut x[b], y);
                    for (u, sum) in sums.iter_mut().enumerate() {
                        if coupled_from(chain, u) <= b {
                            let bottom = read_all(simd, k, &four.bottom[u][b]);
                            *sum = *sum - (bottom[0] * y[0] + bottom[1] * y[1] + bottom[2] * y[2]);
                        }
                    }
                }
                start += count;
            }
            let mut solved = [zero; BORDER];
            for (solved, row) in solved.iter_mut().zip(&four.corner) {
                for (entry, sum) in row.iter().zip(sums) {
                    *solved = *solved + read(simd, k, entry) * sum;
                }
            }
            write_all(k, border, solved);
            let mut end = CYLINDERS;
            for (chain, count) in CHAINS.into_iter().enumerate().rev() {
                let mut next = [zero; 3];
                for b in (end - count..end).rev() {
                    let handed = product(simd, k, &four.upper[b], &next);
                    let mut y = read_all(simd, k, &x[b]);
                    for i in 0..3 {
                        y[i] = y[i] - handed[i];
                    }
                    for (u, solved) in solved.into_iter().enumerate() {
                        if coupled_from(chain, u) <= b {
                            let right = read_all(simd, k, &four.right[u][b]);
                            for i in 0..3 {
                                y[i] = y[i] - right[i] * solved;
                            }
                        }
                    }
                    write_all(k, &mut x[b], y);
                    next = y;
                }
                end -= count;
            }
        }
    }
}

/// Measures joints, residual and solution of four machines: one after the other, and in the lanes.
fn four_machines(criterion: &mut Criterion) {
    let mut single: Vec<Single> = (0..WIDEST).map(Single::new).collect();
    let four = Four::new();
    let mut apart = vec![vec![0.0; 3 * CYLINDERS + BORDER]; WIDEST];
    let mut together = vec![[[0.0; WIDEST]; 3]; CYLINDERS];
    let mut border = [[0.0; WIDEST]; BORDER];
    // both compute the same
    for (machine, x) in single.iter_mut().zip(&mut apart) {
        machine.solve(x);
    }
    Arch::new().dispatch(SolveFour(&four, &mut together, &mut border));
    for (lane, x) in apart.iter().enumerate() {
        let scale = x.iter().fold(0.0, |scale: f64, x| scale.max(x.abs()));
        for (i, x) in x.iter().enumerate() {
            let other = if i < 3 * CYLINDERS {
                together[i / 3][i % 3][lane]
            } else {
                border[i - 3 * CYLINDERS][lane]
            };
            assert!(
                (x - other).abs() < 1e-9 * scale,
                "lane {lane}, unknown {i}: {x} {other}"
            );
        }
    }
    let mut group = criterion.benchmark_group("joints, residual and solution of four machines");
    group.bench_function("one after the other", |b| {
        b.iter(|| {
            for (machine, x) in single.iter_mut().zip(&mut apart) {
                machine.solve(x);
            }
        });
    });
    group.bench_function("one per lane", |b| {
        b.iter(|| Arch::new().dispatch(SolveFour(&four, &mut together, &mut border)));
    });
    group.finish();
}

criterion_group!(benches, four_machines);
criterion_main!(benches);
