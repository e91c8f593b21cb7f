//! What a body can name: variables, and the ways from them to members, elements, bits, characters,
//! and what references refer to.

use super::signatures::{Unit, Way};
use super::types::{Elementary, Kind, Type, Types};

/// How deep ways go.
const DEPTH: usize = 4;
/// Ways that are remembered.
const MOST: usize = 400;

/// A variable of a body.
#[derive(Debug, Clone)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) ty: Type,
    /// Whether the body may assign it.
    pub(super) write: bool,
    /// Whether it lives between scans, so that a reference to it may be kept.
    pub(super) keeps: bool,
}

#[derive(Debug, Clone)]
pub(super) enum Step {
    Word(String),
    /// A subscript for each dimension.
    Index(Vec<(i64, i64)>),
    /// A subscript within the bounds of the `ARRAY [*]` of this name.
    Open(String),
    /// A character of a string that has so many at most.
    Character(u32),
}

/// A way to something.
#[derive(Debug, Clone)]
pub(super) struct Route {
    pub(super) steps: Vec<Step>,
    pub(super) ty: Type,
    pub(super) write: bool,
    pub(super) keeps: bool,
    /// Whether it is more than bits or a character of a variable.
    pub(super) whole: bool,
}

impl Route {
    fn then(&self, step: Step, ty: Type) -> Self {
        let mut steps = self.steps.clone();
        steps.push(step);
        Self {
            steps,
            ty,
            ..self.clone()
        }
    }
}

/// All ways from some variables.
pub(super) fn routes(variables: &[Variable], types: &Types, units: &[Unit]) -> Vec<Route> {
    let mut found: Vec<Route> = variables
        .iter()
        .map(|variable| Route {
            steps: vec![Step::Word(variable.name.clone())],
            ty: variable.ty,
            write: variable.write,
            keeps: variable.keeps,
            // A point behind an address would be a part of the address.
            whole: !variable.name.starts_with('%'),
        })
        .collect();
    let mut next = 0;
    while next < found.len() && found.len() < MOST {
        let route = found[next].clone();
        if route.steps.len() < DEPTH && route.whole {
            found.extend(onward(&route, types, units));
        }
        next += 1;
    }
    found
}

/// The ways that go one step further.
fn onward(route: &Route, types: &Types, units: &[Unit]) -> Vec<Route> {
    match route.ty {
        Type::Elementary(ty) if ty.kind() == Kind::Bits => bits(route, ty),
        Type::Text { wide, length } => {
            let ty = if wide {
                Elementary::Wchar
            } else {
                Elementary::Char
            };
            let step = Step::Character(length);
            let character = route.then(step, Type::Elementary(ty));
            vec![Route {
                whole: false,
                ..character
            }]
        }
        Type::Array(at) => {
            let array = &types.arrays[at];
            let step = Step::Index(array.bounds.clone());
            vec![route.then(step, array.element)]
        }
        Type::Open(element) => {
            let Step::Word(name) = &route.steps[0] else {
                unreachable!("ways begin with a name");
            };
            vec![route.then(Step::Open(name.clone()), Type::Elementary(element))]
        }
        Type::Structure(at) => {
            let members = types.structures[at].members.iter();
            let step = |name: &String| Step::Word(format!(".{name}"));
            members
                .map(|(name, ty)| route.then(step(name), *ty))
                .collect()
        }
        Type::Reference(at) => {
            let target = route.then(Step::Word("^".to_owned()), types.references[at]);
            vec![Route {
                write: true,
                keeps: false,
                ..target
            }]
        }
        Type::Instance(at) => outputs(route, &units[at]),
        Type::Elementary(_) | Type::Enumeration(_) | Type::Subrange(_) => Vec::new(),
    }
}

fn bits(route: &Route, ty: Elementary) -> Vec<Route> {
    let last = ty.bits() - 1;
    let mut parts = vec![
        (".0".to_owned(), Elementary::Bool),
        (format!(".{last}"), Elementary::Bool),
        (format!(".%X{}", last / 2), Elementary::Bool),
    ];
    if ty.bits() > 8 {
        parts.push((".%B1".to_owned(), Elementary::Byte));
    }
    if ty.bits() > 16 {
        parts.push((".%W1".to_owned(), Elementary::Word));
    }
    if ty.bits() > 32 {
        parts.push((".%D0".to_owned(), Elementary::Dword));
    }
    let parts = parts.into_iter();
    let part = |(text, ty)| Route {
        whole: false,
        ..route.then(Step::Word(text), Type::Elementary(ty))
    };
    parts.map(part).collect()
}

/// The outputs of an instance can be read.
fn outputs(route: &Route, unit: &Unit) -> Vec<Route> {
    let params = unit.body.iter().flat_map(|body| &body.params);
    let outputs = params.filter(|param| param.way == Way::Out);
    let output = |name: &String, ty| Route {
        write: false,
        keeps: false,
        // It cannot be changed, so it cannot be an in-out.
        ..route.then(Step::Word(format!(".{name}")), ty)
    };
    outputs.map(|param| output(&param.name, param.ty)).collect()
}
