//! Settings as people name them: a table of keys with what each may be.
//!
//! A strategy's settings are a plain struct with serde's derives; a table says which of its fields
//! can be set by name, what they may be and what they mean. The same table parses, prints, checks
//! and lists them.
use serde::Serialize;
use serde_json::Value;

/// Settings that no search can be made of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A setting lies outside its range.
    #[error("{setting} is {value}, but must be {allowed}")]
    Range {
        /// Name of the setting.
        setting: String,
        /// Its value.
        value: String,
        /// What it may be.
        allowed: String,
    },
    /// There is no setting of this name.
    #[error("there is no setting `{key}`")]
    Unknown {
        /// What was named.
        key: String,
        /// What there is.
        known: Vec<String>,
    },
    /// The setting is one of a part that the search leaves out for this case.
    #[error(
        "`{key}` sets nothing: no unknown of the case has a `valley`, so this search does not scan"
    )]
    Absent {
        /// What was named.
        key: String,
    },
    /// The settings are of a strategy that is not there, or not of the form that it has.
    #[error("the settings of the strategy `{strategy}` cannot be used: {problem}")]
    Form {
        /// The strategy that they name.
        strategy: String,
        /// What is wrong.
        problem: String,
    },
}

/// What a setting may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Values {
    /// One of some words.
    Words(&'static [&'static str]),
    /// A whole number, from the first to the last.
    Whole(u64, u64),
    /// A number, from the first to the last.
    Real(f64, f64),
    /// `true` or `false`.
    Switch,
}

/// One setting of a strategy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its field in the strategy's settings.
    pub field: &'static str,
    /// What it may be.
    pub values: Values,
    /// The word for no value, where it may have none.
    pub none: Option<&'static str>,
    /// What it means, in one line.
    pub meaning: &'static str,
    /// Whether its default follows the number of workers that are planned.
    pub follows_workers: bool,
}

impl Setting {
    /// A setting that always has a value.
    pub const fn new(field: &'static str, values: Values, meaning: &'static str) -> Self {
        Self {
            field,
            values,
            none: None,
            meaning,
            follows_workers: false,
        }
    }

    /// The same, with a word for no value.
    #[must_use]
    pub const fn or(self, none: &'static str) -> Self {
        Self {
            none: Some(none),
            ..self
        }
    }

    /// The same, with a default that follows the number of workers that are planned.
    #[must_use]
    pub const fn following_workers(self) -> Self {
        Self {
            follows_workers: true,
            ..self
        }
    }

    /// What it may be, in words.
    pub fn allowed(&self) -> String {
        let values = match self.values {
            Values::Words(words) => words.join(", "),
            Values::Whole(least, u64::MAX) => format!("at least {least}"),
            Values::Whole(least, most) => format!("{least} to {most}"),
            Values::Real(least, most) if most >= f64::MAX => format!("{least} or more"),
            Values::Real(least, most) => format!("{least} to {most}"),
            Values::Switch => "true, false".to_owned(),
        };
        self.none
            .map_or(values.clone(), |none| format!("{values}, or {none}"))
    }

    /// The value of some words, if it may be that.
    pub fn parse(&self, text: &str) -> Option<Value> {
        if self.none == Some(text) {
            return Some(Value::Null);
        }
        let value = match self.values {
            Values::Words(_) => Value::from(text),
            Values::Whole(..) => Value::from(text.parse::<u64>().ok()?),
            Values::Real(..) => {
                let number = text.parse::<f64>().ok()?;
                Value::from(Some(number).filter(|number| number.is_finite())?)
            }
            Values::Switch => Value::from(text.parse::<bool>().ok()?),
        };
        self.holds(&value).then_some(value)
    }

    /// A value in words: those that [`Setting::parse`] takes.
    pub fn show(&self, value: &Value) -> String {
        match value {
            Value::Null => self.none.unwrap_or("none").to_owned(),
            Value::String(word) => word.clone(),
            // as short as it can be: 0, not 0.0
            Value::Number(number) if number.is_f64() => {
                number.as_f64().unwrap_or(f64::NAN).to_string()
            }
            Value::Bool(_) | Value::Number(_) | Value::Array(_) | Value::Object(_) => {
                value.to_string()
            }
        }
    }

    /// Whether it may be this.
    fn holds(&self, value: &Value) -> bool {
        match (self.values, value) {
            (_, Value::Null) => self.none.is_some(),
            (Values::Words(words), Value::String(word)) => words.contains(&word.as_str()),
            (Values::Whole(least, most), Value::Number(number)) => number
                .as_u64()
                .is_some_and(|number| (least..=most).contains(&number)),
            (Values::Real(least, most), Value::Number(number)) => number
                .as_f64()
                .is_some_and(|number| (least..=most).contains(&number)),
            (Values::Switch, Value::Bool(_)) => true,
            _ => false,
        }
    }

    /// The error of a value that it may not be.
    pub(super) fn refusal(&self, setting: &str, value: &str) -> SettingsError {
        SettingsError::Range {
            setting: setting.to_owned(),
            value: value.to_owned(),
            allowed: self.allowed(),
        }
    }
}

/// Checks settings against their table.
///
/// # Errors
/// If one is not what it may be.
pub fn check(settings: &impl Serialize, table: &[Setting]) -> Result<(), SettingsError> {
    let values = serde_json::to_value(settings).unwrap_or_default();
    for setting in table {
        let value = &values[setting.field];
        if !setting.holds(value) {
            return Err(setting.refusal(setting.field, &setting.show(value)));
        }
    }
    Ok(())
}

/// Checks one number against a condition that no table can state.
///
/// # Errors
/// If it does not hold.
pub(super) fn require(
    holds: bool,
    setting: &str,
    value: usize,
    allowed: &str,
) -> Result<(), SettingsError> {
    if holds {
        return Ok(());
    }
    Err(SettingsError::Range {
        setting: setting.to_owned(),
        value: value.to_string(),
        allowed: allowed.to_owned(),
    })
}
