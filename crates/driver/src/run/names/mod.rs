//! Finds what users name: inputs, outputs, tags and their parts, ignoring upper and lower case.
//!
//! A path begins with a name the module knows, the longest that fits, since names may contain dots
//! themselves (`Local:1:I.Data`). From there `.Member`, `[index]`, `[i,j]` and `.bit` lead on.

mod leaves;

pub(super) use leaves::leaves;

use iecc_diag::{Code, Diagnostic, closest};
use iecc_ir::{
    FieldDef, Index, MemType, Module, Place, PlaceType, Projection, Root, StructId, Type, View,
};
use iecc_sema::hir::BASE;
use iecc_sema::hir::written::{StepKind, WrittenStep, heads, steps};
use iecc_source::Span;
use std::collections::BTreeMap;

/// Why a path names nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NameError {
    pub(super) code: Code,
    pub(super) message: String,
    /// The closest name, where one is close.
    pub(super) suggestion: Option<String>,
}

impl NameError {
    fn misfit(message: String) -> Self {
        Self {
            code: Code::E6010,
            message,
            suggestion: None,
        }
    }

    fn unknown<'c>(
        message: String,
        name: &str,
        candidates: impl IntoIterator<Item = &'c str>,
    ) -> Self {
        Self {
            code: Code::E6009,
            message,
            suggestion: closest(name, candidates).map(str::to_owned),
        }
    }

    /// As a message to the user, at a place if there is one.
    pub(super) fn into_diagnostic(self, span: Option<Span>) -> Diagnostic {
        let diagnostic = match span {
            Some(span) => Diagnostic::new(self.code, span, self.message),
            None => Diagnostic::without_place(self.code, self.message),
        };
        match self.suggestion {
            Some(name) => diagnostic.note(format!("did you mean `{name}`?")),
            None => diagnostic,
        }
    }
}

/// The names with which paths can begin.
#[derive(Debug)]
pub(super) struct Names<'m> {
    module: &'m Module,
    /// By lower-case name: the name as spelled in the program, and what it stands for.
    heads: BTreeMap<String, (&'m str, Place)>,
    /// Inputs and the variables they go to.
    inputs: Vec<(Place, Place)>,
}

impl<'m> Names<'m> {
    /// Names to look at: where an output and a tag have one name, the output is meant.
    pub(super) fn to_watch(module: &'m Module) -> Self {
        Self::new(module, [Root::Input, Root::Output, Root::State])
    }

    /// Names to set: an output cannot be set, but the tag behind it can.
    pub(super) fn to_set(module: &'m Module) -> Self {
        Self::new(module, [Root::Input, Root::State, Root::Output])
    }

    fn new(module: &'m Module, order: [Root; 3]) -> Self {
        let mut names = Self {
            module,
            heads: BTreeMap::new(),
            inputs: super::mirror::mirrored(module),
        };
        for root in order {
            if root == Root::State {
                for (name, place) in &module.names {
                    names.add(name, place.clone());
                }
            }
            for (index, field) in names.fields_of(root).iter().enumerate() {
                names.add(&field.name, Place::root(root).field(index as u32));
            }
        }
        names
    }

