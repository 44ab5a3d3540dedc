//! Tests of the CSV files with the data behind the figures.
use super::{sample, with_failed_recommended};
use protocol::pumping_unit::{MachineSnapshot, Simulation};
use report::pumping_unit::csv;

#[test]
fn the_curves_are_written_with_all_their_digits() {
    let calibration = with_failed_recommended(210);
    let case = &calibration.case;
    let mut bytes = Vec::new();
    csv::curves(&mut bytes, &calibration.shown()).unwrap();
    let mut reader = ::csv::Reader::from_reader(bytes.as_slice());
    let head = reader.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|column| column == name).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 210 + 3 * 720);
    let optimised = &calibration.conditions[0].optimised.curves;
    let optimised = Simulation::of(optimised).unwrap();
    let record = case.channels[0].record.as_ref().unwrap();
    for (index, row) in rows[210..210 + 720].iter().enumerate() {
        assert_eq!(&row[0], "5rpm");
        assert_eq!(&row[1], "optimised");
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap().to_bits();
        assert_eq!(
            number("simulated_3_mpa"),
            optimised.gauge_mpa[2][index].to_bits()
        );
        assert_eq!(number("measured_1_mpa"), record.mean[index].to_bits());
        assert_eq!(
            number("crank_torque_n_m"),
            optimised.crank_torque_n_m[index].to_bits()
        );
        assert_eq!(
            number("mode_2_sqrt_kg_m"),
            optimised.modal[1][index].to_bits()
        );
    }
}

/// Checks that each cylinder of each snapshot has a row of its own.
#[test]
fn ropes_are_written_cylinder_by_cylinder() {
    let simulation = Simulation::of(&sample::single().curves).unwrap();
    let mut bytes = Vec::new();
    csv::ropes(&mut bytes, &simulation).unwrap();
    let mut reader = ::csv::Reader::from_reader(bytes.as_slice());
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    let cylinders = |motion: &MachineSnapshot| motion.back_rope_m.len() + motion.front_rope_m.len();
    let expected: usize = simulation.motion.iter().map(cylinders).sum();
    assert!(expected > 0, "the sample has snapshots");
    assert_eq!(rows.len(), expected);
    let first = &simulation.motion[0];
    let row = &rows[first.back_rope_m.len()];
    assert_eq!((&row[1], &row[2]), ("front", "1"));
    let written = |column: usize| row[column].parse::<f64>().unwrap().to_bits();
    assert_eq!(written(5), f64::from(first.front_tension_n[0]).to_bits());
    assert_eq!(written(6), f64::from(first.front_contact_n[0]).to_bits());
}
