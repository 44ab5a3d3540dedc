//! Why a head cannot be reduced.

/// Why a head cannot be reduced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReductionError {
    /// The mesh is not usable.
    #[error("the mesh cannot be used: {what}")]
    Mesh {
        /// What is wrong with it.
        what: &'static str,
    },
    /// The mesh is not its own mirror image in z = 0.
    #[error(
        "the mesh is not its own mirror image in the plane z = 0: nothing stands opposite \
         ({x:.4}, {y:.4}, {z:.4}) m. Free meshers do not mirror: mesh the half z >= 0 alone, \
         with its cut face as physical group `symmetry`, or mirror that half's mesh"
    )]
    NotMirrored {
        /// Position of the lonely node \[m\].
        x: f64,
        /// Position of the lonely node \[m\].
        y: f64,
        /// Position of the lonely node \[m\].
        z: f64,
    },
    /// An element has no volume at some integration point.
    #[error("element {element} of the mesh (of the half z > 0, from 0) is inside out")]
    InsideOut {
        /// Its index.
        element: usize,
    },
    /// The stiffness is not positive definite.
    #[error("the body can move without strain: the held nodes do not hold it")]
    NotHeld,
    /// The factor does not fit into memory.
    #[error("a factor over {unknowns} unknowns does not fit into memory")]
    TooLarge {
        /// Unknown displacements.
        unknowns: usize,
    },
    /// Too few modes.
    #[error("{wanted} modes were asked for; they did not converge within {steps} steps")]
    Modes {
        /// How many were asked for.
        wanted: usize,
        /// Steps that were tried.
        steps: usize,
    },
    /// The rope surface does not reach a station.
    #[error("the rope surface has nothing at {psi_deg} deg; it spans {from_deg} to {to_deg} deg")]
    Station {
        /// The station \[deg\].
        psi_deg: f64,
        /// Where the surface begins \[deg\].
        from_deg: f64,
        /// Where it ends \[deg\].
        to_deg: f64,
    },
    /// The rope surface is not wide enough for a rope beside the middle.
    #[error("the rope surface at {psi_deg} deg has nothing {offset} m beside the plane z = 0")]
    Beside {
        /// The station \[deg\].
        psi_deg: f64,
        /// Distance of the rope from the plane \[m\].
        offset: f64,
    },
    /// A gauge is not on the steel.
    #[error("gauge {gauge} lies {distance_mm:.2} mm beside the steel")]
    Gauge {
        /// Its number, from 1.
        gauge: usize,
        /// How far \[mm\], about.
        distance_mm: f64,
    },
}
