//! Columns of a run against Richardson-extrapolated central differences of whole runs on the same list
//! of steps, whose stages are solved to rounding.
use simulation::effect::{Asked, Parameter, Role, Selection, catalogue};
use simulation::integrator::stepper::Stages;
use simulation::model::description::{Description, RopeLaw};
use simulation::model::{Individual, Machine};
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{Observe, RunSettings, simulate_on};
use simulation::sensitivity::{self, Coefficient, Column, Derivative, Origin, Plan};
use simulation::system::{State, System};
use simulation::verdict::Verdict;
use std::f64::consts::LN_10;

/// Notes where the steps end.
#[derive(Default)]
struct Steps(Vec<f64>);

impl Observe for Steps {
    fn sample(&mut self, _: usize, _: &mut System<Individual<'_>>, _: &State) {}

    fn step(&mut self, _: &mut System<Individual<'_>>, ends: [&State; 2], _: Option<Stages<'_>>) {
        self.0.push(ends[1].t);
    }
}

/// A machine's own effects, and what is varied of it.
#[derive(Clone)]
struct Subject {
    description: Description,
    effects: Vec<(String, Vec<(String, f64)>)>,
    law: RopeLaw,
    settings: RunSettings,
}

fn asked(effects: &[(String, Vec<(String, f64)>)]) -> Vec<Asked<'_>> {
    let one = |(id, values): &'_ (String, Vec<(String, f64)>)| -> (String, Vec<(String, f64)>) {
        (id.clone(), values.clone())
    };
    let _ = one;
    effects
        .iter()
        .map(|(id, values)| Asked {
            id,
            parameters: values.iter().map(|(name, x)| (&**name, *x)).collect(),
        })
        .collect()
}

impl Subject {
    fn machine(&self) -> Machine {
        let selection = Selection::new(&asked(&self.effects)).unwrap();
        Machine::with_effects(self.description.clone(), 2, selection.effects()).unwrap()
    }

    /// The columns, and the steps that they belong to.
    fn columns(&self, columns: &[Column]) -> (Vec<Derivative>, Vec<f64>) {
        let machine = self.machine();
        let effects = asked(&self.effects);
        let origin = Origin {
            description: &self.description,
            modes: 2,
            effects: &effects,
        };
        let plan = Plan::new(&origin, &machine, columns).unwrap();
        let mut steps = Steps::default();
        let (result, plain) =
            sensitivity::simulate(&machine, &self.law, &self.settings, &plan, &mut steps);
        assert_eq!(result.verdict, Verdict::Complete);
        let steps = steps.0;
        let of = (&machine, &self.law);
        let mut none = Steps::default();
        let (_, found) = sensitivity::simulate_on(of, &self.settings, &steps, &plan, &mut none);
        let gauges = |d: &Derivative| match d {
            Derivative::Curves(c) => c.concat(),
            _ => Vec::new(),
        };
        let found = found.unwrap().columns;
        for (k, (a, b)) in plain.unwrap().columns.iter().zip(&found).enumerate() {
            println!("{k}: plain off {:.1e}", distance(&gauges(a), &gauges(b)));
        }
        (found, steps)
    }

    /// Gauges of a run on given steps with a column's unknown moved.
    fn moved(&self, column: &Column, by: f64, steps: &[f64]) -> [Vec<f64>; 4] {
        let mut own = self.clone();
        match column {
            Column::Coefficient(coefficient) => {
                *coefficient.of(&mut own.law) *= (LN_10 * by).exp();
            }
            Column::Parameter {
                effect,
                parameter,
                values,
            } => {
                let at = own.effects.iter().position(|(id, _)| id == effect);
                let at = at.unwrap_or_else(|| {
                    own.effects.push((effect.clone(), values.clone()));
                    own.effects.len() - 1
                });
                let values = &mut own.effects[at].1;
                match values.iter_mut().find(|(name, _)| name == parameter) {
                    Some((_, value)) => *value += by,
                    None => values.push((parameter.clone(), by)),
                }
            }
        }
        let mut recorder = Recorder::gauges_only();
        let machine = own.machine();
        let result = simulate_on(&machine, &own.law, &own.settings, steps, &mut recorder);
        assert_eq!(result.verdict, Verdict::Complete, "{column:?} {by}");
        recorder.curves.gauge
    }

