//! Tests for every element kind: symmetric and antisymmetric half models against the whole body, influence
//! tables against directly applied loads, and rejected inputs.
use super::*;

/// Gauge with a vertical grid on the side z < 0.
const VERTICAL: Gauge = Gauge {
    position: [-0.7, 0.12, -0.1],
    direction: [0.0, 1.0, 0.0],
    length: 0.02,
};

/// Gauge whose inclined grid crosses the plane z = 0.
const OBLIQUE: Gauge = Gauge {
    position: [-0.6, 0.1, -0.004],
    direction: [0.48, 0.6, 0.64],
    length: 0.03,
};

/// Returns the reading of a gauge for a displacement field of the whole body.
fn reading(row: &[gauge::Term], field: &[[f64; 3]]) -> f64 {
    let products = row.iter().map(|term| {
        let pairs = term.factors.iter().zip(&field[term.node]);
        pairs.map(|(factor, u)| factor * u).sum::<f64>()
    });
    products.sum()
}

/// Returns the same body as a mesh of bricks and as a mesh of tetrahedra.
fn of_every_kind() -> [Mesh; 2] {
    let bricks = mirrored();
    let tetrahedra = tetrahedra::of_bricks(&bricks);
    [bricks, tetrahedra]
}

/// Checks that the modes of the symmetric and of the antisymmetric half model, taken together, are the modes
/// of the whole body.
#[test]
fn both_families_are_the_whole() {
    for mesh in of_every_kind() {
        families_are_the_whole(&mesh);
    }
}

fn families_are_the_whole(mesh: &Mesh) {
    let both = [Family::Symmetric, Family::Antisymmetric];
    let reduction = reduce(&request(mesh, &[], &both)).unwrap();
    let (unknowns, assembly) = problem(mesh);
    let factor = Factor::new(&assembly.stiffness).unwrap();
    let whole = lowest(&assembly, &factor, 8).unwrap();
    let families: Vec<Family> = reduction.modes.iter().map(|mode| mode.family).collect();
    assert!(both.iter().all(|family| families.contains(family)));
    for ((mode, value), shape) in reduction
        .modes
        .iter()
        .zip(&whole.eigenvalues)
        .zip(&whole.shapes)
    {
        assert!((mode.frequency.powi(2) / value - 1.0).abs() < 1e-8);
        let overlap = dot(&unknowns.gather(&mode.field), &assembly.mass.times(shape));
        assert!((overlap.abs() - 1.0).abs() < 1e-6, "{overlap}");
    }
    let volume = assembly_volume(mesh);
    assert!((reduction.mass / (volume * STEEL.density) - 1.0).abs() < 1e-12);
}

/// Checks that a mesh given as its half yields the same reduction as the whole mesh.
#[test]
fn a_half_is_as_good_as_the_whole() {
    for whole in of_every_kind() {
        let half = mesh::Half::new(&whole).unwrap().mesh;
        assert!(half.half && half.nodes.len() < whole.nodes.len());
        let gauges = [VERTICAL, OBLIQUE];
        let families = [Family::Symmetric, Family::Antisymmetric];
        let stations = [std::f64::consts::PI - 1.2];
        let [of_whole, of_half] = [&whole, &half].map(|mesh| {
            let mut asked = request(mesh, &gauges, &families);
            asked.stations = &stations;
            asked.probes = &stations;
            asked.pair = Some(Pair {
                offset: 0.06,
                modes: 3,
            });
            asked.fields = false;
            reduce(&asked).unwrap()
        });
        assert_eq!(of_whole, of_half);
    }
}

/// Checks that the reading from a gauge's influence line equals the stress computed from the displacement
/// under the same load.
#[test]
fn influence_lines_are_the_stress_under_each_load() {
    for mesh in of_every_kind() {
        for gauge in [VERTICAL, OBLIQUE] {
            influence_is_stress(&mesh, gauge);
        }
    }
}

