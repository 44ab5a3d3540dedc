//! Contents of a PEST control file as plain data.

/// Contents of a PEST control file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// Parameters of the model, in the control file's order.
    pub parameters: Vec<Parameter>,
    /// Parameter groups, which share the settings for finite differences.
    pub groups: Vec<ParameterGroup>,
    /// Observations to which the model is calibrated, in the control file's order.
    pub observations: Vec<Observation>,
    /// Command lines that run the model.
    pub commands: Vec<String>,
    /// Template files, each with the model input file written from it.
    pub inputs: Vec<FilePair>,
    /// Instruction files, each with the model output file read by it.
    pub outputs: Vec<FilePair>,
    /// Prior information on parameters, as linear equations.
    pub prior: Vec<PriorInformation>,
    /// Notes on parts of the control file that were ignored or interpreted differently from their text.
    pub notes: Vec<String>,
}

/// Parameter of a control file.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the parameter in lower case.
    pub name: String,
    /// Transformation under which the parameter is estimated.
    pub transform: Transform,
    /// Initial value of the parameter.
    pub initial: f64,
    /// Lower bound of the parameter.
    pub lower: f64,
    /// Upper bound of the parameter.
    pub upper: f64,
    /// Name of the parameter group that contains the parameter.
    pub group: String,
    /// Factor in `scale x value + offset`, the number written into templates.
    pub scale: f64,
    /// Summand `offset` in `scale x value + offset`, the number written into templates.
    pub offset: f64,
}

/// Transformation of a parameter during estimation, or the reason why it is not estimated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transform {
    /// Parameter is estimated without a transformation.
    None,
    /// Parameter is estimated by its logarithm.
    Log,
    /// Parameter is held at its initial value.
    Fixed,
    /// Tied to the named parameter at the ratio of the initial values.
    Tied(String),
}

/// Finite-difference settings of a parameter group.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterGroup {
    /// Name of the parameter group.
    pub name: String,
    /// Reference of the finite-difference increment: the value, the greatest value in the group, or an
    /// absolute number.
    pub increment_kind: IncrementKind,
    /// Finite-difference increment (DERINC); its unit follows from the increment kind.
    pub increment: f64,
    /// Minimum absolute increment (DERINCLB).
    pub floor: f64,
}

/// Reference of a finite-difference increment (INCTYP).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IncrementKind {
    /// Increment is a fraction of the parameter's value.
    Relative,
    /// Increment is an absolute number in the parameter's unit.
    Absolute,
    /// Increment is a fraction of the greatest parameter value in the group.
    RelativeToMax,
}

/// Observation of a PEST control file: measured value and weight of a model output.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Name of the observation in lower case.
    pub name: String,
    /// Measured value of the observation.
    pub value: f64,
    /// Factor on the residual of the observation; 0 for a mere prediction.
    pub weight: f64,
    /// Name of the observation group that contains the observation.
    pub group: String,
}

/// Side on which the observations of a group limit the model, by the beginning of the group's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitSide {
    /// Upper limit: a residual only where the model exceeds the observation (`less..`, `l_..`, `>@..`).
    AtMost,
    /// Lower limit: a residual only where the model stays below the observation (`greater..`, `g_..`, `<@..`).
    AtLeast,
}

impl LimitSide {
    /// Returns the side of an observation group; `None` for equalities.
    pub fn of_group(name: &str) -> Option<Self> {
        let begins = |words: [&str; 3]| words.iter().any(|word| name.starts_with(word));
        if begins(["less", "l_", ">@"]) {
            Some(Self::AtMost)
        } else if begins(["greater", "g_", "<@"]) {
            Some(Self::AtLeast)
        } else {
            None
        }
    }
}

/// PEST template or instruction file, paired with the model file that is written from it or read by it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePair {
    /// Path of the template or instruction file.
    pub own: String,
    /// Path of the model's input or output file.
    pub program: String,
}

/// Prior information: the weighted equation `sum of factor x parameter = value`.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorInformation {
    /// Name of the equation in lower case.
    pub name: String,
    /// Terms on the left-hand side of the equation.
    pub terms: Vec<PriorTerm>,
    /// Right-hand side of the equation.
    pub value: f64,
    /// Factor on the residual of the equation.
    pub weight: f64,
    /// Name of the observation group of the equation.
    pub group: String,
}

/// Term of a prior information equation: a factor times a parameter or its logarithm.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorTerm {
    /// Factor on the parameter or its logarithm.
    pub factor: f64,
    /// Name of the parameter in the term.
    pub parameter: String,
    /// Whether the term uses the parameter's decimal logarithm.
    pub log: bool,
}
