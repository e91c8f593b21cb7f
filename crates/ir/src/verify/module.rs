//! Rules of modules: names, types, regions, aliases, entry points, calls without recursion.

use super::VerifyError;
use crate::{
    FieldDef, FuncId, Layout, MAX_LOCAL_BYTES, MAX_REGION_BYTES, MemType, Module, Place, Root,
    Type, View,
};
use cranelift_entity::EntitySet;
use std::collections::BTreeSet;

pub(super) struct ModuleCheck<'m, 'e> {
    module: &'m Module,
    errors: &'e mut Vec<VerifyError>,
}

impl<'m, 'e> ModuleCheck<'m, 'e> {
    pub(super) fn new(module: &'m Module, errors: &'e mut Vec<VerifyError>) -> Self {
        Self { module, errors }
    }

    fn error(&mut self, rule: u8, message: String) {
        self.errors.push(VerifyError {
            rule,
            function: None,
            message,
            origin: None,
        });
    }

    fn unique<'n>(&mut self, what: &str, names: impl Iterator<Item = &'n str>) {
        let mut seen = BTreeSet::new();
        for name in names {
            if !seen.insert(name) {
                self.error(1, format!("{what} {name:?} is defined twice"));
            }
        }
    }

    pub(super) fn run(&mut self) {
        let module = self.module;
        self.unique(
            "struct",
            module.types.structs.values().map(|def| def.name.as_str()),
        );
        for def in module.types.structs.values() {
            self.unique("field", def.fields.iter().map(|field| field.name.as_str()));
            def.fields.iter().for_each(|field| self.view(field));
        }
        self.unique(
            "function",
            module.funcs.values().map(|func| func.name.as_str()),
        );
        let folded: Vec<String> = module
            .names
            .iter()
            .map(|(name, _)| name.to_ascii_lowercase())
            .collect();
        self.unique("name", folded.iter().map(String::as_str));
        self.regions();
        self.aliases();
        self.entry_points();
        self.recursion();
    }

    fn view(&mut self, field: &FieldDef) {
        let (mut ty, mut lows) = (field.ty, field.lows.iter());
        while let MemType::Array(id) = ty {
            let array = self.module.types.array_type(id);
            let low = lows.next().copied().unwrap_or(0);
            if low.checked_add(i64::from(array.len)).is_none() {
                self.error(
                    2,
                    format!("elements of field {:?} have no numbers", field.name),
                );
            }
            ty = array.element;
        }
        if lows.next().is_some() || field.lows.last() == Some(&0) {
            self.error(
                2,
                format!("field {:?} has too many first numbers", field.name),
            );
        }
        let fits = match ty {
            MemType::Scalar(scalar) => field.view.fits(scalar),
            MemType::Struct(_) | MemType::Array(_) => field.view == View::Plain,
        };
        if !fits {
            let (name, view) = (&field.name, field.view.name());
            self.error(2, format!("field {name:?} cannot be seen as {view}"));
        }
    }

    fn regions(&mut self) {
        let module = self.module;
        if module.types.arrays().any(|array| array.len == 0) {
            self.error(2, "an array has no elements".to_owned());
        }
        let layout = Layout::new(&module.types);
        for (name, id) in [
            ("state", module.state),
            ("input", module.input),
            ("output", module.output),
        ] {
            let size = layout.size(&module.types, MemType::Struct(id));
            if size > MAX_REGION_BYTES {
                self.error(
                    2,
                    format!(
                        "region {name} has {size} bytes, at most {MAX_REGION_BYTES} are allowed"
                    ),
                );
            }
        }
        self.local_bytes(&layout);
        let size = layout.size(&module.types, MemType::Struct(module.state));
        if size != module.image.bytes().len() as u64 {
            self.error(
                2,
                format!(
                    "the image has {} bytes, the state {size}",
                    module.image.bytes().len()
                ),
            );
        } else if size <= MAX_REGION_BYTES {
            self.image_bits(&layout);
        }
    }

    fn local_bytes(&mut self, layout: &Layout) {
        let module = self.module;
        let sizes = module.funcs.values();
        let sizes = sizes.map(|func| layout.locals(&module.types, func).1);
        let size = sizes.fold(0, u64::saturating_add);
        if size > MAX_LOCAL_BYTES {
            self.error(
                2,
                format!("all locals have {size} bytes, at most {MAX_LOCAL_BYTES} are allowed"),
            );
        }
    }

    fn image_bits(&mut self, layout: &Layout) {
        let module = self.module;
        let mut bad = None;
        let state = MemType::Struct(module.state);
        layout.for_each_leaf(
            &module.types,
            &Place::root(Root::State),
            state,
            &mut |_, offset, ty| {
                if ty == Type::I1 && module.image.bytes()[offset as usize] > 1 {
                    bad = Some(offset);
                }
            },
        );
        if let Some(offset) = bad {
            self.error(
                2,
                format!("the i1 at byte {offset} of the image is neither 0 nor 1"),
            );
        }
    }

    fn aliases(&mut self) {
        for (name, place) in &self.module.names {
            let state = MemType::Struct(self.module.state);
            let legal = place.root == Root::State
                && place.is_static()
                && Place::walk(&self.module.types, state, &place.path).is_some();
            if !legal {
                self.error(
                    4,
                    format!("name {name:?} is not a static place of the state"),
                );
            }
        }
    }

    fn entry_points(&mut self) {
        for id in [Some(self.module.scan), self.module.prescan]
            .into_iter()
            .flatten()
        {
            match self.module.funcs.get(id) {
                None => self.error(3, format!("{id} does not exist")),
                Some(func) if func.layout.is_empty() => {}
                Some(func) => {
                    if !(func.refs.is_empty()
                        && func.results.is_empty()
                        && func.param_types().is_empty())
                    {
                        self.error(3, format!("@{} has parameters or results", func.name));
                    }
                }
            }
        }
    }

    /// Depth-first over calls, without recursion of our own.
    fn recursion(&mut self) {
        let (mut done, mut open) = (EntitySet::<FuncId>::new(), EntitySet::<FuncId>::new());
        for root in self.module.funcs.keys() {
            if done.contains(root) {
                continue;
            }
            open.insert(root);
            let mut path = vec![(root, callees(self.module, root))];
            while let Some((func, rest)) = path.last_mut() {
                let (func, next) = (*func, rest.pop());
                match next {
                    Some(callee) if open.contains(callee) => {
                        let name = &self.module.funcs[callee].name;
                        self.error(5, format!("@{name} calls itself"));
                    }
                    Some(callee) if done.contains(callee) => {}
                    Some(callee) => {
                        open.insert(callee);
                        path.push((callee, callees(self.module, callee)));
                    }
                    None => {
                        done.insert(func);
                        open.remove(func);
                        path.pop();
                    }
                }
            }
        }
    }
}

fn callees(module: &Module, id: FuncId) -> Vec<FuncId> {
    let known = |callee: &FuncId| module.funcs.get(*callee).is_some();
    let called: BTreeSet<FuncId> = module.funcs[id].calls().filter(known).collect();
    called.into_iter().collect()
}
