//! Results are bit-identical for every processor, optimisation level and number of threads.
//!
//! `tests/determinism.sh` builds this test for several instruction sets and optimisation levels; each build
//! must reproduce the digests below.
use simulation::flexible::{
    Family, Gauge, Mesh, Pair, Reduction, ReductionRequest, Steel, SurfaceLoads, Wrap, reduce,
};
use simulation::reference;
use std::process::Command;

/// Digest and work counters of the reference run, the same on every machine and in every build. A change of
/// the laws, of a tolerance or of the order of a summation changes this text: copy the new one from the
/// test's message, and state in the changelog why results change.
const REFERENCE: &str = "digest 348b85ae4dd6ba0a Statistics { steps: 694, error_rejections: 0, \
    newton_rejections: 20, newton_iterations: 7633, force_evaluations: 7652, jacobians: 490, \
    factorizations: 490 }";

/// Digest of the reference run's derivatives; to be updated like `REFERENCE`.
const COLUMNS: &str = "columns d03496e61266161d";

/// Digest of the modal reduction of a small head; to be updated like `REFERENCE`.
const HEAD: &str = "head 79d06d85a2c73f50";

fn hash(bits: impl IntoIterator<Item = u64>) -> u64 {
    let bytes = bits.into_iter().flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Returns the digest of the reference run's bits and its work counters, as text.
fn digest() -> String {
    let (bits, statistics) = reference::bits();
    format!("digest {:016x} {statistics:?}", hash(bits))
}

/// Returns the digest of the reference run's derivatives, as text.
fn columns() -> String {
    format!("columns {:016x}", hash(reference::columns()))
}

/// Builds the mesh of a small back head: a sector of a ring of bricks, held at one end. It has hundreds of
/// unknowns, so that panels of the matrix factor are wider than its tiles.
fn sector() -> Mesh {
    const COUNTS: [usize; 3] = [3, 14, 4];
    let [across, around, wide] = COUNTS;
    let node = |i: usize, j: usize, k: usize| (k * (around + 1) + j) * (across + 1) + i;
    let mut mesh = Mesh::default();
    for k in 0..=wide {
        for j in 0..=around {
            for i in 0..=across {
                // a point of the circle without any function of the C library: 118 to 242 deg
                let t = 1.2 * (j as f64 / around as f64) - 0.6;
                let (x, y) = ((t * t - 1.0) / (1.0 + t * t), -2.0 * t / (1.0 + t * t));
                let radius = 1.5 + 0.4 * i as f64 / across as f64;
                let z = 0.3 * (k as f64 / wide as f64 - 0.5);
                mesh.nodes.push([radius * x, radius * y, z]);
                if j == 0 {
                    mesh.held.push(node(i, j, k));
                }
            }
        }
    }
    for k in 0..wide {
        for j in 0..around {
            for i in 0..across {
                for k in [k, k + 1] {
                    let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                    mesh.elements.extend(corners.map(|(i, j)| node(i, j, k)));
                }
            }
            let corners = [(j, k), (j + 1, k), (j + 1, k + 1), (j, k + 1)];
            mesh.rope_faces
                .extend(corners.map(|(j, k)| node(across, j, k)));
        }
    }
    mesh
}

fn reduced() -> Reduction {
    let gauge = |z: f64| Gauge {
        position: [-1.7, 0.1, z],
        direction: [0.0, 1.0, 0.0],
        length: 0.02,
    };
    reduce(&ReductionRequest {
        mesh: &sector(),
        steel: Steel {
            young: 206.0e9,
            poisson: 0.3,
            density: 7850.0,
        },
        gauges: &[gauge(0.15), gauge(-0.15)],
        center: [0.0, 0.0],
        stations: &[2.2, 2.8, 3.4, 4.0],
        probes: &[2.5, 3.5],
        wrap: Some(Wrap {
            tension: 1e5,
            anchor: 2.2,
            leaves: 3.6,
        }),
        pair: Some(Pair {
            offset: 0.1,
            modes: 2,
        }),
        modes: 6,
        families: &[Family::Symmetric, Family::Antisymmetric],
        patterns: &[],
        surface: Some(SurfaceLoads {
            breaks: &[2.2, 2.8, 3.4],
            returned: &[0, 1, 2, 3, 4, 5, 6, 7],
        }),
        fields: true,
    })
    .unwrap()
}

/// Returns the digest of every number of the head's reduction, as text.
fn head() -> String {
    let reduction = reduced();
    let mut numbers = Vec::new();
    for mode in &reduction.modes {
        numbers.push(mode.frequency);
        numbers.extend(mode.radial.iter().chain(&mode.tangential));
        numbers.extend(mode.gauge_stress.iter().chain(&mode.participation));
    }
    let sway = reduction.sway.unwrap();
    numbers.extend(&sway.frequencies);
    for rows in [
        &reduction.normal_influence,
        &reduction.tangential_influence,
        &reduction.compliance,
        &reduction.inertia_stress.to_vec(),
        &sway.radial,
        &sway.lateral,
        &sway.lateral_influence,
    ] {
        numbers.extend(rows.iter().flatten());
    }
    numbers.extend(reduction.wrap_field.iter().flatten());
    numbers.extend(reduction.wrap_stress.iter().flatten());
    let surface = reduction.surface.unwrap();
    numbers.extend(surface.stress.iter().flatten().flatten());
    assert!(numbers.iter().all(|x| x.is_finite()));
    format!("head {:016x}", hash(numbers.iter().map(|x| x.to_bits())))
}

/// Checks that every build reproduces the head's reduction. The matrix factorisation behind it uses plain
/// loops, because a library that selects instructions by processor gave different bits on each kind of
/// processor.
#[test]
fn every_build_reproduces_the_reduction_of_a_head() {
    assert_eq!(head(), HEAD);
}

#[test]
fn every_build_reproduces_the_reference_run() {
    assert_eq!(digest(), REFERENCE);
}

#[test]
fn every_build_reproduces_the_columns() {
    assert_eq!(columns(), COLUMNS);
}

/// Checks that simultaneous runs in several threads give the same bits as a single one.
#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let alone = digest();
    for threads in [2, 5] {
        let digests: Vec<String> = std::thread::scope(|scope| {
            let runs: Vec<_> = (0..threads).map(|_| scope.spawn(digest)).collect();
            runs.into_iter().map(|run| run.join().unwrap()).collect()
        });
        assert!(digests.iter().all(|digest| *digest == alone));
    }
}

