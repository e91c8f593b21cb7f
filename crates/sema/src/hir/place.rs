//! Places: a tag and the way into it.

use crate::hir::{Elementary, TagId, Type, Types};
use std::fmt::Write;

/// One step into a tag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Member of a structure, by position.
    Field(u32),
    /// Element of an array, from 0, within bounds.
    Index(u32),
    /// Bit of an integer, 0 the lowest; always last.
    Bit(u32),
}

/// A part of a tag.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// Where it begins.
    pub tag: TagId,
    /// The steps.
    pub path: Vec<Step>,
}

/// What an instruction does with a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Access {
    /// Its value is used.
    Read,
    /// It may be changed.
    Write,
    /// Both.
    ReadWrite,
}

impl Place {
    /// A whole tag.
    pub fn whole(tag: TagId) -> Self {
        Self {
            tag,
            path: Vec::new(),
        }
    }

    /// The place one step further.
    #[must_use]
    pub fn step(mut self, step: Step) -> Self {
        self.path.push(step);
        self
    }

    /// The place without a bit step at its end, and the bit.
    pub fn split_bit(&self) -> (Place, Option<u32>) {
        match self.path.split_last() {
            Some((Step::Bit(bit), path)) => {
                let word = Place {
                    tag: self.tag,
                    path: path.to_vec(),
                };
                (word, Some(*bit))
            }
            Some((Step::Field(_) | Step::Index(_), _)) | None => (self.clone(), None),
        }
    }

    /// The type at the end of the path through a tag of type `ty`; `BOOL` for a bit.
    pub(crate) fn type_from(&self, types: &Types, ty: Type) -> Type {
        self.path.iter().fold(ty, |at, step| match (at, step) {
            (Type::Struct(id), Step::Field(index)) => {
                types.struct_def(id).members[*index as usize].ty
            }
            (Type::Array(id), Step::Index(_)) => types.array_def(id).element,
            (Type::Elementary(_), Step::Bit(_)) => Type::Elementary(Elementary::Bool),
            (Type::Struct(_) | Type::Array(_) | Type::Elementary(_), _) => {
                panic!("places are checked when they are made")
            }
        })
    }

    /// The place as users write it: `tag.member[1,2].3`, in a tag `name` of type `ty`.
    pub(crate) fn display(&self, types: &Types, name: &str, ty: Type) -> String {
        let (mut text, mut at, mut in_index) = (name.to_owned(), ty, false);
        for step in &self.path {
            let ended = match (at, step) {
                (Type::Struct(id), Step::Field(index)) => {
                    let member = &types.struct_def(id).members[*index as usize];
                    at = member.ty;
                    write!(text, ".{}", member.name)
                }
                (Type::Array(id), Step::Index(index)) => {
                    let array = types.array_def(id);
                    let index = array.low + i64::from(*index);
                    at = array.element;
                    if in_index {
                        text.pop();
                        write!(text, ",{index}]")
                    } else {
                        write!(text, "[{index}]")
                    }
                }
                (Type::Elementary(_), Step::Bit(bit)) => write!(text, ".{bit}"),
                (Type::Struct(_) | Type::Array(_) | Type::Elementary(_), _) => {
                    panic!("places are checked when they are made")
                }
            };
            ended.expect("writing to memory");
            in_index = matches!(step, Step::Index(_));
        }
        text
    }
}
