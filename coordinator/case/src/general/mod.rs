//! Cases of models that this program does not know. Unknowns, conditions, channels and objective have one
//! general form; all other settings are passed to the workers unchanged.
//!
//! ```toml
//! name = "test rig"                 # title of every report
//! records = "measured"              # or "synthetic"; measured unless stated
//!
//! [model]
//! kind = "oscillator"               # must be a kind that the workers can simulate
//! stop_mm = 30.0                    # all other keys are settings of the model, passed on unchanged
//!
//! [[unknowns]]                      # their order is that of every table of results
//! name = "stiffness"                # short, of letters, digits, `_` and `-`; used on command lines
//! title = "stiffness of the spring" # description; the name unless stated
//! symbol = "k"                      # the name unless stated
//! unit = "N/mm"                     # only shown, never converted
//! scale = "logarithmic"             # or "linear", for values that may be zero or negative
//! start = 6.0                       # best guess, where searches begin
//! lower = 1.0                       # bounds of the search
//! upper = 40.0
//! trust = [-0.5, 0.5]               # optional: range in which simulations usually succeed, relative to the start:
//!                                   # in decades, or on a linear scale in half-widths of the search interval
//! prior = [4.0, 9.0]                # optional: interval with 95 % probability; on a logarithmic scale also
//!                                   # { value = 6.0, factor = 1.5 }: 95 % between value / factor and value x factor;
//!                                   # or { value = .., deviation = .. }: standard deviation in the units of `trust`
//! absent = 0.0                      # optional: value at which the unknown has no effect; with `start = absent` it is
//!                                   # switched off and is a candidate effect of a diagnosis
//! fixed = true                      # optional: known and not searched; needs no bounds
//! suspect = "leakage"               # optional, with `absent`: unknowns with the same text form one candidate effect
//! difference = 0.01                 # optional: finite-difference step, as a share of the value; on a linear scale in
//!                                   # the unknown's unit
//! tie = { to = "other", ratio = 1.0 }   # optional: always this multiple of another unknown; needs no start or bounds
//!
//! [[conditions]]
//! name = "5hz"
//! held_out = true                   # optional: excluded from every fit, used for validation
//! drive_hz = 5.0                    # all other keys are settings of the model
//!
//! [[channels]]                      # one per quantity and condition
//! name = "force"
//! title = "force on the foundation" # the name unless stated
//! unit = "N"
//! condition = "5hz"
//! abscissa = { name = "phase", unit = "deg", period = 360.0 }   # period: only for a periodic curve
//! held_out = false                  # optional: as for a condition; or { from = 90.0, to = 180.0 }, a segment of the
//!                                   # record that `identify` and `diagnose` do not fit (a calibration uses all of it)
//! offset = "fixed"                  # optional: for this channel, instead of the objective's
//! noise = 0.05                      # standard deviation of one value; required for a record of one cycle. With
//!                                   # several cycles their scatter is used, and at least half of this variance
//! correlation = 0.8                 # optional: correlation of the noise between successive values, for a record of
//!                                   # one cycle; unless stated, a diagnosis estimates it from the best fit's residual
//! model_error = 0.02                # optional: standard deviation of the model's own error, added to the noise
//! record = { file = "measured/5hz.csv", at = "phase_deg", column = "force_n", cycle = "cycle" }
//!                                   # weight = "COLUMN": factor on each value's residual; its noise is `noise` divided
//!                                   # by it. rows = { column = "COLUMN", is = "WORD" }: use only these rows
//!
//! [[channels]]                      # a channel without a record states its abscissa points
//! name = "velocity"
//! unit = "mm/s"
//! condition = "5hz"
//! abscissa = { name = "phase", unit = "deg", period = 360.0, points = { first = 0.0, step = 3.0, count = 120 } }
//!
//! [objective]                       # minimised by a calibration: sum of weighted mean squared errors
//! condition = "5hz"                 # or ["5hz", "9hz"]: the sums of all these conditions are added; `identify` and
//!                                   # `diagnose` fit the first condition and use the others for validation
//! terms = [{ channel = "force", weight = 1.0 }]   # for every condition that has this channel
//! offset = "free"                   # for sensors without an absolute zero; or "fixed": constant differences count,
//!                                   # and a channel may be a single number
//! ```
//!
//! `[[effects]]` tables are as in every case. A record is a CSV table, compressed if its name ends in `.gz`:
//! one row per abscissa point, cycles one after the other with the same points, and the cycle number in the
//! column `cycle`; without that column there is one cycle.
mod channels;
mod conditions;
mod file;
mod objective;
mod read;
mod record;
mod unknowns;

pub use read::read;
