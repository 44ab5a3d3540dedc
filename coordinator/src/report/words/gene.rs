//! Genes in words: what they are, and the bounds that they touch.
use crate::report::number::quantity;
use protocol::case::{Coefficient, Gene, Scale};

/// What a coefficient is, in words.
pub(in crate::report) const fn meaning(gene: Coefficient) -> &'static str {
    match gene {
        Coefficient::Kb1 => "axial stiffness",
        Coefficient::Kb23 => "shear stiffness",
        Coefficient::Kb4 => "torsional stiffness",
        Coefficient::Kb56 => "bending stiffness",
        Coefficient::Cb1 => "axial damping",
        Coefficient::Cb23 => "shear damping",
        Coefficient::Cb4 => "torsional damping",
        Coefficient::Cb56 => "bending damping",
        Coefficient::Kc => "contact stiffness",
        Coefficient::Cc => "contact damping",
    }
}

/// Letter and index of a coefficient's symbol.
pub(in crate::report) const fn symbol(gene: Coefficient) -> (&'static str, &'static str) {
    match gene {
        Coefficient::Kb1 => ("K", "b1"),
        Coefficient::Kb23 => ("K", "b23"),
        Coefficient::Kb4 => ("K", "b4"),
        Coefficient::Kb56 => ("K", "b56"),
        Coefficient::Cb1 => ("C", "b1"),
        Coefficient::Cb23 => ("C", "b23"),
        Coefficient::Cb4 => ("C", "b4"),
        Coefficient::Cb56 => ("C", "b56"),
        Coefficient::Kc => ("K", "c"),
        Coefficient::Cc => ("C", "c"),
    }
}

/// A bound of a gene in words, as "its upper bound 1.00e12 N/m".
pub(in crate::report) fn bound(gene: &Gene, side: &str) -> String {
    let value = if side == "lower" {
        gene.lower
    } else {
        gene.upper
    };
    format!("its {side} bound {}", quantity(value, gene.unit()))
}

/// Which bound a value touches, within half a per cent of the interval on the gene's scale.
pub(in crate::report) fn at_bound(gene: &Gene, value: f64) -> Option<&'static str> {
    let Gene { lower, upper, .. } = *gene;
    let share = match gene.scale() {
        Scale::Logarithmic => (value / lower).ln() / (upper / lower).ln(),
        Scale::Linear => (value - lower) / (upper - lower),
    };
    if share < 0.005 {
        Some("lower")
    } else if share > 0.995 {
        Some("upper")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{at_bound, bound};
    use protocol::{
        case::{Coefficient, Gene, Quantity},
        unit::Unit,
    };

    #[test]
    fn bounds_are_noticed_on_the_scale_of_the_gene() {
        let unit = Unit::NewtonPerMetre;
        let stiffness = Gene::coefficient(Coefficient::Kb1, unit, 1e8, [1e4, 1e12]);
        assert_eq!(at_bound(&stiffness, 1e4), Some("lower"));
        assert_eq!(at_bound(&stiffness, 0.99e12), Some("upper"));
        assert_eq!(at_bound(&stiffness, 2e4), None);
        let size = Gene {
            quantity: Quantity::Effect {
                id: "load_offset".to_owned(),
                parameter: "force".to_owned(),
                unit: "N".to_owned(),
            },
            recommended: 0.0,
            lower: -500.0,
            upper: 1500.0,
        };
        assert_eq!(at_bound(&size, -499.0), Some("lower"));
        assert_eq!(at_bound(&size, 0.0), None);
        assert_eq!(at_bound(&size, 1400.0), None);
        assert_eq!(bound(&size, "upper"), "its upper bound 1500\u{a0}N");
    }
}
