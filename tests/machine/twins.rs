//! Tests of twin ropes on the shipped pumping unit, with the influence tables of the back head for a rope
//! pair that are shipped with the case.
use crate::{folder, individuals};
use protocol::pumping_unit::PumpingUnit;
use simulation::model::description::RopeLaw;
use simulation::observe::{Curves, Recorder};
use simulation::run::{RunResult, simulate};
use simulation::verdict::Verdict;
use std::{fs, os::unix::fs::symlink};

/// Returns the shipped case with twin ropes at `z = +-0.12 m`, of which those at -z are longer by the given
/// lengths \[mm\].
fn twins(back_mm: f64, front_mm: f64) -> PumpingUnit {
    let scratch = tempfile::tempdir().unwrap();
    for name in ["back_head", "measured"] {
        symlink(folder().join(name), scratch.path().join(name)).unwrap();
    }
    let text = fs::read_to_string(folder().join("case.toml")).unwrap();
    let entry = format!(
        "\n[twin_ropes]\noffset_m = 0.12\nback_length_difference_m = {:?}\n\
         front_length_difference_m = {:?}\nhead_file = \"back_head/back_head_twin.json\"\n",
        1e-3 * back_mm,
        1e-3 * front_mm
    );
    fs::write(scratch.path().join("case.toml"), text + &entry).unwrap();
    let case = case::load(scratch.path(), &case::Overrides::default()).unwrap();
    PumpingUnit::of(case).unwrap()
}

fn simulated(unit: &PumpingUnit, law: &RopeLaw) -> (RunResult, Curves) {
    let machine = worker::pumping_unit::machine(unit, 0).unwrap();
    let settings = worker::pumping_unit::run_settings(&unit.machine);
    let mut recorder = Recorder::everything(0);
    let result = simulate(&machine, law, &settings, &mut recorder);
    assert_eq!(result.verdict, Verdict::Complete);
    (result, recorder.curves)
}

fn twisted(law: &RopeLaw, stiffer: f64, damped: f64) -> RopeLaw {
    let mut other = *law;
    other.bushing.rotational_stiffness[0] *= stiffer;
    other.bushing.rotational_damping[0] *= damped;
    other
}

/// Returns the largest difference between the gauge curves of two runs, divided by the gauge's range in the
/// second run.
fn apart(a: &Curves, b: &Curves) -> f64 {
    let each = a.gauge.iter().zip(&b.gauge).map(|(a, b)| {
        let low = b.iter().copied().fold(f64::MAX, f64::min);
        let high = b.iter().copied().fold(f64::MIN, f64::max);
        let most = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        most.fold(0.0, f64::max) / (high - low)
    });
    each.fold(0.0, f64::max)
}

fn mean(curve: &[f64]) -> f64 {
    curve.iter().sum::<f64>() / curve.len() as f64
}

/// Checks that twins of equal length, simulated in space with the modes of both families, give the gauges of
/// the single rope in its plane for any torsional coefficients: to 1e-9 of the range (measured: 4e-11), with
/// the same steps.
#[test]
fn equal_twins_are_the_single_rope_whatever_their_torsion() {
    let single = crate::unit();
    let pair = twins(0.0, 0.0);
    for (name, genes) in individuals(&single.case) {
        let law = worker::pumping_unit::rope_law(&single, &genes).unwrap();
        let (one, plane) = simulated(&single, &law);
        for (stiffer, damped) in [(1.0, 1.0), (1e-2, 1e2), (1e2, 1e-2)] {
            let (two, space) = simulated(&pair, &twisted(&law, stiffer, damped));
            let apart = apart(&space, &plane);
            eprintln!("{name}, torsion times {stiffer}: {apart:.1e}");
            assert_eq!(two.statistics, one.statistics, "{name} {stiffer}");
            assert!(apart < 1e-9, "{name} {stiffer}: {apart}");
        }
    }
}

