//! Splitting: words whose bits are separate things become bits.
//!
//! After it, a word of the state that is only ever accessed by constant bit numbers is gone; each
//! bit that is accessed or has a name is an `i1` in its place, called `word.bit`. Whatever is used
//! as a whole, by a computed bit number, by `elapsed` or inside something passed by reference stays
//! a word. Structs and arrays stay, with another layout: two fields of one type may come to have
//! different types. The elements of an array are split alike. Names of bits are kept; names of
//! words that are split are dropped, as are types nobody uses. Inputs and outputs keep their
//! layout.

mod retype;

use iecc_ir::{
    Image, Index, InstData, Layout, MemType, Module, Place, Projection, Root, Scalar, Type,
};
use retype::Retyped;
use std::collections::{BTreeMap, BTreeSet};

/// The way to a scalar of the state: fields, with one number for all elements of an array.
type Key = Vec<u32>;
const ELEMENT: u32 = u32::MAX;

/// Splits the words of the state.
pub(crate) fn split(module: &mut Module) {
    let words = words_to_split(module);
    if words.is_empty() {
        return;
    }
    let mut retyped = Retyped::of(module, &words);
    let image = new_image(module, &words, &retyped);
    for func in module.funcs.values_mut() {
        for block in func.layout.clone() {
            for inst in func.block(block).insts.clone() {
                rewrite_places(func.inst_mut(inst), &retyped);
            }
        }
        for param in func.refs.values_mut() {
            param.ty = retyped.unchanged(param.ty);
        }
        for local in func.locals.values_mut() {
            local.ty = retyped.unchanged(local.ty);
        }
    }
    let names = std::mem::take(&mut module.names).into_iter();
    module.names = names
        .filter_map(|(name, place)| Some((name, retyped.place(&place)?)))
        .collect();
    module.state = retyped.state;
    module.input = retyped.input;
    module.output = retyped.output;
    module.types = retyped.types;
    module.image = image;
}

fn rewrite_places(data: &mut InstData, retyped: &Retyped) {
    for place in data.places_mut() {
        *place = retyped
            .place(place)
            .expect("split words are accessed by bits");
    }
}

/// The words to split and which of their bits matter.
fn words_to_split(module: &Module) -> BTreeMap<Key, u64> {
    let mut words: BTreeMap<Key, u64> = BTreeMap::new();
    let mut whole: BTreeSet<Key> = BTreeSet::new();
    for func in module.funcs.values() {
        let blocks = func.layout.iter().map(|&block| func.block(block));
        for &inst in blocks.flat_map(|block| &block.insts) {
            let data = func.inst(inst);
            let Some(place) = data.place() else {
                // Calls, copies and clears reach all that lies there.
                let places = data.places().into_iter();
                whole.extend(places.filter_map(state_key).map(|(key, _)| key));
                continue;
            };
            let Some((key, bit)) = state_key(place) else {
                continue;
            };
            match bit {
                Some(Index::Const(bit)) => *words.entry(key).or_default() |= 1 << bit,
                Some(Index::Value(_)) | None => {
                    whole.insert(key);
                }
            }
        }
    }
    for kept in whole {
        // What is passed may be a struct: then all words inside are kept.
        let inside: Vec<Key> = words
            .range(kept.clone()..)
            .map(|(key, _)| key)
            .take_while(|key| key.starts_with(&kept))
            .cloned()
            .collect();
        inside.iter().for_each(|key| {
            words.remove(key);
        });
    }
    for (_, place) in &module.names {
        if let Some((key, Some(Index::Const(bit)))) = state_key(place)
            && let Some(bits) = words.get_mut(&key)
        {
            *bits |= 1 << bit;
        }
    }
    words
}

/// The key of a place of the state, and the bit it ends in.
fn state_key(place: &Place) -> Option<(Key, Option<Index>)> {
    if place.root != Root::State {
        return None;
    }
    let (mut key, mut bit) = (Key::new(), None);
    for step in &place.path {
        match step {
            Projection::Field(field) => key.push(*field),
            Projection::Index(_) => key.push(ELEMENT),
            Projection::Bit(index) => bit = Some(*index),
        }
    }
    Some((key, bit))
}

fn new_image(module: &Module, words: &BTreeMap<Key, u64>, retyped: &Retyped) -> Image {
    let old = Layout::new(&module.types);
    let new = Layout::new(&retyped.types);
    let mut image = Image::zero(&new, &retyped.types, retyped.state);
    let mut copy = |place: &Place, offset: u64, ty: Type| {
        let value = module.image.get(offset, ty);
        if value.bits != 0 {
            for (place, value) in parts(words, place, value) {
                let place = retyped.place(&place).expect("bits that matter have places");
                image.set_place(&new, &retyped.types, retyped.state, &place, value.bits);
            }
        }
    };
    let state = MemType::Struct(module.state);
    old.for_each_leaf(&module.types, &Place::root(Root::State), state, &mut copy);
    image
}

/// A scalar as it will be: itself, or the bits that matter.
fn parts(words: &BTreeMap<Key, u64>, place: &Place, value: Scalar) -> Vec<(Place, Scalar)> {
    let (key, _) = state_key(place).expect("a place of the state");
    let Some(&bits) = words.get(&key) else {
        return vec![(place.clone(), value)];
    };
    let bits = (0..value.ty.bits()).filter(|bit| bits >> bit & 1 == 1);
    bits.map(|bit| {
        let part = Scalar::new(Type::I1, value.bits >> bit & 1);
        (place.clone().bit(Index::Const(bit)), part)
    })
    .collect()
}
