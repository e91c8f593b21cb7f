//! Finished machine code: the only place where it is entered and freed.

use crate::context::ScanContext;
use cranelift_jit::JITModule;
use cranelift_module::{FuncId, ModuleError};
use std::mem::ManuallyDrop;

/// The signature of the scan function: `(context, state) -> status`.
type Scan = unsafe extern "C" fn(*mut ScanContext, *mut u8) -> u32;

/// Owns the memory of compiled functions.
pub(crate) struct Code {
    module: ManuallyDrop<JITModule>,
    scan: Option<Scan>,
}

impl Code {
    /// Takes over a module whose functions are defined, or whose definition failed.
    pub(crate) fn new(module: JITModule) -> Self {
        Self {
            module: ManuallyDrop::new(module),
            scan: None,
        }
    }

    /// Makes the code executable. `scan` is the function of a scan, declared with the signature
    /// [`Scan`] in the calling convention of the host.
    pub(crate) fn finish(&mut self, scan: FuncId) -> Result<(), Box<ModuleError>> {
        self.module.finalize_definitions().map_err(Box::new)?;
        let address = self.module.get_finalized_function(scan);
        // SAFETY: `address` is the entry of the function that was compiled from the scan of a
        // verified module, which has no parameters and results; `Program::signature` therefore gave
        // it two pointers and an `i32` in the default convention of the host, which is `extern "C"`.
        self.scan = Some(unsafe { std::mem::transmute::<*const u8, Scan>(address) });
        Ok(())
    }

    /// Runs one scan; 0 or the number of a fault. The regions must have the sizes of the module.
    pub(crate) fn run(&self, context: &mut ScanContext, state: &mut [u8]) -> u32 {
        let scan = self.scan.expect("the code is finished");
        // SAFETY: the code lives as long as `self`. It reads and writes the context, the state and,
        // through the context, the inputs and outputs; every address it forms lies inside the
        // region or the local the place belongs to, since constant indices are verified and others compared with
        // their bounds first (`translate/memory.rs`), and the engine has checked the sizes of the
        // regions. Nothing else refers to them during the call. It calls only itself, the two
        // rounding functions and the two below, never unwinds, ends (`plan.rs`), and needs no more stack than
        // `compile.rs` allows.
        unsafe { scan(context, state.as_mut_ptr()) }
    }
}

/// Moves bytes for machine code.
///
/// # Safety
/// Both ranges are memory that may be accessed.
pub(crate) unsafe extern "C" fn copy_bytes(to: *mut u8, from: *const u8, len: usize) -> *mut u8 {
    // SAFETY: said above; machine code passes places of one type, which lie in regions and locals.
    unsafe { std::ptr::copy(from, to, len) };
    to
}

/// Fills bytes for machine code.
///
/// # Safety
/// The range is memory that may be changed.
pub(crate) unsafe extern "C" fn fill_bytes(to: *mut u8, byte: i32, len: usize) -> *mut u8 {
    // SAFETY: said above; machine code passes a place, which lies in a region or local.
    unsafe { std::ptr::write_bytes(to, byte as u8, len) };
    to
}

impl Drop for Code {
    fn drop(&mut self) {
        self.scan = None;
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
