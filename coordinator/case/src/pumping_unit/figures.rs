//! Key figures of a pumping-unit case, as printed by `horsehead case check`.
use super::{
    flexible::ReadHead,
    geometry::Envelope,
    head::{GaugePlace, UPWARDS},
    mesh::surface_distances_m,
    read::{Resolved, read},
    record::RecordFacts,
};
use crate::{
    effect::CaseEffect,
    error::CaseError,
    note::Note,
    source::{Overrides, RecordFolder, document},
    summary::{CaseSummary, calibrated_conditions},
};
use protocol::{
    case::{Case, Term, Unknown},
    pumping_unit::{HeadGauge, Machine},
};
use std::{fmt, path::Path};

/// Key figures of a pumping-unit case, for the summary of `horsehead case check`.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyFigures {
    /// Name of the machine in the case.
    pub name: String,
    /// Range of motion of beam and ropes, by rigid kinematics.
    pub envelope: Envelope,
    /// Length of the back rope \[m\], and number of rigid cylinders that represent it.
    pub back_rope: (f64, usize),
    /// Length of the front rope \[m\], and number of rigid cylinders that represent it.
    pub front_rope: (f64, usize),
    /// Frequencies of the simulated modes of the flexible back head \[Hz\].
    pub modes_hz: Vec<f64>,
    /// Figures of a machine with two ropes on each head: distance of the ropes from the plane \[m\], excess
    /// length of the back and front rope at -z \[m\], and frequencies of the out-of-plane modes \[Hz\].
    pub twin_ropes: Option<(f64, [f64; 2], Vec<f64>)>,
    /// Mass of the back head according to its mesh \[kg\].
    pub head_mass_kg: f64,
    /// Gauges of the back head; empty without their places.
    pub gauges: Vec<GaugeFigures>,
    /// Unknowns of the case.
    pub genes: Vec<Unknown>,
    /// Effects that the case adds to the baseline model.
    pub effects: Vec<CaseEffect>,
    /// Key figures of each working condition.
    pub conditions: Vec<ConditionFigures>,
    /// Calibrated conditions with their weights, and the terms of their objective.
    pub objective: (String, Vec<Term>),
    /// Remarks on the case that are not errors.
    pub notes: Vec<Note>,
}

/// Key figures of a working condition.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionFigures {
    /// Name of the working condition.
    pub name: String,
    /// Crank speed [1/min].
    pub speed_rpm: f64,
    /// Smallest and largest load of the condition's load card \[N\].
    pub load_n: [f64; 2],
    /// Key figures of the condition's gauge record, if there is one.
    pub record: Option<RecordFigures>,
}

/// Place of a gauge on the back head, and its stress under the rope at its largest tension.
#[derive(Clone, Debug, PartialEq)]
pub struct GaugeFigures {
    /// Place, direction and length of the gauge.
    pub place: GaugePlace,
    /// Distance from the surface of the body \[m\]; `None` without a mesh.
    pub surface_distance_m: Option<f64>,
    /// Tension of the rope \[N\], stress under it \[MPa\] and its change when the gauge is moved along x, y and z
    /// [MPa/m]; `None` if the tables do not state them.
    pub stress: Option<(f64, f64, [Option<f64>; 3])>,
}

/// Key figures of a gauge record.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFigures {
    /// File name, samples, losses and speed of the record.
    pub facts: RecordFacts,
    /// Number of whole crank turns that were averaged to the mean curve.
    pub cycles: usize,
    /// Title, unit, half of the measured range, and noise of the mean curve (root mean square of spread /
    /// sqrt(cycles)) of each channel.
    pub channels: Vec<(String, String, f64, f64)>,
}

/// Loads a case and returns its key figures.
///
/// # Errors
/// As [`crate::load()`].
pub fn figures(folder: &Path) -> Result<KeyFigures, CaseError> {
    let overrides = Overrides::default();
    of(&RecordFolder::new(
        folder,
        &overrides,
        &document(folder, &overrides)?,
    ))
}

/// Returns the key figures as a summary, with their text.
///
/// # Errors
/// As [`crate::load()`].
pub(super) fn summary(source: &RecordFolder<'_>) -> Result<CaseSummary, CaseError> {
    let figures = of(source)?;
    let (text, conditions) = (figures.to_string(), figures.conditions.iter());
    Ok(CaseSummary {
        key: "genes",
        text,
        conditions: conditions.map(|one| one.name.clone()).collect(),
        unknowns: figures.genes.iter().map(|one| one.name.clone()).collect(),
        name: figures.name,
        notes: figures.notes,
    })
}

