//! What types are stored as, and what they hold at the start.

mod overlay;
mod size;

pub(crate) use overlay::{Shape, steps_in_bytes};

use super::analysis::Analysis;
use super::elementary::El;
use super::objects::InstancePart;
use super::signature::PouId;
use super::types::{TypeId, TypeKind};
use crate::hir::{
    ArrayId, BASE, Elementary, InitId, MemberDef, StructDef, StructId, StructKind, Type, View,
    code::Init,
};
use rustc_hash::FxHashMap;
use std::collections::HashSet;

/// Storage of types, made on first use.
#[derive(Debug, Default)]
pub(crate) struct StorageTypes {
    types: FxHashMap<TypeId, Type>,
    instances: FxHashMap<PouId, StructId>,
    inits: FxHashMap<TypeId, Option<InitId>>,
    shared: FxHashMap<Init, InitId>,
    names: HashSet<String>,
}

/// Most elements an array may have, and most bytes a variable may take.
pub(crate) const MAX_ELEMENTS: u64 = 1 << 28;

impl Analysis<'_> {
    /// What a type is stored as. Types that contain themselves were refused before.
    pub(crate) fn storage(&mut self, ty: TypeId) -> Type {
        let ty = self.types.strip(ty);
        if let Some(&known) = self.storage.types.get(&ty) {
            return known;
        }
        let made = self.make_storage(ty);
        self.storage.types.insert(ty, made);
        made
    }

    fn make_storage(&mut self, ty: TypeId) -> Type {
        match self.types.kind(ty).clone() {
            TypeKind::Elementary(el) | TypeKind::Subrange { base: el, .. } => {
                Type::Elementary(el.storage())
            }
            TypeKind::Enum(index) => {
                Type::Elementary(self.types.enums[index as usize].base.storage())
            }
            TypeKind::Interface(_) | TypeKind::Reference(..) | TypeKind::Null => {
                Type::Elementary(Elementary::Ulint)
            }
            TypeKind::Text { wide, length } => Type::Struct(self.text_struct(wide, length)),
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let element = self.storage(element);
                Type::Array(self.array_storage(&dimensions, element))
            }
            TypeKind::Struct(index) => match &self.types.structs[index as usize].overlay {
                Some(overlay) => {
                    let (byte, bytes) = (Type::Elementary(Elementary::Usint), overlay.bytes);
                    Type::Array(self.hir.types.array(byte, bytes))
                }
                None => Type::Struct(self.struct_storage(index)),
            },
            TypeKind::Instance(pou) => Type::Struct(self.instance_struct(pou)),
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::OpenArray { .. }
            | TypeKind::Alias(_) => Type::Elementary(Elementary::Dint),
        }
    }

    /// The number a value of the type is stored as.
    pub(crate) fn scalar(&mut self, ty: TypeId) -> Elementary {
        match self.storage(ty) {
            Type::Elementary(elementary) => elementary,
            Type::Struct(_) | Type::Array(_) => panic!("only scalars are one number"),
        }
    }

    fn array_storage(&mut self, dimensions: &[(i64, i64)], element: Type) -> ArrayId {
        let (first, inner) = dimensions.split_first().expect("at least one dimension");
        let element = if inner.is_empty() {
            element
        } else {
            Type::Array(self.array_storage(inner, element))
        };
        self.hir.types.array_from(element, extent(*first), first.0)
    }

    fn text_struct(&mut self, wide: bool, length: u32) -> StructId {
        let unit = if wide {
            Elementary::Uint
        } else {
            Elementary::Usint
        };
        let data = self.hir.types.array(Type::Elementary(unit), length.max(1));
        let member = |name: &str, ty, view| MemberDef {
            name: name.to_owned(),
            ty,
            view,
            hidden: false,
        };
        let len = Type::Elementary(Elementary::Dint);
        let members = vec![
            member("LEN", len, View::Number),
            member("DATA", Type::Array(data), View::Character),
        ];
        let name = format!("{}STRING[{length}]", if wide { "W" } else { "" });
        self.add_struct(name, StructKind::Text, members)
    }

    fn struct_storage(&mut self, index: u32) -> StructId {
        let def = self.types.structs[index as usize].clone();
        let members = def.members.iter().map(|member| {
            let ty = self.storage(member.ty);
            self.member(self.text(member.name), ty, member.ty)
        });
        let members = members.collect();
        let name = def.name.map_or("STRUCT", |name| self.text(name));
        self.add_struct(name.to_owned(), StructKind::Plain, members)
    }

    fn member(&self, name: &str, ty: Type, of: TypeId) -> MemberDef {
        MemberDef {
            name: name.to_owned(),
            ty,
            view: self.view(of),
            hidden: false,
        }
    }

    /// What the numbers in a type stand for.
    pub(crate) fn view(&self, ty: TypeId) -> View {
        match self.types.base(ty) {
            TypeKind::Elementary(el) => el.view(),
            TypeKind::Array { element, .. } => self.view(*element),
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Text { .. }
            | TypeKind::Enum(_)
            | TypeKind::Subrange { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Struct(_)
            | TypeKind::Instance(_)
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => View::Number,
        }
    }

    /// The structure of an instance: what it extends, then its own members.
    pub(crate) fn instance_struct(&mut self, pou: PouId) -> StructId {
        // All bodies of a block run on the same storage.
        let pou = self.pou(pou).template.unwrap_or(pou);
        if let Some(&known) = self.storage.instances.get(&pou) {
            return known;
        }
        let mut members = Vec::new();
        for part in self.instance_parts(pou) {
            let (name, ty, of, hidden) = match part {
                InstancePart::TypeNumber => {
                    let ty = Type::Elementary(Elementary::Udint);
                    ("type'".to_owned(), ty, TypeId::ERROR, true)
                }
                InstancePart::Mock => {
                    let ty = Type::Elementary(Elementary::Lint);
                    ("mock'".to_owned(), ty, TypeId::ERROR, true)
                }
                InstancePart::Base(base) => {
                    let ty = Type::Struct(self.instance_struct(base));
                    (BASE.to_owned(), ty, TypeId::ERROR, true)
                }
                InstancePart::Var(index) => {
                    let var = self.pou(pou).vars[index].clone();
                    let ty = self.storage(var.ty);
                    (self.text(var.name).to_owned(), ty, var.ty, false)
                }
                InstancePart::Edge(index) => {
                    let name = self.text(self.pou(pou).vars[index].name);
                    let name = format!("edge'{name}");
                    (name, Type::Elementary(Elementary::Bool), TypeId::BOOL, true)
                }
            };
            let view = self.view(of);
            members.push(MemberDef {
                name,
                ty,
                view,
                hidden,
            });
        }
        let name = self.text(self.pou(pou).name).to_owned();
        let id = self.add_struct(name, StructKind::Plain, members);
        self.storage.instances.insert(pou, id);
        id
    }

    /// Adds a structure; its name gets a number where another one has it.
    fn add_struct(&mut self, name: String, kind: StructKind, members: Vec<MemberDef>) -> StructId {
        let mut unique = name.clone();
        let mut number = 2;
        while !self.storage.names.insert(unique.to_ascii_uppercase()) {
            unique = format!("{name}'{number}");
            number += 1;
        }
        self.hir.types.add_struct(StructDef {
            name: unique,
            kind,
            members,
            unusable: Vec::new(),
        })
    }

    /// What a variable of the type holds if its declaration says nothing; `None` if all is 0.
    pub(crate) fn default_init(&mut self, ty: TypeId) -> Option<InitId> {
        if let Some(&known) = self.storage.inits.get(&ty) {
            return known;
        }
        // A default that needs itself was reported where the type was resolved.
        self.storage.inits.insert(ty, None);
        let init = self.make_default(ty);
        self.storage.inits.insert(ty, init);
        init
    }

    fn make_default(&mut self, ty: TypeId) -> Option<InitId> {
        match self.types.kind(ty).clone() {
            TypeKind::Alias(index) => {
                let alias = self.types.aliases[index as usize].clone();
                match alias.initial {
                    Some(initial) => self.initial_value(initial, alias.base),
                    None => self.default_init(alias.base),
                }
            }
            TypeKind::Subrange { base, low, .. } => self.bits_init(base, low),
            TypeKind::Enum(index) => {
                let def = &self.types.enums[index as usize];
                let (base, first) = (def.base, def.values.first().map_or(0, |value| value.1));
                self.bits_init(base, first)
            }
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let mut init = self.default_init(element)?;
                for dimension in dimensions.iter().rev() {
                    init = self.init(Init::Array(vec![(0, extent(*dimension), init)]));
                }
                Some(init)
            }
            // Members that overlap begin as 0.
            TypeKind::Struct(index) if self.types.structs[index as usize].overlay.is_some() => None,
            TypeKind::Struct(index) => {
                let members = self.types.structs[index as usize].members.clone();
                let mut parts = Vec::new();
                for (position, member) in (0..).zip(members) {
                    let init = match member.initial {
                        Some(initial) => self.initial_value(initial, member.ty),
                        None => self.default_init(member.ty),
                    };
                    parts.extend(init.map(|init| (position, init)));
                }
                self.struct_init(parts)
            }
            TypeKind::Instance(pou) => self.instance_default(pou),
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Elementary(_)
            | TypeKind::Text { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Interface(_)
            | TypeKind::Reference(..) => None,
        }
    }

    fn bits_init(&mut self, el: El, value: i128) -> Option<InitId> {
        let bits = super::constant::Const::Int(value).bits(el);
        (bits != 0).then(|| self.init(Init::Bits(bits)))
    }

    pub(crate) fn struct_init(&mut self, parts: Vec<(u32, InitId)>) -> Option<InitId> {
        (!parts.is_empty()).then(|| self.init(Init::Struct(parts)))
    }

    /// An initial value, shared with those that are equal.
    pub(crate) fn init(&mut self, init: Init) -> InitId {
        if let Some(&known) = self.storage.shared.get(&init) {
            return known;
        }
        let id = self.hir.inits.add(init.clone());
        self.storage.shared.insert(init, id);
        id
    }
}

/// How many elements a dimension has; bounds are checked when the type is made.
pub(crate) fn extent((low, high): (i64, i64)) -> u32 {
    (high - low + 1) as u32
}
