//! Accuracy and properties that the tests demand of each preset, in addition to the requirements on all presets; measured
//! on the functions of [`crate::test_function`].

/// Accuracy and properties of a preset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expectations {
    /// Upper bound on the final fitness of the search on test functions with one basin of attraction.
    pub(super) one_basin: f64,
    /// Upper bound on the final fitness of the search on a test function with many basins of attraction.
    pub(super) many_basins: f64,
    /// Upper bound on the distance between the best point and the true minimum in every gene (coordinate).
    pub(super) distance: f64,
    /// Whether the first proposed individual has the recommended values.
    pub(super) starts_at_recommended: bool,
    /// Maximum number of evaluations to find a narrow minimum on a plateau; `None` if the preset does not
    /// find such minima.
    pub(super) valley_evaluations: Option<usize>,
    /// Whether the proposals depend on the seed.
    pub(super) seed_dependent: bool,
}

const QUICK: Expectations = Expectations {
    one_basin: 1e-8,
    many_basins: 3.0,
    distance: 1e-4,
    starts_at_recommended: true,
    // differences take an evaluation for each column
    valley_evaluations: Some(1_400),
    seed_dependent: true,
};

const PAPER: Expectations = Expectations {
    one_basin: 0.1,
    many_basins: 1.1,
    distance: 0.3,
    starts_at_recommended: false,
    valley_evaluations: None,
    seed_dependent: true,
};

/// Returns what the tests demand of a preset.
///
/// # Panics
/// If the list lacks the preset.
pub(super) fn of(preset: &str) -> Expectations {
    match preset {
        "quick" | "least-squares" | "hybrid" => QUICK,
        "memetic" => Expectations {
            one_basin: 1e-4,
            many_basins: 1.1,
            distance: 0.01,
            ..QUICK
        },
        "descent" => Expectations {
            // it stays in the basin that it begins in
            many_basins: 1e3,
            valley_evaluations: None,
            seed_dependent: false,
            ..QUICK
        },
        "paper" | "paper-batch" | "window" => PAPER,
        "cma-es" => Expectations {
            one_basin: 1e-6,
            many_basins: 3.0,
            distance: 1e-3,
            ..PAPER
        },
        "l-shade" => Expectations {
            one_basin: 0.01,
            many_basins: 3.0,
            distance: 0.1,
            starts_at_recommended: true,
            ..PAPER
        },
        "random" | "latin-hypercube" | "sobol" => Expectations {
            one_basin: 1.5,
            many_basins: 3.0,
            distance: 1.5,
            ..PAPER
        },
        other => panic!("nothing is demanded of {other}"),
    }
}
