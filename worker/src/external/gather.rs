//! Converts the output files of an external program into the curves of a condition.
use exchange::{Problem, dakota, object, pest, table};
use protocol::{
    case::Channel,
    external::{ChannelSource, Equation, OutputFile, OutputFormat},
};
use std::collections::BTreeMap;

/// Parsed rules for extracting values from the output files of an external program.
#[derive(Debug)]
pub(super) struct Readings {
    all: Vec<(String, Form)>,
}

#[derive(Debug)]
enum Form {
    Pest(pest::Instructions),
    Dakota {
        functions: Vec<String>,
        gradients: bool,
    },
    Whole,
}

/// Texts of the output files of one run of an external program, and the values read from them.
#[derive(Debug, Default)]
pub(super) struct Outputs {
    /// Values by name, extracted by PEST instructions, from Dakota results and by equations.
    pub(super) named: BTreeMap<String, f64>,
    /// Derivatives of named values by all variables of the parameters file, from Dakota results.
    gradients: BTreeMap<String, Vec<f64>>,
    /// Text of each output file, in the order of the readings.
    texts: Vec<String>,
    /// Whether the results file itself reports that the run failed (Dakota's `fail`).
    pub(super) is_fail: bool,
}

impl Readings {
    /// Parses the instructions by which the output files are read.
    pub(super) fn new(readings: &[OutputFile]) -> Result<Self, Problem> {
        let form = |reading: &OutputFile| {
            let form = match &reading.form {
                OutputFormat::Pest(text) => {
                    Form::Pest(pest::Instructions::parse(&reading.file, text)?)
                }
                OutputFormat::Dakota {
                    functions,
                    gradients,
                } => Form::Dakota {
                    functions: functions.clone(),
                    gradients: *gradients,
                },
                OutputFormat::Table | OutputFormat::Object => Form::Whole,
            };
            Ok((reading.file.clone(), form))
        };
        Ok(Self {
            all: readings.iter().map(form).collect::<Result<_, Problem>>()?,
        })
    }

    /// Returns the names of the functions that Dakota's results files must contain.
    pub(super) fn functions(&self) -> Vec<String> {
        let lists = self.all.iter().filter_map(|(_, form)| match form {
            Form::Dakota { functions, .. } => Some(functions.clone()),
            Form::Pest(_) | Form::Whole => None,
        });
        lists.flatten().collect()
    }

    /// Returns whether the program returns gradients where they are requested.
    pub(super) fn has_gradients(&self) -> bool {
        let mut forms = self.all.iter();
        forms.any(|(_, form)| {
            matches!(
                form,
                Form::Dakota {
                    gradients: true,
                    ..
                }
            )
        })
    }

    /// Returns the names of the output files that the program must write.
    pub(super) fn files(&self) -> impl Iterator<Item = &str> {
        self.all.iter().map(|(file, _)| file.as_str())
    }

    /// Reads all output files; `left` is a function that returns the text of the file with a given name.
    ///
    /// # Errors
    /// A message saying which file or value is missing or cannot be read.
    pub(super) fn read(
        &self,
        left: impl Fn(&str) -> Result<String, String>,
    ) -> Result<Outputs, String> {
        let mut all = Outputs::default();
        for (file, form) in &self.all {
            let text = left(file)?;
            match form {
                Form::Pest(instructions) => {
                    let values = instructions.read(file, &text);
                    all.named.extend(values.map_err(|error| error.to_string())?);
                }
                Form::Dakota { functions, .. } => {
                    let results = dakota::results(file, &text, functions);
                    match results.map_err(|error| error.to_string())? {
                        dakota::Results::Fail => all.is_fail = true,
                        dakota::Results::Values { values, gradients } => {
                            all.named.extend(functions.iter().cloned().zip(values));
                            all.gradients
                                .extend(functions.iter().cloned().zip(gradients));
                        }
                    }
                }
                Form::Whole => {}
            }
            all.texts.push(text);
        }
        Ok(all)
    }