    fn fields_of(&self, root: Root) -> &'m [FieldDef] {
        let id = region_of(self.module, root).expect("regions have fields");
        &self.module.types.structs[id].fields
    }

    fn add(&mut self, name: &'m str, place: Place) {
        self.heads
            .entry(name.to_ascii_lowercase())
            .or_insert((name, place));
    }

    /// The place a path names.
    pub(super) fn find(&self, path: &str) -> Result<Place, NameError> {
        self.find_spelled(path).map(|(_, place)| place)
    }

    /// The place a path names, and the path as the program spells it.
    pub(super) fn find_spelled(&self, path: &str) -> Result<(String, Place), NameError> {
        let head = heads(path).find_map(|head| {
            let found = self.heads.get(&head.to_ascii_lowercase());
            found.map(|(name, place)| (*name, head, place.clone()))
        });
        let Some((name, head, start)) = head else {
            let name = heads(path).last().unwrap_or(path);
            let known = self.heads.values().map(|(name, _)| *name);
            let message = format!("no tag or point is named `{name}`");
            return Err(NameError::unknown(message, name, known));
        };
        let mut spelled = name.to_owned();
        let mut place = start;
        for step in steps(path, head) {
            place = self.follow(place, step, &mut spelled)?;
        }
        Ok((spelled, self.public(place)))
    }

    /// Another name of an input is the input.
    fn public(&self, place: Place) -> Place {
        let input = self.inputs.iter().find(|(_, state)| *state == place);
        input.map_or(place, |(input, _)| input.clone())
    }

    /// Where a step leads, which is added to the path as the program spells it.
    fn follow(
        &self,
        mut place: Place,
        step: WrittenStep<'_>,
        spelled: &mut String,
    ) -> Result<Place, NameError> {
        let before = step.before;
        let misfit = |message| Err(NameError::misfit(message));
        let Some(PlaceType::Mem(ty)) = self.type_of(&place) else {
            return misfit(format!("`{before}` is one bit and has no parts"));
        };
        match step.kind {
            StepKind::Indices(list) => {
                for index in list.split(',') {
                    place = self.element(before, place, index.trim())?;
                }
                spelled.push_str(&format!("[{list}]"));
                Ok(place)
            }
            StepKind::Member(name) => {
                let place = self.part(before, place, ty, name)?;
                spelled.push('.');
                spelled.push_str(self.last_name(&place).unwrap_or(name));
                Ok(place)
            }
            StepKind::Unclosed => misfit(format!("the bracket after `{before}` is not closed")),
            StepKind::Stray(rest) => misfit(format!("`{rest}` cannot follow `{before}`")),
        }
    }

    /// The name of the member that a place ends with.
    fn last_name(&self, place: &Place) -> Option<&'m str> {
        let (id, field) = field_at(self.module, place)?;
        Some(&self.module.types.structs[id].fields[field as usize].name)
    }

    /// What lies at a place of a region.
    pub(super) fn type_of(&self, place: &Place) -> Option<PlaceType> {
        type_of(self.module, place)
    }

    fn element(&self, before: &str, place: Place, index: &str) -> Result<Place, NameError> {
        let Some(PlaceType::Mem(MemType::Array(id))) = self.type_of(&place) else {
            return Err(NameError::misfit(format!(
                "`{before}` has no elements to count, or fewer dimensions"
            )));
        };
        let low = low_of(self.module, &place);
        let high = low + i64::from(self.module.types.array_type(id).len) - 1;
        match index.parse::<i64>() {
            Ok(index) if (low..=high).contains(&index) => {
                Ok(place.index(Index::Const((index - low) as u32)))
            }
            Ok(_) => Err(NameError::misfit(format!(
                "index {index} is outside `{before}`, which has elements {low} to {high}"
            ))),
            Err(_) => Err(NameError::misfit(format!(
                "`{index}` is no index of `{before}`"
            ))),
        }
    }

    fn part(
        &self,
        before: &str,
        place: Place,
        ty: MemType,
        name: &str,
    ) -> Result<Place, NameError> {
        match ty {
            MemType::Struct(id) => self.member(before, place, id, name),
            MemType::Scalar(ty) => bit(before, place, ty, name),
            MemType::Array(_) => Err(NameError::misfit(format!(
                "`{before}` is an array; an index must come before `.{name}`"
            ))),
        }
    }

    fn member(
        &self,
        before: &str,
        place: Place,
        id: StructId,
        name: &str,
    ) -> Result<Place, NameError> {
        let (mut place, mut looked_in) = (place, Some(id));
        let mut known = Vec::new();
        while let Some(id) = looked_in {
            let fields = &self.module.types.structs[id].fields;
            let found = |field: &FieldDef| field.name.eq_ignore_ascii_case(name);
            if let Some(index) = fields.iter().position(found) {
                return Ok(place.field(index as u32));
            }
            known.extend(fields.iter().map(|field| field.name.as_str()));
            looked_in = None;
            // What an instance inherits lies in the part of it that is the base.
            let base = fields.iter().position(|field| field.name == BASE);
            if let Some((index, MemType::Struct(base))) =
                base.map(|index| (index, fields[index].ty))
            {
                (place, looked_in) = (place.field(index as u32), Some(base));
            }
        }
        known.retain(|name| !name.contains('\''));
        let message = format!("`{before}` has no member `{name}`");
        Err(NameError::unknown(message, name, known))
    }
}