/// Checks that a rope that is 1 mm shorter carries `dL EA / (2 L)` more where the contact is stiff, and less
/// than that where the contact yields (measured: 0.98 and 0.75 of it), and that the energy ledger closes.
#[test]
fn unequal_twins_share_the_load_and_the_ledger_closes() {
    let single = crate::unit();
    let pair = twins(1.0, 0.0);
    for ((name, genes), share) in individuals(&single.case)
        .into_iter()
        .zip([0.7..0.8, 0.95..1.0])
    {
        let law = worker::pumping_unit::rope_law(&single, &genes).unwrap();
        let (result, curves) = simulated(&pair, &law);
        let ropes = &single.machine.ropes;
        let stiffness = law.bushing.stiffness[0] * ropes.reference_length_m;
        let length = ropes.back_cylinders as f64 * ropes.cylinder_length_m;
        let expected = 1e-3 * stiffness / (2.0 * length);
        let [back, front] = &curves.tension_difference;
        let found = mean(back) / expected;
        let work = result.work;
        let gained = work.input - work.output - work.dissipated;
        let defect = (result.stored - gained).abs() / work.input;
        eprintln!("{name}: {found:.3} of {expected:.0} N, ledger {defect:.1e}");
        assert!(share.contains(&found), "{name}: {found}");
        assert!(front.iter().all(|t| t.abs() < 1.0), "{name}");
        assert!(defect < 1e-4, "{name}: {defect}");
    }
}

/// Checks that unequal twins change two opposite gauges on the two cheeks by equal amounts with opposite
/// signs. Gauge 2 is moved to the mirror image of gauge 1.
#[test]
fn gauges_on_the_two_cheeks_part_with_opposite_signs() {
    let mirrored = |back_mm: f64| {
        let mut unit = twins(back_mm, 0.0);
        let both = |row: &mut [f64; 4]| row[1] = row[0];
        let opposite = |row: &mut [f64; 4]| row[1] = -row[0];
        let head = &mut unit.machine.modal_head;
        head.gauge_stress_mpa.iter_mut().for_each(both);
        head.inertia_stress_mpa.iter_mut().for_each(both);
        head.influence.normal_mpa_per_n.iter_mut().for_each(both);
        head.influence
            .tangential_mpa_per_n
            .iter_mut()
            .for_each(both);
        let head = &mut unit.machine.twin_ropes.as_mut().unwrap().head;
        head.gauge_stress_mpa.iter_mut().for_each(opposite);
        head.influence
            .normal_mpa_per_n
            .iter_mut()
            .for_each(opposite);
        head.influence
            .tangential_mpa_per_n
            .iter_mut()
            .for_each(opposite);
        head.lateral_mpa_per_n.iter_mut().for_each(opposite);
        unit
    };
    let unit = mirrored(1.0);
    for (name, genes) in individuals(&unit.case) {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        let (_, curves) = simulated(&unit, &law);
        let (_, equal) = simulated(&mirrored(0.0), &law);
        let change = |gauge: usize| mean(&curves.gauge[gauge]) - mean(&equal.gauge[gauge]);
        let (here, there) = (change(0), change(1));
        eprintln!("{name}: {here:.3e} and {there:.3e} Pa");
        assert!(
            here.abs() > 5e4 && here * there < 0.0,
            "{name}: {here} {there}"
        );
        assert!(
            (here + there).abs() < 0.05 * here.abs(),
            "{name}: {here} {there}"
        );
    }
}

/// Checks that torsion of unequal twins reaches the gauges only weakly: four decades of `K_44` change a gauge
/// by 1e-5 MPa (3e-7 of its range; runs that differ only in rounding differ by 1e-11), four decades of
/// `C_44`, with ropes that sink into a soft contact, by 0.04 MPa.
#[test]
fn torsion_of_unequal_twins_reaches_the_gauges() {
    let unit = twins(1.0, 0.0);
    let changes = [
        ("K_44", 1e4, 1.0, [1e-8..1e-6, 5e-8..2e-6]),
        ("C_44", 1.0, 1e4, [5e-4..1e-2, 1e-7..5e-6]),
    ];
    for (k, (name, genes)) in individuals(&unit.case).into_iter().enumerate() {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        let (_, plain) = simulated(&unit, &law);
        for (what, stiffer, damped, expected) in &changes {
            let (_, other) = simulated(&unit, &twisted(&law, *stiffer, *damped));
            let apart = apart(&other, &plain);
            eprintln!("{name}, four decades of {what}: {apart:.1e}");
            assert!(expected[k].contains(&apart), "{name} {what}: {apart}");
        }
    }
}
