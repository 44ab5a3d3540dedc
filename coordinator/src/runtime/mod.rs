//! The asynchronous glue between link, core and journal.
