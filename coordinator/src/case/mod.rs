//! Reads a case folder, checks it and resolves it into plain data.
