//! Benchmarks of the kernels and of whole runs. The times are informative only; regressions are detected by
//! the counts of work that tests/numerics compares with its snapshots.
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use nalgebra::Vector3;
use simulation::drive::Drive;
use simulation::effect::{Role, catalogue};
use simulation::integrator::method::CATALOGUE;
use simulation::model::description::RopeLaw;
use simulation::model::{Machine, RopeMachine};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::rig::{End, Rig, Setup};
use simulation::run::{RunSettings, simulate};
use simulation::sensitivity::{self, Coefficient, Column, ColumnOrigin, DerivativePlan};
use simulation::settle::{guess, minimize};
use simulation::system::{Equations, StateRef, StateShift, System};

/// Returns the reference machine with 72 + 114 rope cylinders of 50 mm, as on the real pumping unit.
fn machine() -> Machine {
    let mut description = reference::description();
    description.rope.pitch = 0.05;
    description.rope.back = 72;
    description.rope.front = 114;
    Machine::new(description, 2).expect("the description is complete")
}

/// Returns the two sets of rope coefficients in the paper's Table 3: the recommended and the optimised one.
fn laws() -> [(&'static str, RopeLaw); 2] {
    let optimised = reference::law();
    let mut recommended = optimised;
    let deg = 180.0 / std::f64::consts::PI;
    recommended.bushing.stiffness = [3.14e8, 1.25e8];
    recommended.bushing.damping = [400.0; 2];
    recommended.bushing.rotational_stiffness = [110.0 * deg, 137.0 * deg];
    recommended.bushing.rotational_damping = [40.0 * deg; 2];
    recommended.contact.stiffness = 1e6;
    recommended.contact.damping = 50.0;
    [("recommended", recommended), ("optimised", optimised)]
}

/// Measures three kernels at the start of a run under load: evaluation of forces, assembly with factorisation
/// of the tangent matrix, and linear solution.
fn kernels(criterion: &mut Criterion) {
    let machine = machine();
    let drive = Drive {
        start: 1.0,
        ramp: 1.0,
        speed: 0.5,
    };
    let ropes = machine.ropes(&reference::law());
    let mut system = System::new(RopeMachine::new(&machine, ropes, drive));
    let state = system.equations.drive_state(0.0);
    let q = guess(&machine, &ropes, &state).expect("the mechanism closes");
    let v = vec![0.0; q.len()];
    let mut force = vec![0.0; q.len()];
    let at = StateRef::new(0.0, &q, &v);
    let mut group = criterion.benchmark_group("kernel, 186 cylinders");
    group.bench_function("forces", |b| {
        b.iter(|| {
            system.forces(at, &mut force);
        });
    });
    let mut matrix = system.equations.matrix();
    let shift = StateShift {
        mass: 1600.0,
        damping: 40.0,
    };
    let mut loads = system.forces(at, &mut force);
    group.bench_function("tangent", |b| {
        b.iter(|| loads.tangent(shift, &mut matrix));
    });
    group.bench_function("tangent and factorisation", |b| {
        b.iter(|| loads.factorize(shift));
    });
    group.bench_function("solution", |b| {
        b.iter(|| {
            force.fill(1.0);
            system.solve(&mut force);
        });
    });
    group.finish();
}

/// Measures a whole run (settling, lead-in and one revolution), which is the cost of one evaluation of a
/// search.
fn runs(criterion: &mut Criterion) {
    let machine = machine();
    let mut group = criterion.benchmark_group("run, 186 cylinders");
    group.sample_size(10);
    for (name, law) in laws() {
        for method in CATALOGUE {
            let settings = RunSettings {
                method,
                longest_step: 0.03,
                ..RunSettings::default()
            };
            group.bench_function(format!("{name}, {}", method.name()), |b| {
                b.iter(|| simulate(&machine, &law, &settings, &mut Recorder::gauges_only()));
            });
        }
    }
    group.finish();
}

/// Measures the time to find the static equilibrium of a strongly bent cantilever.
fn settles(criterion: &mut Criterion) {
    let law = reference::law().bushing;
    let setup = Setup {
        chain: simulation::model::chain::Chain::solid(0, 40, 0.01, 0.05, 7850.0),
        gravity: Vector3::zeros(),
        joint: law,
        ends: [
            End::Held {
                place: Vector3::zeros(),
                angle: 0.0,
                law,
            },
            End::Free {
                force: Vector3::new(0.0, -100.0, 0.0),
                twist: 0.0,
                turn: 0.0,
            },
        ],
        drum: None,
    };
    criterion.bench_function("cantilever of 40 cylinders settles", |b| {
        b.iter(|| {
            let mut system = System::new(Rig::new(setup));
            let mut q = system.equations.straight(Vector3::zeros(), 0.0);
            minimize(&mut system, 0.0, &mut q)
        });
    });
}

/// Measures simulation runs that also integrate sensitivities, against the plain run: with respect to the ten
/// rope coefficients and one friction moment, and to all size parameters of the effect catalogue.
fn columns(criterion: &mut Criterion) {
    let mut description = reference::description();
    description.rope.pitch = 0.05;
    description.rope.back = 72;
    description.rope.front = 114;
    let machine = machine();
    let origin = ColumnOrigin {
        description: &description,
        modes: 2,
        effects: &[],
    };
    let sizes = catalogue().iter().flat_map(|d| {
        let sizes = d.parameters.iter().filter(|p| p.role == Role::Size);
        sizes.map(|p| Column::Parameter {
            effect: d.id.to_string(),
            parameter: p.name.to_owned(),
            values: Vec::new(),
        })
    });
    let sizes: Vec<Column> = sizes.collect();
    let of = |id: &str| {
        let own = |c: &&Column| matches!(c, Column::Parameter { effect, .. } if effect == id);
        sizes.iter().filter(own).cloned().collect::<Vec<_>>()
    };
    let coefficients = Coefficient::ALL.map(Column::Coefficient);
    let sets = [
        ("no column", Vec::new()),
        ("one column", coefficients[..1].to_vec()),
        ("10 columns", coefficients.to_vec()),
        (
            "12 columns",
            [coefficients.to_vec(), of("pivot_friction")].concat(),
        ),
        ("all sizes", sizes.clone()),
    ];
    let mut group = criterion.benchmark_group("run with columns");
    group.sample_size(10);
    let (_, law) = laws()[0];
    for (name, columns) in sets {
        let plan = DerivativePlan::new(&origin, &machine, &columns).expect("the catalogue's own");
        group.bench_function(format!("{name} ({})", columns.len()), |b| {
            b.iter(|| {
                let mut recorder = Recorder::gauges_only();
                let settings = RunSettings::default();
                sensitivity::simulate(&machine, &law, &settings, &plan, &mut recorder)
            });
        });
    }
}

/// 200 individuals of the shipped case's quick calibration (seed 1), evenly spaced over the 374 different ones that
/// completed, as `horsehead export` writes them; rotational coefficients per degree, as in the case.
const INDIVIDUALS: &str = include_str!("quick_individuals.csv");

/// Returns the rope laws of [`INDIVIDUALS`].
fn individuals() -> Vec<RopeLaw> {
    let mut reader = csv::Reader::from_reader(INDIVIDUALS.as_bytes());
    let rows = reader.deserialize::<[f64; 10]>();
    let deg = 180.0 / std::f64::consts::PI;
    let law = |row: Result<[f64; 10], csv::Error>| {
        let [kb1, kb23, kb4, kb56, cb1, cb23, cb4, cb56, kc, cc] = row.expect("ten numbers");
        let mut law = reference::law();
        law.bushing.stiffness = [kb1, kb23];
        law.bushing.rotational_stiffness = [kb4 * deg, kb56 * deg];
        law.bushing.damping = [cb1, cb23];
        law.bushing.rotational_damping = [cb4 * deg, cb56 * deg];
        law.contact.stiffness = kc;
        law.contact.damping = cc;
        law
    };
    rows.map(law).collect()
}

/// Measures simulations per second over the individuals of a quick calibration, on one core.
fn throughput(criterion: &mut Criterion) {
    let machine = machine();
    let laws = individuals();
    let settings = RunSettings::default();
    let mut group = criterion.benchmark_group("throughput");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.throughput(Throughput::Elements(laws.len() as u64));
    group.bench_function("individuals of a quick calibration", |b| {
        b.iter(|| {
            for law in &laws {
                let mut recorder = Recorder::gauges_only();
                std::hint::black_box(simulate(&machine, law, &settings, &mut recorder));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, kernels, runs, columns, settles, throughput);
criterion_main!(benches);