fn influence_is_stress(mesh: &Mesh, gauge: Gauge) {
    let psi = std::f64::consts::PI - 1.2;
    let mut whole = request(mesh, std::slice::from_ref(&gauge), &[Family::Symmetric]);
    let stations = [psi];
    whole.stations = &stations;
    let reduction = reduce(&whole).unwrap();

    let (unknowns, assembly) = problem(mesh);
    let factor = Factor::new(&assembly.stiffness).unwrap();
    let station = arc::Rim::new(mesh, [0.0; 2]).station(psi).unwrap();
    let row = gauge.row(mesh, STEEL.young, 1).unwrap();
    for (direction, size, line) in [
        (station.radial, -1.0, &reduction.normal_influence),
        (station.tangential, 1.0, &reduction.tangential_influence),
    ] {
        let mut force = vec![[0.0; 3]; mesh.nodes.len()];
        station.add_force(&mut force, direction, size);
        let mut answer = unknowns.gather(&force);
        factor.solve(&mut answer);
        let field = unknowns.spread(&answer);
        let direct: f64 = reading(&row, &field);
        assert!(
            direct.abs() > 0.1 && (line[0][0] / direct - 1.0).abs() < 1e-9,
            "{direct}"
        );
    }
}

/// Checks that stress and gradient of a gauge under the wrapped rope are those of the displacement field that is
/// returned with them; also at a gauge whose one side is outside the body.
#[test]
fn a_moved_gauge_reads_what_the_gradient_says() {
    const STEP: f64 = 0.01;
    for mesh in of_every_kind() {
        let surface = Gauge {
            position: [-0.7, 0.12, -0.266],
            ..VERTICAL
        };
        let gauges = [VERTICAL, OBLIQUE, surface];
        let mut asked = request(&mesh, &gauges, &[Family::Symmetric]);
        let half_turn = std::f64::consts::PI;
        asked.wrap = Some(Wrap {
            tension: 1e4,
            anchor: half_turn - 1.15,
            leaves: half_turn - 0.6,
        });
        let reduction = reduce(&asked).unwrap();
        for (g, gauge) in gauges.iter().enumerate() {
            let at = |axis: usize, by: f64| {
                let mut there = *gauge;
                there.position[axis] += by;
                let row = there.row(&mesh, STEEL.young, 1).ok()?;
                Some(reading(&row, &reduction.wrap_field))
            };
            let here = at(0, 0.0).unwrap();
            assert!((reduction.wrap_reading[g] / here - 1.0).abs() < 1e-9);
            for axis in 0..3 {
                let step = 0.5 * gauge.length;
                let (low, high) = (at(axis, -step), at(axis, step));
                let width = f64::from(u8::from(low.is_some()) + u8::from(high.is_some())) * step;
                let slope = (high.unwrap_or(here) - low.unwrap_or(here)) / width;
                let ours = reduction.wrap_gradient[g][axis].unwrap();
                assert!(
                    (ours - slope).abs() < 1e-6 * here.abs() / STEP,
                    "{ours} {slope}"
                );
            }
        }
        let [.., z] = reduction.wrap_gradient[2];
        assert!(z.is_some(), "one side is inside");
    }
}

/// Checks the tables of a pair of ropes against direct solutions on the whole body: a pair of opposite forces
/// in the plane of motion and a pair of equal forces along z. Also checks that the shapes are those of the
/// whole body's modes at the points where the ropes lie.
#[test]
fn a_pair_of_ropes_strains_the_whole_as_its_tables_say() {
    for mesh in of_every_kind() {
        pair_strains_the_whole(&mesh);
    }
}

