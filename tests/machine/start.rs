//! The machine at rest at several crank angles is in equilibrium.
use super::{case, individuals};
use simulation::{
    drive::Drive,
    integrator::State,
    model::{Individual, Machine, description::RopeLaw},
    run::{RunSettings, settle},
    system::System,
};

/// Crank angles before bottom dead centre \[rad\].
const TURNS: [f64; 6] = [0.4, 1.4, 2.4, 3.4, 4.4, 5.4];

/// The machine at rest with its crank `turn` before bottom dead centre.
fn at_rest<'a>(
    machine: &'a Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    turn: f64,
) -> (System<Individual<'a>>, State) {
    let drive = Drive {
        start: -turn,
        ramp: settings.ramp,
        speed: machine.description.crank.speed,
    };
    let mut system = System::new(Individual::new(machine, machine.ropes(law), drive));
    let q = settle(&mut system, settings, None).unwrap();
    (system, State::at_rest(0.0, q))
}

/// A run starts from equilibrium: nothing accelerates there, and the beam a tenth of a milliradian
/// beside it does, by tens of rad/s2.
#[test]
fn a_run_starts_at_rest() {
    let case = case();
    let machine = worker::convert::machine(&case, 0).unwrap();
    let settings = worker::convert::run_settings(&case);
    let beam = machine.layout.beam();
    for (name, genes) in individuals(&case) {
        let law = worker::convert::rope_law(&case, &genes).unwrap();
        for turn in TURNS {
            let (mut system, mut state) = at_rest(&machine, &law, &settings, turn);
            let mut accelerated = |q: &[f64]| {
                system
                    .accelerations(0.0, q, &state.v, &mut state.a)
                    .unwrap();
                state.a[beam].abs()
            };
            let rest = accelerated(&state.q);
            let mut beside = state.q.clone();
            beside[beam] += 1e-4;
            let displaced = accelerated(&beside);
            eprintln!("{name} at {turn}: {rest:.1e} rad/s2, displaced {displaced:.1e} rad/s2");
            assert!(rest < 1e-9 * displaced, "{name} at {turn}: {rest}");
        }
    }
}
