//! Contents of a control file as plain data.

/// Parsed control file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// Parameters in the file's order.
    pub parameters: Vec<Parameter>,
    /// Parameter groups, which share the settings for finite differences.
    pub groups: Vec<ParameterGroup>,
    /// Observations in the file's order.
    pub observations: Vec<Observation>,
    /// Command lines that run the model.
    pub commands: Vec<String>,
    /// Template files, each with the model input file written from it.
    pub inputs: Vec<Pair>,
    /// Instruction files, each with the model output file read by it.
    pub outputs: Vec<Pair>,
    /// Prior information on parameters, as linear equations.
    pub prior: Vec<PriorInformation>,
    /// Maximum number of iterations (NOPTMAX).
    pub iterations: i64,
    /// Options of PEST++ (`++name(value)`).
    pub options: Vec<(String, String)>,
    /// Notes on entries that were interpreted differently from their text or ignored.
    pub notes: Vec<String>,
}

/// Parameter of a control file.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in lower case.
    pub name: String,
    /// Transformation under which the parameter is estimated.
    pub transform: Transform,
    /// Initial value.
    pub initial: f64,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Name of its parameter group.
    pub group: String,
    /// Factor in `scale x value + offset`, the number written into templates.
    pub scale: f64,
    /// Summand in `scale x value + offset`; see [`Self::scale`].
    pub offset: f64,
}

/// Transformation of a parameter for estimation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transform {
    /// Estimated without a transformation.
    None,
    /// Estimated by its logarithm.
    Log,
    /// Held at its initial value.
    Fixed,
    /// Tied to the named parameter at the ratio of the initial values.
    Tied(String),
}

/// Finite-difference settings of a parameter group.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterGroup {
    /// Name of the group.
    pub name: String,
    /// Reference of the increment: the value, the greatest value in the group, or an absolute number.
    pub increment_kind: IncrementKind,
    /// Increment (DERINC), in units given by the increment kind.
    pub increment: f64,
    /// Minimum absolute increment (DERINCLB).
    pub floor: f64,
    /// Number of points of a difference (FORCEN).
    pub method: Method,
    /// Factor on the increment for three-point differences (DERINCMUL).
    pub multiplier: f64,
}

/// Reference of an increment (INCTYP).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IncrementKind {
    /// Fraction of the parameter's value.
    Relative,
    /// Absolute number in the parameter's unit.
    Absolute,
    /// Fraction of the greatest value in the group.
    RelativeToMax,
}

/// Number of points of a finite difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Two points at first, three in later iterations.
    Switch,
    /// Two points.
    Two,
    /// Three points.
    Three,
}

/// Observation of a control file.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Name in lower case.
    pub name: String,
    /// Measured value.
    pub value: f64,
    /// Factor on the residual; 0 for a prediction.
    pub weight: f64,
    /// Name of its observation group.
    pub group: String,
}

/// Template or instruction file together with the model's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Path of the template or instruction file.
    pub own: String,
    /// Path of the model's input or output file.
    pub program: String,
}

/// Prior information: the weighted equation `sum of factor x parameter = value`.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorInformation {
    /// Name in lower case.
    pub name: String,
    /// Terms on the left-hand side.
    pub terms: Vec<PriorTerm>,
    /// Right-hand side.
    pub value: f64,
    /// Factor on the residual of the equation.
    pub weight: f64,
    /// Name of its observation group.
    pub group: String,
}

/// Term of prior information.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorTerm {
    /// Factor on the parameter or its logarithm.
    pub factor: f64,
    /// Name of the parameter.
    pub parameter: String,
    /// Whether the term uses the parameter's decimal logarithm.
    pub log: bool,
}
