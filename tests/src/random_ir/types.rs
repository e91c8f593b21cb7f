//! Random structs and arrays, and the regions made of them.

use super::Options;
use crate::rng::Rng;
use iecc_ir::{FieldDef, MemType, Place, Projection, StructId, Type, TypeTable, View};

/// Timers of a module.
pub(super) const TIMERS: u32 = 3;
/// Fields of a timer: what it has counted, whether that is enough, and the time it last ran, which
/// only `elapsed` uses.
pub(super) const ACC: u32 = 0;
pub(super) const DONE: u32 = 1;
pub(super) const LAST: u32 = 2;

/// The types of a module.
pub(super) struct RandomTypes {
    pub(super) table: TypeTable,
    pub(super) state: StructId,
    pub(super) input: StructId,
    pub(super) output: StructId,
    values: Vec<Type>,
    /// What references may refer to.
    memory: Vec<MemType>,
}

/// The value types a module with these options may use.
pub(super) fn value_types(options: &Options) -> Vec<Type> {
    let all = Type::ALL.into_iter();
    all.filter(|ty| options.floats || ty.is_int()).collect()
}

impl RandomTypes {
    pub(super) fn new(rng: &mut Rng, options: &Options) -> Self {
        let values = value_types(options);
        let mut table = TypeTable::default();
        let mut memory: Vec<MemType> = values.iter().copied().map(MemType::Scalar).collect();
        for index in 0..2 + rng.below(3) {
            let fields = fields(rng, &memory, &mut table, 1);
            let id = table.add_struct(format!("S{index}"), fields);
            memory.push(MemType::Struct(id));
        }
        // A state that holds each type once makes every reference type callable.
        let mut state = fields(rng, &memory, &mut table, 4);
        state.extend(each(&memory));
        memory.extend(state.iter().map(|field| field.ty));
        state.extend(timers(&mut table));
        let inputs = fields(rng, &memory[..values.len()], &mut table, 4);
        let mut outputs = fields(rng, &memory[..values.len()], &mut table, 2);
        outputs.extend(each(&memory[..values.len()]));
        Self {
            state: table.add_struct("state", state),
            input: table.add_struct("input", inputs),
            output: table.add_struct("output", outputs),
            table,
            values,
            memory,
        }
    }

    /// Whether a place of the state lies in a timer.
    pub(super) fn is_timer(&self, place: &Place) -> bool {
        let first = timer_field(&self.table, self.state, 0);
        matches!(place.path.first(), Some(Projection::Field(field)) if *field >= first)
    }

    pub(super) fn random_values(&self, rng: &mut Rng, most: usize) -> Vec<Type> {
        (0..rng.below(most + 1))
            .map(|_| rng.pick(&self.values))
            .collect()
    }

    /// Types of locals: some functions have none, some structs and arrays.
    pub(super) fn random_locals(&self, rng: &mut Rng) -> Vec<MemType> {
        let count = rng.below(4);
        (0..count).map(|_| rng.pick(&self.memory)).collect()
    }

    pub(super) fn random_refs(&self, rng: &mut Rng) -> Vec<MemType> {
        let scalars = &self.memory[..self.values.len()];
        let count = rng.below(4);
        let kinds = [scalars, self.memory.as_slice()];
        (0..count)
            .map(|_| {
                let kind = rng.pick(&kinds);
                rng.pick(kind)
            })
            .collect()
    }
}

/// One field of each type.
fn each(memory: &[MemType]) -> Vec<FieldDef> {
    let fields = (0..).zip(memory);
    let fields = fields.map(|(index, &ty): (usize, _)| FieldDef::new(format!("each{index}"), ty));
    fields.collect()
}

fn timers(table: &mut TypeTable) -> impl Iterator<Item = FieldDef> + use<> {
    let field = |name: &str, ty| FieldDef::new(name, MemType::Scalar(ty));
    let fields = vec![
        field("acc", Type::I32),
        field("done", Type::I1),
        field("last", Type::I64),
    ];
    let ty = MemType::Struct(table.add_struct("TIMER", fields));
    (0..TIMERS).map(move |index| FieldDef::new(format!("timer{index}"), ty))
}

/// The field of the state that holds a timer: they are its last.
pub(super) fn timer_field(table: &TypeTable, state: StructId, timer: u32) -> u32 {
    table.structs[state].fields.len() as u32 - TIMERS + timer
}

/// At least `least` fields of the types, some in arrays; one name needs quotes.
fn fields(rng: &mut Rng, memory: &[MemType], table: &mut TypeTable, least: usize) -> Vec<FieldDef> {
    let count = least + rng.below(4);
    let mut fields = Vec::with_capacity(count);
    for index in 0..count {
        let mut ty = rng.pick(memory);
        while rng.one_in(3) {
            ty = MemType::Array(table.array(ty, 1 + rng.below(4) as u32));
        }
        let name = if index == 1 {
            "Local:1:I.\"x\"".to_owned()
        } else {
            format!("x{index}")
        };
        let view = random_view(rng, table, ty);
        let lows = random_lows(rng, table, ty);
        fields.push(FieldDef::new(name, ty).with_view(view).with_lows(lows));
    }
    fields
}

fn random_lows(rng: &mut Rng, table: &TypeTable, mut ty: MemType) -> Vec<i64> {
    let mut lows = Vec::new();
    while let MemType::Array(id) = ty {
        lows.push(rng.pick(&[0, 1, -3]));
        ty = table.array_type(id).element;
    }
    lows
}

fn random_view(rng: &mut Rng, table: &TypeTable, mut ty: MemType) -> View {
    while let MemType::Array(id) = ty {
        ty = table.array_type(id).element;
    }
    let view = rng.pick(&View::ALL);
    match ty {
        MemType::Scalar(scalar) if view.fits(scalar) => view,
        MemType::Scalar(_) | MemType::Struct(_) | MemType::Array(_) => View::Plain,
    }
}
