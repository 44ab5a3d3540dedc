//! Surface of the back head with its stress under the loads that a simulation records, and its pins.
use super::place::Pin;
use case::pumping_unit::{INERT, mac, mesh};
use fatigue::StressedSurface;
use protocol::pumping_unit::{HeadMode, HeadSurface, Machine, ModalHead, ReducedHead};
use support::Problem;

/// Largest relative difference of a mode's frequency by the mesh from that in the table of the case, which another
/// program may have computed.
const SAME_FREQUENCY: f64 = 0.02;
/// Least modal assurance criterion of the two shapes.
const SAME_SHAPE: f64 = 0.99;

/// Surface of the head that is assessed.
pub(super) struct Body<'a> {
    surface: &'a HeadSurface,
    /// Stress under each load of `HeadLoads::curves`.
    unit_stress: Vec<Vec<[f32; 6]>>,
    pub(super) pins: Vec<Pin>,
    /// Points that are assessed: those that are not held.
    pub(super) points: Vec<usize>,
}

impl<'a> Body<'a> {
    /// Finds the modes of the machine's table among those of the reduced head, and the pins in its mesh.
    ///
    /// # Errors
    /// If a mode that the rope drives has no counterpart: the tables are of another head.
    pub(super) fn new(
        read: &mesh::Mesh,
        reduced: &'a ReducedHead,
        machine: &Machine,
    ) -> Result<Self, Problem> {
        let surface = reduced.surface.as_ref().ok_or_else(|| Problem {
            message: "the worker returned no stress of the surface".to_owned(),
            remedy: "use workers of the same build".to_owned(),
        })?;
        let table = &machine.modal_head;
        let statics = surface.stress_mpa.len().saturating_sub(reduced.modes.len());
        let mut unit_stress = surface.stress_mpa[..statics].to_vec();
        for k in 0..machine.run.modes.min(table.frequencies_hz.len()) {
            let own = shape(&table.radial[k], &table.tangential[k]);
            if !is_driven(table, &own) {
                unit_stress.push(vec![[0.0; 6]; surface.held.len()]);
                continue;
            }
            let found = reduced
                .modes
                .iter()
                .position(|mode| same(table.frequencies_hz[k], &own, mode));
            let found = found.ok_or_else(|| Problem {
                message: format!(
                    "mode {} of the case's tables, {:.2} Hz, is none of its mesh",
                    k + 1,
                    table.frequencies_hz[k]
                ),
                remedy: "write tables of this mesh: horsehead head CASE --write".to_owned(),
            })?;
            let mode = &reduced.modes[found];
            let other = shape(&mode.radial, &mode.tangential);
            let sign = if dot(&own, &other) < 0.0 { -1.0 } else { 1.0 };
            let stress = surface.stress_mpa[statics + found].iter();
            unit_stress.push(stress.map(|stress| stress.map(|s| sign * s)).collect());
        }
        let pins = ["pin_a", "pin_b"].iter().zip(["A", "B"]);
        let pins = pins.filter_map(|(group, name)| {
            let nodes = read.surfaces.get(*group)?.iter();
            let places = nodes.filter_map(|node| read.nodes_m.get(*node)).copied();
            Pin::around(name, &places.collect::<Vec<_>>())
        });
        let free = |point: &usize| !surface.held[*point];
        Ok(Self {
            surface,
            unit_stress,
            pins: pins.collect(),
            points: (0..surface.held.len()).filter(free).collect(),
        })
    }

    /// Returns the surface as the assessment takes it.
    pub(super) fn fatigue(&self) -> StressedSurface<'_> {
        StressedSurface {
            normals: &self.surface.normals,
            unit_stress: &self.unit_stress,
        }
    }

    /// Returns the surface, with positions and faces.
    pub(super) const fn surface(&self) -> &'a HeadSurface {
        self.surface
    }

    /// Returns the position of a point \[m\].
    pub(super) fn place_m(&self, point: usize) -> [f64; 3] {
        self.surface.places_m[point]
    }
}

/// Returns the displacement of the rope surface in a mode.
fn shape(radial: &[f64], tangential: &[f64]) -> Vec<f64> {
    [radial, tangential].concat()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns whether a mode of a table moves the rope surface.
fn is_driven(table: &ModalHead, shape: &[f64]) -> bool {
    let largest =
        |values: &mut dyn Iterator<Item = &f64>| values.fold(0.0_f64, |most, x| most.max(x.abs()));
    let all = largest(&mut table.radial.iter().chain(&table.tangential).flatten());
    largest(&mut shape.iter()) > INERT * all
}

/// Returns whether a reduced mode is that of a frequency and a shape in the table.
fn same(frequency_hz: f64, own: &[f64], mode: &HeadMode) -> bool {
    let other = shape(&mode.radial, &mode.tangential);
    mac(own, &other) > SAME_SHAPE && (mode.frequency_hz / frequency_hz - 1.0).abs() < SAME_FREQUENCY
}
