//! Tests that apply to every effect of the catalogue.
mod contract;
mod force;
mod load_cell_lag;
mod shape;
