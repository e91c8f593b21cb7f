//! Places: the only way to memory.

use crate::{Local, MemType, RefParam, StructId, Type, TypeTable, Value};

/// Where a place begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Root {
    /// What is kept from scan to scan.
    State,
    /// The inputs latched for this scan; never stored to.
    Input,
    /// The outputs published after this scan; never loaded.
    Output,
    /// A reference parameter of the function.
    Ref(RefParam),
    /// Memory of this activation of the function. It is no part of the state and of no other local,
    /// nor do the function's own references refer to it.
    Local(Local),
    /// What lies at an address of the state, see [`InstData::Address`](crate::InstData::Address). If
    /// not all of it lies inside the state, loads give 0 and stores do nothing. It may overlap
    /// anything in the state, in any way.
    Deref {
        /// The address, an `i64`.
        value: Value,
        /// What is taken to lie there.
        ty: MemType,
    },
}

impl Root {
    /// Whether places of this root may be the same memory as places of another.
    pub fn may_alias(self) -> bool {
        match self {
            Self::State | Self::Ref(_) | Self::Deref { .. } => true,
            Self::Input | Self::Output | Self::Local(_) => false,
        }
    }
}

/// An array index or bit number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Index {
    /// Known; the verifier checks it against the bounds.
    Const(u32),
    /// An `i32` read as signed. Outside the bounds a load gives 0 and a store does nothing.
    Value(Value),
}

/// One step into a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Projection {
    /// Field of a struct, by position.
    Field(u32),
    /// Element of an array, from 0.
    Index(Index),
    /// Bit of an integer scalar, 0 the lowest; always the last step.
    Bit(Index),
}

/// A root and the way from it. Loads and stores need a scalar or bit at the end; calls pass any.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// Where it begins.
    pub root: Root,
    /// The steps.
    pub path: Vec<Projection>,
}

/// What lies at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaceType {
    /// A value, struct or array in memory.
    Mem(MemType),
    /// One bit of an integer.
    Bit,
}

impl PlaceType {
    /// The type a load gives, if a load is legal.
    pub fn scalar(self) -> Option<Type> {
        match self {
            Self::Mem(MemType::Scalar(ty)) => Some(ty),
            Self::Bit => Some(Type::I1),
            Self::Mem(MemType::Struct(_) | MemType::Array(_)) => None,
        }
    }
}

impl Place {
    /// A whole region or reference.
    pub fn root(root: Root) -> Self {
        Self {
            root,
            path: Vec::new(),
        }
    }

    /// The place one field further.
    #[must_use]
    pub fn field(mut self, field: u32) -> Self {
        self.path.push(Projection::Field(field));
        self
    }

    /// The place one element further.
    #[must_use]
    pub fn index(mut self, index: Index) -> Self {
        self.path.push(Projection::Index(index));
        self
    }

    /// One bit of the integer here.
    #[must_use]
    pub fn bit(mut self, index: Index) -> Self {
        self.path.push(Projection::Bit(index));
        self
    }

    /// The place with further steps appended.
    #[must_use]
    pub fn join(mut self, path: &[Projection]) -> Self {
        self.path.extend_from_slice(path);
        self
    }

    /// Whether the address is no value and every index on the way is a constant.
    pub fn is_static(&self) -> bool {
        self.values().next().is_none()
    }

    /// The address and the index values on the way.
    pub fn values(&self) -> impl Iterator<Item = Value> + '_ {
        let address = match self.root {
            Root::Deref { value, .. } => Some(value),
            Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Local(_) => None,
        };
        address.into_iter().chain(self.index_values())
    }

    /// The index values on the way.
    pub fn index_values(&self) -> impl Iterator<Item = Value> + '_ {
        self.path.iter().filter_map(|step| match step {
            Projection::Index(Index::Value(value)) | Projection::Bit(Index::Value(value)) => {
                Some(*value)
            }
            Projection::Index(Index::Const(_))
            | Projection::Bit(Index::Const(_))
            | Projection::Field(_) => None,
        })
    }

    /// The address and the index values on the way, for replacement.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut Value> + '_ {
        let address = match &mut self.root {
            Root::Deref { value, .. } => Some(value),
            Root::State | Root::Input | Root::Output | Root::Ref(_) | Root::Local(_) => None,
        };
        let indices = self.path.iter_mut().filter_map(|step| match step {
            Projection::Index(Index::Value(value)) | Projection::Bit(Index::Value(value)) => {
                Some(value)
            }
            Projection::Index(Index::Const(_))
            | Projection::Bit(Index::Const(_))
            | Projection::Field(_) => None,
        });
        address.into_iter().chain(indices)
    }

    /// Whether a store to one may change a load of the other. Exact for static places with the same
    /// root; the state, reference parameters and what lies at addresses may always overlap.
    pub fn may_overlap(&self, other: &Place) -> bool {
        if self.root != other.root {
            return self.root.may_alias() && other.root.may_alias();
        }
        self.path
            .iter()
            .zip(&other.path)
            .all(|(a, b)| match (a, b) {
                (Projection::Index(Index::Const(a)), Projection::Index(Index::Const(b)))
                | (Projection::Bit(Index::Const(a)), Projection::Bit(Index::Const(b)))
                | (Projection::Field(a), Projection::Field(b)) => a == b,
                _ => true,
            })
    }

    /// What lies at the end of `path` from a place of type `start`; `None` if a step does not fit
    /// or a constant index is out of bounds.
    pub fn walk(types: &TypeTable, start: MemType, path: &[Projection]) -> Option<PlaceType> {
        let mut at = PlaceType::Mem(start);
        for step in path {
            let PlaceType::Mem(mem) = at else { return None };
            at = Self::step(types, mem, *step)?;
        }
        Some(at)
    }

    fn step(types: &TypeTable, mem: MemType, step: Projection) -> Option<PlaceType> {
        match (mem, step) {
            (MemType::Struct(id), Projection::Field(field)) => types.structs[id]
                .fields
                .get(field as usize)
                .map(|f| PlaceType::Mem(f.ty)),
            (MemType::Array(id), Projection::Index(index)) => {
                let array = types.array_type(id);
                in_bounds(index, array.len).then_some(PlaceType::Mem(array.element))
            }
            (MemType::Scalar(ty), Projection::Bit(index)) => {
                (ty.is_int() && ty != Type::I1 && in_bounds(index, ty.bits()))
                    .then_some(PlaceType::Bit)
            }
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), _) => None,
        }
    }

    /// A place in a struct region by field names, for tests and tools.
    pub fn named(types: &TypeTable, root: Root, region: StructId, names: &[&str]) -> Option<Place> {
        let mut at = MemType::Struct(region);
        let mut place = Place::root(root);
        for name in names {
            let MemType::Struct(id) = at else { return None };
            let field = types.structs[id].field(name)?;
            at = types.structs[id].fields[field as usize].ty;
            place = place.field(field);
        }
        Some(place)
    }
}

fn in_bounds(index: Index, len: u32) -> bool {
    match index {
        Index::Const(index) => index < len,
        Index::Value(_) => true,
    }
}
