//! Opens a module to be looked at and meddled with, before any pass runs: every engine then sees
//! nothing but larger input and output regions, and all give the same trace.
//!
//! A watch is an output more, stored at every end of the scan. A poke is two inputs more, a value
//! and whether it counts; where it counts, it is stored before everything else in the scan.

use super::names::{type_of, view_of};
use iecc_ir::{
    FieldDef, Inst, InstData, MemType, Module, Place, PlaceType, Root, StructId, Terminator, Type,
    Value, View,
};

/// What is added to the name of a poke for the input that says whether it counts.
const SET: &str = "?set";

/// A value of the state with the name of its new output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Watch {
    /// Name of the column.
    pub name: String,
    /// A scalar or bit of the state.
    pub place: Place,
}

/// A value of the state with the name of its new input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Poke {
    /// Name of the input.
    pub name: String,
    /// A scalar or bit of the state.
    pub place: Place,
}

/// Where the new fields are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Instruments {
    /// The output of each watch.
    pub watches: Vec<Place>,
    /// For each poke the input with its value and the one that says whether it counts.
    pub pokes: Vec<(Place, Place)>,
}

/// Adds watches and pokes to a module. Their places are static and lie in the state.
pub fn instrument(module: &mut Module, watches: &[Watch], pokes: &[Poke]) -> Instruments {
    assert!(
        module.input != module.output,
        "regions have structs of their own"
    );
    let watches = watches
        .iter()
        .map(|watch| add_watch(module, watch))
        .collect();
    // Each goes before what is there, so the first poke comes last; they do not overlap.
    let pokes = pokes.iter().map(|poke| add_poke(module, poke)).collect();
    Instruments { watches, pokes }
}

fn scalar_at(module: &Module, place: &Place) -> Type {
    let ty = type_of(module, place).and_then(PlaceType::scalar);
    ty.expect("one value is watched or poked")
}

/// Adds a field to a region; a name that is taken gets a mark.
fn add_field(module: &mut Module, region: StructId, name: &str, ty: Type, view: View) -> u32 {
    let fields = &mut module.types.structs[region].fields;
    let mut name = name.to_owned();
    while fields
        .iter()
        .any(|field| field.name.eq_ignore_ascii_case(&name))
    {
        name.push('\'');
    }
    fields.push(FieldDef::new(name, MemType::Scalar(ty)).with_view(view));
    fields.len() as u32 - 1
}

fn add_watch(module: &mut Module, watch: &Watch) -> Place {
    let ty = scalar_at(module, &watch.place);
    let view = view_of(module, &watch.place);
    let field = add_field(module, module.output, &watch.name, ty, view);
    let output = Place::root(Root::Output).field(field);
    let func = &mut module.funcs[module.scan];
    for block in func.layout.clone() {
        if !matches!(func.block(block).terminator, Some(Terminator::Return(_))) {
            continue;
        }
        let load = InstData::Load {
            place: watch.place.clone(),
        };
        let load = func.append_inst(block, load, &[ty], None);
        let store = InstData::Store {
            place: output.clone(),
            value: func.result(load),
        };
        func.append_inst(block, store, &[], None);
    }
    output
}

fn add_poke(module: &mut Module, poke: &Poke) -> (Place, Place) {
    let ty = scalar_at(module, &poke.place);
    let value = add_field(module, module.input, &poke.name, ty, View::Plain);
    let counts = add_field(
        module,
        module.input,
        &format!("{}{SET}", poke.name),
        Type::I1,
        View::Plain,
    );
    let [value, counts] = [value, counts].map(|field| Place::root(Root::Input).field(field));
    let func = &mut module.funcs[module.scan];
    let mut insts: Vec<Inst> = Vec::new();
    let mut load = |place: &Place, ty: Type| -> Value {
        let place = place.clone();
        insts.push(func.make_inst(InstData::Load { place }, &[ty], None));
        func.result(insts[insts.len() - 1])
    };
    let cond = load(&counts, Type::I1);
    let args = [load(&value, ty), load(&poke.place, ty)];
    let select = func.make_inst(InstData::Select { cond, args }, &[ty], None);
    let store = InstData::Store {
        place: poke.place.clone(),
        value: func.result(select),
    };
    let store = func.make_inst(store, &[], None);
    insts.extend([select, store]);
    let entry = func.entry();
    func.block_mut(entry).insts.splice(0..0, insts);
    (value, counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_ir::{Index, parse_module, print_module, verify};

    #[test]
    fn watches_are_stored_at_every_return_and_pokes_before_everything() {
        let mut module = parse_module(
            "module m
state { w: i16, n: i32 }
input { a: i1 }
output { y: i1 }
scan @s

fn @s[]() -> () {
b0:
  v0: i1 = load input.a
  brif v0, b1, b2
b1:
  return
b2:
  store output.y, v0
  return
}
",
        )
        .unwrap();
        let state = Place::root(Root::State);
        let watch = Watch {
            name: "Y".to_owned(),
            place: state.clone().field(0).bit(Index::Const(3)),
        };
        let poke = Poke {
            name: "n".to_owned(),
            place: state.field(1),
        };
        let instruments = instrument(&mut module, &[watch], &[poke]);
        verify(&module).unwrap();
        assert_eq!(instruments.watches, [Place::root(Root::Output).field(1)]);
        let input = Place::root(Root::Input);
        assert_eq!(
            instruments.pokes,
            [(input.clone().field(1), input.field(2))]
        );
        let text = print_module(&module);
        let expected = "input { a: i1, n: i32, \"n?set\": i1 }
output { y: i1, \"Y'\": i1 }
scan @s

fn @s[]() -> () {
b0:
  v0: i1 = load input.\"n?set\"
  v1: i32 = load input.n
  v2: i32 = load state.n
  v3: i32 = select v0, v1, v2
  store state.n, v3
  v4: i1 = load input.a
  brif v4, b1, b2
b1:
  v5: i1 = load state.w.3
  store output.\"Y'\", v5
  return
b2:
  store output.y, v4
  v6: i1 = load state.w.3
  store output.\"Y'\", v6
  return
}
";
        assert!(text.ends_with(expected), "{text}");
    }
}
