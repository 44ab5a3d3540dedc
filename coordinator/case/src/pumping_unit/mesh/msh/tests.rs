//! Tests of the mesh reader with a mesh of one tetrahedron, and of the messages for invalid meshes.
use super::{
    super::body::{Mesh, SYMMETRY, VOLUME},
    reader::read_hashed,
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

/// Names of the physical groups of every test mesh; `floor` is that of surface 4.
fn names(floor: &str) -> String {
    format!(
        "$PhysicalNames\n5\n2 1 \"pin_a\"\n2 2 \"pin_b\"\n2 3 \"rope_surface\"\n2 4 \"{floor}\"\n3 1 \"steel\"\n\
         $EndPhysicalNames\n"
    )
}

/// Reads a mesh file with the given text, whose unit is `unit_m` metres.
fn read_text(text: &str, unit_m: f64) -> Result<Mesh, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("head.msh");
    fs::write(&path, text).unwrap();
    let read = read_hashed(&path, unit_m).map(|(mesh, _)| mesh);
    read.map_err(|error| error.to_string())
}

/// Reads a test mesh in the format MSH 2.2.
fn read_flat(blocks: &[Block], nodes: &[[f64; 3]], unit_m: f64) -> Result<Mesh, String> {
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{}$Nodes\n{}\n",
        names("floor"),
        nodes.len()
    );
    for (tag, [x, y, z]) in (1..).zip(nodes) {
        writeln!(text, "{tag} {x} {y} {z}").unwrap();
    }
    // points and lines of the geometry, which carry nothing
    let count = blocks.len() + 2;
    write!(
        text,
        "$EndNodes\n$Elements\n{count}\n1 15 2 0 1 1\n2 1 2 0 1 1 2\n"
    )
    .unwrap();
    for (tag, (_, entity, kind, element)) in (3..).zip(blocks) {
        let words: Vec<String> = element.iter().map(ToString::to_string).collect();
        writeln!(text, "{tag} {kind} 2 {entity} 7 {}", words.join(" ")).unwrap();
    }
    text += "$EndElements\n";
    read_text(&text, unit_m)
}

/// Reads a test mesh made of the given element blocks; `floor` is the group name of surface 4.
fn read_blocks(blocks: &[Block], nodes: &[[f64; 3]], floor: &str) -> Result<Mesh, String> {
    let mut text = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{}$Entities\n0 0 4 1\n",
        names(floor)
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
    read_text(&text, 1.0)
}

#[test]
fn both_versions_of_the_format_give_the_same_mesh() {
    let blocks = [PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON];
    let flat = read_flat(&blocks, &NODES, 1.0).unwrap();
    assert_eq!(Ok(flat), read_blocks(&blocks, &NODES, "floor"));
}

#[test]
fn a_mesh_in_millimetres_is_converted_by_the_stated_unit() {
    let blocks = [PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON];
    let millimetres = NODES.map(|node| node.map(|x| 1e3 * x));
    let mesh = read_flat(&blocks, &millimetres, 1e-3).unwrap();
    assert_eq!(mesh.nodes_m, NODES);
    let message = read_flat(&blocks, &millimetres, 1.0).unwrap_err();
    for part in [
        "line 15",
        "a position outside -100 to 100 m",
        "help: state the unit: flexible_head.mesh_unit_m = 0.001",
    ] {
        assert!(message.contains(part), "{part}\n{message}");
    }
}

/// Corners of the unit cube, then the midpoints of its edges in Gmsh's order of a 20-node brick.
const CUBE: [[f64; 3]; 20] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [1.0, 0.5, 0.0],
    [1.0, 0.0, 0.5],
    [0.5, 1.0, 0.0],
    [1.0, 1.0, 0.5],
    [0.0, 1.0, 0.5],
    [0.5, 0.0, 1.0],
    [0.0, 0.5, 1.0],
    [1.0, 0.5, 1.0],
    [0.5, 1.0, 1.0],
];

const BRICK: Block = (
    3,
    1,
    17,
    &[
        1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
    ],
);
const LEFT: Block = (2, 1, 16, &[1, 4, 8, 5, 10, 16, 18, 11]);
const RIGHT: Block = (2, 2, 16, &[2, 3, 7, 6, 12, 15, 19, 13]);
const TOP: Block = (2, 3, 16, &[4, 3, 7, 8, 14, 15, 20, 16]);

/// Checks that a second-order brick is read by its corners, with the distance of its mid-edge nodes from the
/// straight edges; as it is in both versions of the format.
#[test]
fn second_order_bricks_are_read_by_their_corners() {
    let mut nodes = CUBE;
    let blocks = [LEFT, RIGHT, TOP, BRICK];
    for read in [
        read_flat(&blocks, &nodes, 1.0).unwrap(),
        read_blocks(&blocks, &nodes, "floor").unwrap(),
    ] {
        assert_eq!(read.kind, ElementKind::Hexahedron);
        assert_eq!(read.nodes_m, nodes[..8]);
        assert_eq!(read.volumes[VOLUME], (0..8).collect::<Vec<_>>());
        assert_eq!(read.surfaces["rope_surface"], [3, 2, 6, 7]);
        assert!((read.volume_m3() - 1.0).abs() < 1e-15);
        assert_eq!(read.straightened_m, Some(0.0));
    }
    nodes[18][0] += 0.03;
    let bent = read_flat(&blocks, &nodes, 1.0).unwrap();
    assert!((bent.straightened_m.unwrap() - 0.03).abs() < 1e-15);
    let first_order = read_flat(&[PIN_A, PIN_B, ROPE, TETRAHEDRON], &NODES, 1.0).unwrap();
    assert_eq!(first_order.straightened_m, None);
}

