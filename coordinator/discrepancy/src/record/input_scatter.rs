//! What the input of a measurement may be wrong by from cycle to cycle: directions that no test counts as a
//! disagreement. Whoever reads the data sheet knows them; here they are an abscissa, or the name of an
//! effect. What is constant over a measurement is another matter (`nuisance`).

/// One way in which cycles differ because their input did.
#[derive(Clone, Debug, PartialEq)]
pub enum InputScatter {
    /// The curves stand at other places than they seem to.
    Abscissa {
        /// Bound of the error of a cycle, in the unit of the abscissa.
        tolerance: f64,
    },
    /// An effect of the library acts on the input; where the library lacks it, it is left out.
    Effect {
        /// Its identifier.
        id: String,
        /// Standard deviation of its first size from cycle to cycle, in that size's unit.
        deviation: f64,
    },
}
