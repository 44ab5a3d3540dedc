//! Export of a mesh with fields for `ParaView`: an unstructured grid as VTK XML, in plain text.
//!
//! Independent of the meaning of the fields.
use protocol::pumping_unit::{ElementKind, HeadMesh};
use std::io::{self, Write};

/// Returns the VTK cell type of an element, and for each VTK node its index in Gmsh's node order.
const fn cell(kind: ElementKind) -> (u8, &'static [usize]) {
    match kind {
        ElementKind::Hexahedron => (12, &[0, 1, 2, 3, 4, 5, 6, 7]),
        // Gmsh goes on from the edge 0-3 with 2-3 and 1-3, VTK with 1-3 and 2-3
        ElementKind::Tetrahedron => (24, &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8]),
    }
}

/// Named field on a mesh for export; `values[k]` belongs to node or element k.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name of the field, as listed in `ParaView`.
    pub name: String,
    /// Values of the field: the components at each node or element, all of the same number.
    pub values: Vec<Vec<f32>>,
}

impl Field {
    /// Creates a field from its name and its components at each node or element.
    pub fn new<const N: usize>(name: impl Into<String>, rows: &[[f32; N]]) -> Self {
        Self {
            name: name.into(),
            values: rows.iter().map(|row| row.to_vec()).collect(),
        }
    }
}

/// Writes a mesh with nodal and elemental fields.
///
/// # Errors
/// [`io::Error`] when the writer fails.
pub fn write(
    mut to: impl Write,
    mesh: &HeadMesh,
    at_nodes: &[Field],
    at_elements: &[Field],
) -> io::Result<()> {
    let (number, order) = cell(mesh.kind);
    let elements = mesh.elements.chunks_exact(order.len());
    let (points, cells) = (mesh.nodes_m.len(), elements.len());
    writeln!(to, "<?xml version=\"1.0\"?>")?;
    writeln!(to, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\">")?;
    writeln!(to, "<UnstructuredGrid>")?;
    writeln!(
        to,
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">"
    )?;
    fields(&mut to, "PointData", at_nodes)?;
    fields(&mut to, "CellData", at_elements)?;
    writeln!(to, "<Points>")?;
    array(&mut to, "Float64", "Points", 3, mesh.nodes_m.iter())?;
    writeln!(to, "</Points>\n<Cells>")?;
    let nodes = elements.map(|element| order.iter().map(|&place| element[place]));
    array(&mut to, "Int64", "connectivity", 1, nodes)?;
    let offsets = (1..=cells).map(|k| [order.len() * k]);
    array(&mut to, "Int64", "offsets", 1, offsets)?;
    let types = (0..cells).map(|_| [number]);
    array(&mut to, "UInt8", "types", 1, types)?;
    writeln!(to, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

fn fields(to: &mut impl Write, kind: &str, fields: &[Field]) -> io::Result<()> {
    writeln!(to, "<{kind}>")?;
    for field in fields {
        let width = field.values.first().map_or(1, Vec::len);
        array(to, "Float32", &field.name, width, field.values.iter())?;
    }
    writeln!(to, "</{kind}>")
}

fn array<R, N>(
    to: &mut impl Write,
    kind: &str,
    name: &str,
    width: usize,
    rows: impl Iterator<Item = R>,
) -> io::Result<()>
where
    R: IntoIterator<Item = N>,
    N: std::fmt::Display,
{
    let name = name
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;");
    writeln!(
        to,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"ascii\">"
    )?;
    for row in rows {
        for (k, number) in row.into_iter().enumerate() {
            write!(to, "{}{number}", if k == 0 { "" } else { " " })?;
        }
        writeln!(to)?;
    }
    writeln!(to, "</DataArray>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brick_is_written_as_a_grid_that_says_what_it_holds() {
        let nodes: Vec<[f64; 3]> = (0..8_u8).map(|k| [f64::from(k), 0.5, -1.25]).collect();
        let shape = Field::new("mode <1>", &[[0.5_f32, -1e-9, 3.0]; 8]);
        let stress = Field::new("stress", &[[1.0_f32; 6]]);
        let mut bytes = Vec::new();
        let mesh = HeadMesh {
            nodes_m: nodes,
            elements: (0..8).collect(),
            ..HeadMesh::default()
        };
        write(&mut bytes, &mesh, &[shape], &[stress]).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let array = |name: &str| {
            let found = document
                .descendants()
                .find(|n| n.attribute("Name") == Some(name));
            let found = found.unwrap();
            let words = found.text().unwrap().split_whitespace();
            let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
            (
                numbers,
                found.attribute("NumberOfComponents").unwrap().to_owned(),
            )
        };
        assert_eq!(array("Points").0.len(), 24);
        assert_eq!(
            array("connectivity").0,
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
        );
        assert_eq!(array("offsets").0, [8.0]);
        assert_eq!(array("types").0, [12.0]);
        let (shape, width) = array("mode <1>");
        assert_eq!((shape.len(), width.as_str()), (24, "3"));
        assert!(
            (shape[1] + 1e-9).abs() < 1e-15,
            "small numbers keep their digits"
        );
        assert_eq!(array("stress"), (vec![1.0; 6], "6".to_owned()));
    }

    /// Checks that each mid-edge node of a quadratic tetrahedron, given in Gmsh's order, is written between
    /// the corners that VTK expects.
    #[test]
    fn a_tetrahedron_is_written_in_the_other_order() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let middle = |[a, b]: [usize; 2]| [0, 1, 2].map(|k| 0.5 * (corners[a][k] + corners[b][k]));
        let gmsh = [[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [3, 1]];
        let vtk = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
        let mesh = HeadMesh {
            nodes_m: corners.into_iter().chain(gmsh.map(middle)).collect(),
            kind: ElementKind::Tetrahedron,
            elements: (0..10).collect(),
            ..HeadMesh::default()
        };
        let mut bytes = Vec::new();
        write(&mut bytes, &mesh, &[], &[]).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let after = |name: &str| text.split(&format!("Name=\"{name}\"")).nth(1).unwrap();
        let numbers = |name: &str| -> Vec<usize> {
            let lines = after(name).lines().skip(1);
            let words = lines.take_while(|line| !line.starts_with('<'));
            words
                .flat_map(str::split_whitespace)
                .map(|word| word.parse().unwrap())
                .collect()
        };
        let nodes = numbers("connectivity");
        for (node, ends) in nodes[4..].iter().zip(vtk) {
            assert_eq!(
                mesh.nodes_m[*node].map(f64::to_bits),
                middle(ends).map(f64::to_bits)
            );
        }
        assert_eq!((numbers("offsets"), numbers("types")), (vec![10], vec![24]));
    }
}