/// Reads a pumping-unit case and collects its key figures.
fn of(source: &RecordFolder<'_>) -> Result<KeyFigures, CaseError> {
    let Resolved {
        loaded,
        facts,
        envelope,
        machine,
        head,
        ..
    } = read(source)?;
    let case = loaded.case;
    let rope = |count: usize| (count as f64 * machine.ropes.cylinder_length_m, count);
    Ok(KeyFigures {
        envelope,
        back_rope: rope(machine.ropes.back_cylinders),
        front_rope: rope(machine.ropes.front_cylinders),
        modes_hz: machine
            .modal_head
            .frequencies_hz
            .iter()
            .take(machine.run.modes)
            .copied()
            .collect(),
        twin_ropes: machine.twin_ropes.as_ref().map(|twins| {
            let longer = [
                twins.back_length_difference_m,
                twins.front_length_difference_m,
            ];
            let modes = twins.head.frequencies_hz.iter().take(twins.modes);
            (twins.offset_m, longer, modes.copied().collect())
        }),
        head_mass_kg: machine.modal_head.mass_kg,
        gauges: gauges(&head),
        conditions: conditions(&case, &machine, facts),
        objective: (calibrated_conditions(&case), case.objective.terms.clone()),
        notes: loaded.notes,
        effects: loaded.effects,
        genes: case.unknowns,
        name: case.name,
    })
}

/// Returns the figures of the gauges whose places are known.
fn gauges(head: &ReadHead) -> Vec<GaugeFigures> {
    let wrap = head.provenance.largest_wrap;
    let places: Vec<HeadGauge> = head.provenance.gauges.into_iter().flatten().collect();
    let points: Vec<[f64; 3]> = places.iter().map(|gauge| gauge.position_m).collect();
    let distances = head.mesh.as_ref();
    let distances = distances.map(|(mesh, _)| surface_distances_m(mesh, &points));
    let figures = places.iter().enumerate().map(|(at, gauge)| GaugeFigures {
        place: GaugePlace::from(*gauge),
        surface_distance_m: distances.as_ref().and_then(|all| all.get(at).copied()),
        stress: wrap.map(|wrap| {
            (
                wrap.tension_n,
                wrap.stress_mpa[at],
                wrap.gradient_mpa_per_m[at],
            )
        }),
    });
    figures.collect()
}

/// Returns the key figures of each condition.
fn conditions(
    case: &Case,
    machine: &Machine,
    facts: Vec<Option<RecordFacts>>,
) -> Vec<ConditionFigures> {
    let all = case.conditions.iter().zip(&machine.conditions).zip(facts);
    let summaries = all
        .enumerate()
        .map(|(index, ((condition, working), facts))| {
            let record = facts.map(|facts| {
                let channels = case.measured(index).map(|(_, channel, record)| {
                    let [low, high] = range(&record.mean);
                    let count = record.spread.len().max(1) as f64;
                    let square: f64 = record.spread.iter().map(|s| s * s).sum::<f64>() / count;
                    let noise = (square / record.cycles.max(1) as f64).sqrt();
                    let (title, unit) = (channel.title.clone(), channel.unit.clone());
                    (title, unit, (high - low) / 2.0, noise)
                });
                let cycles = case.measured(index).map(|(_, _, record)| record.cycles);
                RecordFigures {
                    facts,
                    cycles: cycles.max().unwrap_or_default(),
                    channels: channels.collect(),
                }
            });
            ConditionFigures {
                name: condition.name.clone(),
                speed_rpm: working.speed_rpm,
                load_n: range(&working.card.load_n),
                record,
            }
        });
    summaries.collect()
}

/// Returns the smallest and the largest value.
fn range(values: &[f64]) -> [f64; 2] {
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ]
}

impl fmt::Display for KeyFigures {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_machine(to)?;
        for condition in &self.conditions {
            write!(to, "{condition}")?;
        }
        let (condition, terms) = &self.objective;
        let terms = terms.iter();
        let terms = terms.map(|term| format!("{} (weight {})", term.channel, term.weight));
        let terms: Vec<String> = terms.collect();
        write!(to, "objective   {condition}: {}", terms.join(", "))?;
        for note in &self.notes {
            write!(to, "\nnote: {note}")?;
        }
        Ok(())
    }
}

