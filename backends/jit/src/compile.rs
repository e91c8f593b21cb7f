//! From a module to machine code: declares every function the scan needs, compiles them callees
//! first, and sums up how much stack the deepest chain of calls takes.

use crate::code::{Code, copy_bytes, fill_bytes};
use crate::plan::{Plan, calls};
use crate::translate::{Program, translate};
use cranelift_codegen::Context;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_entity::SecondaryMap;
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::{FuncId as DeclaredId, Linkage, Module as _, ModuleError};
use iecc_ir::{FuncId, Layout, Module};
use iecc_target::{Refusal, TargetError};

/// Address space for code; pages are only taken as they are filled. One piece, so that calls reach
/// every function.
const CODE_BYTES: usize = 256 << 20;

/// Most stack a scan may take. Threads have at least 2 MiB unless told otherwise.
const MAX_STACK_BYTES: u64 = 1 << 20;

/// Return address and saved frame pointer.
const FRAME_OVERHEAD_BYTES: u64 = 16;

/// The machine code of a program, or why there is none.
pub(crate) fn compile(
    module: &Module,
    layout: &Layout,
    plan: &Plan,
) -> Result<Code, Vec<TargetError>> {
    let mut jit = new_module()?;
    let mut program = Program {
        module,
        layout,
        plan,
        declared: SecondaryMap::new(),
    };
    let declared = declare(&mut program, &mut jit);
    let defined = define(&program, &mut jit, &declared);
    // Owns the memory from here on, so that it is freed whatever happens.
    let mut code = Code::new(jit);
    defined?;
    code.finish(declared[declared.len() - 1])
        .map_err(|error| refuse(&error, None))?;
    Ok(code)
}

fn new_module() -> Result<JITModule, Vec<TargetError>> {
    let isa = host()?;
    let names = cranelift_module::default_libcall_names();
    let mut builder = JITBuilder::with_isa(isa, names);
    let memory = ArenaMemoryProvider::new_with_size(CODE_BYTES)
        .map_err(|error| size_error(format!("no memory for machine code: {error}")))?;
    builder.memory_provider(Box::new(memory));
    // What processors without SSE4.1 call to round.
    builder.symbol("nearbyintf", round_f32 as *const u8);
    builder.symbol("nearbyint", round_f64 as *const u8);
    builder.symbol("memmove", copy_bytes as *const u8);
    builder.symbol("memset", fill_bytes as *const u8);
    Ok(JITModule::new(builder))
}

extern "C" fn round_f32(x: f32) -> f32 {
    x.round_ties_even()
}

extern "C" fn round_f64(x: f64) -> f64 {
    x.round_ties_even()
}

fn host() -> Result<OwnedTargetIsa, Vec<TargetError>> {
    let mut flags = settings::builder();
    let verifier = if cfg!(debug_assertions) {
        "true"
    } else {
        "false"
    };
    for (name, value) in [
        ("opt_level", "speed"),
        ("enable_verifier", verifier),
        ("enable_nan_canonicalization", "true"),
        // Functions of the IR return as many values as they like.
        ("enable_multi_ret_implicit_sret", "true"),
        // A large frame touches every page on its way down, so that it cannot skip the guard page.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
        ("unwind_info", "false"),
        ("is_pic", "false"),
        ("use_colocated_libcalls", "false"),
    ] {
        flags.set(name, value).expect("a flag of Cranelift");
    }
    let unfit = |what: String| {
        vec![TargetError {
            refusal: Refusal::Option,
            origin: None,
            message: format!("this computer has no JIT: {what}; use the interpreter"),
        }]
    };
    let isa = cranelift_native::builder().map_err(|what| unfit(what.to_owned()))?;
    isa.finish(settings::Flags::new(flags))
        .map_err(|error| unfit(error.to_string()))
}

/// Declares all functions; the scan is the last.
fn declare(program: &mut Program<'_>, jit: &mut JITModule) -> Vec<DeclaredId> {
    let order = &program.plan.order;
    let pointer = jit.target_config().pointer_type();
    let mut declared = Vec::with_capacity(order.len());
    for &id in order {
        let mut signature = jit.make_signature();
        program.signature(id, &mut signature, pointer);
        // Names of users may be anything, so functions go by number.
        let name = format!("f{}", id.as_u32());
        let function = jit.declare_function(&name, Linkage::Local, &signature);
        declared.push(function.expect("numbers are unique"));
        program.declared[id] = declared.last().copied();
    }
    declared
}

fn define(
    program: &Program<'_>,
    jit: &mut JITModule,
    declared: &[DeclaredId],
) -> Result<(), Vec<TargetError>> {
    let mut context = jit.make_context();
    let mut frontend = FunctionBuilderContext::new();
    let mut stack = SecondaryMap::with_default(0u64);
    for (&id, &function) in program.plan.order.iter().zip(declared) {
        let pointer = jit.target_config().pointer_type();
        context.func.signature = jit.make_signature();
        program.signature(id, &mut context.func.signature, pointer);
        translate(program, jit, id, &mut context.func, &mut frontend);
        let name = &program.module.funcs[id].name;
        jit.define_function(function, &mut context)
            .map_err(|error| refuse(&error, Some(name)))?;
        stack[id] = frame_bytes(&context) + deepest_callee(program.module, id, &stack);
        if stack[id] > MAX_STACK_BYTES {
            return Err(too_deep(name, stack[id]));
        }
        jit.clear_context(&mut context);
    }
    Ok(())
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
    let callees = func.layout.iter().flat_map(|&block| calls(func, block));
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

fn size_error(message: String) -> Vec<TargetError> {
    vec![TargetError {
        refusal: Refusal::Size,
        origin: None,
        message,
    }]
}

/// Only limits of size are left when a verified module has been translated; anything else is a
/// mistake of ours.
fn refuse(error: &ModuleError, name: Option<&str>) -> Vec<TargetError> {
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
        | ModuleError::Flag(_) => panic!("compiler bug in the JIT: {error:?}"),
    };
    let place = name.map_or(String::new(), |name| {
        format!("@{name} is too large for the JIT: ")
    });
    size_error(format!("{place}{what}; use the interpreter"))
}