/// Checks that a body in a second group is read once, that elements outside the body or defined twice are refused, as are
/// nodes in another order, and that the sign of a physical tag is its orientation alone.
#[test]
fn every_volume_element_belongs_to_the_body_once() {
    let blocks = [PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON];
    // entity 2 of the flat format is the group `all`
    let both: Block = (3, 9, 11, TETRAHEDRON.3);
    let whole = read_flat(&blocks, &NODES, 1.0).unwrap();
    let twice = read_flat(&[PIN_A, PIN_B, ROPE, FLOOR, TETRAHEDRON, both], &NODES, 1.0);
    assert_eq!(twice.unwrap(), whole);
    let negative = PIN_A.3;
    let text_of = |tag: i64| {
        let mut text = format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{}$Nodes\n10\n",
            names("floor")
        );
        for (at, [x, y, z]) in (1..).zip(NODES) {
            writeln!(text, "{at} {x} {y} {z}").unwrap();
        }
        text += "$EndNodes\n$Elements\n4\n";
        let words = |nodes: &[usize]| {
            let words: Vec<String> = nodes.iter().map(ToString::to_string).collect();
            words.join(" ")
        };
        writeln!(text, "1 9 2 {tag} 7 {}", words(negative)).unwrap();
        writeln!(text, "2 9 2 2 7 {}", words(PIN_B.3)).unwrap();
        writeln!(text, "3 9 2 3 7 {}", words(ROPE.3)).unwrap();
        writeln!(text, "4 11 2 1 7 {}", words(TETRAHEDRON.3)).unwrap();
        text + "$EndElements\n"
    };
    assert_eq!(read_text(&text_of(-1), 1.0), read_text(&text_of(1), 1.0));
    let message = read_flat(&[PIN_A, PIN_B, ROPE, TETRAHEDRON, TETRAHEDRON], &NODES, 1.0);
    let message = message.unwrap_err();
    assert!(
        message.contains("line 32: an element of group `steel` is defined twice"),
        "{message}"
    );
    let mut nodes = NODES.to_vec();
    nodes.push([-1.0, 0.0, 0.0]);
    nodes.extend([[-0.5, 0.5, 0.0], [-0.5, 0.0, 0.0], [-0.5, 0.0, 0.5]]);
    let loose: Block = (3, 9, 11, &[1, 3, 11, 4, 7, 12, 13, 8, 14, 9]);
    let message = read_flat(&[PIN_A, PIN_B, ROPE, TETRAHEDRON, loose], &nodes, 1.0).unwrap_err();
    for part in [
        "1 volume elements of the block",
        "do not belong to group `steel`",
        "help: put all volumes",
    ] {
        assert!(message.contains(part), "{part}\n{message}");
    }
    // the order of Abaqus and VTK, which has the upper edges before the vertical ones
    let vtk: Block = (
        3,
        1,
        17,
        &[
            1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 14, 10, 17, 19, 20, 18, 11, 13, 15, 16,
        ],
    );
    let message = read_flat(&[LEFT, RIGHT, TOP, vtk], &CUBE, 1.0).unwrap_err();
    assert!(
        message.contains("the nodes are not in Gmsh's order"),
        "{message}"
    );
}

/// Checks that prisms beside bricks, triangles on them and files that end in an element are refused with line and
/// remedy.
#[test]
fn what_does_not_fit_beside_bricks_is_refused() {
    let prism: Block = (
        3,
        1,
        18,
        &[1, 2, 3, 5, 6, 7, 9, 10, 11, 12, 13, 15, 17, 18, 19],
    );
    let triangle: Block = (2, 3, 9, &[4, 3, 7, 14, 15, 20]);
    let cut: Block = (3, 1, 17, &[1, 2, 3, 4, 5, 6, 7, 8]);
    let cases: [(&[Block], &[&str]); 3] = [
        (
            &[LEFT, RIGHT, TOP, BRICK, prism],
            &[
                "line 43",
                "15-node prisms",
                "prisms lock beside hexahedra",
                "help: mesh all volumes",
            ],
        ),
        (
            &[LEFT, RIGHT, triangle, BRICK],
            &[
                "line 41: 6-node triangles, but line 42 has 20-node hexahedra",
                "help: mesh all",
            ],
        ),
        (
            &[LEFT, RIGHT, TOP, cut],
            &["line 42", "20 nodes are expected here", "help: "],
        ),
    ];
    for (blocks, expected) in cases {
        let message = read_flat(blocks, &CUBE, 1.0).unwrap_err();
        for part in ["head.msh"].iter().chain(expected) {
            assert!(message.contains(part), "{part}\n{message}");
        }
    }
    let message = read_text("$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", 1.0).unwrap_err();
    assert!(message.contains("`4.1 0 8` or `2.2 0 8`"), "{message}");
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
                "line 46",
                "6-node triangles, but line 52 has 8-node hexahedra",
                "help: mesh all volumes with bricks",
            ],
        ),
        (
            with(3, (3, 1, 6, &[1, 2, 3, 4, 5, 6])),
            &[
                "line 52",
                "6-node prisms",
                "10-node tetrahedra (type 11)",
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
                "element 4 of group `steel` is inside out",
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
