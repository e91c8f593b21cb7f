//! Finds what users name: inputs, outputs, tags and their parts, ignoring upper and lower case.
//!
//! A path begins with a name the module knows, the longest that fits, since names may contain dots
//! themselves (`Local:1:I.Data`). From there `.Member`, `[index]`, `[i,j]` and `.bit` lead on.

use iecc_diag::{Code, Diagnostic, closest};
use iecc_ir::{
    FieldDef, Index, InstData, Layout, MemType, Module, Place, PlaceType, Projection, Root,
    StructId, Type, View,
};
use iecc_sema::hir::BASE;
use iecc_source::Span;
use std::collections::{BTreeMap, BTreeSet};

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
        let ends = path.match_indices(['.', '[']).map(|(at, _)| at);
        let ends: Vec<usize> = ends.chain([path.len()]).collect();
        let head = ends.iter().rev().find_map(|&end| {
            let found = self.heads.get(&path[..end].to_ascii_lowercase());
            found.map(|(name, place)| (*name, end, place.clone()))
        });
        match head {
            Some((name, end, place)) => {
                let mut spelled = name.to_owned();
                let place = self.walk(path, end, place, &mut spelled)?;
                Ok((spelled, self.public(place)))
            }
            None => {
                let name = &path[..ends[0]];
                let known = self.heads.values().map(|(name, _)| *name);
                let message = format!("no tag or point is named `{name}`");
                Err(NameError::unknown(message, name, known))
            }
        }
    }

    /// Another name of an input is the input.
    fn public(&self, place: Place) -> Place {
        let input = self.inputs.iter().find(|(_, state)| *state == place);
        input.map_or(place, |(input, _)| input.clone())
    }

    fn walk(
        &self,
        path: &str,
        mut at: usize,
        mut place: Place,
        spelled: &mut String,
    ) -> Result<Place, NameError> {
        while at < path.len() {
            let before = &path[..at];
            let Some(PlaceType::Mem(ty)) = self.type_of(&place) else {
                return Err(NameError::misfit(format!(
                    "`{before}` is one bit and has no parts"
                )));
            };
            if let Some(rest) = path[at..].strip_prefix('[') {
                let close = rest.find(']').ok_or_else(|| {
                    NameError::misfit(format!("the bracket after `{before}` is not closed"))
                })?;
                for index in rest[..close].split(',') {
                    place = self.element(before, place, index.trim())?;
                }
                spelled.push_str(&path[at..at + close + 2]);
                at += close + 2;
            } else if let Some(rest) = path[at..].strip_prefix('.') {
                let end = rest.find(['.', '[']).unwrap_or(rest.len());
                place = self.part(before, place, ty, &rest[..end])?;
                spelled.push('.');
                spelled.push_str(self.last_name(&place).unwrap_or(&rest[..end]));
                at += end + 1;
            } else {
                let rest = &path[at..];
                return Err(NameError::misfit(format!(
                    "`{rest}` cannot follow `{before}`"
                )));
            }
        }
        Ok(place)
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

/// The values at a place, each with its path below `name`. Times that `elapsed` keeps are left out:
/// they belong to the machinery, not to the program.
pub(super) fn leaves(
    module: &Module,
    name: &str,
    place: &Place,
    most: u64,
) -> Result<Vec<(String, Place)>, NameError> {
    let ty = match type_of(module, place) {
        Some(PlaceType::Mem(ty)) => ty,
        Some(PlaceType::Bit) | None => return Ok(vec![(name.to_owned(), place.clone())]),
    };
    let count = leaf_count(module, ty);
    if count > most {
        return Err(NameError::misfit(format!(
            "`{name}` has {count} values, at most {most} can be shown at once"
        )));
    }
    let (kept, base) = (kept_times(module), place.path.len());
    let mut found = Vec::new();
    Layout::new(&module.types).for_each_leaf(&module.types, place, ty, &mut |leaf, _, _| {
        let hidden =
            leaf.path.len() > base && field_at(module, leaf).is_some_and(|m| kept.contains(&m));
        if !hidden {
            let name = format!("{name}{}", spell(module, leaf, base));
            found.push((name, leaf.clone()));
        }
    });
    Ok(found)
}

fn leaf_count(module: &Module, ty: MemType) -> u64 {
    match ty {
        MemType::Scalar(_) => 1,
        MemType::Struct(id) => {
            let fields = &module.types.structs[id].fields;
            fields.iter().fold(0, |sum, field| {
                sum.saturating_add(leaf_count(module, field.ty))
            })
        }
        MemType::Array(id) => {
            let array = module.types.array_type(id);
            leaf_count(module, array.element).saturating_mul(u64::from(array.len))
        }
    }
}

/// The way to a value, from a step on.
fn spell(module: &Module, leaf: &Place, from: usize) -> String {
    let mut text = String::new();
    let mut at = Place {
        root: leaf.root,
        path: leaf.path[..from].to_vec(),
    };
    for step in &leaf.path[from..] {
        if let Projection::Index(Index::Const(index)) = step {
            let index = low_of(module, &at) + i64::from(*index);
            text.push_str(&format!("[{index}]"));
        }
        at.path.push(*step);
        if let Projection::Field(_) = step {
            let (id, field) = field_at(module, &at).expect("leaves are static places");
            text.push('.');
            text.push_str(&module.types.structs[id].fields[field as usize].name);
        }
    }
    text
}

/// The members that `elapsed` uses, by struct and position.
fn kept_times(module: &Module) -> BTreeSet<(StructId, u32)> {
    let mut kept = BTreeSet::new();
    for func in module.funcs.values() {
        for &block in &func.layout {
            for &inst in &func.block(block).insts {
                if let InstData::Elapsed { place, .. } = func.inst(inst) {
                    let start = module.root_type(func, place.root);
                    kept.extend(start.and_then(|start| member_at_end(module, start, &place.path)));
                }
            }
        }
    }
    kept
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
mod tests {
    use super::*;
    use iecc_ir::{parse_module, print_place};

    const MODULE: &str = "module m
struct TIMER { DN: i1, PRE: i32, last: i64 }
struct Fan { speed: i8 }
struct Blower { \"base'\": Fan, heat: i8 }
state { Motor: i1, t: TIMER, b: Blower, \"Local:1:I.Data\": i16, grid: [2 x [3 x i8]], r: f32 }
input { Start: i1 }
output { Motor: i1 }
name Alias = state.\"Local:1:I.Data\".3
name Word = state.\"Local:1:I.Data\"
scan @s
fn @s[]() -> () {
b0:
  v0: i32 = elapsed state.t.last, 1ms
  return
}
";

    fn show(module: &Module, place: &Place) -> String {
        print_place(module, &module.funcs[module.scan], place)
    }

    #[test]
    fn paths_are_followed_ignoring_case() {
        let module = parse_module(MODULE).unwrap();
        let (watch, set) = (Names::to_watch(&module), Names::to_set(&module));
        for (path, expected) in [
            ("start", "input.Start"),
            ("T.pre", "state.t.PRE"),
            ("alias", "state.\"Local:1:I.Data\".3"),
            ("WORD.15", "state.\"Local:1:I.Data\".15"),
            ("local:1:i.data.0", "state.\"Local:1:I.Data\".0"),
            ("grid[1][2]", "state.grid[1][2]"),
            ("grid[1, 2]", "state.grid[1][2]"),
            ("grid[0,1].7", "state.grid[0][1].7"),
            ("t", "state.t"),
            ("b.Heat", "state.b.heat"),
            ("b.Speed", "state.b.\"base'\".speed"),
        ] {
            assert_eq!(
                show(&module, &watch.find(path).unwrap()),
                expected,
                "{path}"
            );
            assert_eq!(show(&module, &set.find(path).unwrap()), expected, "{path}");
        }
        assert_eq!(show(&module, &watch.find("motor").unwrap()), "output.Motor");
        assert_eq!(show(&module, &set.find("motor").unwrap()), "state.Motor");
    }

    #[test]
    fn paths_are_shown_as_the_program_spells_them() {
        let module = parse_module(MODULE).unwrap();
        let names = Names::to_watch(&module);
        for (path, expected) in [
            ("start", "Start"),
            ("T.pre", "t.PRE"),
            ("WORD.15", "Word.15"),
            ("GRID[1, 2].7", "grid[1, 2].7"),
            ("B.Speed", "b.speed"),
        ] {
            let spelled = names.find_spelled(path).unwrap().0;
            assert!(spelled.eq_ignore_ascii_case(path), "{path}");
            assert_eq!(spelled, expected, "{path}");
        }
    }

    #[test]
    fn what_is_not_found_is_explained() {
        let module = parse_module(MODULE).unwrap();
        let names = Names::to_watch(&module);
        for (path, message, suggestion) in [
            ("Strat", "no tag or point is named `Strat`", Some("Start")),
            ("xyzzy.3", "no tag or point is named `xyzzy`", None),
            ("t.PER", "`t` has no member `PER`", Some("PRE")),
            (
                "grid[2]",
                "index 2 is outside `grid`, which has elements 0 to 1",
                None,
            ),
            ("grid[x]", "`x` is no index of `grid`", None),
            ("grid[0", "the bracket after `grid` is not closed", None),
            (
                "grid.x",
                "`grid` is an array; an index must come before `.x`",
                None,
            ),
            (
                "t[0]",
                "`t` has no elements to count, or fewer dimensions",
                None,
            ),
            (
                "t.PRE.32",
                "bit 32 is outside `t.PRE`, which has bits 0 to 31",
                None,
            ),
            (
                "t.PRE.x",
                "`t.PRE` is an integer: `x` is no number of a bit",
                None,
            ),
            ("t.DN.0", "`t.DN` is one bit and has no part `0`", None),
            ("alias.0", "`alias` is one bit and has no parts", None),
            ("r.0", "`r` is a real number and has no part `0`", None),
            ("grid[0]x", "`x` cannot follow `grid[0]`", None),
        ] {
            let error = names.find(path).unwrap_err();
            assert_eq!(
                (error.message.as_str(), error.suggestion.as_deref()),
                (message, suggestion)
            );
        }
        assert!(names.find("").is_err());
    }

    #[test]
    fn a_structure_stands_for_its_values_without_kept_times() {
        let module = parse_module(MODULE).unwrap();
        let names = Names::to_watch(&module);
        let all = |path: &str, most| {
            let found = leaves(&module, path, &names.find(path).unwrap(), most)?;
            Ok::<_, NameError>(found.into_iter().map(|(name, _)| name).collect::<Vec<_>>())
        };
        assert_eq!(all("t", 9).unwrap(), ["t.DN", "t.PRE"]);
        assert_eq!(all("t.last", 9).unwrap(), ["t.last"]);
        assert_eq!(
            all("grid[1]", 9).unwrap(),
            ["grid[1][0]", "grid[1][1]", "grid[1][2]"]
        );
        assert_eq!(all("alias", 9).unwrap(), ["alias"]);
        let error = all("grid", 5).unwrap_err();
        assert_eq!(
            error.message,
            "`grid` has 6 values, at most 5 can be shown at once"
        );
    }

    const FROM: &str = "module m
struct ROW { cells: [2 x [2 x i16]] from [1, -1], n: i8 }
state { rows: [2 x ROW] from [5], plain: [2 x i8] }
input { }
output { }
scan @s
fn @s[]() -> () {
b0:
  return
}
";

    #[test]
    fn elements_have_the_numbers_that_people_give_them() {
        let module = parse_module(FROM).unwrap();
        iecc_ir::verify(&module).unwrap();
        let names = Names::to_watch(&module);
        for (path, expected) in [
            ("rows[5].cells[1,-1]", "state.rows[0].cells[0][0]"),
            ("rows[6].cells[2][0].3", "state.rows[1].cells[1][1].3"),
            ("plain[1]", "state.plain[1]"),
        ] {
            assert_eq!(
                show(&module, &names.find(path).unwrap()),
                expected,
                "{path}"
            );
        }
        for (path, expected) in [
            (
                "rows[4]",
                "index 4 is outside `rows`, which has elements 5 to 6",
            ),
            (
                "rows[5].cells[0]",
                "index 0 is outside `rows[5].cells`, which has elements 1 to 2",
            ),
        ] {
            assert_eq!(names.find(path).unwrap_err().message, expected);
        }
        let place = names.find("rows[6]").unwrap();
        let found = leaves(&module, "rows[6]", &place, 10).unwrap();
        let found: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        let cells = ["[1][-1]", "[1][0]", "[2][-1]", "[2][0]"].map(|i| format!("rows[6].cells{i}"));
        assert_eq!(found[..4], cells);
        assert_eq!(found[4], "rows[6].n");
    }
}
