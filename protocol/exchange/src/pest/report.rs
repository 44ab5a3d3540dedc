//! Writers of PEST's result files: parameter values (`.par`) and residuals (`.rei`).
use std::fmt::Write as _;

/// Row of a `.par` file: the value of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParRow {
    /// Name of the parameter.
    pub name: String,
    /// Value of the parameter.
    pub value: f64,
    /// Factor in `scale x value + offset`, the number written into templates.
    pub scale: f64,
    /// Summand `offset` in `scale x value + offset`, the number written into templates.
    pub offset: f64,
}

/// Row of a `.rei` file: the residual of one observation.
#[derive(Clone, Debug, PartialEq)]
pub struct ReiRow {
    /// Name of the observation.
    pub name: String,
    /// Name of the observation group that contains the observation.
    pub group: String,
    /// Measured value of the observation.
    pub measured: f64,
    /// Value of the observation computed by the model.
    pub modelled: f64,
    /// Factor on the residual of the observation.
    pub weight: f64,
}

/// Formats a PEST parameter value file (`.par`).
pub fn par(rows: &[ParRow]) -> String {
    let mut text = "single point\n".to_owned();
    for row in rows {
        let ParRow {
            name,
            value,
            scale,
            offset,
        } = row;
        // writing to a text does not fail
        let _written = writeln!(
            text,
            "{name:<20} {value:>24.15e} {scale:>14.6} {offset:>14.6}"
        );
    }
    text
}

/// Formats a PEST residual file (`.rei`).
pub fn rei(rows: &[ReiRow]) -> String {
    let mut text = "MODEL OUTPUTS AT THE BEST PARAMETERS:\n\n".to_owned();
    let heads = [
        "Name", "Group", "Measured", "Modelled", "Residual", "Weight",
    ];
    let heads = heads.map(|head| format!("{head:>20} "));
    let _written = writeln!(text, "{}", heads.concat().trim_end());
    for row in rows {
        let ReiRow {
            name,
            group,
            measured,
            modelled,
            weight,
        } = row;
        let residual = measured - modelled;
        let _written = writeln!(
            text,
            "{name:>20} {group:>20} {measured:>24.15e} {modelled:>24.15e} {residual:>24.15e} {weight:>20.9e}"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_a_row_for_each() {
        let row = ParRow {
            name: "k".to_owned(),
            value: 2.5,
            scale: 1.0,
            offset: 0.0,
        };
        let text = par(&[row]);
        let words: Vec<&str> = text.lines().nth(1).unwrap().split_whitespace().collect();
        assert_eq!(
            (text.lines().next(), words[0], crate::number(words[1])),
            (Some("single point"), "k", Some(2.5))
        );
        let row = ReiRow {
            name: "o".to_owned(),
            group: "g".to_owned(),
            measured: 3.0,
            modelled: 1.0,
            weight: 2.0,
        };
        let text = rei(&[row]);
        let words: Vec<&str> = text.lines().last().unwrap().split_whitespace().collect();
        let numbers: Vec<Option<f64>> = words[2..].iter().map(|word| crate::number(word)).collect();
        assert_eq!(numbers, [3.0, 1.0, 2.0, 2.0].map(Some));
    }
}
