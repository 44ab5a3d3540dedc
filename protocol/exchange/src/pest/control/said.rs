//! What a control file says, as plain data.

/// A control file, read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// Parameters in the file's order.
    pub parameters: Vec<Parameter>,
    /// Groups of parameters, which share how they are differenced.
    pub groups: Vec<ParameterGroup>,
    /// Observations in the file's order.
    pub observations: Vec<Observation>,
    /// What runs the model.
    pub commands: Vec<String>,
    /// Template files, each with the file that is written from it.
    pub inputs: Vec<Pair>,
    /// Instruction files, each with the file that is read by it.
    pub outputs: Vec<Pair>,
    /// What is known of parameters beside their bounds, as equations.
    pub prior: Vec<PriorInformation>,
    /// Most iterations (NOPTMAX).
    pub iterations: i64,
    /// Options of PEST++ (`++name(value)`).
    pub options: Vec<(String, String)>,
    /// What was read otherwise than it stands, or not taken.
    pub notes: Vec<String>,
}

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, in small letters.
    pub name: String,
    /// How it is estimated.
    pub transform: Transform,
    /// Where it begins.
    pub initial: f64,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
    /// Its group.
    pub group: String,
    /// `scale x value + offset` is written into templates.
    pub scale: f64,
    /// See [`Self::scale`].
    pub offset: f64,
}

/// How a parameter is estimated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transform {
    /// As it is.
    None,
    /// By its logarithm.
    Log,
    /// Not at all.
    Fixed,
    /// At the ratio of the initial values to another one.
    Tied(String),
}

/// How the parameters of a group are differenced.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterGroup {
    /// Its name.
    pub name: String,
    /// What the increment counts.
    pub increment_kind: IncrementKind,
    /// Increment (DERINC).
    pub increment: f64,
    /// Least absolute increment (DERINCLB).
    pub floor: f64,
    /// How many points (FORCEN).
    pub method: Method,
    /// Factor of the increment for three points (DERINCMUL).
    pub multiplier: f64,
}

/// What an increment counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IncrementKind {
    /// A share of the parameter's value.
    Relative,
    /// The parameter's own unit.
    Absolute,
    /// A share of the greatest value in the group.
    RelativeToMax,
}

/// How many points a derivative takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Two, later three.
    Switch,
    /// Two.
    Two,
    /// Three.
    Three,
}

/// One observation.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Name, in small letters.
    pub name: String,
    /// What was measured.
    pub value: f64,
    /// Factor of its residual; 0 for a prediction.
    pub weight: f64,
    /// Its group.
    pub group: String,
}

/// A template or instruction file with the file of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Template or instructions.
    pub own: String,
    /// What the program reads or leaves.
    pub program: String,
}

/// `sum of factor x parameter = value`, with a weight.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorInformation {
    /// Name, in small letters.
    pub name: String,
    /// The left side.
    pub terms: Vec<PriorTerm>,
    /// The right side.
    pub value: f64,
    /// Factor of its residual.
    pub weight: f64,
    /// Its observation group.
    pub group: String,
}

/// A term of prior information.
#[derive(Clone, Debug, PartialEq)]
pub struct PriorTerm {
    /// Its factor.
    pub factor: f64,
    /// The parameter.
    pub parameter: String,
    /// Whether its decimal logarithm is meant.
    pub log: bool,
}