impl KeyFigures {
    /// Writes the lines of the summary about machine, ropes, head, unknowns and effects.
    fn write_machine(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Envelope {
            beam_deg: [low, high],
            contact_deg: [from, until],
            free_rope_m: [shortest, longest],
            hang_m: [top, bottom],
            stroke_m,
        } = self.envelope;
        writeln!(to, "machine     {}", self.name)?;
        writeln!(
            to,
            "stroke      {stroke_m:.3} m, beam {low:.2} to {high:.2} deg"
        )?;
        let (length, count) = self.back_rope;
        writeln!(
            to,
            "back rope   {length:.3} m in {count} cylinders, {shortest:.3} to {longest:.3} m free, \
             leaves the head at {from:.1} to {until:.1} deg"
        )?;
        let (length, count) = self.front_rope;
        writeln!(
            to,
            "front rope  {length:.3} m in {count} cylinders, {top:.3} to {bottom:.3} m hanging"
        )?;
        let modes: Vec<String> = self.modes_hz.iter().map(|f| format!("{f:.1}")).collect();
        writeln!(
            to,
            "back head   {:.1} kg, modes at {} Hz",
            self.head_mass_kg,
            modes.join(", ")
        )?;
        for (number, gauge) in (1..).zip(&self.gauges) {
            writeln!(to, "  gauge {number}   {gauge}")?;
        }
        if let Some((offset, [back, front], modes)) = &self.twin_ropes {
            let modes: Vec<String> = modes.iter().map(|f| format!("{f:.1}")).collect();
            writeln!(
                to,
                "twin ropes  at z = +-{offset:.3} m, those at -z longer by {:.2} mm (back) and {:.2} mm \
                 (front), modes out of the plane at {} Hz",
                1e3 * back,
                1e3 * front,
                modes.join(", ")
            )?;
        }
        let whose = if self.twin_ropes.is_some() {
            "; of both ropes of a head together"
        } else {
            ""
        };
        writeln!(to, "genes       recommended (lower .. upper){whose}")?;
        let labels = self.genes.iter().map(|gene| gene.name.len());
        let width = labels.fold(6, usize::max);
        for gene in &self.genes {
            writeln!(
                to,
                "  {:<width$} {:>10.3e} ({:.2e} .. {:.2e}) {}",
                gene.name, gene.start, gene.lower, gene.upper, gene.unit
            )?;
        }
        if self.twin_ropes.is_none() {
            writeln!(
                to,
                "  kb4 and cb4 have no effect: a single rope in the middle plane is not twisted; see twin_ropes"
            )?;
        }
        for effect in &self.effects {
            let numbers = effect.parameters.iter();
            let numbers = numbers.map(|(name, p)| format!("{name} {} {}", p.value, p.unit));
            let numbers: Vec<String> = numbers.collect();
            writeln!(to, "effect      {}: {}", effect.id, numbers.join(", "))?;
        }
        Ok(())
    }
}

impl fmt::Display for GaugeFigures {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let GaugePlace {
            x_m,
            y_m,
            z_m,
            length_m,
            direction,
        } = self.place;
        let along = match direction {
            UPWARDS => "y".to_owned(),
            [x, y, z] => format!("({x:.2}, {y:.2}, {z:.2})"),
        };
        write!(
            to,
            "at ({x_m:.4}, {y_m:.4}, {z_m:.4}) m, {:.0} mm along {along}",
            1e3 * length_m
        )?;
        if let Some(distance_m) = self.surface_distance_m {
            write!(to, ", {:.1} mm from the surface", 1e3 * distance_m)?;
        }
        let Some((tension_n, stress, gradient)) = self.stress else {
            return Ok(());
        };
        write!(
            to,
            "; {stress:.1} MPa under {:.1} kN of rope tension, moved by 1 mm along x, y, z: ",
            1e-3 * tension_n
        )?;
        let changes = gradient.map(|own| {
            own.map_or_else(
                || "-".to_owned(),
                |per_m| format!("{:+.1} %", 0.1 * per_m / stress),
            )
        });
        write!(to, "{}", changes.join(", "))
    }
}

impl fmt::Display for ConditionFigures {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [least, greatest] = self.load_n.map(|load| load / 1000.0);
        writeln!(
            to,
            "condition   {}: {} /min, load {least:.1} to {greatest:.1} kN",
            self.name, self.speed_rpm
        )?;
        let Some(record) = &self.record else {
            return writeln!(to, "  no record: simulated only");
        };
        writeln!(
            to,
            "  record {} cycles, {} samples at {:.0} Hz, {} lost, measured speed {:.3} /min",
            record.cycles,
            record.facts.samples,
            record.facts.rate_hz,
            record.facts.lost,
            record.facts.speed_rpm
        )?;
        for (title, unit, half_range, noise) in &record.channels {
            writeln!(
                to,
                "  {title}: half-range {half_range:.2} {unit}, noise of the mean {noise:.3} {unit}"
            )?;
        }
        Ok(())
    }
}
