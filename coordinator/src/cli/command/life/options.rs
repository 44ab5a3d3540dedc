//! Options of `horsehead life`, checked against the case: curve, mean stress, hours of the conditions, target.
use crate::cli::argument::hours::{HoursChoice, Operation};
use clap::{Args, ValueEnum};
use fatigue::{Assessment, Criterion, Curve, CurveError, MeanStress, categories};
use protocol::{case::Case, pumping_unit::Machine};
use std::path::Path;
use support::Problem;

/// Options of the assessment.
#[derive(Clone, Debug, Args)]
pub(super) struct LifeOptions {
    /// Fatigue curve: a category of EN 1993-1-9 (en-36 to en-160), a class of DNV-RP-C203 in air (dnv-b1 to dnv-w3), or a
    /// CSV file with the columns `cycles` and `range_mpa`. Class D belongs to stress on the surface at a weld.
    #[arg(
        long,
        value_name = "NAME|FILE",
        default_value = "dnv-d",
        env = "HORSEHEAD_CURVE"
    )]
    curve: String,
    /// Probability that a detail survives its life, for curves of which the scatter is known; that of the curve by default.
    #[arg(long, value_name = "P", env = "HORSEHEAD_SURVIVAL")]
    survival: Option<f64>,
    /// Rule for the mean stress; as-welded steel has none.
    #[arg(
        long,
        value_enum,
        default_value = "none",
        env = "HORSEHEAD_MEAN_STRESS"
    )]
    mean_stress: MeanStressChoice,
    /// Tensile strength for Goodman and Gerber [MPa].
    #[arg(long, value_name = "MPA", env = "HORSEHEAD_STRENGTH")]
    strength: Option<f64>,
    /// Exponent of Walker's rule; 0.5 is that of Smith, Watson and Topper.
    #[arg(
        long,
        value_name = "G",
        default_value_t = 0.5,
        env = "HORSEHEAD_WALKER"
    )]
    walker: f64,
    /// Stress whose cycles are counted.
    #[arg(long, value_enum, default_value = "normal", env = "HORSEHEAD_STRESS")]
    stress: StressChoice,
    #[command(flatten)]
    hours: HoursChoice,
    /// Factor on every stress, such as a partial factor of safety.
    #[arg(
        long,
        value_name = "F",
        default_value_t = 1.0,
        env = "HORSEHEAD_STRESS_FACTOR"
    )]
    stress_factor: f64,
    /// Life for which the load factor is given \[years\].
    #[arg(
        long,
        value_name = "Y",
        default_value_t = 20.0,
        env = "HORSEHEAD_TARGET_YEARS"
    )]
    target_years: f64,
    /// Yield stress; a larger equivalent stress is said [MPa].
    #[arg(
        long,
        value_name = "MPA",
        default_value_t = 235.0,
        env = "HORSEHEAD_YIELD"
    )]
    r#yield: f64,
}

/// Rules for the mean stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MeanStressChoice {
    /// The mean does not count.
    None,
    /// Goodman; needs --strength.
    Goodman,
    /// Gerber; needs --strength.
    Gerber,
    /// Walker with the exponent --walker.
    Walker,
}

/// Stresses whose cycles are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum StressChoice {
    /// Normal stress on the worst plane perpendicular to the surface.
    Normal,
    /// Equivalent stress of von Mises, signed.
    VonMises,
}

/// Checked options of an assessment.
#[derive(Clone, Debug)]
pub(super) struct LifePlan {
    pub(super) assessment: Assessment,
    pub(super) criterion: Criterion,
    pub(super) operations: Vec<Operation>,
    pub(super) target_years: f64,
    pub(super) yield_mpa: f64,
}

impl LifePlan {
    /// Iterates over the indices of the conditions.
    pub(super) fn conditions(&self) -> impl Iterator<Item = usize> {
        self.operations.iter().map(|own| own.condition)
    }
}

