//! Tests of the mesh reader with a mesh of one tetrahedron, and of the messages for invalid meshes.
use super::{
    super::body::{Mesh, SYMMETRY, VOLUME},
    reader::read,
};
use protocol::pumping_unit::ElementKind;
use std::{fmt::Write as _, fs};

/// Corners of the unit tetrahedron, then the midpoints of its edges in Gmsh's order.
const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];

/// Block of one element: dimension, entity, type, and node tags from 1.
type Block = (usize, usize, usize, &'static [usize]);

const TETRAHEDRON: Block = (3, 1, 11, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
const PIN_A: Block = (2, 1, 9, &[1, 2, 4, 5, 10, 8]);
const PIN_B: Block = (2, 2, 9, &[1, 4, 3, 8, 9, 7]);
const ROPE: Block = (2, 3, 9, &[2, 3, 4, 6, 9, 10]);
const FLOOR: Block = (2, 4, 9, &[1, 3, 2, 7, 6, 5]);

/// Reads a test mesh made of the given element blocks; `floor` is the group name of surface 4.
fn read_blocks(blocks: &[Block], nodes: &[[f64; 3]], floor: &str) -> Result<Mesh, String> {
    let mut text = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n2 1 \"pin_a\"\n2 2 \"pin_b\"\n\
         2 3 \"rope_surface\"\n2 4 \"{floor}\"\n3 1 \"steel\"\n$EndPhysicalNames\n\
         $Entities\n0 0 4 1\n"
    );
    for tag in [1, 2, 3, 4, 1] {
        writeln!(text, "{tag} 0 0 0 0 0 0 1 {tag} 0").unwrap();
    }
    let count = nodes.len();
    write!(
        text,
        "$EndEntities\n$Nodes\n1 {count} 1 {count}\n3 1 0 {count}\n"
    )
    .unwrap();
    for tag in 1..=count {
        writeln!(text, "{tag}").unwrap();
    }
    for [x, y, z] in nodes {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    write!(text, "$EndNodes\n$Elements\n{0} {0} 1 {0}\n", blocks.len()).unwrap();
    for (tag, (dimension, entity, kind, element)) in (1..).zip(blocks) {
        let words: Vec<String> = element.iter().map(ToString::to_string).collect();
        write!(
            text,
            "{dimension} {entity} {kind} 1\n{tag} {}\n",
            words.join(" ")
        )
        .unwrap();
    }
    text += "$EndElements\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.msh");
    fs::write(&path, text).unwrap();
    read(&path).map_err(|error| error.to_string())
}

#[test]
fn quadratic_tetrahedra_are_read_whole_or_as_a_half() {
    let blocks = [PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON];
    let whole = read_blocks(&blocks, &NODES, "floor").unwrap();
    assert_eq!((whole.kind, whole.half), (ElementKind::Tetrahedron, false));
    assert_eq!(whole.volumes[VOLUME], (0..10).collect::<Vec<_>>());
    assert_eq!(whole.surfaces["rope_surface"], [1, 2, 3, 5, 8, 9]);
    assert!((whole.volume_m3() - 1.0 / 6.0).abs() < 1e-15);
    let half = read_blocks(&blocks, &NODES, SYMMETRY).unwrap();
    assert!(half.half);
    assert!((half.volume_m3() - 1.0 / 3.0).abs() < 1e-15);
}

/// Checks that errors name the file, the line and a remedy.
#[test]
fn what_cannot_be_taken_is_named_with_its_line_and_a_remedy() {
    let good = [PIN_A, PIN_B, ROPE, TETRAHEDRON];
    // the first block stands on line 46, and each has two lines
    let with = |at: usize, block: Block| {
        let mut blocks = good;
        blocks[at] = block;
        read_blocks(&blocks, &NODES, "floor").unwrap_err()
    };
    let cases: [(String, &[&str]); 7] = [
        (
            with(3, (3, 1, 4, &[1, 2, 3, 4])),
            &[
                "line 52",
                "4-node tetrahedra",
                "lock",
                "help: mesh with order 2",
                "gmsh -order 2",
            ],
        ),
        (
            with(0, (2, 1, 2, &[1, 2, 4])),
            &[
                "line 46",
                "3-node triangles",
                "lock",
                "help: mesh with order 2",
            ],
        ),
        (
            with(3, (3, 1, 5, &[1, 2, 3, 4, 5, 6, 7, 8])),
            &[
                "line 52",
                "8-node hexahedra, but line 46 has 6-node triangles",
                "help: mesh all volumes alike",
            ],
        ),
        (
            with(3, (3, 1, 6, &[1, 2, 3, 4, 5, 6])),
            &[
                "line 52",
                "6-node prisms",
                "11 (10-node tetrahedron)",
                "help: ",
            ],
        ),
        (
            with(3, (3, 1, 11, &[1, 2, 3, 4, 5, 6, 7, 8, 9])),
            &["line 53", "at least 11 numbers", "help: "],
        ),
        (
            with(3, (3, 1, 11, &[2, 1, 3, 4, 5, 7, 6, 10, 9, 8])),
            &[
                "element 1 of group `steel` is inside out",
                "help: correct the node order",
            ],
        ),
        (
            with(1, (2, 4, 9, FLOOR.3)),
            &["group `pin_b` is missing", "help: name the groups"],
        ),
    ];
    for (message, expected) in cases {
        for part in ["head.msh"].iter().chain(expected) {
            assert!(message.contains(part), "{part}\n{message}");
        }
    }
}

/// Checks that nodes without an element are removed, wherever they stand, and that a face with such a node is
/// refused.
#[test]
fn nodes_without_an_element_are_left_out() {
    const MOVED: Block = (3, 1, 11, &[2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
    const MOVED_A: Block = (2, 1, 9, &[2, 3, 5, 6, 11, 9]);
    const MOVED_B: Block = (2, 2, 9, &[2, 5, 4, 9, 10, 8]);
    const MOVED_ROPE: Block = (2, 3, 9, &[3, 4, 5, 7, 10, 11]);
    let mut nodes = vec![[9.0; 3]];
    nodes.extend(NODES);
    let blocks = [MOVED_A, MOVED_B, MOVED_ROPE, MOVED];
    let own = [PIN_A, PIN_B, ROPE, TETRAHEDRON];
    assert_eq!(
        read_blocks(&blocks, &nodes, "floor"),
        read_blocks(&own, &NODES, "floor")
    );
    let hanging = [
        (2, 1, 9, &[2, 3, 1, 6, 11, 9][..]),
        MOVED_B,
        MOVED_ROPE,
        MOVED,
    ];
    let message = read_blocks(&hanging, &nodes, "floor").unwrap_err();
    for part in [
        "group `pin_a` has a node at (9.0000, 9.0000, 9.0000) m",
        "help: put only faces",
    ] {
        assert!(message.contains(part), "{part}\n{message}");
    }
}

#[test]
fn a_half_must_end_on_the_plane_and_lie_on_one_side_of_it() {
    let blocks = [PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON];
    let raised = NODES.map(|[x, y, z]| [x, y, z + 0.01]);
    let message = read_blocks(&blocks, &raised, SYMMETRY).unwrap_err();
    for part in [
        "(0.0000, 0.0000, 0.0100) m",
        "plane z = 0",
        "help: cut the body at z = 0",
    ] {
        assert!(message.contains(part), "{part}\n{message}");
    }
    // turned about x by half a turn: the floor stays, the body is below
    let below = NODES.map(|[x, y, z]| [x, -y, -z]);
    let message = read_blocks(&blocks, &below, SYMMETRY).unwrap_err();
    for part in ["lies beyond the plane z = 0", "mesh the side z >= 0 alone"] {
        assert!(message.contains(part), "{part}\n{message}");
    }
}
