//! Function blocks, classes and interfaces: who extends whom, whether it may, what instances are made
//! of, and which body runs when a method is called.

mod dispatch;
mod heritage;
mod instance;
mod rules;

pub(crate) use dispatch::Dispatcher;
pub(crate) use heritage::Families;
pub(crate) use instance::InstancePart;
