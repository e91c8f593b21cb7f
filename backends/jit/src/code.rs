//! Finished machine code: the only place where it is made executable, entered and freed.

use crate::block::Block;
use crate::compile::{Compiled, compile, define_entry, refuse, size_error};
use crate::isa::{Cpu, Purpose, host};
use cranelift_jit::{ArenaMemoryProvider, JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, ModuleError};
use iecc_ir::Module;
use iecc_target::TargetError;
use std::mem::ManuallyDrop;

/// Address space for code; pages are only taken as they are filled. One piece, so that calls reach
/// every function.
const CODE_BYTES: usize = 256 << 20;

/// The signature of the entry: `(block, inputs, outputs, now) -> status`.
type Entry = unsafe extern "C" fn(*mut u8, *const u8, *mut u8, u64) -> u32;

/// The machine code of a program and the layout of its memory, or why there is none.
pub(crate) fn load(module: &Module) -> Result<(Code, Block), Vec<TargetError>> {
    let mut unit = new_unit()?;
    let made = compile_all(module, &mut unit);
    // Owns the memory from here on, so that it is freed whatever happens.
    let mut code = Code::new(unit);
    let (entry, compiled) = made?;
    code.finish(entry).map_err(|error| refuse(&error, None))?;
    Ok((code, compiled.block))
}

fn compile_all(
    module: &Module,
    unit: &mut JITModule,
) -> Result<(FuncId, Compiled), Vec<TargetError>> {
    let mut compiled = compile(module, unit)?;
    let entry = define_entry(&mut compiled, unit, "scan", Linkage::Local)?;
    Ok((entry, compiled))
}

fn new_unit() -> Result<JITModule, Vec<TargetError>> {
    let isa = host(Cpu::Native, Purpose::Run)?;
    let names = cranelift_module::default_libcall_names();
    let mut builder = JITBuilder::with_isa(isa, names);
    let memory = ArenaMemoryProvider::new_with_size(CODE_BYTES)
        .map_err(|error| size_error(format!("no memory for machine code: {error}")))?;
    builder.memory_provider(Box::new(memory));
    builder.symbol("memmove", copy_bytes as *const u8);
    builder.symbol("memset", fill_bytes as *const u8);
    Ok(JITModule::new(builder))
}

/// Owns the memory of compiled functions.
pub(crate) struct Code {
    module: ManuallyDrop<JITModule>,
    entry: Option<Entry>,
}

impl Code {
    /// Takes over a module whose functions are defined, or whose definition failed.
    pub(crate) fn new(module: JITModule) -> Self {
        Self {
            module: ManuallyDrop::new(module),
            entry: None,
        }
    }

    /// Makes the code executable. `entry` was made by `define_entry`.
    pub(crate) fn finish(&mut self, entry: FuncId) -> Result<(), Box<ModuleError>> {
        self.module.finalize_definitions().map_err(Box::new)?;
        let address = self.module.get_finalized_function(entry);
        // SAFETY: `address` is the entry of the function that `define_entry` made, to which
        // `entry::signature` gave three pointers, an `i64` and the result `i32` in the default
        // convention of the host, which is `extern "C"`.
        self.entry = Some(unsafe { std::mem::transmute::<*const u8, Entry>(address) });
        Ok(())
    }

    /// Runs one scan; 0 or the number of a fault. `block` must be one of the program, and the regions
    /// must have the sizes of the module.
    pub(crate) fn run(
        &self,
        block: &mut [u8],
        inputs: &[u8],
        outputs: &mut [u8],
        now_ns: u64,
    ) -> u32 {
        let entry = self.entry.expect("the code is finished");
        // SAFETY: the code lives as long as `self`. It reads and writes the block, the outputs and
        // its stack, and reads the inputs; every address it forms lies inside the region or the local
        // the place belongs to, since constant indices are verified and others compared with their bounds first
        // (`translate/memory.rs`), the entry stays inside the block (`block.rs`), and the engine has
        // checked the sizes of the regions. Nothing else refers to them during the call. It calls
        // only itself and the two functions below, never unwinds, ends (`plan.rs`), and needs no more stack than `compile.rs`
        // allows.
        unsafe {
            entry(
                block.as_mut_ptr(),
                inputs.as_ptr(),
                outputs.as_mut_ptr(),
                now_ns,
            )
        }
    }
}

/// Moves bytes for machine code.
///
/// # Safety
/// Both ranges are memory that may be accessed.
unsafe extern "C" fn copy_bytes(to: *mut u8, from: *const u8, len: usize) -> *mut u8 {
    // SAFETY: said above; machine code passes places of one type, which lie in regions and locals.
    unsafe { std::ptr::copy(from, to, len) };
    to
}

/// Fills bytes for machine code.
///
/// # Safety
/// The range is memory that may be changed.
unsafe extern "C" fn fill_bytes(to: *mut u8, byte: i32, len: usize) -> *mut u8 {
    // SAFETY: said above; machine code passes a place, which lies in a region or local.
    unsafe { std::ptr::write_bytes(to, byte as u8, len) };
    to
}

impl Drop for Code {
    fn drop(&mut self) {
        self.entry = None;
        // SAFETY: `module` is not used again. Nobody else holds an address of the code, and none of
        // it is running, for `run` borrows `self`.
        unsafe { ManuallyDrop::take(&mut self.module).free_memory() };
    }
}

impl std::fmt::Debug for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Code").finish_non_exhaustive()
    }
}