    /// Returns the curve of a channel, interpolated at the channel's abscissa points if the output file
    /// states points of its own.
    ///
    /// # Errors
    /// A message saying which values are missing, or that their number differs from the channel's number of
    /// points.
    pub(super) fn curve(
        &self,
        source: &ChannelSource,
        channel: &Channel,
        left: &Outputs,
    ) -> Result<Vec<f64>, String> {
        let places = &channel.abscissa.points;
        let of = |reading: &usize| {
            let file = self.all.get(*reading).map_or("", |(file, _)| file.as_str());
            (file, left.texts.get(*reading).map_or("", String::as_str))
        };
        let (file, values, at) = match source {
            ChannelSource::Named(names) => {
                let value = |name: &String| {
                    let found = left.named.get(name).copied();
                    found.ok_or_else(|| format!("the output files contain no value named `{name}`"))
                };
                let values = names.iter().map(value).collect::<Result<Vec<f64>, _>>()?;
                ("", values, None)
            }
            ChannelSource::Column {
                reading,
                at,
                column,
            } => {
                let (file, text) = of(reading);
                let names = std::iter::once(column.as_str()).chain(at.as_deref());
                let names: Vec<&str> = names.collect();
                let read = table::columns(file, text, &names).map_err(|error| error.to_string())?;
                let mut read = read.into_iter();
                (file, read.next().unwrap_or_default(), read.next())
            }
            ChannelSource::Pointer {
                reading,
                values,
                at,
            } => {
                let (file, text) = of(reading);
                let read = |pointer: &String| {
                    object::values(file, text, pointer).map_err(|error| error.to_string())
                };
                let at = at.as_ref().map(read).transpose()?;
                (file, read(values)?, at)
            }
        };
        match at {
            Some(at) => resample(file, &at, &values, places),
            None if values.len() == places.len() => Ok(values),
            None => Err(format!(
                "{file} holds {} values of channel `{}`, which has {} points",
                values.len(),
                channel.name,
                places.len()
            )),
        }
    }
}

impl Outputs {
    /// Checks that gradients, where there are any, have an entry for each of the variables.
    ///
    /// # Errors
    /// A message that names the lengths.
    pub(super) fn check_gradients(&self, variables: usize) -> Result<(), String> {
        let mut gradients = self.gradients.iter();
        let wrong = gradients.find(|(_, gradient)| gradient.len() != variables);
        wrong.map_or(Ok(()), |(name, gradient)| {
            let length = gradient.len();
            Err(format!(
                "the gradient of `{name}` has {length} entries, and the parameters file {variables} variables"
            ))
        })
    }

    /// Returns the derivative of a channel's values by the variable at an index of the parameters file; an empty curve if the
    /// output files hold no gradients of all of them.
    pub(super) fn derivative(&self, source: &ChannelSource, variable: usize) -> Vec<f64> {
        let ChannelSource::Named(names) = source else {
            return Vec::new();
        };
        let of = |name: &String| self.gradients.get(name)?.get(variable).copied();
        names
            .iter()
            .map(of)
            .collect::<Option<_>>()
            .unwrap_or_default()
    }
}

/// Evaluates the equations of a case (weighted sums of parameters or of their decimal logarithms); returns
/// values by equation name.
pub(super) fn evaluate_equations(
    equations: &[Equation],
    values: &BTreeMap<String, f64>,
) -> BTreeMap<String, f64> {
    let sum = |equation: &Equation| {
        let terms = equation.terms.iter().map(|term| {
            let value = values.get(&term.parameter).copied().unwrap_or(f64::NAN);
            term.factor * if term.log { libm::log10(value) } else { value }
        });
        (equation.name.clone(), terms.sum())
    };
    equations.iter().map(sum).collect()
}

