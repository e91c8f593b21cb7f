//! Links functions of the standard library into a module.
//!
//! A function is copied with what it calls on first use, once per timer unit. Its structures are
//! the program's predefined ones, which have the same fields; that is checked when linking.

use crate::MILLISECOND_NS;
use crate::types::TypeMap;
use cranelift_entity::PrimaryMap;
use iecc_ir::{FuncId, Function, InstData, MemType, Module, StructId, parse_module};
use std::collections::BTreeMap;

/// The parsed library and what of it is linked.
pub(crate) struct Library {
    modules: Vec<Module>,
    linked: BTreeMap<(String, u64), FuncId>,
}

impl Library {
    pub(crate) fn new() -> Self {
        let parse = |file: &iecc_stdlib::File| {
            parse_module(file.text).unwrap_or_else(|error| panic!("{}:{error}", file.path))
        };
        Self {
            modules: iecc_stdlib::ROCKWELL.iter().map(parse).collect(),
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
        let found = self
            .modules
            .iter()
            .enumerate()
            .find_map(|(index, module)| Some((index, module.func_named(name)?)));
        let (module, func) = found.unwrap_or_else(|| panic!("the library has no function @{name}"));
        self.copy(module, func, unit_ns, funcs, types)
    }

    /// Library code calls a few levels deep at most.
    fn copy(
        &mut self,
        module: usize,
        func: FuncId,
        unit_ns: u64,
        funcs: &mut PrimaryMap<FuncId, Function>,
        types: &mut TypeMap<'_>,
    ) -> FuncId {
        let mut copy = self.modules[module].funcs[func].clone();
        let unit_ns = if self.counts_time(module, func) {
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
            param.ty = self.linked_type(module, param.ty, types);
        }
        let blocks = copy.layout.clone();
        for block in blocks {
            for inst in copy.block(block).insts.clone() {
                match copy.inst_mut(inst) {
                    InstData::Call { func, .. } => {
                        *func = self.copy(module, *func, unit_ns, funcs, types);
                    }
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
        }
        let id = funcs.push(copy);
        self.linked.insert(key, id);
        id
    }

    /// Whether a function itself looks at the time; only these exist once per unit.
    fn counts_time(&self, module: usize, func: FuncId) -> bool {
        let func = &self.modules[module].funcs[func];
        func.layout
            .iter()
            .flat_map(|block| &func.block(*block).insts)
            .any(|inst| matches!(func.inst(*inst), InstData::Elapsed { .. }))
    }

    fn linked_type(&self, module: usize, ty: MemType, types: &mut TypeMap<'_>) -> MemType {
        let MemType::Struct(id) = ty else {
            panic!("library functions refer to structures")
        };
        let def = &self.modules[module].types.structs[id];
        let linked: StructId = types.predefined(&def.name);
        assert_eq!(
            types.table().structs[linked].fields,
            def.fields,
            "library and program agree on {}",
            def.name
        );
        MemType::Struct(linked)
    }
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

#[cfg(test)]
mod tests {
    use iecc_ir::{parse_module, verify};

    #[test]
    fn library_files_keep_the_rules_of_the_ir() {
        for file in iecc_stdlib::ROCKWELL {
            let module = parse_module(file.text).unwrap_or_else(|e| panic!("{}:{e}", file.path));
            assert_eq!(verify(&module).err(), None, "{}", file.path);
        }
    }
}
