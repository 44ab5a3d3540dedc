//! What people see of a finished run.