/// Ratio from which an abscissa that runs farther than a channel's counts as written in another unit, if hardly any of its
/// points lie within the channel's: seconds and milliseconds differ by 1000, hours and seconds by 3600, degrees and
/// radians by 57.3.
const OTHER_UNIT: f64 = 50.0;
/// Number of abscissa points within a channel's range from which the abscissa fits the channel in any case.
const ENOUGH: usize = 3;

/// Returns the ratio of the length of an abscissa to that of a channel's, if the abscissa seems to be in another unit.
fn other_unit(at: &[f64], places: &[f64]) -> Option<f64> {
    let (first, last) = (places.first()?, places.last()?);
    let within = at.iter().filter(|own| (first..=last).contains(own)).count();
    let ratio = length(at) / length(places);
    (places.len() > ENOUGH && within < ENOUGH && ratio >= OTHER_UNIT).then_some(ratio)
}

fn length(points: &[f64]) -> f64 {
    points.last().unwrap_or(&0.0) - points.first().unwrap_or(&0.0)
}

/// Interpolates a curve (abscissa points `at`, ordinates `values`) linearly at the abscissa points `places`.
fn resample(file: &str, at: &[f64], values: &[f64], places: &[f64]) -> Result<Vec<f64>, String> {
    if at.len() != values.len() || at.is_empty() {
        return Err(format!(
            "{file} holds {} values but {} abscissa points",
            values.len(),
            at.len()
        ));
    }
    if at.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(format!(
            "the abscissa values in {file} are not strictly ascending"
        ));
    }
    let (first, last) = (at[0], at[at.len() - 1]);
    if let Some(factor) = other_unit(at, places) {
        return Err(format!(
            "the abscissa in {file} runs from {first} to {last}, {factor:.0} times as far as that of the channel: it may be in \
             another unit, as ms for s; write it in the unit of the channel's `abscissa`"
        ));
    }
    // the last digit of a place that was written as text is not held against it
    let slack = 1e-9 * (last - first).abs();
    let value = |place: &f64| {
        if *place < first - slack || *place > last + slack {
            return Err(format!(
                "the abscissa in {file} runs from {first} to {last}, but the channel needs a value at {place}{}",
                if at.len() > ENOUGH && length(places) >= OTHER_UNIT * length(at) {
                    ": it may be in another unit, as s for ms"
                } else {
                    ""
                }
            ));
        }
        let above = at
            .partition_point(|own| own < place)
            .clamp(1, at.len().max(2) - 1);
        let Some((from, to)) = at.get(above - 1).zip(at.get(above)) else {
            return Ok(values[0]);
        };
        let share = ((place - from) / (to - from)).clamp(0.0, 1.0);
        Ok(values[above - 1] + share * (values[above] - values[above - 1]))
    };
    places.iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_brought_to_the_channels_places() {
        let at = [0.0, 1.0, 3.0];
        let values = [0.0, 2.0, 4.0];
        let found = resample("f", &at, &values, &[0.0, 0.5, 2.0, 3.0]).unwrap();
        assert_eq!(found, [0.0, 1.0, 3.0, 4.0]);
        let error = resample("f", &at, &values, &[3.5]).unwrap_err();
        assert!(error.contains("from 0 to 3"), "{error}");
        let seconds: Vec<f64> = (0..50).map(|k| 0.2 * f64::from(k)).collect();
        let milliseconds: Vec<f64> = seconds.iter().map(|s| 1000.0 * s).collect();
        let error = resample("f", &milliseconds, &seconds, &seconds).unwrap_err();
        assert!(
            error.contains("1000 times as far") && error.contains("ms for s"),
            "{error}"
        );
        let error = resample("f", &seconds, &seconds, &milliseconds).unwrap_err();
        assert!(
            error.contains("needs a value at 200: it may be in another unit, as s for ms"),
            "{error}"
        );
        resample("f", &[1.0, 1.0], &[0.0, 0.0], &[1.0]).unwrap_err();
        resample("f", &[], &[], &[1.0]).unwrap_err();
        assert_eq!(resample("f", &[1.0], &[5.0], &[1.0]).unwrap(), [5.0]);
    }
}
