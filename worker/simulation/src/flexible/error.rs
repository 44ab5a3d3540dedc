//! Errors of the reduction of a head to modes and influence lines.

/// Reason why a head cannot be reduced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReductionError {
    /// The mesh is incomplete or inconsistent.
    #[error("the mesh cannot be used: {what}")]
    Mesh {
        /// Description of the defect.
        what: &'static str,
    },
    /// The mesh is not symmetric with respect to the plane z = 0.
    #[error(
        "the mesh is not its own mirror image in the plane z = 0: nothing stands opposite \
         ({x:.4}, {y:.4}, {z:.4}) m. Free meshers do not mirror: mesh the half z >= 0 alone, \
         with its cut face as physical group `symmetry`, or mirror that half's mesh"
    )]
    NotMirrored {
        /// x coordinate of the node without a mirror image \[m\].
        x: f64,
        /// y coordinate of the node without a mirror image \[m\].
        y: f64,
        /// z coordinate of the node without a mirror image \[m\].
        z: f64,
    },
    /// The Jacobian of an element is not positive at some integration point.
    #[error(
        "element {element} (counted from 0 in the half z > 0 of the mesh) is inverted or has no volume: its Jacobian is not positive"
    )]
    InvertedElement {
        /// Index of the inverted element in the mesh.
        element: usize,
    },
    /// The stiffness matrix is not positive definite: the held nodes leave a rigid motion free.
    #[error(
        "the held nodes of the mesh leave a rigid motion of the head free: hold at least three nodes that are not on one line"
    )]
    NotPositiveDefinite,
    /// The Cholesky factor does not fit into memory.
    #[error(
        "the stiffness factor for {unknowns} unknowns does not fit into memory: use a coarser mesh"
    )]
    TooLarge {
        /// Number of unknown displacements of the half model, which is the order of the matrix.
        unknowns: usize,
    },
    /// Fewer modes converged than were requested.
    #[error(
        "the {wanted} requested modes did not converge within {steps} Lanczos steps: request fewer modes"
    )]
    Modes {
        /// Number of modes requested.
        wanted: usize,
        /// Number of Lanczos steps made before giving up.
        steps: usize,
    },
    /// A station, at which mode shapes are evaluated, lies outside the angular range of the rope surface.
    #[error(
        "the rope surface does not reach the station at {psi_deg} deg: it spans {from_deg} to {to_deg} deg"
    )]
    Station {
        /// Angle of the station outside the range \[deg\].
        psi_deg: f64,
        /// Angle where the rope surface begins \[deg\].
        from_deg: f64,
        /// Angle where the rope surface ends \[deg\].
        to_deg: f64,
    },
    /// The rope surface is too narrow for a rope at the given distance from the plane of symmetry.
    #[error(
        "the rope surface at {psi_deg} deg is too narrow for a rope {offset} m from the plane z = 0"
    )]
    OutsideRim {
        /// Angle of the station \[deg\].
        psi_deg: f64,
        /// Distance of the rope from the plane z = 0 \[m\].
        offset: f64,
    },
    /// A unit load is requested that the surface does not have.
    #[error("unit load {index} of the surface does not exist: there are {count}")]
    UnitLoad {
        /// Index of the requested load.
        index: usize,
        /// Number of loads.
        count: usize,
    },
    /// An end of a gauge lies in no element.
    #[error(
        "an end of gauge {gauge} lies more than 1 mm outside the mesh: check the gauge's position, direction and length"
    )]
    Gauge {
        /// Number of the gauge with an end outside the mesh, from 1.
        gauge: usize,
    },
}
