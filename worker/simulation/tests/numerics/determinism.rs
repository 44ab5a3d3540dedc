//! The same bits whatever the processor, the optimisation, the number of threads.
//!
//! `tests/determinism.sh` builds this test for several instruction sets and optimisation levels; each
//! build must reproduce the digest below.
use simulation::reference;
use std::process::Command;

/// Digest and work of the reference run, on every machine and in every build. A change of the laws,
/// of a tolerance or of the order of a sum changes it: copy the new one from the message, and say in
/// the changelog why results change.
const REFERENCE: &str = "digest e33cb423842ffb0d Statistics { steps: 694, error_rejections: 0, \
    newton_rejections: 20, newton_iterations: 7633, force_evaluations: 7652, jacobians: 490, \
    factorizations: 490 }";

/// Digest of the reference run's bits and work: FNV-1a, to be compared as text.
fn digest() -> String {
    let (bits, statistics) = reference::bits();
    let hash = bits
        .iter()
        .flat_map(|b| b.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    format!("digest {hash:016x} {statistics:?}")
}

#[test]
fn every_build_reproduces_the_reference_run() {
    assert_eq!(digest(), REFERENCE);
}

/// Runs side by side share nothing.
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

/// Run by the test below in a process of its own.
#[test]
#[ignore = "prints for the test below"]
fn child_prints_its_digest() {
    println!("{}", digest());
    // how the C library's own functions fare: they may well differ
    let sines = (0..10_000).map(|i| (0.37 * f64::from(i)).sin().to_bits());
    println!(
        "libc {:016x}",
        sines.fold(0_u64, |fold, bits| fold.rotate_left(5) ^ bits)
    );
}

/// glibc told that the processor has neither AVX2 nor FMA takes other variants of sine and power,
/// which differ in the last bit; a worker on an older node must still return the same result.
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
        (line("digest"), line("libc"))
    };
    let (plain, libc) = run(None);
    let (masked, masked_libc) = run(Some("glibc.cpu.hwcaps=-AVX2,-FMA"));
    eprintln!(
        "{plain}; the C library's sines differ: {}",
        libc != masked_libc
    );
    assert_eq!(plain, masked);
    assert_eq!(plain, digest());
}
