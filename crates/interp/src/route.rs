//! Places prepared for execution: a byte offset, and a stride for every index known only then.

use cranelift_entity::{PrimaryMap, SecondaryMap};
use iecc_ir::{
    FuncId, Function, Index, Inst, Layout, Local, MemType, Module, Place, Projection, Root, Type,
    Value,
};

/// A step over array elements by an index known at run time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    pub(crate) index: Value,
    pub(crate) len: u32,
    pub(crate) bytes: u64,
}

/// How to reach a place.
#[derive(Debug, Clone)]
pub(crate) struct Route {
    pub(crate) root: Root,
    /// How many bytes lie there.
    pub(crate) root_bytes: u64,
    /// Of all fields and constant indices together.
    pub(crate) offset: u64,
    pub(crate) strides: Vec<Stride>,
    /// What lies there, or holds the bit.
    pub(crate) ty: MemType,
    /// How many bytes that takes.
    pub(crate) bytes: u64,
    pub(crate) bit: Option<Index>,
}

impl Route {
    fn new(
        module: &Module,
        layout: &Layout,
        func: &Function,
        locals: &PrimaryMap<Local, u64>,
        place: &Place,
    ) -> Self {
        let start = module.root_type(func, place.root);
        let mut route = Self {
            root: place.root,
            offset: match place.root {
                Root::Local(local) => locals[local],
                Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Deref { .. } => 0,
            },
            root_bytes: layout.size(&module.types, start.expect("verified roots exist")),
            strides: Vec::new(),
            ty: start.expect("verified roots exist"),
            bytes: 0,
            bit: None,
        };
        for &step in &place.path {
            route.follow(module, layout, step);
        }
        route.bytes = layout.size(&module.types, route.ty);
        route
    }

    fn follow(&mut self, module: &Module, layout: &Layout, step: Projection) {
        match (self.ty, step) {
            (MemType::Struct(id), Projection::Field(field)) => {
                self.offset += layout.field_offset(id, field);
                self.ty = module.types.structs[id].fields[field as usize].ty;
            }
            (MemType::Array(id), Projection::Index(index)) => {
                let array = module.types.array_type(id);
                let bytes = layout.size(&module.types, array.element);
                self.ty = array.element;
                match index {
                    Index::Const(index) => self.offset += u64::from(index) * bytes,
                    Index::Value(index) => self.strides.push(Stride {
                        index,
                        len: array.len,
                        bytes,
                    }),
                }
            }
            (MemType::Scalar(_), Projection::Bit(bit)) => self.bit = Some(bit),
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => {
                panic!("verified places follow their types")
            }
        }
    }

    /// The type of the scalar at the end, or of the one that holds the bit.
    pub(crate) fn scalar(&self) -> Type {
        match self.ty {
            MemType::Scalar(ty) => ty,
            MemType::Struct(_) | MemType::Array(_) => {
                panic!("verified loads and stores are scalar")
            }
        }
    }
}

/// The routes of all places of a module, and how large the locals of each function are.
#[derive(Debug)]
pub(crate) struct Routes {
    routes: SecondaryMap<FuncId, SecondaryMap<Inst, Vec<Route>>>,
    local_bytes: SecondaryMap<FuncId, u64>,
}

impl Routes {
    pub(crate) fn new(module: &Module) -> Self {
        let layout = Layout::new(&module.types);
        let mut all = Self {
            routes: SecondaryMap::new(),
            local_bytes: SecondaryMap::new(),
        };
        for (id, func) in module.funcs.iter() {
            let (locals, local_bytes) = layout.locals(&module.types, func);
            all.local_bytes[id] = local_bytes;
            let insts = func
                .layout
                .iter()
                .flat_map(|&block| &func.block(block).insts);
            for &inst in insts {
                let places = func.inst(inst).places().into_iter();
                all.routes[id][inst] = places
                    .map(|place| Route::new(module, &layout, func, &locals, place))
                    .collect();
            }
        }
        all
    }

    /// Those of an instruction, in text order.
    pub(crate) fn of(&self, func: FuncId, inst: Inst) -> &[Route] {
        &self.routes[func][inst]
    }

    /// Bytes of the locals of a function.
    pub(crate) fn local_bytes(&self, func: FuncId) -> usize {
        self.local_bytes[func] as usize
    }
}
