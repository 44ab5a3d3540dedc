//! A mesh with fields for `ParaView`: an unstructured grid of hexahedra as VTK XML, in plain text.
//!
//! Knows the file format and nothing of what the fields mean.
use std::io::{self, Write};

/// Number of the 8-node hexahedron among VTK's cells; its order of nodes is Gmsh's.
const HEXAHEDRON: u8 = 12;

/// Values of one name; `values[k]` belongs to node or element k.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// As it is chosen in a list.
    pub name: String,
    /// One row of numbers per node or element, all of the same length.
    pub values: Vec<Vec<f32>>,
}

impl Field {
    /// A field from rows of fixed length.
    pub fn new<const N: usize>(name: impl Into<String>, rows: &[[f32; N]]) -> Self {
        Self {
            name: name.into(),
            values: rows.iter().map(|row| row.to_vec()).collect(),
        }
    }
}

/// Writes a mesh with fields at its nodes and at its elements.
///
/// # Errors
/// [`io::Error`] when the writer fails.
pub fn write(
    mut to: impl Write,
    (nodes_m, hexahedra): (&[[f64; 3]], &[[u32; 8]]),
    at_nodes: &[Field],
    at_elements: &[Field],
) -> io::Result<()> {
    let (points, cells) = (nodes_m.len(), hexahedra.len());
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
    array(&mut to, "Float64", ("Points", 3), nodes_m.iter())?;
    writeln!(to, "</Points>\n<Cells>")?;
    array(&mut to, "Int64", ("connectivity", 1), hexahedra.iter())?;
    let offsets = (1..=cells).map(|k| [8 * k]);
    array(&mut to, "Int64", ("offsets", 1), offsets)?;
    let types = hexahedra.iter().map(|_| [HEXAHEDRON]);
    array(&mut to, "UInt8", ("types", 1), types)?;
    writeln!(to, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

fn fields(to: &mut impl Write, kind: &str, fields: &[Field]) -> io::Result<()> {
    writeln!(to, "<{kind}>")?;
    for field in fields {
        let width = field.values.first().map_or(1, Vec::len);
        array(to, "Float32", (&field.name, width), field.values.iter())?;
    }
    writeln!(to, "</{kind}>")
}

fn array<R, N>(
    to: &mut impl Write,
    kind: &str,
    (name, width): (&str, usize),
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
        let mesh = (&nodes[..], &[[0, 1, 2, 3, 4, 5, 6, 7]][..]);
        write(&mut bytes, mesh, &[shape], &[stress]).unwrap();
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
}
