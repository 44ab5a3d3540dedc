//! Tables of a strategy's settings: keys with allowed values and meanings.
//!
//! A strategy's settings are a plain struct with serde's derives; a table says which of its fields can be set
//! by name, their allowed values and their meaning. The same table parses, prints, checks and lists the
//! settings.
use serde::Serialize;
use serde_json::Value;

/// Error in the settings of a search.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// Value of a setting outside its allowed range.
    #[error("{setting} is {value}, but must be {allowed}")]
    Range {
        /// Key of the setting that lies outside its range.
        setting: String,
        /// Rejected value, as text.
        value: String,
        /// Allowed values of the setting, in words.
        allowed: String,
    },
    /// Key that no setting of the preset has.
    #[error("there is no setting `{key}`")]
    Unknown {
        /// Key given by the user, which no setting has.
        key: String,
    },
    /// Setting of a part that the search omits for this case.
    #[error(
        "`{key}` has no effect: no unknown of the case has a `valley`, so this search has no scan; remove the setting, or add `valley` to an unknown in case.toml"
    )]
    Absent {
        /// Key of the setting that belongs to the omitted part.
        key: String,
    },
    /// Settings that name an unknown or different strategy, or do not have the form of the strategy's
    /// settings.
    #[error("the settings of the strategy `{strategy}` cannot be used: {problem}")]
    Form {
        /// Name of the strategy in the rejected settings.
        strategy: String,
        /// Reason why the settings are rejected.
        problem: String,
    },
}

/// Allowed values of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllowedValues {
    /// List of allowed words, of which the value must be one.
    Words(&'static [&'static str]),
    /// Integer within an inclusive range.
    Whole(u64, u64),
    /// Real number within an inclusive range.
    Real(f64, f64),
    /// Boolean, `true` or `false`.
    Switch,
}

/// Setting of a strategy, with its allowed values and meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Name of the setting's field in the struct of the strategy's settings.
    pub field: &'static str,
    /// Values that the setting may have.
    pub values: AllowedValues,
    /// Word that stands for no value, if the setting is optional; else `None`.
    pub none: Option<&'static str>,
    /// Meaning of the setting, one line.
    pub meaning: &'static str,
    /// Whether the default of the setting depends on the planned number of workers.
    pub follows_workers: bool,
}

impl Setting {
    /// Creates a setting that always has a value.
    pub const fn new(field: &'static str, values: AllowedValues, meaning: &'static str) -> Self {
        Self {
            field,
            values,
            none: None,
            meaning,
            follows_workers: false,
        }
    }

    /// Makes the setting optional; `none` is the word that stands for no value.
    #[must_use]
    pub const fn optional(self, none: &'static str) -> Self {
        Self {
            none: Some(none),
            ..self
        }
    }

    /// Marks the default of the setting as dependent on the planned number of workers.
    #[must_use]
    pub const fn following_workers(self) -> Self {
        Self {
            follows_workers: true,
            ..self
        }
    }

    /// Returns a description of the allowed values of the setting, for messages and help texts.
    pub fn allowed(&self) -> String {
        let values = match self.values {
            AllowedValues::Words(words) => words.join(", "),
            AllowedValues::Whole(least, u64::MAX) => format!("at least {least}"),
            AllowedValues::Whole(least, most) => format!("{least} to {most}"),
            AllowedValues::Real(least, most) if most >= f64::MAX => format!("{least} or more"),
            AllowedValues::Real(least, most) => format!("{least} to {most}"),
            AllowedValues::Switch => "true, false".to_owned(),
        };
        self.none
            .map_or(values.clone(), |none| format!("{values}, or {none}"))
    }

    /// Parses a value of the setting from text; `None` if the value is not allowed.
    pub fn parse(&self, text: &str) -> Option<Value> {
        if self.none == Some(text) {
            return Some(Value::Null);
        }
        let value = match self.values {
            AllowedValues::Words(_) => Value::from(text),
            AllowedValues::Whole(..) => Value::from(text.parse::<u64>().ok()?),
            AllowedValues::Real(..) => {
                let number = text.parse::<f64>().ok()?;
                Value::from(Some(number).filter(|number| number.is_finite())?)
            }
            AllowedValues::Switch => Value::from(text.parse::<bool>().ok()?),
        };
        self.allows(&value).then_some(value)
    }

    /// Formats a value of the setting as text that [`Setting::parse`] accepts.
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

    fn allows(&self, value: &Value) -> bool {
        match (self.values, value) {
            (_, Value::Null) => self.none.is_some(),
            (AllowedValues::Words(words), Value::String(word)) => words.contains(&word.as_str()),
            (AllowedValues::Whole(least, most), Value::Number(number)) => number
                .as_u64()
                .is_some_and(|number| (least..=most).contains(&number)),
            (AllowedValues::Real(least, most), Value::Number(number)) => number
                .as_f64()
                .is_some_and(|number| (least..=most).contains(&number)),
            (AllowedValues::Switch, Value::Bool(_)) => true,
            _ => false,
        }
    }

    pub(super) fn refusal(&self, setting: &str, value: &str) -> SettingsError {
        SettingsError::Range {
            setting: setting.to_owned(),
            value: value.to_owned(),
            allowed: self.allowed(),
        }
    }
}

/// Declares the settings of a strategy and the table of those that can be set by name. A field with a meaning and allowed
/// values stands in the table, under its own name; a call such as `optional("none")` behind them changes its entry.
macro_rules! settings {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident, $table_vis:vis table $table:ident {
            $(
                $(#[$field_meta:meta])*
                $field_vis:vis $field:ident: $type:ty
                $(= $meaning:literal, $values:expr $(, $method:ident($($argument:expr)?))?)?;
            )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        $vis struct $name {
            $(
                $(#[$field_meta])*
                $(#[doc = ""] #[doc = concat!("`", $meaning, "`")])?
                $field_vis $field: $type,
            )*
        }

        $table_vis const $table: &[Setting] = &[
            $($(Setting::new(stringify!($field), $values, $meaning)$(.$method($($argument)?))?,)?)*
        ];
    };
}
pub(super) use settings;

/// Checks a strategy's settings against their table of allowed values.
///
/// # Errors
/// If a setting has a value that is not allowed.
pub fn check(settings: &impl Serialize, table: &[Setting]) -> Result<(), SettingsError> {
    let values = serde_json::to_value(settings).unwrap_or_default();
    for setting in table {
        let value = &values[setting.field];
        if !setting.allows(value) {
            return Err(setting.refusal(setting.field, &setting.show(value)));
        }
    }
    Ok(())
}

/// Checks a condition on a setting that its table cannot express; the error names the setting and its value.
///
/// # Errors
/// If the condition does not hold.
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
