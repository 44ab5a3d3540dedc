//! Equations of motion of one symmetry family (symmetric or antisymmetric fields) on the half mesh;
//! factorised once, then used for modes and static solutions.
//!
//! The static solution takes one linear solve per gauge, `K w_g = row_g`; the reading under any load `f` is
//! then `w_g . f`.
use super::{
    arc::{Rim, Station},
    assembly::{Assembly, Unknowns},
    cholesky::Factor,
    eigen::{dot, lowest},
    element::Steel,
    error::ReductionError,
    gauge::{Gauge, Term},
    mesh::{Half, Mesh},
    request::{Family, ReductionRequest, Wrap},
    result::{Mode, Reduction, Row},
};
use nalgebra::DVector;

/// Returns the displacement fields of three rigid motions of the head: unit translations along x and y, and
/// unit rotation about the origin.
fn rigid(mesh: &Mesh) -> [Vec<[f64; 3]>; 3] {
    [
        mesh.nodes.iter().map(|_| [1.0, 0.0, 0.0]).collect(),
        mesh.nodes.iter().map(|_| [0.0, 1.0, 0.0]).collect(),
        mesh.nodes.iter().map(|n| [-n[1], n[0], 0.0]).collect(),
    ]
}

/// Response of the head to a wrapped rope.
#[derive(Default)]
struct Wrapped {
    /// Reading of each gauge \[Pa\].
    reading: Vec<f64>,
    /// Change of each reading when the gauge is moved along x, y and z [Pa/m].
    gradient: Vec<[Option<f64>; 3]>,
    /// Displacement of every node \[m\].
    field: Vec<[f64; 3]>,
    /// Stress at every element's centre \[Pa\].
    stress: Vec<[f64; 6]>,
}

/// Outputs evaluated for each mode: displacement at rope stations, gauge readings and optionally the
/// displacement field of all nodes.
pub(super) struct ModeOutputs<'a> {
    pub(super) stations: &'a [Station],
    /// Weights of nodal displacements that give the reading of each gauge.
    pub(super) rows: &'a [Row],
    /// Whether to return the displacement field of every mode too.
    pub(super) fields: bool,
}

