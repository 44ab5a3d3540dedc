//! Cases of models that are programs of the user's own: the kind `command`.
//!
//! ```toml
//! [model]
//! kind = "command"
//! entry = "decay"                         # name of the entry in a machine's list of what may be started
//! command = ["python3", "model.py"]       # optional: what `horsehead allow` proposes for it
//! version = ["python3", "--version"]      # optional, the same: machines on which it says other things do not
//!                                         # work on one run
//! files = ["model.py", "tables"]          # optional: files and folders beside this one that travel with the case
//! deadline_s = 60.0                       # how long one run may take
//! repeatable = false                      # optional: whether equal inputs give equal bits everywhere
//! reference_tolerance = 1e-3              # optional, where they do not: how far each machine's run of the start
//!                                         # may lie from the first one's, as a share of each channel's size
//! verdicts = { 3 = "diverged" }           # optional: exit statuses that say something of the individual, and
//!                                         # are not tried again
//! inputs = [
//!     { file = "model.in", template = "model.tpl" },     # a template of PEST
//!     { file = "job.txt", braces = "job.txt.in" },       # or a text with {name}
//!     { file = "params.in", dakota = "standard" },       # or Dakota's parameters: standard, aprepro, json
//! ]
//! outputs = [
//!     { file = "model.out", instructions = "model.ins" },  # instructions of PEST: named values
//!     { file = "results.out", dakota = ["w1", "w2"] },     # Dakota's results: named values
//!     { file = "curve.csv" },                              # a table with a header
//!     { file = "curve.json" },                             # an object
//! ]
//! # optional: values that follow from the parameters alone, as PEST's prior information
//! equations = [{ name = "belief", terms = [{ parameter = "young", factor = 1.0, log = true }] }]
//! # optional: how unknowns are written, where not by their own name and value
//! parameters = { load = { name = "Q", factor = -1.0, offset = 0.0 } }
//!
//! [[conditions]]
//! name = "slow"
//! values = { speed = 5.0 }                # optional: what templates are filled in with beside the unknowns
//!
//! [[channels]]                            # as in every case, and where its values come from:
//! source = { file = "curve.csv", column = "force_n", at = "time_s" }   # brought to the record's places
//! source = { file = "curve.json", values = "/force", at = "/time" }    # the same
//! source = { named = ["w1", "w2"] }                                    # named values, place by place
//! ```
mod allow;
mod assemble;
mod file;
mod files;
pub mod import;
pub(crate) mod kind;
mod parameters;

pub use allow::{Proposal, proposed};
