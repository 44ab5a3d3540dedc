//! Parameter values of an effect, and simple effects given by one function of the parameter values.
use crate::model::description::Description;
use crate::model::extension::{Effect, Extensions, Reading, SampleState, Site};

/// Parameter values of an effect by name, in declaration order and SI units.
#[derive(Clone, Debug)]
pub struct ParameterValues(pub(super) Vec<(&'static str, f64)>);

impl ParameterValues {
    /// Returns the value of the parameter with a given name.
    ///
    /// # Panics
    /// If the effect declares no parameter of that name, which is an error in the effect's own file.
    #[expect(
        clippy::panic,
        reason = "a misspelt name must not become a number, in any build"
    )]
    pub fn get(&self, name: &str) -> f64 {
        let value = self.0.iter().find(|(own, _)| *own == name);
        let Some((_, value)) = value else {
            let declared: Vec<&str> = self.0.iter().map(|(own, _)| *own).collect();
            panic!("the effect declares no parameter `{name}`, only {declared:?}");
        };
        *value
    }

    /// Returns the values of several parameters, in the order of the given names.
    pub fn each<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.get(name))
    }

    /// Returns all values in the order of the parameters.
    pub fn in_order(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|(_, value)| *value)
    }
}

/// Effect that only edits the machine description, by a function of the parameter values.
#[derive(Clone, Debug)]
pub(super) struct Edit {
    pub(super) values: ParameterValues,
    pub(super) edit: fn(&ParameterValues, &mut Description),
}

impl Effect for Edit {
    fn describe(&self, description: &mut Description, _: &mut usize) {
        (self.edit)(&self.values, description);
    }
}

/// Effect that only changes gauge readings, sample by sample, by a function of the parameter values and of the
/// elapsed share of the recorded revolution, 0 to 1.
#[derive(Clone, Debug)]
pub(super) struct Read {
    pub(super) values: ParameterValues,
    pub(super) read: fn(&ParameterValues, f64, &mut [f64; 4]),
}

impl Effect for Read {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_reading(self.clone());
    }
}

impl Reading for Read {
    fn sample(&self, at: &SampleState, stress: &mut [f64; 4]) {
        (self.read)(&self.values, at.elapsed, stress);
    }

    fn needs_loads(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::ParameterValues;

    #[test]
    #[should_panic(expected = "no parameter `momnet`, only [\"moment\", \"creep\"]")]
    fn a_misspelt_parameter_is_no_number() {
        let values = ParameterValues(vec![("moment", 1.0), ("creep", 2.0)]);
        assert!(values.get("momnet").is_nan());
    }
}
