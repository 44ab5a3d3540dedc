//! The case that is shipped loads, and its figures are those its README states.
use coordinator::case::{self, Overrides};
use protocol::case::{GaugeTrace, GeneName};
use std::path::{Path, PathBuf};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

fn half_range(trace: &GaugeTrace) -> f64 {
    let low = trace.mean_mpa.iter().copied().fold(f64::INFINITY, f64::min);
    let high = trace
        .mean_mpa
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    (high - low) / 2.0
}

#[test]
fn the_shipped_case_has_the_figures_of_its_readme() {
    let started = std::time::Instant::now();
    let loaded = case::load_with_notes(&shipped(), &Overrides::default()).unwrap();
    println!(
        "loaded in {:?}; {:#?}\n{:#?}\n{:?}",
        started.elapsed(),
        loaded.notes,
        loaded.records,
        loaded.envelope
    );
    let case = &loaded.case;
    assert_eq!(case.genes.len(), 10);
    assert_eq!(case.genes[0].name, GeneName::Kb1);
    for condition in &case.conditions {
        let record = condition.record.as_ref().unwrap();
        assert_eq!(record.turn_deg.len(), 720);
        for trace in &record.gauges {
            let spread = (trace.spread_mpa.iter().map(|s| s * s).sum::<f64>() / 720.0).sqrt();
            println!(
                "{} cycles {} gauge {} half range {:.3} spread {:.3}",
                condition.name,
                record.cycles,
                trace.gauge,
                half_range(trace),
                spread
            );
        }
    }
}
