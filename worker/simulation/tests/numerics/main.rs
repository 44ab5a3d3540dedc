//! Tests of the dynamics against known solutions; every test begins with a description and its formula.
//!
//! Expected values come from closed forms, from other programs' results or from conservation laws, never from
//! the code under test.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "helpers of tests; what was measured is printed; closed forms use the C library's functions"
)]
mod bounce;
mod box_of_genes;
mod determinism;
mod dual;
mod effect;
mod energy;
mod forced;
mod frame;
mod implicit;
mod order;
mod plane;
mod reference;
mod rope;
mod sensitivity;
mod statics;
mod swing;
mod tangent;
mod twins;
mod vibration;
mod weight;
mod work;
