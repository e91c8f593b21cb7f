//! All places a function can name, by what lies there.

use iecc_ir::{MemType, Module, PlaceType, RefParam, Root, Type};

/// A step of a [`Route`].
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    Field(u32),
    /// An element of an array of this length.
    Element(u32),
    /// A bit of an integer of this width.
    Bit(u32),
}

/// A place whose indices are still open.
#[derive(Debug, Clone)]
pub(super) struct Route {
    pub(super) root: Root,
    pub(super) steps: Vec<Step>,
    pub(super) end: PlaceType,
}

impl Route {
    /// Whether it ends in a value of the type.
    pub(super) fn is_value(&self, ty: Type) -> bool {
        self.end.scalar() == Some(ty)
    }
}

/// Every route from every region and reference of a function.
pub(super) fn routes(module: &Module, refs: &[MemType]) -> Vec<Route> {
    let regions = [
        (Root::State, module.state),
        (Root::Input, module.input),
        (Root::Output, module.output),
    ];
    let mut found = Vec::new();
    for (root, id) in regions {
        collect(
            module,
            root,
            &mut Vec::new(),
            MemType::Struct(id),
            &mut found,
        );
    }
    for (index, &ty) in refs.iter().enumerate() {
        let root = Root::Ref(RefParam::from_u32(index as u32));
        // The same chance for a reference as for the state, which has many more places.
        for _ in 0..4 {
            collect(module, root, &mut Vec::new(), ty, &mut found);
        }
    }
    found
}

fn collect(
    module: &Module,
    root: Root,
    steps: &mut Vec<Step>,
    ty: MemType,
    found: &mut Vec<Route>,
) {
    let mut add = |steps: &[Step], end| {
        found.push(Route {
            root,
            steps: steps.to_vec(),
            end,
        });
    };
    add(steps, PlaceType::Mem(ty));
    match ty {
        MemType::Scalar(scalar) => {
            if scalar.is_int() && scalar != Type::I1 {
                steps.push(Step::Bit(scalar.bits()));
                add(steps, PlaceType::Bit);
                steps.pop();
            }
        }
        MemType::Struct(id) => {
            for (index, field) in module.types.structs[id].fields.iter().enumerate() {
                steps.push(Step::Field(index as u32));
                collect(module, root, steps, field.ty, found);
                steps.pop();
            }
        }
        MemType::Array(id) => {
            let array = module.types.array_type(id);
            steps.push(Step::Element(array.len));
            collect(module, root, steps, array.element, found);
            steps.pop();
        }
    }
}
