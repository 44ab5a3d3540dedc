//! Dashboard: follows runs by their journals and shows them in a browser.
//!
//! `follow` reads the journal of a run as it grows; `state` is the fold over its events; `sections` turns what is known so
//! far into the sections of the report; `simulator` simulates individuals with a worker of the dashboard's own; `folder`
//! lists the runs of a folder; `port` opens the listening socket; `token` is the secret that browsers show; `attached` is
//! the dashboard of `--dashboard`, in a process of its own. Nothing is written into a run folder.
mod attached;
mod folder;
mod follow;
mod port;
mod sections;
mod simulator;
mod state;
mod token;

pub(crate) use attached::AttachedDashboard;
pub(crate) use folder::FolderPages;
pub(crate) use follow::RunPages;
pub(crate) use port::{DEFAULT_PORT, listen, listen_near};
pub(crate) use token::token;
