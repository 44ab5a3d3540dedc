//! What a simulation takes of the heap: nothing in a step, little in all.
use simulation::integrator::State;
use simulation::model::{Individual, Machine};
use simulation::reference;
use simulation::run::{Observe, RunSettings, simulate};
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

/// The real unit's 72 + 114 cylinders: between the first and the last sample of a revolution lie
/// hundreds of steps with their Newton iterations and factorisations, and not one allocation; a run
/// fits into 64 MiB many times over.
#[test]
fn a_step_allocates_nothing_and_a_run_little() {
    let mut description = reference::description();
    description.rope.pitch = 0.05;
    description.rope.back = 72;
    description.rope.front = 114;
    let profiler = dhat::Profiler::builder().testing().build();
    let machine = Machine::new(description, 2).unwrap();
    let settings = RunSettings {
        samples: 12,
        ..RunSettings::default()
    };
    let mut blocks = Blocks::default();
    let result = simulate(&machine, &reference::law(), &settings, &mut blocks);
    let stats = dhat::HeapStats::get();
    drop(profiler);
    assert!(result.statistics.steps > 200, "{:?}", result.statistics);
    // the energy at the recorded revolution's start is one momentum vector
    let in_steps = blocks.last - blocks.first.unwrap();
    assert!(in_steps <= 1, "{in_steps} allocations in the steps");
    assert!(
        stats.max_bytes < 4 << 20,
        "{} bytes at most",
        stats.max_bytes
    );
}
