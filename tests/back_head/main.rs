//! The shipped back head, reduced from its mesh, against the tables that other programs made:
//! modes by CalculiX, statics by another implementation of the same element.
use coordinator::case::mesh;
use simulation::flexible::{Family, Gauge, Mesh, Reduction, Request, Steel, Wrap, reduce};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Welded steel, as the case's documentation states it.
const STEEL: Steel = Steel {
    young: 206.0e9,
    poisson: 0.3,
    density: 7850.0,
};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb/back_head")
}

fn shipped_mesh() -> Mesh {
    let read = mesh::read(&folder().join("back_head.msh")).unwrap();
    let held = ["pin_a", "pin_b"].map(|pin| read.surfaces[pin].iter().flatten().copied());
    Mesh {
        held: held.into_iter().flatten().collect(),
        rim: read.surfaces["rope_surface"].clone(),
        hexahedra: read.volumes["steel"].clone(),
        nodes: read.nodes_m,
    }
}

fn table(name: &str) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder().join(name)).unwrap()).unwrap()
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    let list = value.as_array().unwrap().iter();
    list.map(|x| x.as_f64().unwrap()).collect()
}

fn rows(name: &str) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder().join(name)).unwrap();
    let data = text.lines().skip(1);
    data.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect()
}

fn gauges(table: &serde_json::Value) -> Vec<Gauge> {
    let gauge = |name: &str| {
        let entry = &table["gauges"][name];
        let number = |key: &str| entry[key].as_f64().unwrap();
        Gauge {
            position: [number("x_m"), number("y_m"), number("z_m")],
            length: number("length_m"),
        }
    };
    ["1", "2", "3", "4"].map(gauge).to_vec()
}

const PROBES_DEG: [f64; 6] = [125.0, 140.0, 160.0, 180.0, 200.0, 212.0];

fn reduced(modes: usize, families: &[Family]) -> Reduction {
    let table = table("back_head_modes.json");
    let radians = |deg: &[f64]| deg.iter().map(|x| x.to_radians()).collect::<Vec<_>>();
    reduce(&Request {
        mesh: &shipped_mesh(),
        steel: STEEL,
        gauges: &gauges(&table),
        center: [-0.15, -0.58],
        stations: &radians(&numbers(&table["arc_deg"])),
        probes: &radians(&PROBES_DEG),
        wrap: None,
        modes,
        families,
        fields: false,
    })
    .unwrap()
}

/// Modal assurance criterion of two vectors.
fn mac(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(a, b).powi(2) / (dot(a, a) * dot(b, b))
}

#[test]
fn look() {
    let started = std::time::Instant::now();
    let both = [Family::Symmetric, Family::Antisymmetric];
    let r = reduced(24, &both);
    println!("{:?} unknowns {} steps {}", started.elapsed(), r.unknowns, r.lanczos_steps);
    println!("{} {:?} {}", r.mass, r.center_of_mass, r.inertia);
    let t = table("back_head_modes_all.json");
    let f = numbers(&t["frequencies_hz"]);
    for (k, m) in r.modes.iter().enumerate() {
        let hz = m.frequency / std::f64::consts::TAU;
        let shape = [m.radial.clone(), m.tangential.clone()].concat();
        let theirs = [numbers(&t["radial"][k]), numbers(&t["tangential"][k])].concat();
        println!(
            "{k} {:?} {} {:.3} {:.3} {:+.2}% mac {:.4} gauge {:.5} part {:?} {:?} g {:?} {:?}",
            m.family, t["family"][k], hz, f[k], (hz / f[k] - 1.0) * 100.0,
            mac(&shape, &theirs),
            mac(&m.gauge_stress, &numbers(&t["gauge_stress_mpa"][k])),
            m.participation, numbers(&t["participation"][k]),
            m.gauge_stress.iter().map(|x| (x*1e-4).round()*1e-2).collect::<Vec<_>>(), numbers(&t["gauge_stress_mpa"][k])
        );
    }
    for k in 0..3 {
        println!("{:?} {:?}", r.inertia_stress[k], numbers(&t["inertia_stress_mpa"][k]));
    }
    let inf = rows("back_head_influence.csv");
    for g in 0..4 {
        let mut worst = [0.0_f64; 2];
        let mut most = [0.0_f64; 2];
        for (s, row) in inf.iter().enumerate() {
            for (w, (ours, theirs)) in [
                (r.normal_influence[s][g] * 1e-6, row[1 + g]),
                (r.tangential_influence[s][g] * 1e-6, row[5 + g]),
            ].into_iter().enumerate() {
                worst[w] = worst[w].max((ours - theirs).abs());
                most[w] = most[w].max(theirs.abs());
            }
        }
        println!("gauge {g}: worst {worst:?} of {most:?}");
    }
    for (ours, theirs) in r.compliance.iter().zip(rows("back_head_static_compliance.csv")) {
        println!("{ours:?} {:?}", &theirs[1..]);
    }
    let _ = Wrap { tension: 1.0, anchor: 1.0, leaves: 2.0 };
}
