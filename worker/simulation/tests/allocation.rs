//! Heap use of a simulation: the steps allocate nothing, the whole run little.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "helpers of tests; what was measured is printed"
)]
use simulation::effect::{Role, catalogue};
use simulation::integrator::method::CATALOGUE;
use simulation::model::description::Description;
use simulation::model::{Machine, RopeMachine};
use simulation::reference;
use simulation::run::{Observe, RunSettings, simulate};
use simulation::sensitivity::{
    self, Coefficient, Column, ColumnOrigin, Derivative, DerivativePlan,
};
use simulation::system::State;
use simulation::system::System;

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

/// Test observer that counts heap blocks allocated by a run, up to its second and up to its last sample.
#[derive(Default)]
struct Blocks {
    first: Option<u64>,
    last: u64,
}

impl Observe for Blocks {
    fn sample(&mut self, index: usize, _system: &mut System<RopeMachine<'_>>, _state: &State) {
        let now = dhat::HeapStats::get().total_blocks;
        // what reads a sample takes its room at the first one
        if index > 0 {
            self.first.get_or_insert(now);
        }
        self.last = now;
    }
}

/// Checks that derivatives by all rope coefficients and all effect sizes of the catalogue, including the
/// machines built for them, fit into 32 MiB, and that their steps and samples allocate nothing.
fn columns_take_little(description: &Description) {
    let profiler = dhat::Profiler::builder().testing().build();
    let machine = Machine::new(description.clone(), 2).unwrap();
    let sizes = catalogue().iter().flat_map(|d| {
        let sizes = d.parameters.iter().filter(|p| p.role == Role::Size);
        sizes.map(|p| Column::Parameter {
            effect: d.id.to_string(),
            parameter: p.name.to_owned(),
            values: Vec::new(),
        })
    });
    let coefficients = Coefficient::ALL.map(Column::Coefficient);
    let all: Vec<Column> = coefficients.into_iter().chain(sizes).collect();
    let origin = ColumnOrigin {
        description,
        modes: 2,
        effects: &[],
    };
    let plan = DerivativePlan::new(&origin, &machine, &all).unwrap();
    let settings = RunSettings {
        samples: 12,
        ..RunSettings::default()
    };
    let law = reference::law();
    let mut blocks = Blocks::default();
    let (_, found) = sensitivity::simulate(&machine, &law, &settings, &plan, &mut blocks);
    let stats = dhat::HeapStats::get();
    drop(profiler);
    let found = found.unwrap().columns;
    let curves = |one: &&Derivative| matches!(one, Derivative::Curves(_));
    let worked_out = found.iter().filter(curves).count();
    assert!(worked_out >= 140, "{worked_out}");
    let in_steps = blocks.last - blocks.first.unwrap();
    println!(
        "{worked_out} columns: {} bytes, {in_steps} blocks in the steps",
        stats.max_bytes
    );
    assert!(in_steps <= 1, "{in_steps} allocations in the steps");
    assert!(stats.max_bytes < 32 << 20, "{} bytes", stats.max_bytes);
}

/// Checks the memory use with the real unit's 72 + 114 cylinders, with one rope and with twin ropes: between
/// the second and the last sample of a revolution lie hundreds of steps with their Newton iterations and
/// factorisations, during which no integration method allocates (one block in all is permitted); a whole run
/// stays below 32 MiB.
#[test]
fn a_step_allocates_nothing_and_a_run_little() {
    let mut descriptions = [reference::description(), reference::twins([1e-3, 0.0])];
    for description in &mut descriptions {
        description.rope.pitch = 0.05;
        description.rope.back = 72;
        description.rope.front = 114;
    }
    let [single, twins] = descriptions;
    columns_take_little(&single);
    let default = RunSettings::default().method;
    let mut runs: Vec<_> = CATALOGUE.map(|method| (single.clone(), method)).into();
    runs.push((twins, default));
    for (description, method) in runs {
        let name = format!("{}, twins: {}", method.name(), description.twins.is_some());
        let profiler = dhat::Profiler::builder().testing().build();
        let machine = Machine::new(description, 2).unwrap();
        let settings = RunSettings {
            samples: 12,
            method,
            ..RunSettings::default()
        };
        let mut blocks = Blocks::default();
        let result = simulate(&machine, &reference::law(), &settings, &mut blocks);
        let stats = dhat::HeapStats::get();
        drop(profiler);
        assert!(
            result.statistics.steps > 200,
            "{name}: {:?}",
            result.statistics
        );
        // the energy at the recorded revolution's start is one momentum vector
        let in_steps = blocks.last - blocks.first.unwrap();
        assert!(in_steps <= 1, "{name}: {in_steps} allocations in the steps");
        assert!(
            stats.max_bytes < 32 << 20,
            "{name}: {} bytes",
            stats.max_bytes
        );
    }
}
