//! Proofs of the dynamics: every test opens with its story and its formula.
//!
//! Expected values come from closed forms, from other programs' results or from conservation laws,
//! never through the code under test.
mod bounce;
mod determinism;
mod energy;
mod frame;
mod order;
mod reference;
mod rope;
mod statics;
mod tangent;
mod vibration;
mod work;
