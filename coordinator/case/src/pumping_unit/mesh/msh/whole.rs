//! Checks of the complete mesh: all groups present, no inverted element, no node without an element, and a
//! half mesh that ends at the plane z = 0.
use super::{
    super::body::{Mesh, SURFACES, SYMMETRY, VOLUME},
    sections::Sections,
};
use crate::{
    error::{CaseError, damaged},
    table::clip,
};
use std::path::Path;

/// Returns the mesh of all sections, if it is suitable for a reduction of the head.
///
/// # Errors
/// Returns an error for a missing physical group, a group with a node that belongs to no element, an inverted
/// element, and a half mesh that does not end at the plane z = 0.
pub(super) fn validated_mesh(path: &Path, sections: Sections) -> Result<Mesh, CaseError> {
    for wanted in SURFACES {
        require(
            path,
            &sections,
            wanted,
            sections.mesh.surfaces.get(wanted).map_or(0, Vec::len),
        )?;
    }
    require(
        path,
        &sections,
        VOLUME,
        sections.mesh.volumes.get(VOLUME).map_or(0, Vec::len),
    )?;
    let mut mesh = only_used(path, sections.mesh)?;
    let tag = |at: usize| sections.body.get(at).copied().unwrap_or_default();
    for (group, elements) in &mesh.volumes {
        let inverted = |element: &[usize]| mesh.element_volume_m3(element).is_none();
        let mut elements = elements.chunks_exact(mesh.kind.nodes());
        if let Some(at) = elements.position(inverted) {
            return Err(damaged(
                path,
                format!(
                    "element {} of group `{group}` is inside out or has no volume",
                    tag(at)
                ),
                "correct the node order of the element or the position of its nodes",
            ));
        }
    }
    mesh.half = mesh.surfaces.contains_key(SYMMETRY);
    check_half(path, &mesh)?;
    Ok(mesh)
}

/// Checks that a required group of the mesh has elements.
fn require(path: &Path, sections: &Sections, wanted: &str, count: usize) -> Result<(), CaseError> {
    if count > 0 {
        return Ok(());
    }
    let found: Vec<&str> = sections.names.values().map(String::as_str).collect();
    Err(damaged(
        path,
        format!(
            "physical group `{wanted}` is missing or empty; the groups are: {}",
            clip(&found.join(", "), 200)
        ),
        "name the groups steel (volume), pin_a, pin_b and rope_surface (surfaces) in Gmsh",
    ))
}

/// Removes nodes that belong to no element, such as the centres of arcs, because nothing would constrain
/// them. The order of the other nodes is kept.
fn only_used(path: &Path, mut mesh: Mesh) -> Result<Mesh, CaseError> {
    let mut place = vec![None; mesh.nodes_m.len()];
    for node in mesh.volumes.values().flatten() {
        if let Some(place) = place.get_mut(*node) {
            *place = Some(0);
        }
    }
    for (index, place) in place.iter_mut().flatten().enumerate() {
        *place = index;
    }
    let moved = |node: &usize| place.get(*node).copied().flatten();
    for (group, faces) in &mut mesh.surfaces {
        for node in faces {
            *node = moved(node).ok_or_else(|| {
                let [x, y, z] = mesh.nodes_m.get(*node).copied().unwrap_or_default();
                damaged(
                    path,
                    format!(
                        "group `{group}` has a node at ({x:.4}, {y:.4}, {z:.4}) m that no element of the \
                         body has"
                    ),
                    "put only faces of the meshed body into the group",
                )
            })?;
        }
    }
    for node in mesh.volumes.values_mut().flatten() {
        *node = moved(node).unwrap_or_default();
    }
    let nodes = mesh.nodes_m.iter().zip(&place);
    mesh.nodes_m = nodes.filter_map(|(at, place)| place.map(|_| *at)).collect();
    Ok(mesh)
}

/// Checks that the cut face of a half mesh lies in the plane z = 0 and that no node is beyond it.
fn check_half(path: &Path, mesh: &Mesh) -> Result<(), CaseError> {
    const NEAR_M: f64 = 1e-6;
    let wrong = |[x, y, z]: &[f64; 3], problem: &str| {
        Err(damaged(
            path,
            format!("the node at ({x:.4}, {y:.4}, {z:.4}) m {problem}"),
            "cut the body at z = 0, mesh the side z >= 0 alone, and name the cut face symmetry",
        ))
    };
    let cut = mesh.surfaces.get(SYMMETRY);
    let mut cut = cut
        .into_iter()
        .flatten()
        .filter_map(|&node| mesh.nodes_m.get(node));
    if let Some(node) = cut.find(|[_, _, z]| z.abs() > NEAR_M) {
        return wrong(
            node,
            "belongs to group `symmetry`, which must lie in the plane z = 0",
        );
    }
    let beyond = mesh.nodes_m.iter().find(|[_, _, z]| *z < -NEAR_M);
    match beyond {
        Some(node) if mesh.half => wrong(
            node,
            "lies beyond the plane z = 0: a mesh with a group `symmetry` is the half z >= 0",
        ),
        _ => Ok(()),
    }
}
