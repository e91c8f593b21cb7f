//! Answers what an editor asks, as plain data.
//!
//! A [`Workspace`] holds the texts of a project as they are in the editor. After a change it says
//! what is wrong in the whole project as a check of the command line would, and looks again only
//! at what the change can have touched: a unit whose text is the same is not read again, and a body
//! is not checked again while no declaration changed. Nothing here reads files or speaks a protocol.

mod workspace;

pub use iecc_grammar::st::Dialect;
pub use workspace::Workspace;
