//! A controller as an object file for a linker, and the header that a C compiler reads.
//!
//! The object needs nothing but `memmove` and `memset`, and those only to move much memory; it runs at
//! any address, and has no memory that changes: the caller owns every controller as a block (`block.rs`).
//!
//! * `interface` is what the object offers, function by function.
//! * `header` says the same in C, `types` the layout of the regions, `names` makes identifiers.

mod header;
mod interface;
mod names;
mod types;

use crate::compile::compile;
use crate::isa::{Cpu, Purpose, host};
use cranelift_object::{ObjectBuilder, ObjectModule};
use header::Header;
use iecc_ir::{Module, Verified};
use iecc_target::{Artifact, Target, TargetError};
use interface::Interface;

/// The back end that writes object files for this kind of computer.
#[derive(Debug, Clone, Copy, Default)]
pub struct Object;

/// What the user chooses.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ObjectOptions {
    /// Which instructions the code may use.
    pub cpu: Cpu,
}

impl Target for Object {
    type Options = ObjectOptions;

    fn compile(
        &self,
        module: Verified<'_>,
        options: &ObjectOptions,
    ) -> Result<Vec<Artifact>, Vec<TargetError>> {
        let name = names::identifier(&module.name);
        let (bytes, interface) = object(&module, &name, options.cpu)?;
        let header = Header::new(&module, &name, &interface);
        Ok(vec![
            Artifact {
                name: format!("{name}.o"),
                bytes,
            },
            Artifact::text(format!("{name}.h"), header.text()),
        ])
    }
}

fn object(module: &Module, name: &str, cpu: Cpu) -> Result<(Vec<u8>, Interface), Vec<TargetError>> {
    let isa = host(cpu, Purpose::Link)?;
    let libcalls = cranelift_module::default_libcall_names();
    let builder = ObjectBuilder::new(isa, name, libcalls);
    let mut unit = ObjectModule::new(builder.expect("objects exist for every host"));
    let compiled = compile(module, &mut unit)?;
    let interface = interface::define(module, name, compiled, &mut unit)?;
    let bytes = unit.finish().emit();
    Ok((bytes.expect("an object of defined functions"), interface))
}