fn bit(before: &str, place: Place, ty: Type, name: &str) -> Result<Place, NameError> {
    let what = if ty.is_float() {
        "a real number"
    } else {
        "one bit"
    };
    if ty.is_float() || ty == Type::I1 {
        return Err(NameError::misfit(format!(
            "`{before}` is {what} and has no part `{name}`"
        )));
    }
    match name.parse::<u32>() {
        Ok(bit) if bit < ty.bits() => Ok(place.bit(Index::Const(bit))),
        Ok(_) => Err(NameError::misfit(format!(
            "bit {name} is outside `{before}`, which has bits 0 to {}",
            ty.bits() - 1
        ))),
        Err(_) => Err(NameError::misfit(format!(
            "`{before}` is an integer: `{name}` is no number of a bit"
        ))),
    }
}

/// The struct of a region; references are none.
fn region_of(module: &Module, root: Root) -> Option<StructId> {
    match root {
        Root::State => Some(module.state),
        Root::Input => Some(module.input),
        Root::Output => Some(module.output),
        Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => None,
    }
}

/// What lies at a static place of a region.
pub(super) fn type_of(module: &Module, place: &Place) -> Option<PlaceType> {
    let start = MemType::Struct(region_of(module, place.root)?);
    Place::walk(&module.types, start, &place.path)
}

/// How people see the value at a place of a region; a single bit is plain.
pub(super) fn view_of(module: &Module, place: &Place) -> View {
    let is_bit = matches!(place.path.last(), Some(Projection::Bit(_)));
    let is_field = |step: &Projection| matches!(step, Projection::Field(_));
    let (Some(start), Some(last)) = (
        region_of(module, place.root),
        place.path.iter().rposition(is_field),
    ) else {
        return View::Plain;
    };
    let holder = Place::walk(&module.types, MemType::Struct(start), &place.path[..last]);
    match (holder, place.path[last]) {
        (Some(PlaceType::Mem(MemType::Struct(id))), Projection::Field(field)) if !is_bit => {
            module.types.structs[id].fields[field as usize].view
        }
        _ => View::Plain,
    }
}

/// The number that people give the first element of the array at a place of a region.
fn low_of(module: &Module, array: &Place) -> i64 {
    let is_field = |step: &Projection| matches!(step, Projection::Field(_));
    let Some(last) = array.path.iter().rposition(is_field) else {
        return 0;
    };
    let holder = Place {
        root: array.root,
        path: array.path[..=last].to_vec(),
    };
    let dimension = array.path.len() - last - 1;
    let field = field_at(module, &holder).map(|(id, field)| {
        let fields = &module.types.structs[id].fields;
        &fields[field as usize]
    });
    let low = field.and_then(|field| field.lows.get(dimension));
    low.copied().unwrap_or(0)
}

/// The struct and position of the field that a place of a region ends with.
fn field_at(module: &Module, place: &Place) -> Option<(StructId, u32)> {
    let start = MemType::Struct(region_of(module, place.root)?);
    member_at_end(module, start, &place.path)
}

fn member_at_end(module: &Module, start: MemType, path: &[Projection]) -> Option<(StructId, u32)> {
    let (&Projection::Field(field), before) = path.split_last()? else {
        return None;
    };
    match Place::walk(&module.types, start, before)? {
        PlaceType::Mem(MemType::Struct(id)) => Some((id, field)),
        PlaceType::Mem(MemType::Scalar(_) | MemType::Array(_)) | PlaceType::Bit => None,
    }
}

#[cfg(test)]
mod tests;
