//! Acceptance tests of the discovery pipeline against a stand-in machine whose simulations cost a fraction of
//! a millisecond each, and against true machines whose laws differ from those of the pipeline's model.
//!
//! Sizes are those of continuous integration; `HORSEHEAD_ACCEPTANCE=full` makes every stratum large enough for
//! rates. `cargo test -p discrepancy --test acceptance -- --nocapture` prints the rates.
#![expect(
    clippy::too_many_lines,
    clippy::unused_self,
    clippy::string_slice,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::repeat_vec_with_capacity,
    reason = "a stand-in machine with known, small numbers and ASCII names"
)]
mod by_curves;
mod by_sample;
mod case;
mod composed;
mod data_value;
mod healthy;
mod identify;
mod machine;
mod maps;
mod mimic;
mod model_error;
mod nothing;
mod numerics;
mod other_minimum;
mod ringing;
mod robust;
mod single;
mod strata;
mod trial;
mod truth;
mod valley;
