//! Links functions of the standard library into a program of ladder.
//!
//! The library is lowered as a program of its own, from which a function is copied with what it calls
//! on first use, once per timer unit. Its structures are those of the program with the same names,
//! which have the same fields; that is checked when linking.

use crate::types::TypeMap;
use crate::{MILLISECOND_NS, Options, lower};
use cranelift_entity::PrimaryMap;
use iecc_ir::{FieldDef, FuncId, Function, Inst, InstData, MemType, Module, StructId};
use iecc_sema::hir;
use std::collections::BTreeMap;

/// The library and what of it is linked.
pub(crate) struct Library {
    module: Option<Module>,
    linked: BTreeMap<(String, u64), FuncId>,
}

impl Library {
    pub(crate) fn new(program: &hir::Program) -> Self {
        let library = program.stdlib.as_deref();
        Self {
            module: library.map(|library| lower(library, &Options::default())),
            linked: BTreeMap::new(),
        }
    }

    /// The function with this name, with its time counted in units.
    pub(crate) fn link(
        &mut self,
        name: &str,
        unit_ns: u64,
        funcs: &mut PrimaryMap<FuncId, Function>,
        types: &mut TypeMap<'_>,
    ) -> FuncId {
        let func = self.module().func_named(name);
        let func = func.unwrap_or_else(|| panic!("the library has no function @{name}"));
        self.copy(func, unit_ns, funcs, types)
    }

    fn module(&self) -> &Module {
        let module = self.module.as_ref();
        module.expect("programs of ladder bring their library")
    }

    /// Library code calls a few levels deep at most.
    fn copy(
        &mut self,
        func: FuncId,
        unit_ns: u64,
        funcs: &mut PrimaryMap<FuncId, Function>,
        types: &mut TypeMap<'_>,
    ) -> FuncId {
        let mut copy = self.module().funcs[func].clone();
        let unit_ns = if counts_time(&copy) {
            unit_ns
        } else {
            MILLISECOND_NS
        };
        let key = (copy.name.clone(), unit_ns);
        if let Some(&linked) = self.linked.get(&key) {
            return linked;
        }
        copy.name = linked_name(&copy.name, unit_ns);
        for param in copy.refs.values_mut() {
            param.ty = self.linked_type(param.ty, types);
        }
        for block in copy.layout.clone() {
            copy.block_mut(block).terminator_origin = None;
        }
        for inst in instructions(&copy) {
            // What is inlined then has the origin of the call, its rung.
            copy.set_origin(inst, None);
            match copy.inst_mut(inst) {
                InstData::Call { func, .. } => *func = self.copy(*func, unit_ns, funcs, types),
                InstData::Elapsed { unit_ns: unit, .. } => *unit = unit_ns,
                InstData::Const { .. }
                | InstData::Unary { .. }
                | InstData::Binary { .. }
                | InstData::Compare { .. }
                | InstData::Convert { .. }
                | InstData::Select { .. }
                | InstData::Load { .. }
                | InstData::Store { .. }
                | InstData::Copy { .. }
                | InstData::Clear { .. }
                | InstData::Address { .. }
                | InstData::Now
                | InstData::Step { .. } => {}
            }
        }
        let id = funcs.push(copy);
        self.linked.insert(key, id);
        id
    }

    fn linked_type(&self, ty: MemType, types: &mut TypeMap<'_>) -> MemType {
        let MemType::Struct(id) = ty else {
            panic!("library functions refer to structures")
        };
        let def = &self.module().types.structs[id];
        let linked: StructId = types.predefined(&def.name);
        let stored = |field: &FieldDef| (field.name.clone(), field.ty);
        let [own, program] = [def, &types.table().structs[linked]]
            .map(|def| def.fields.iter().map(stored).collect::<Vec<_>>());
        assert_eq!(own, program, "library and program agree on {}", def.name);
        MemType::Struct(linked)
    }
}

/// Whether a function itself looks at the time; only these exist once per unit.
fn counts_time(func: &Function) -> bool {
    let mut all = instructions(func).into_iter();
    all.any(|inst| matches!(func.inst(inst), InstData::Elapsed { .. }))
}

fn instructions(func: &Function) -> Vec<Inst> {
    let blocks = func.layout.iter();
    let all = blocks.flat_map(|block| &func.block(*block).insts);
    all.copied().collect()
}

fn linked_name(name: &str, unit_ns: u64) -> String {
    match unit_ns {
        MILLISECOND_NS => name.to_owned(),
        unit if unit % 1_000_000_000 == 0 => format!("{name}@{}s", unit / 1_000_000_000),
        unit if unit % MILLISECOND_NS == 0 => format!("{name}@{}ms", unit / MILLISECOND_NS),
        unit if unit % 1_000 == 0 => format!("{name}@{}us", unit / 1_000),
        unit => format!("{name}@{unit}ns"),
    }
}
