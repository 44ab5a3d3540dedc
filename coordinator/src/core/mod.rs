//! The sans-I/O state machine that leases jobs to workers.
