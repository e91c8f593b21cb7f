//! The new types of a module whose words are split, and where old places lie in them.

use super::{ELEMENT, Key};
use crate::functions::unique;
use iecc_ir::{
    FieldDef, Index, MemType, Module, Place, Projection, Root, StructId, Type, TypeTable,
};
use std::collections::{BTreeMap, BTreeSet};

/// Where the fields of a changed struct went.
#[derive(Debug, Default)]
struct FieldMap {
    /// New position by old one, for fields that are not split.
    fields: BTreeMap<u32, u32>,
    /// New position of each bit of a split field.
    bits: BTreeMap<(u32, u32), u32>,
}

/// The new types.
#[derive(Debug)]
pub(super) struct Retyped {
    pub(super) types: TypeTable,
    pub(super) state: StructId,
    pub(super) input: StructId,
    pub(super) output: StructId,
    /// Changed structs by the way to them.
    changed: BTreeMap<Key, FieldMap>,
    /// New ids of structs that are as before.
    unchanged: BTreeMap<StructId, StructId>,
    old: TypeTable,
}

impl Retyped {
    /// The types of the module with these bits of words in place of the words.
    pub(super) fn of(module: &Module, words: &BTreeMap<Key, u64>) -> Self {
        let mut builder = Builder {
            old: &module.types,
            words,
            types: TypeTable::default(),
            names: BTreeSet::new(),
            changed: BTreeMap::new(),
            unchanged: BTreeMap::new(),
        };
        for func in module.funcs.values() {
            let refs = func.refs.values().map(|data| data.ty);
            for ty in refs.chain(func.locals.values().map(|data| data.ty)) {
                builder.keep(ty);
            }
        }
        let state = builder.split_struct(module.state, &mut Key::new());
        let input = builder.keep_struct(module.input);
        let output = builder.keep_struct(module.output);
        let Builder {
            types,
            changed,
            unchanged,
            ..
        } = builder;
        Self {
            types,
            state,
            input,
            output,
            changed,
            unchanged,
            old: module.types.clone(),
        }
    }

    /// The new id of a type that holds nothing that is split.
    pub(super) fn unchanged(&mut self, ty: MemType) -> MemType {
        match ty {
            MemType::Scalar(_) => ty,
            MemType::Struct(id) => MemType::Struct(self.unchanged[&id]),
            MemType::Array(id) => {
                let array = self.old.array_type(id);
                let element = self.unchanged(array.element);
                MemType::Array(self.types.array(element, array.len))
            }
        }
    }

    /// Where an old place lies; `None` for split words and for bits that do not matter.
    pub(super) fn place(&self, place: &Place) -> Option<Place> {
        if place.root != Root::State {
            return Some(place.clone());
        }
        let (mut key, mut path) = (Key::new(), Vec::new());
        let mut steps = place.path.iter().peekable();
        while let Some(step) = steps.next() {
            let Projection::Field(field) = *step else {
                key.push(ELEMENT);
                path.push(*step);
                continue;
            };
            let position = match self.changed.get(&key) {
                None => Some(field),
                Some(map) => match (map.fields.get(&field), steps.peek()) {
                    (Some(&position), _) => Some(position),
                    (None, Some(Projection::Bit(Index::Const(bit)))) => {
                        steps.next();
                        map.bits.get(&(field, *bit)).copied()
                    }
                    (None, _) => None,
                },
            };
            key.push(field);
            path.push(Projection::Field(position?));
        }
        Some(Place {
            root: Root::State,
            path,
        })
    }
}

struct Builder<'m> {
    old: &'m TypeTable,
    words: &'m BTreeMap<Key, u64>,
    types: TypeTable,
    names: BTreeSet<String>,
    changed: BTreeMap<Key, FieldMap>,
    unchanged: BTreeMap<StructId, StructId>,
}

impl Builder<'_> {
    fn keep(&mut self, ty: MemType) -> MemType {
        match ty {
            MemType::Scalar(_) => ty,
            MemType::Struct(id) => MemType::Struct(self.keep_struct(id)),
            MemType::Array(id) => {
                let array = self.old.array_type(id);
                let element = self.keep(array.element);
                MemType::Array(self.types.array(element, array.len))
            }
        }
    }

    fn keep_struct(&mut self, id: StructId) -> StructId {
        if let Some(&new) = self.unchanged.get(&id) {
            return new;
        }
        let old = &self.old.structs[id];
        let fields = old.fields.iter().map(|field| FieldDef {
            name: field.name.clone(),
            ty: self.keep(field.ty),
            view: field.view,
            lows: field.lows.clone(),
        });
        let fields = fields.collect();
        let new = self.add(&old.name, fields);
        self.unchanged.insert(id, new);
        new
    }

    fn add(&mut self, name: &str, fields: Vec<FieldDef>) -> StructId {
        let name = unique(name, &self.names);
        self.names.insert(name.clone());
        self.types.add_struct(name, fields)
    }

    fn has_words(&self, key: &Key) -> bool {
        let mut inside = self.words.range(key.clone()..);
        inside.next().is_some_and(|(word, _)| word.starts_with(key))
    }

    /// The new type of what lies at `key`. Nesting is bounded like that of every type.
    fn split(&mut self, ty: MemType, key: &mut Key) -> MemType {
        if !self.has_words(key) {
            return self.keep(ty);
        }
        match ty {
            MemType::Scalar(_) => ty,
            MemType::Struct(id) => MemType::Struct(self.split_struct(id, key)),
            MemType::Array(id) => {
                let array = self.old.array_type(id);
                key.push(ELEMENT);
                let element = self.split(array.element, key);
                key.pop();
                MemType::Array(self.types.array(element, array.len))
            }
        }
    }

    fn split_struct(&mut self, id: StructId, key: &mut Key) -> StructId {
        let old = &self.old.structs[id];
        let taken: BTreeSet<String> = old.fields.iter().map(|f| f.name.clone()).collect();
        let (mut fields, mut map) = (Vec::new(), FieldMap::default());
        for (position, field) in (0..).zip(&old.fields) {
            key.push(position);
            match self.words.get(key) {
                Some(&bits) => {
                    for bit in (0..64).filter(|bit| bits >> bit & 1 == 1) {
                        map.bits.insert((position, bit), fields.len() as u32);
                        let name = unique(&format!("{}.{bit}", field.name), &taken);
                        let ty = MemType::Scalar(Type::I1);
                        fields.push(FieldDef::new(name, ty));
                    }
                }
                None => {
                    map.fields.insert(position, fields.len() as u32);
                    let ty = self.split(field.ty, key);
                    let name = field.name.clone();
                    fields.push(FieldDef::new(name, ty).with_view(field.view));
                }
            }
            key.pop();
        }
        self.changed.insert(key.clone(), map);
        self.add(&old.name, fields)
    }
}