/// Prints the digests of this process; started in a process of its own by
/// `bits_do_not_depend_on_fused_operations`.
#[test]
#[ignore = "prints for the test below"]
fn child_prints_its_digest() {
    println!("{}", digest());
    println!("{}", head());
    println!("{}", columns());
    // how the C library's own functions fare: they may well differ
    let sines = (0..10_000).map(|i| (0.37 * f64::from(i)).sin().to_bits());
    println!(
        "libc {:016x}",
        sines.fold(0_u64, |fold, bits| fold.rotate_left(5) ^ bits)
    );
}

/// Checks that results do not depend on fused multiply-add. When glibc is told that the processor has neither
/// AVX2 nor FMA, it selects other variants of sine and power that differ in the last bit; a worker on an
/// older node must still return the same result.
#[test]
fn bits_do_not_depend_on_fused_operations() {
    let run = |tunables: Option<&str>| {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args([
            "--ignored",
            "--exact",
            "--nocapture",
            "determinism::child_prints_its_digest",
        ]);
        if let Some(tunables) = tunables {
            command.env("GLIBC_TUNABLES", tunables);
        }
        let output = command.output().unwrap();
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        let line = |name: &str| {
            text.lines()
                .find(|line| line.starts_with(name))
                .unwrap()
                .to_owned()
        };
        (
            line("digest") + &line("head") + &line("columns"),
            line("libc"),
        )
    };
    let (plain, libc) = run(None);
    let (masked, masked_libc) = run(Some("glibc.cpu.hwcaps=-AVX2,-FMA"));
    eprintln!(
        "{plain}; the C library's sines differ: {}",
        libc != masked_libc
    );
    assert_eq!(plain, masked);
    assert_eq!(plain, digest() + &head() + &columns());
}