fn pair_strains_the_whole(mesh: &Mesh) {
    let right = Gauge {
        position: [-0.6, 0.1, 0.05],
        ..VERTICAL
    };
    let gauges = [VERTICAL, right, OBLIQUE];
    let psi = std::f64::consts::PI - 1.2;
    let stations = [psi];
    let offset = 0.06;
    let mut asked = request(mesh, &gauges, &[Family::Antisymmetric]);
    asked.stations = &stations;
    asked.pair = Some(Pair { offset, modes: 3 });
    let reduction = reduce(&asked).unwrap();
    let sway = reduction.sway.unwrap();

    let (unknowns, assembly) = problem(mesh);
    let factor = Factor::new(&assembly.stiffness).unwrap();
    let rim = arc::Rim::new(mesh, [0.0; 2]);
    let [here, there] = [offset, -offset].map(|z| rim.station_beside(psi, z).unwrap());
    let along = |[x, y]: [f64; 2]| [x, y, 0.0];
    for (direction, image, line) in [
        (along(here.radial).map(|x| -x), -1.0, &sway.normal_influence),
        (along(here.tangential), -1.0, &sway.tangential_influence),
        ([0.0, 0.0, 1.0], 1.0, &sway.lateral_influence),
    ] {
        let mut force = vec![[0.0; 3]; mesh.nodes.len()];
        for (station, size) in [(&here, 1.0), (&there, image)] {
            for &(node, weight) in &station.weights {
                for (force, direction) in force[node].iter_mut().zip(direction) {
                    *force += size * weight * direction;
                }
            }
        }
        let mut answer = unknowns.gather(&force);
        factor.solve(&mut answer);
        let field = unknowns.spread(&answer);
        for (g, gauge) in gauges.iter().enumerate() {
            let row = gauge.row(mesh, STEEL.young, g + 1).unwrap();
            let direct: f64 = reading(&row, &field);
            assert!(
                direct.abs() > 0.05 && (line[0][g] / direct - 1.0).abs() < 1e-8,
                "{direct} {}",
                line[0][g]
            );
        }
    }
    for (k, mode) in reduction.modes.iter().take(3).enumerate() {
        assert!((sway.frequencies[k] / mode.frequency - 1.0).abs() < 1e-12);
        let stresses = sway.gauge_stress[k].iter().zip(&mode.gauge_stress);
        for (pair, single) in stresses {
            assert!((pair / single - 1.0).abs() < 1e-9, "{pair} {single}");
        }
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
        close(sway.radial[k][0], here.mean(&mode.field, here.radial));
        close(sway.radial[k][0], -there.mean(&mode.field, here.radial));
        close(
            sway.tangential[k][0],
            here.mean(&mode.field, here.tangential),
        );
        close(sway.lateral[k][0], here.mean_along_z(&mode.field));
        close(sway.lateral[k][0], there.mean_along_z(&mode.field));
    }
    asked.pair = Some(Pair {
        offset: 0.3,
        modes: 1,
    });
    assert!(matches!(
        reduce(&asked),
        Err(ReductionError::OutsideRim { .. })
    ));
}

#[test]
fn what_cannot_be_reduced_says_why() {
    let families = [Family::Symmetric];
    let error = |mesh: &Mesh, gauges: &[Gauge], stations: &[f64]| {
        let mut request = request(mesh, gauges, &families);
        request.stations = stations;
        reduce(&request).unwrap_err()
    };
    let mut lopsided = mirrored();
    lopsided.nodes[0][0] += 0.01;
    assert!(matches!(
        error(&lopsided, &[], &[]),
        ReductionError::NotMirrored { .. }
    ));
    let mut crushed = mirrored();
    for element in crushed.elements.chunks_exact_mut(8) {
        element.swap(0, 4);
    }
    assert!(matches!(
        error(&crushed, &[], &[]),
        ReductionError::InvertedElement { element: 0 }
    ));
    let mut loose = mirrored();
    loose.held.truncate(1);
    assert_eq!(error(&loose, &[], &[]), ReductionError::NotPositiveDefinite);
    assert!(matches!(
        error(&mirrored(), &[], &[0.1]),
        ReductionError::Station { .. }
    ));
    let beside = Gauge {
        position: [-0.7, 0.12, 0.5],
        direction: [0.0, 1.0, 0.0],
        length: 0.02,
    };
    assert!(matches!(
        error(&mirrored(), &[beside], &[]),
        ReductionError::Gauge { gauge: 1, .. }
    ));
    let mut empty = mirrored();
    empty.rope_faces.clear();
    assert!(matches!(
        error(&empty, &[], &[]),
        ReductionError::Mesh { .. }
    ));
    let mut torn = mirrored();
    torn.elements.pop();
    assert!(matches!(
        error(&torn, &[], &[]),
        ReductionError::Mesh { .. }
    ));
    let mut no_half = mirrored();
    no_half.half = true;
    assert!(matches!(
        error(&no_half, &[], &[]),
        ReductionError::Mesh { .. }
    ));
    let tiny = bricks([1, 1, 2], [1.0; 3], [-2.0, 0.1, -0.5], |x| x);
    let mut many = request(&tiny, &[], &families);
    many.modes = 100;
    assert!(matches!(
        reduce(&many),
        Err(ReductionError::Modes { wanted: 100, .. })
    ));
}
