//! From a module to functions of machine code: declares every function the scan needs, compiles them
//! callees first, sums up how much stack the deepest chain of calls takes, and adds the entry.
//!
//! Whether the code is run here or written to a file is decided by who owns the `MachineModule`.

use crate::block::Block;
use crate::entry;
use crate::isa::{has_rounding, has_vectors};
use crate::plan::Plan;
use crate::translate::{Program, translate};
use crate::writes::Writes;
use cranelift_codegen::Context;
use cranelift_codegen::ir as clif;
use cranelift_entity::SecondaryMap;
use cranelift_frontend::FunctionBuilderContext;
use cranelift_module::{FuncId as DeclaredId, Linkage, Module as MachineModule, ModuleError};
use iecc_ir::{FuncId, Layout, Module};
use iecc_target::{Refusal, TargetError};

/// Most stack a scan may take. Threads have at least 2 MiB unless told otherwise.
const MAX_STACK_BYTES: u64 = 1 << 20;

/// Return address and saved frame pointer.
const FRAME_OVERHEAD_BYTES: u64 = 16;

/// A program whose functions are defined in a machine module, but for the entry.
pub(crate) struct Compiled {
    /// The memory of a controller.
    pub(crate) block: Block,
    /// The function of one scan.
    pub(crate) scan: DeclaredId,
    /// Stack a call of the entry takes at most.
    pub(crate) stack_bytes: u64,
}

/// Defines the functions of a program.
pub(crate) fn compile(
    module: &Module,
    unit: &mut dyn MachineModule,
) -> Result<Compiled, Vec<TargetError>> {
    let layout = Layout::new(&module.types);
    let plan = Plan::new(module, &layout);
    let mut program = Program {
        module,
        layout: &layout,
        plan: &plan,
        has_rounding: has_rounding(unit.isa()),
        has_vectors: has_vectors(unit.isa()),
        declared: SecondaryMap::new(),
    };
    let declared = declare(&mut program, unit);
    let stack_bytes = define(&program, unit, &declared)?;
    Ok(Compiled {
        block: Block::new(module, &plan, &Writes::new(module, &layout, &plan)),
        scan: declared[declared.len() - 1],
        stack_bytes,
    })
}

/// Defines the entry under a name.
pub(crate) fn define_entry(
    compiled: &mut Compiled,
    unit: &mut dyn MachineModule,
    name: &str,
    linkage: Linkage,
) -> Result<DeclaredId, Vec<TargetError>> {
    let pointer = unit.target_config().pointer_type();
    let mut context = unit.make_context();
    let mut frontend = FunctionBuilderContext::new();
    entry::signature(&mut context.func.signature, pointer);
    let id = declare_one(unit, name, linkage, &context.func.signature);
    entry::build(unit, compiled, &mut context.func, &mut frontend);
    unit.define_function(id, &mut context)
        .map_err(|error| refuse(&error, None))?;
    compiled.stack_bytes += frame_bytes(&context);
    Ok(id)
}

/// Declares a function whose name nothing else has.
pub(crate) fn declare_one(
    unit: &mut dyn MachineModule,
    name: &str,
    linkage: Linkage,
    signature: &clif::Signature,
) -> DeclaredId {
    let declared = unit.declare_function(name, linkage, signature);
    declared.expect("names are unique")
}

/// Declares all functions; the scan is the last.
fn declare(program: &mut Program<'_>, unit: &mut dyn MachineModule) -> Vec<DeclaredId> {
    let order = &program.plan.order;
    let pointer = unit.target_config().pointer_type();
    let mut declared = Vec::with_capacity(order.len());
    for &id in order {
        let mut signature = unit.make_signature();
        program.signature(id, &mut signature, pointer);
        // Names of users may be anything, so functions go by number.
        let name = format!("f{}", id.as_u32());
        declared.push(declare_one(unit, &name, Linkage::Local, &signature));
        program.declared[id] = declared.last().copied();
    }
    declared
}

fn define(
    program: &Program<'_>,
    unit: &mut dyn MachineModule,
    declared: &[DeclaredId],
) -> Result<u64, Vec<TargetError>> {
    let mut context = unit.make_context();
    let mut frontend = FunctionBuilderContext::new();
    let mut stack = SecondaryMap::with_default(0u64);
    for (&id, &function) in program.plan.order.iter().zip(declared) {
        let pointer = unit.target_config().pointer_type();
        context.func.signature = unit.make_signature();
        program.signature(id, &mut context.func.signature, pointer);
        translate(program, unit, id, &mut context.func, &mut frontend);
        let name = &program.module.funcs[id].name;
        unit.define_function(function, &mut context)
            .map_err(|error| refuse(&error, Some(name)))?;
        stack[id] = frame_bytes(&context) + deepest_callee(program.module, id, &stack);
        if stack[id] > MAX_STACK_BYTES {
            return Err(too_deep(name, stack[id]));
        }
        unit.clear_context(&mut context);
    }
    Ok(stack[program.module.scan])
}

fn frame_bytes(context: &Context) -> u64 {
    let compiled = context.compiled_code().expect("just compiled");
    let frame = compiled
        .buffer
        .frame_layout()
        .expect("every function has a frame");
    u64::from(frame.frame_to_fp_offset) + FRAME_OVERHEAD_BYTES
}

fn deepest_callee(module: &Module, id: FuncId, stack: &SecondaryMap<FuncId, u64>) -> u64 {
    let func = &module.funcs[id];
    let callees = func.calls();
    callees.map(|callee| stack[callee]).max().unwrap_or(0)
}

fn too_deep(name: &str, bytes: u64) -> Vec<TargetError> {
    size_error(format!(
        "@{name} and the functions it calls need {} KiB of stack, at most {} KiB are available; \
         nest calls less deeply, or use the interpreter",
        bytes >> 10,
        MAX_STACK_BYTES >> 10
    ))
}

pub(crate) fn size_error(message: String) -> Vec<TargetError> {
    vec![TargetError {
        refusal: Refusal::Size,
        origin: None,
        message,
    }]
}

/// Only limits of size are left when a verified module has been translated; anything else is a
/// mistake of ours.
pub(crate) fn refuse(error: &ModuleError, name: Option<&str>) -> Vec<TargetError> {
    use cranelift_codegen::CodegenError;
    let what = match error {
        ModuleError::Allocation { err } => err.to_string(),
        ModuleError::Compilation(CodegenError::CodeTooLarge) => "code too large".to_owned(),
        ModuleError::Compilation(CodegenError::ImplLimitExceeded) => "too many values".to_owned(),
        ModuleError::Compilation(_)
        | ModuleError::Undeclared(_)
        | ModuleError::IncompatibleDeclaration(_)
        | ModuleError::IncompatibleSignature(..)
        | ModuleError::DuplicateDefinition(_)
        | ModuleError::InvalidImportDefinition(_)
        | ModuleError::Backend(_)
        | ModuleError::Flag(_) => panic!("compiler bug in machine code: {error:?}"),
    };
    let place = name.map_or(String::new(), |name| {
        format!("@{name} is too large for machine code: ")
    });
    size_error(format!("{place}{what}; use the interpreter"))
}
