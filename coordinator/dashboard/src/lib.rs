//! Dashboard: follows runs by their journals and shows them in a browser.
//!
//! `follow` reads the journal of a run as it grows; `state` is the fold over its events; `sections` turns what is known so
//! far into the sections of the report; `simulator` simulates individuals with a worker of the dashboard's own; `folder`
//! lists the runs of a folder. Nothing is written into a run folder.
//!
//! A page is a list of rendered sections. Its `board` holds them, and [`serve`] sends those that have changed to every
//! reader as server-sent events, whose id is the version of the page. A slow reader skips what was replaced meanwhile.
//! The server reads no run and knows no model; every request is answered from memory, and none changes anything. `port`
//! opens the listening socket; `token` is the secret that browsers show.
mod access;
mod board;
mod folder;
mod follow;
mod page;
mod port;
mod sections;
mod server;
mod simulator;
mod state;
mod token;

pub use folder::FolderPages;
pub use follow::RunPages;
pub use port::{DEFAULT_PORT, listen, listen_near};
pub use server::{Pages, serve};
pub use token::token;
