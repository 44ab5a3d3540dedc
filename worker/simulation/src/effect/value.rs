//! Parameter values of an effect, and effects that consist of a single function of them.
use crate::model::description::Description;
use crate::model::hook::{Effect, Hooks, Reading, Sampled, Site};

/// Parameter values of an effect by name, in declaration order and SI units.
#[derive(Clone, Debug)]
pub struct Values(pub(super) Vec<(&'static str, f64)>);

impl Values {
    /// Returns the value of a parameter.
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

    /// Returns the values of several parameters.
    pub fn each<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.get(name))
    }

    /// Returns all values in the order of the parameters.
    pub fn in_order(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|(_, value)| *value)
    }
}

/// Effect that only edits the description.
#[derive(Clone, Debug)]
pub(super) struct Edit {
    pub(super) values: Values,
    pub(super) edit: fn(&Values, &mut Description),
}

impl Effect for Edit {
    fn describe(&self, description: &mut Description, _: &mut usize) {
        (self.edit)(&self.values, description);
    }
}

/// Effect that only changes gauge readings, sample by sample.
#[derive(Clone, Debug)]
pub(super) struct Read {
    pub(super) values: Values,
    pub(super) read: fn(&Values, &Sampled, &mut [f64; 4]),
}

impl Effect for Read {
    fn install(&self, _: &Site<'_>, hooks: &mut Hooks) {
        hooks.add_reading(self.clone());
    }
}

impl Reading for Read {
    fn sample(&self, at: &Sampled, stress: &mut [f64; 4]) {
        (self.read)(&self.values, at, stress);
    }
}

#[cfg(test)]
mod tests {
    use super::Values;

    #[test]
    #[should_panic(expected = "no parameter `momnet`, only [\"moment\", \"creep\"]")]
    fn a_misspelt_parameter_is_no_number() {
        let values = Values(vec![("moment", 1.0), ("creep", 2.0)]);
        assert!(values.get("momnet").is_nan());
    }
}