    /// Derivative by extrapolated differences, and how far those of two step sizes are apart.
    fn differenced(&self, column: &Column, step: f64, steps: &[f64]) -> (Vec<f64>, f64) {
        let one_sided = match column {
            Column::Coefficient(_) => false,
            Column::Parameter {
                effect, parameter, ..
            } => find(effect, parameter).is_one_sided(),
        };
        let run = |by: f64| -> Vec<f64> { self.moved(column, by, steps).concat() };
        let combine = |terms: &[(f64, f64)]| -> Vec<f64> {
            let mut sum = vec![0.0; 4 * self.settings.samples];
            for (weight, by) in terms {
                for (sum, x) in sum.iter_mut().zip(run(by * step)) {
                    *sum += weight / step * x;
                }
            }
            sum
        };
        let [coarse, fine] = if one_sided {
            [
                combine(&[(-1.5, 0.0), (2.0, 1.0), (-0.5, 2.0)]),
                combine(&[(-3.0, 0.0), (4.0, 0.5), (-1.0, 1.0)]),
            ]
        } else {
            [
                combine(&[(0.5, 1.0), (-0.5, -1.0)]),
                combine(&[(1.0, 0.5), (-1.0, -0.5)]),
            ]
        };
        let best: Vec<f64> = fine
            .iter()
            .zip(&coarse)
            .map(|(fine, coarse)| fine + (fine - coarse) / 3.0)
            .collect();
        let apart = distance(&best, &fine);
        (best, apart)
    }
}

fn find(effect: &str, parameter: &str) -> &'static Parameter {
    let descriptor = catalogue().iter().find(|d| d.id == effect).unwrap();
    &descriptor.parameters[descriptor.parameter(parameter).unwrap()]
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Distance of two columns over the size of the second.
fn distance(x: &[f64], y: &[f64]) -> f64 {
    let apart: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
    norm(&apart) / norm(y).max(1e-300)
}

fn fast() -> Subject {
    let mut description = reference::description();
    description.crank.speed *= 3.0;
    description.rope.pitch *= 3.0;
    description.rope.back /= 3;
    description.rope.front /= 3;
    Subject {
        description,
        effects: Vec::new(),
        law: reference::law(),
        settings: RunSettings {
            samples: 72,
            lead_in: 20_f64.to_radians(),
            ramp: 0.3,
            ..RunSettings::default()
        },
    }
}

fn show(subject: &Subject, columns: &[Column]) {
    let (found, steps) = subject.columns(columns);
    for (column_of, found) in columns.iter().zip(found) {
        let step = match column_of {
            Column::Coefficient(_) => 2e-3,
            Column::Parameter {
                effect, parameter, ..
            } => 1e-2 * find(effect, parameter).scale,
        };
        let name = match column_of {
            Column::Coefficient(c) => format!("{c:?}"),
            Column::Parameter {
                effect, parameter, ..
            } => format!("{effect}.{parameter}"),
        };
        match found {
            Derivative::Curves(curves) => {
                let column = curves.concat();
                let judged = [1.0, 0.1, 0.01].map(|share| {
                    let (judge, apart) = subject.differenced(column_of, share * step, &steps);
                    let size = norm(&judge) / (judge.len() as f64).sqrt() / 1e6;
                    (apart, distance(&column, &judge), size)
                });
                let best = judged
                    .into_iter()
                    .min_by(|x, y| x.0.total_cmp(&y.0))
                    .unwrap();
                println!(
                    "{name}: {:.3e} MPa, off {:.1e}, judge {:.1e}",
                    best.2, best.1, best.0
                );
            }
            other => println!("{name}: {other:?}"),
        }
    }
}

#[test]
fn coefficients() {
    let columns = Coefficient::ALL.map(Column::Coefficient);
    show(&fast(), &columns);
}

#[test]
fn effects() {
    let columns: Vec<Column> = catalogue()
        .iter()
        .filter(|d| {
            let shown = ["const", "d2", "sgn_v", "v", "cos3"];
            !d.generic || shown.iter().any(|form| d.id.ends_with(&format!(".{form}")))
        })
        .flat_map(|d| {
            d.parameters
                .iter()
                .filter(|p| p.role == Role::Size)
                .map(|p| Column::Parameter {
                    effect: d.id.to_string(),
                    parameter: p.name.to_owned(),
                    values: Vec::new(),
                })
        })
        .collect();
    show(&fast(), &columns);
}
