//! Web server of the pages of runs: a page is a list of rendered sections, which are replaced in the browser as
//! they change.
//!
//! A [`Board`] holds the sections of one page; its owner publishes new ones, and [`serve`] sends those that
//! have changed to every reader as server-sent events, whose id is the version of the page. A slow
//! reader skips what was replaced meanwhile. The server reads no run and knows no model; every request is
//! answered from memory, and none changes anything.
mod access;
mod board;
mod page;
mod server;

pub use access::allowed_hosts;
pub use board::{Board, PageReader, PageState, Rendered, Version};
pub use server::{Pages, serve};
