//! What a simulation takes of the heap: nothing in a step, little in all.
use simulation::integrator::method::CATALOGUE;
use simulation::model::{Individual, Machine};
use simulation::reference;
use simulation::run::{Observe, RunSettings, simulate};
use simulation::system::State;
use simulation::system::System;

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

/// Notes the number of blocks that were allocated up to the first and up to the last sample.
#[derive(Default)]
struct Blocks {
    first: Option<u64>,
    last: u64,
}

impl Observe for Blocks {
    fn sample(&mut self, _index: usize, _system: &mut System<Individual<'_>>, _state: &State) {
        let now = dhat::HeapStats::get().total_blocks;
        self.first.get_or_insert(now);
        self.last = now;
    }
}

/// The real unit's 72 + 114 cylinders, one rope and two: between the first and the last sample of a
/// revolution lie hundreds of steps with their Newton iterations and factorisations, and with no method
/// a single allocation; a run fits into 64 MiB many times over.
#[test]
fn a_step_allocates_nothing_and_a_run_little() {
    let mut descriptions = [reference::description(), reference::twins([1e-3, 0.0])];
    for description in &mut descriptions {
        description.rope.pitch = 0.05;
        description.rope.back = 72;
        description.rope.front = 114;
    }
    let [single, twins] = descriptions;
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
