//! Rates of the decisions on the linearised oscillator, at fixed seeds.
use case::Overrides;
use oscillator::case_folder::{HIDDEN, write};
use oscillator::effect::Effects;
use oscillator::simulator::Oscillators;
use protocol::job::Numerics;
use rejudge::LinearModel;
use rejudge::trial::{Counts, Rig, rows};

/// Checks that a smooth model error and slow noise bring no name to records in which nothing is hidden, and leave
/// most effects their names.
#[test]
fn smooth_errors_and_slow_noise_bring_no_names() {
    /// Records of each row of the table.
    const SETS: u64 = 5;
    /// Sizes of the hidden effects, in detection limits.
    const TIMES: f64 = 10.0;
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &HIDDEN, &Effects::default(), 3).unwrap();
    let loaded = case::load_with_notes(folder.path(), &Overrides::default()).unwrap();
    let numerics = vec![Numerics::FROM_CASE];
    let model = LinearModel::of_case(&loaded.case, &[&Oscillators], &numerics).unwrap();
    let rig = Rig::new(&model, &loaded.case, (loaded.cycles, numerics));
    let limits = rig.limits().unwrap();
    let [mut empty, mut hidden] = [0, 1].map(|_| Counts::default());
    for row in rows(TIMES) {
        let own = rig.counts(row, SETS, &limits).unwrap();
        eprintln!("{row} | {own:?}");
        let all = if row.times > 0.0 {
            &mut hidden
        } else {
            &mut empty
        };
        all.sets += own.sets;
        all.right += own.right;
        all.wrong.extend(own.wrong);
    }
    assert!(20 * empty.wrong.len() <= empty.sets, "{empty:?}");
    assert!(20 * hidden.wrong.len() <= 2 * hidden.sets, "{hidden:?}");
    assert!(4 * hidden.right >= 3 * hidden.sets, "{hidden:?}");
}
