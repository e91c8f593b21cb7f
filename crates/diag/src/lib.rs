//! Says what is wrong.
//!
//! A [`Diagnostic`] is data: a [`Code`] from the one table in `codes.rs`, a message, labelled
//! places, notes and perhaps a [`Fix`]. Producers push into [`Diagnostics`] and go on; only the
//! command line turns them into text ([`render_text`]) or JSON lines ([`render_json`]).
//! User mistakes are diagnostics; compiler mistakes are panics labelled as ours.

mod codes;
mod diagnostic;
mod excerpt;
mod render;
mod suggest;

pub use codes::{Code, Severity};
pub use diagnostic::{Diagnostic, Diagnostics, Fix, Label};
pub use render::{render_json, render_text};
pub use suggest::{closest, closest_within};
