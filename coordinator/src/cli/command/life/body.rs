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

/// Modes of the machine's table among those of the reduced head: index and sign of each; `None` for a mode that the
/// rope does not drive.
pub(super) struct TableModes(Vec<Option<(usize, f32)>>);

impl TableModes {
    /// Finds the modes.
    ///
    /// # Errors
    /// If a mode that the rope drives has no counterpart: the tables are of another head.
    pub(super) fn find(reduced: &ReducedHead, machine: &Machine) -> Result<Self, Problem> {
        let table = &machine.modal_head;
        let counterpart = |k: usize| {
            let own = shape(&table.radial[k], &table.tangential[k]);
            if !is_driven(table, &own) {
                return Ok(None);
            }
            let mut modes = reduced.modes.iter().enumerate();
            let found = modes.find(|(_, mode)| same(table.frequencies_hz[k], &own, mode));
            let (at, mode) = found.ok_or_else(|| Problem {
                message: format!(
                    "mode {} of the case's tables, {:.2} Hz, is none of its mesh",
                    k + 1,
                    table.frequencies_hz[k]
                ),
                remedy: "write tables of this mesh: horsehead head CASE --write".to_owned(),
            })?;
            let other = shape(&mode.radial, &mode.tangential);
            let sign = if dot(&own, &other) < 0.0 { -1.0 } else { 1.0 };
            Ok(Some((at, sign)))
        };
        let simulated = machine.run.modes.min(table.frequencies_hz.len());
        let all = (0..simulated).map(counterpart);
        Ok(Self(all.collect::<Result<_, _>>()?))
    }

    /// Returns the indices of the unit loads of the surface under which its stress is needed: those that are no modes,
    /// `statics` in number, and the driven modes.
    pub(super) fn loads(&self, statics: usize) -> Vec<u32> {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a reduction has at most hundreds of loads"
        )]
        let index = |load: usize| load as u32;
        let driven = self.0.iter().flatten().map(|(at, _)| statics + at);
        (0..statics).chain(driven).map(index).collect()
    }

    /// Returns the stress under each load of `HeadLoads::curves` from that under each of [`Self::loads`].
    fn unit_stress(&self, statics: usize, mut stress: Vec<Vec<[f32; 6]>>) -> Vec<Vec<[f32; 6]>> {
        let points = stress.first().map_or(0, Vec::len);
        let driven = stress.split_off(statics.min(stress.len()));
        let mut driven = driven.into_iter();
        stress.extend(self.0.iter().map(|own| {
            let found = own.zip(own.and_then(|_| driven.next()));
            found.map_or_else(
                || vec![[0.0; 6]; points],
                |((_, sign), mut of_mode)| {
                    for entry in of_mode.iter_mut().flatten() {
                        *entry *= sign;
                    }
                    of_mode
                },
            )
        }));
        stress
    }
}

/// Surface of the head that is assessed.
pub(super) struct Body {
    surface: HeadSurface,
    /// Stress under each load of `HeadLoads::curves`.
    unit_stress: Vec<Vec<[f32; 6]>>,
    pub(super) pins: Vec<Pin>,
    /// Points that are assessed: those that are not held.
    pub(super) points: Vec<usize>,
}

impl Body {
    /// Combines the surface with the stress under the loads of `modes`, of which the first `statics` are no modes, and
    /// finds the pins in the mesh.
    pub(super) fn new(
        read: &mesh::Mesh,
        surface: HeadSurface,
        (modes, statics): (&TableModes, usize),
        stress: Vec<Vec<[f32; 6]>>,
    ) -> Self {
        let pins = ["pin_a", "pin_b"].iter().zip(["A", "B"]);
        let pins = pins.filter_map(|(group, name)| {
            let nodes = read.surfaces.get(*group)?.iter();
            let places = nodes.filter_map(|node| read.nodes_m.get(*node)).copied();
            Pin::around(name, &places.collect::<Vec<_>>())
        });
        let free = |point: &usize| !surface.held[*point];
        Self {
            unit_stress: modes.unit_stress(statics, stress),
            pins: pins.collect(),
            points: (0..surface.held.len()).filter(free).collect(),
            surface,
        }
    }

    /// Returns the surface as the assessment takes it.
    pub(super) fn fatigue(&self) -> StressedSurface<'_> {
        StressedSurface {
            normals: &self.surface.normals,
            unit_stress: &self.unit_stress,
        }
    }

    /// Returns the surface, with positions and faces.
    pub(super) const fn surface(&self) -> &HeadSurface {
        &self.surface
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