/// Stiffness and mass of the half mesh under the boundary conditions of one symmetry family.
pub(super) struct Problem<'a> {
    pub(super) half: &'a Half,
    family: Family,
    unknowns: Unknowns,
    pub(super) assembly: Assembly,
    pub(super) factor: Factor,
    /// Consistent mass matrix times each of the three rigid motions (x, y, rotation), on all nodes of the
    /// half.
    pub(super) inertia: [Vec<[f64; 3]>; 3],
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        request: &ReductionRequest<'_>,
        half: &'a Half,
        family: Family,
    ) -> Result<Self, ReductionError> {
        let mesh = &half.mesh;
        let mut held = vec![false; mesh.nodes.len()];
        for &node in &mesh.held {
            held[node] = true;
        }
        let free = |node: usize, axis: usize| {
            let on_plane = half.on_plane[node] && family.image()[axis] < 0.0;
            !held[node] && !on_plane
        };
        let unknowns = Unknowns::new(mesh.nodes.len(), free);
        let assembly = Assembly::new(mesh, &request.steel, &unknowns)?;
        let factor = Factor::new(&assembly.stiffness)?;
        let inertia = mass_times(mesh, &request.steel, &rigid(mesh))?;
        Ok(Self {
            half,
            family,
            unknowns,
            assembly,
            factor,
            inertia,
        })
    }

    /// Computes the `count` lowest modes of this symmetry family, and the number of linear solves made;
    /// `coupling` computes a mode's coupling with the load patterns from its angular frequency and its
    /// displacement field on the half.
    pub(super) fn modes(
        &self,
        count: usize,
        coupling: &dyn Fn(f64, &[[f64; 3]]) -> f64,
        seen: &ModeOutputs<'_>,
    ) -> Result<(Vec<Mode>, usize), ReductionError> {
        let found = lowest(&self.assembly, &self.factor, count)?;
        let mode = |(value, shape): (&f64, &Vec<f64>)| {
            let (frequency, field) = (value.sqrt(), self.unit_mass(shape));
            let coupling = coupling(frequency, &field);
            let mode = self.mode(seen, frequency, field);
            Mode { coupling, ..mode }
        };
        let modes = found.eigenvalues.iter().zip(&found.shapes).map(mode);
        Ok((modes.collect(), found.steps))
    }

    /// Expands a mode shape to all nodes of the half and scales it to unit modal mass of the whole body.
    pub(super) fn unit_mass(&self, shape: &[f64]) -> Vec<[f64; 3]> {
        let scale = std::f64::consts::FRAC_1_SQRT_2;
        let mut field = self.unknowns.spread(shape);
        field.iter_mut().flatten().for_each(|u| *u *= scale);
        field
    }

    /// Chooses the sign of a mode such that the gauge with the largest reading is in tension; returns its
    /// displacement field and gauge readings.
    pub(super) fn signed(
        &self,
        rows: &[Row],
        mut field: Vec<[f64; 3]>,
    ) -> (Vec<[f64; 3]>, Vec<f64>) {
        let read = |field: &[[f64; 3]]| -> Vec<f64> {
            rows.iter().map(|row| self.reading(row, field)).collect()
        };
        let mut gauge_stress = read(&field);
        let most = gauge_stress.iter().fold(0.0_f64, |most, stress| {
            if stress.abs() > most.abs() {
                *stress
            } else {
                most
            }
        });
        if most < 0.0 {
            field.iter_mut().flatten().for_each(|u| *u = -*u);
            gauge_stress = read(&field);
        }
        (field, gauge_stress)
    }

    fn mode(&self, seen: &ModeOutputs<'_>, frequency: f64, field: Vec<[f64; 3]>) -> Mode {
        let &ModeOutputs {
            stations,
            rows,
            fields,
        } = seen;
        let (field, gauge_stress) = self.signed(rows, field);
        // both halves together: double, or nothing
        let both = 1.0 + self.family.image()[0];
        let participation = self
            .inertia
            .each_ref()
            .map(|inertia| both * dot(inertia.as_flattened(), field.as_flattened()));
        let mean = |station: &Station, direction| 0.5 * both * station.mean(&field, direction);
        Mode {
            family: self.family,
            frequency,
            radial: stations.iter().map(|s| mean(s, s.radial)).collect(),
            tangential: stations.iter().map(|s| mean(s, s.tangential)).collect(),
            gauge_stress,
            participation,
            coupling: 0.0,
            field: if fields {
                self.half.unfold(&field, self.family.image())
            } else {
                Vec::new()
            },
        }
    }

    /// Returns the reading of a gauge \[Pa\] for a displacement field of the half.
    fn reading(&self, row: &[Term], field: &[[f64; 3]]) -> f64 {
        let reading = |term: &Term| {
            let factors = self.factors(term);
            let products = factors.iter().zip(&field[term.node]).map(|(f, u)| f * u);
            products.sum::<f64>()
        };
        row.iter().map(reading).sum()
    }

    /// Returns the factors of a term for displacements of the half: those of a mirror image with the family's
    /// signs.
    fn factors(&self, term: &Term) -> [f64; 3] {
        let signs = if term.image {
            self.family.image()
        } else {
            [1.0; 3]
        };
        [0, 1, 2].map(|axis| signs[axis] * term.factors[axis])
    }

    /// Computes the influence field of each gauge on the half, with one linear solve per gauge; a gauge's
    /// reading under a load is the inner product of load and influence field.
    pub(super) fn lines(&self, rows: &[Row]) -> Vec<Vec<[f64; 3]>> {
        let line = |row: &Row| {
            let mut load = vec![[0.0; 3]; self.half.mesh.nodes.len()];
            for term in row {
                for (load, factor) in load[term.node].iter_mut().zip(self.factors(term)) {
                    *load += factor;
                }
            }
            self.solve(&load)
        };
        rows.iter().map(line).collect()
    }

    /// Computes all static results of the reduction (influence lines, compliance, wrapped rope, mass
    /// properties) and leaves its list of modes empty.
    pub(super) fn statics(
        &self,
        request: &ReductionRequest<'_>,
        rim: &Rim<'_>,
        stations: &[Station],
        rows: &[Row],
    ) -> Result<Reduction, ReductionError> {
        let lines = self.lines(rows);
        // a newton over the whole width is half a newton on the half
        let stress = |station: &Station, direction: [f64; 2], force: f64| -> Vec<f64> {
            let read = |line: &Vec<[f64; 3]>| 0.5 * force * station.mean(line, direction);
            lines.iter().map(read).collect()
        };
        let inertia_stress = self.inertia.each_ref().map(|inertia| {
            let read = |line: &Vec<[f64; 3]>| -dot(inertia.as_flattened(), line.as_flattened());
            lines.iter().map(read).collect()
        });
        let total = |inertia: usize, rigid: &[[f64; 3]]| {
            2.0 * dot(self.inertia[inertia].as_flattened(), rigid.as_flattened())
        };
        let [x, y, turn] = rigid(&self.half.mesh);
        let mass = total(0, &x);
        let wrapped = match &request.wrap {
            Some(wrap) => self.wrapped(request, rim, wrap, rows)?,
            None => Wrapped::default(),
        };
        Ok(Reduction {
            modes: Vec::new(),
            left_out: Vec::new(),
            normal_influence: stations.iter().map(|s| stress(s, s.radial, -1.0)).collect(),
            tangential_influence: stations
                .iter()
                .map(|s| stress(s, s.tangential, 1.0))
                .collect(),
            inertia_stress,
            compliance: self.compliance(request, rim)?,
            wrap_reading: wrapped.reading,
            wrap_gradient: wrapped.gradient,
            wrap_field: wrapped.field,
            wrap_stress: wrapped.stress,
            surface: None,
            sway: None,
            mass,
            center_of_mass: [total(2, &y) / mass, -total(2, &x) / mass],
            inertia: total(2, &turn),
            unknowns: self.unknowns.len(),
            lanczos_steps: 0,
        })
    }

    /// Computes the static displacement of the half under nodal forces on the half.
    pub(super) fn solve(&self, load: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut vector = self.unknowns.gather(load);
        self.factor.solve(&mut vector);
        self.unknowns.spread(&vector)
    }

    fn compliance(
        &self,
        request: &ReductionRequest<'_>,
        rim: &Rim<'_>,
    ) -> Result<Vec<Vec<f64>>, ReductionError> {
        let probes = request.probes.iter().map(|&psi| rim.station(psi));
        let probes: Vec<Station> = probes.collect::<Result<_, _>>()?;
        let row = |load: &Station| {
            let force = load.force(self.half.mesh.nodes.len(), load.radial, -0.5);
            let field = self.solve(&force);
            probes.iter().map(|p| p.mean(&field, p.radial)).collect()
        };
        Ok(probes.iter().map(row).collect())
    }

    /// Computes the nodal forces on the half from a rope wrapped around the head \[N\].
    pub(super) fn wrap_force(
        &self,
        rim: &Rim<'_>,
        wrap: &Wrap,
    ) -> Result<Vec<[f64; 3]>, ReductionError> {
        let mut force = vec![[0.0; 3]; self.half.mesh.nodes.len()];
        for (psi, share) in wrap.line(512) {
            let station = rim.station(psi)?;
            station.add_force(&mut force, station.radial, -0.5 * share);
        }
        let anchor = rim.station(wrap.anchor)?;
        // the rope runs towards increasing psi and pulls its fixed end that way
        anchor.add_force(&mut force, anchor.tangential, 0.5 * wrap.tension);
        Ok(force)
    }

    /// Returns the response of gauges and, if fields are requested, of the whole mesh to a wrapped rope.
    fn wrapped(
        &self,
        request: &ReductionRequest<'_>,
        rim: &Rim<'_>,
        wrap: &Wrap,
        rows: &[Row],
    ) -> Result<Wrapped, ReductionError> {
        let moved = self.solve(&self.wrap_force(rim, wrap)?);
        let reading = |row: &[Term]| self.reading(row, &moved);
        let gradient =
            |gauge: &Gauge| gauge.gradient(&self.half.mesh, request.steel.young, &reading);
        let of_gauges = Wrapped {
            reading: rows.iter().map(|row| reading(row)).collect(),
            gradient: request.gauges.iter().map(gradient).collect(),
            ..Wrapped::default()
        };
        if !request.fields {
            return Ok(of_gauges);
        }
        let field = self.half.unfold(&moved, self.family.image());
        let stress = request.mesh.elements().map(|element| {
            let moved: Vec<[f64; 3]> = element.iter().map(|&node| field[node]).collect();
            let nodes = request.mesh.places(element);
            let law = request.mesh.law();
            law.center_stress(&request.steel, &nodes, &moved)
        });
        Ok(Wrapped {
            stress: stress.collect(),
            field,
            ..of_gauges
        })
    }
}

/// Multiplies displacement fields over all nodes by the consistent mass matrix.
fn mass_times<const N: usize>(
    mesh: &Mesh,
    steel: &Steel,
    fields: &[Vec<[f64; 3]>; N],
) -> Result<[Vec<[f64; 3]>; N], ReductionError> {
    let mut products = [(); N].map(|()| vec![[0.0; 3]; mesh.nodes.len()]);
    for (element, nodes) in mesh.elements().enumerate() {
        let own = mesh.law().matrices(&mesh.places(nodes), steel);
        let mass = own
            .map_err(|_| ReductionError::InvertedElement { element })?
            .mass;
        for (product, field) in products.iter_mut().zip(fields) {
            let values = DVector::from_fn(mass.ncols(), |i, _| field[nodes[i / 3]][i % 3]);
            let force = &mass * values;
            for (i, force) in force.iter().enumerate() {
                product[nodes[i / 3]][i % 3] += force;
            }
        }
    }
    Ok(products)
}