impl LifeOptions {
    /// Checks the options against a case and its machine.
    pub(super) fn plan(&self, case: &Case, machine: &Machine) -> anyhow::Result<LifePlan> {
        let positive = [
            ("--stress-factor", self.stress_factor),
            ("--target-years", self.target_years),
            ("--yield", self.r#yield),
            ("--strength", self.strength.unwrap_or(1.0)),
        ];
        for (option, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(problem(
                    format!("{option} is {value}"),
                    "give a positive number",
                ));
            }
        }
        if !(0.0..=1.0).contains(&self.walker) {
            return Err(problem(
                format!("--walker is {}", self.walker),
                "give an exponent of 0 to 1; 0.5 is the rule of Smith, Watson and Topper",
            ));
        }
        Ok(LifePlan {
            assessment: Assessment {
                curve: self.curve()?,
                mean_stress: self.mean_stress()?,
                factor: self.stress_factor,
            },
            criterion: match self.stress {
                StressChoice::Normal => Criterion::NormalStress,
                StressChoice::VonMises => Criterion::SignedVonMises,
            },
            operations: self
                .hours
                .operations(case, |k| machine.conditions[k].speed_rpm)?,
            target_years: self.target_years,
            yield_mpa: self.r#yield,
        })
    }

    fn mean_stress(&self) -> anyhow::Result<MeanStress> {
        let strength = || {
            self.strength.ok_or_else(|| {
                problem(
                    "this rule for the mean stress needs the tensile strength".to_owned(),
                    "add --strength MPA, such as --strength 470 for S355",
                )
            })
        };
        Ok(match self.mean_stress {
            MeanStressChoice::None => MeanStress::Ignored,
            MeanStressChoice::Goodman => MeanStress::Goodman {
                strength: strength()?,
            },
            MeanStressChoice::Gerber => MeanStress::Gerber {
                strength: strength()?,
            },
            MeanStressChoice::Walker => MeanStress::Walker {
                exponent: self.walker,
            },
        })
    }

    fn curve(&self) -> anyhow::Result<Curve> {
        let curve = self.stated_curve()?;
        let Some(survival) = self.survival else {
            return Ok(curve);
        };
        if !(0.5..1.0).contains(&survival) {
            return Err(problem(
                format!("--survival is {survival}"),
                "give a probability from 0.5, that of the mean curve, to less than 1",
            ));
        }
        let name = curve.name.clone();
        curve.at_survival(survival).ok_or_else(|| {
            problem(
                format!("the scatter of {name} is not known, so that --survival cannot be met"),
                "leave --survival out, or name a curve of DNV-RP-C203",
            )
        })
    }

    fn stated_curve(&self) -> anyhow::Result<Curve> {
        let path = Path::new(&self.curve);
        match Curve::named(&self.curve) {
            Ok(curve) => Ok(curve),
            Err(_) if path.is_file() => {
                let points = points(path)?;
                let shown = path.display();
                Curve::table(&self.curve, &points)
                    .map_err(|error| problem(format!("{shown}: {error}"), "mend the table"))
            }
            Err(error @ CurveError::Unknown { .. }) => Err(problem(
                format!("--curve: {error}, and no such file"),
                &format!(
                    "there are: {}; or name a CSV file with cycles,range_mpa",
                    categories().join(", ")
                ),
            )),
            Err(error) => Err(error.into()),
        }
    }
}

fn problem(message: String, remedy: &str) -> anyhow::Error {
    Problem {
        message,
        remedy: remedy.to_owned(),
    }
    .into()
}

/// Reads the points of a curve: number of cycles and stress range.
fn points(path: &Path) -> anyhow::Result<Vec<[f64; 2]>> {
    let shown = path.display();
    let bad = |what: String| {
        problem(
            format!("{shown}: {what}"),
            "write a CSV file with the header cycles,range_mpa and a point in each line",
        )
    };
    let mut reader = csv::Reader::from_path(path).map_err(|error| bad(error.to_string()))?;
    let header = reader.headers().map_err(|error| bad(error.to_string()))?;
    let names: Vec<&str> = header.iter().map(str::trim).collect();
    if names != ["cycles", "range_mpa"] {
        return Err(bad(format!("its header is `{}`", names.join(","))));
    }
    let mut points = Vec::new();
    for (line, row) in (2..).zip(reader.records()) {
        let row = row.map_err(|error| bad(error.to_string()))?;
        let number = |k: usize| row.get(k).and_then(|text| text.trim().parse::<f64>().ok());
        let (Some(cycles), Some(range)) = (number(0), number(1)) else {
            return Err(bad(format!("line {line} is no pair of numbers")));
        };
        points.push([cycles, range]);
    }
    Ok(points)
}
