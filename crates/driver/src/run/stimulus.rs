//! A stimulus: what is set before which scan.
//!
//! Reading the text and binding it to a module are separate, so that mistakes in the text are found
//! without a program, and values are checked against the types of what they set.

use super::csv_text::{Cell, records};
use super::names::{NameError, Names, type_of, view_of};
use super::time::{TimeUnit, decimal};
use super::value::parse_value;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_ir::{Function, InstData, Module, Place, PlaceType, Projection, Root, Type, View};
use iecc_source::{FileId, Span};
use std::collections::BTreeMap;

/// More messages about one file help nobody.
const MAX_MESSAGES: usize = 20;

/// One row: at which time which cells count.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Row {
    time_ns: u64,
    cells: Vec<Cell>,
}

/// A stimulus as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stimulus {
    columns: Vec<Cell>,
    rows: Vec<Row>,
}

/// What a column sets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Setting {
    /// A scalar or bit of the input region.
    Input(Place),
    /// A scalar or bit of the state, which needs a poke.
    Poke(Place),
}

impl Setting {
    fn place(&self) -> &Place {
        match self {
            Self::Input(place) | Self::Poke(place) => place,
        }
    }
}

/// A column that sets something.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BoundColumn {
    pub(super) name: String,
    pub(super) setting: Setting,
    pub(super) ty: Type,
    pub(super) view: View,
}

/// What happens at the first scan at or after a time: columns by number and the bits they get.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct BoundRow {
    pub(super) time_ns: u64,
    pub(super) values: Vec<(usize, u64)>,
}

/// A stimulus that fits a module.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct BoundStimulus {
    pub(super) columns: Vec<BoundColumn>,
    pub(super) rows: Vec<BoundRow>,
}

impl Stimulus {
    /// Reads the text of a stimulus; `None` after mistakes, which are all in `diagnostics`.
    pub fn parse(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> Option<Self> {
        let mut found = Diagnostics::new();
        let stimulus = parse(file, text, &mut found);
        let faultless = !found.has_errors();
        diagnostics.append(found);
        stimulus.filter(|_| faultless)
    }

    /// Looks up the columns and reads the values; `None` after mistakes.
    pub(super) fn bind(
        &self,
        module: &Module,
        diagnostics: &mut Diagnostics,
    ) -> Option<BoundStimulus> {
        let mut found = Diagnostics::new();
        let columns = bind_columns(&self.columns, module, &mut found);
        let mut bound = BoundStimulus::default();
        for row in &self.rows {
            let mut values = Vec::new();
            for (number, (column, cell)) in columns.iter().zip(&row.cells).enumerate() {
                if let Some(column) = column.as_ref().filter(|_| !cell.text.is_empty()) {
                    values.extend(read_value(column, cell, &mut found).map(|bits| (number, bits)));
                }
            }
            bound.rows.push(BoundRow {
                time_ns: row.time_ns,
                values,
            });
            if found.len() >= MAX_MESSAGES {
                break;
            }
        }
        let faultless = !found.has_errors();
        diagnostics.append(found);
        bound.columns = columns.into_iter().flatten().collect();
        faultless.then_some(bound)
    }

    /// The same for what sets inputs only; a column that pokes a tag is a mistake (E6012).
    pub(super) fn bind_inputs(
        &self,
        module: &Module,
        diagnostics: &mut Diagnostics,
    ) -> Option<BoundStimulus> {
        let bound = self.bind(module, diagnostics)?;
        let mut faultless = true;
        for (cell, column) in self.columns.iter().zip(&bound.columns) {
            match column.setting {
                Setting::Input(_) => {}
                Setting::Poke(_) => {
                    let message = format!(
                        "`{}` is no input, and a testbench reaches hardware through its inputs only",
                        cell.text
                    );
                    diagnostics.push(Diagnostic::new(Code::E6012, cell.span, message));
                    faultless = false;
                }
            }
        }
        faultless.then_some(bound)
    }
}

fn parse(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> Option<Stimulus> {
    let mut records = records(file, text).into_iter();
    let mut header = records.next().unwrap_or_default().into_iter();
    let first = header.next();
    let unit = first.as_ref().and_then(|cell| time_unit(&cell.text));
    let Some(unit) = unit else {
        let span = first.map_or(Span::point(file, 0), |cell| cell.span);
        let message = "the first column of a stimulus is its time: t_ms, t_us or t_ns";
        diagnostics.push(Diagnostic::new(Code::E6003, span, message).label("no unit of time"));
        return None;
    };
    let columns: Vec<Cell> = header.collect();
    let mut stimulus = Stimulus {
        columns,
        rows: Vec::new(),
    };
    let mut before = None;
    for record in records {
        if let Some(row) = row(
            record,
            stimulus.columns.len() + 1,
            unit,
            &mut before,
            diagnostics,
        ) {
            stimulus.rows.push(row);
        }
        if diagnostics.len() >= MAX_MESSAGES {
            break;
        }
    }
    Some(stimulus)
}

fn time_unit(name: &str) -> Option<TimeUnit> {
    let mut units = TimeUnit::ALL.into_iter();
    units.find(|unit| unit.column().eq_ignore_ascii_case(name))
}

/// Reads a row; `before` is the time of the row before it and where that stands.
fn row(
    record: Vec<Cell>,
    width: usize,
    unit: TimeUnit,
    before: &mut Option<(u64, Span)>,
    diagnostics: &mut Diagnostics,
) -> Option<Row> {
    let (start, count) = (record[0].span, record.len());
    if count != width {
        let end = record[count - 1].span;
        let message = format!("the row has {}, the header {}", cells(count), cells(width));
        diagnostics.push(Diagnostic::new(Code::E6004, start.to(end), message));
        return None;
    }
    let mut cells = record.into_iter();
    let time = cells.next().expect("rows have a first cell");
    let time_ns = match decimal(&time.text, unit.nanoseconds()) {
        Ok(time_ns) => time_ns,
        Err(what) => {
            let message = format!(
                "`{}` is no time in the unit of {}: {what}",
                time.text,
                unit.column()
            );
            diagnostics.push(Diagnostic::new(Code::E6005, time.span, message));
            return None;
        }
    };
    if let Some((_, earlier)) = before.filter(|(earlier_ns, _)| *earlier_ns >= time_ns) {
        let message = "the time of this row is not later than that of the row before";
        diagnostics
            .push(Diagnostic::new(Code::E6006, time.span, message).also(earlier, "the row before"));
    }
    *before = Some((time_ns, time.span));
    Some(Row {
        time_ns,
        cells: cells.collect(),
    })
}

fn cells(count: usize) -> String {
    format!("{count} cell{}", if count == 1 { "" } else { "s" })
}

fn bind_columns(
    columns: &[Cell],
    module: &Module,
    diagnostics: &mut Diagnostics,
) -> Vec<Option<BoundColumn>> {
    let (names, copies) = (Names::to_set(module), input_copies(module));
    let mut bound: Vec<Option<BoundColumn>> = Vec::new();
    for cell in columns {
        match bind_column(&cell.text, module, &names, &copies) {
            Ok(column) => {
                let same = bound.iter().position(|earlier| {
                    let earlier = earlier.as_ref().map(|earlier| earlier.setting.place());
                    earlier.is_some_and(|earlier| earlier.may_overlap(column.setting.place()))
                });
                if let Some(earlier) = same {
                    let message = format!("`{}` sets what an earlier column sets", cell.text);
                    let diagnostic = Diagnostic::new(Code::E6011, cell.span, message);
                    diagnostics.push(diagnostic.also(columns[earlier].span, "the earlier column"));
                }
                bound.push(Some(column));
            }
            Err(error) => {
                diagnostics.push(error.into_diagnostic(Some(cell.span)));
                bound.push(None);
            }
        }
    }
    bound
}

fn bind_column(
    name: &str,
    module: &Module,
    names: &Names<'_>,
    copies: &BTreeMap<Place, Place>,
) -> Result<BoundColumn, NameError> {
    let place = names.find(name)?;
    let refuse = |code, message| {
        Err(NameError {
            code,
            message,
            suggestion: None,
        })
    };
    let Some(ty) = type_of(module, &place).and_then(PlaceType::scalar) else {
        return refuse(
            Code::E6010,
            format!("`{name}` is not one value; name one of its parts"),
        );
    };
    let view = view_of(module, &place);
    let setting = match place.root {
        Root::Input => Setting::Input(place),
        Root::State => match copied_from(&place, copies) {
            Some(input) => Setting::Input(input),
            None if copies.keys().any(|copy| copy.may_overlap(&place)) => {
                let message = format!(
                    "parts of `{name}` are inputs, which are copied into it before every scan"
                );
                return refuse(Code::E6012, message);
            }
            None => Setting::Poke(place),
        },
        Root::Output | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => {
            return refuse(
                Code::E6012,
                format!("`{name}` is an output, which the program sets"),
            );
        }
    };
    Ok(BoundColumn {
        name: name.to_owned(),
        setting,
        ty,
        view,
    })
}

/// The state that the scan function copies from inputs before it does anything else: setting a copy
/// means setting the input.
fn input_copies(module: &Module) -> BTreeMap<Place, Place> {
    let func = &module.funcs[module.scan];
    let mut copies = BTreeMap::new();
    for &inst in &func.block(func.entry()).insts {
        let data = func.inst(inst);
        if let Some((copy, input)) = input_copy(func, data) {
            copies.insert(copy.clone(), input.clone());
        } else if !matches!(data, InstData::Load { place } if place.root == Root::Input) {
            break;
        }
    }
    copies
}

/// The state and the input, if the instruction stores one in the other.
fn input_copy<'f>(func: &'f Function, data: &'f InstData) -> Option<(&'f Place, &'f Place)> {
    let InstData::Store { place, value } = data else {
        return None;
    };
    let Some(InstData::Load { place: input }) = func.def_inst(*value) else {
        return None;
    };
    let roots = (place.root, input.root) == (Root::State, Root::Input);
    (roots && place.is_static() && input.is_static()).then_some((place, input))
}

fn copied_from(place: &Place, copies: &BTreeMap<Place, Place>) -> Option<Place> {
    if let Some(input) = copies.get(place) {
        return Some(input.clone());
    }
    let (bit @ Projection::Bit(_), word) = place.path.split_last()? else {
        return None;
    };
    let word = Place {
        root: place.root,
        path: word.to_vec(),
    };
    copies.get(&word).map(|input| input.clone().join(&[*bit]))
}

fn read_value(column: &BoundColumn, cell: &Cell, diagnostics: &mut Diagnostics) -> Option<u64> {
    match parse_value(&cell.text, column.ty, column.view) {
        Ok(bits) => Some(bits),
        Err(error) => {
            let what = if error.code == Code::E6008 {
                "does not fit"
            } else {
                "is no value of"
            };
            let message = format!("`{}` {what} `{}`: {}", cell.text, column.name, error.reason);
            diagnostics.push(Diagnostic::new(error.code, cell.span, message));
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_ir::{Index, parse_module};

    const MODULE: &str = "module m
state { word: i16, in: i16, n: i8, points: i16 }
input { Start: i1, In: i16, P0: i1 }
output { Lamp: i1 }
name \"Local:1:I.0\" = state.word.0
name Points = state.points
scan @s
fn @s[]() -> () {
b0:
  v0: i1 = load input.Start
  store state.word.0, v0
  v1: i16 = load input.In
  store state.in, v1
  v2: i1 = load input.P0
  store state.points.0, v2
  v3: i8 = load state.n
  store state.n, v3
  return
}
";

    fn codes(text: &str) -> Vec<(Code, String)> {
        let (file, mut diagnostics) = (FileId::from_index(0), Diagnostics::new());
        if let Some(stimulus) = Stimulus::parse(file, text, &mut diagnostics) {
            stimulus.bind(&parse_module(MODULE).unwrap(), &mut diagnostics);
        }
        let place = |d: &Diagnostic| text[d.primary.as_ref().unwrap().span.range()].to_owned();
        diagnostics.iter().map(|d| (d.code, place(d))).collect()
    }

    fn bind(text: &str) -> BoundStimulus {
        let mut diagnostics = Diagnostics::new();
        let stimulus = Stimulus::parse(FileId::from_index(0), text, &mut diagnostics).unwrap();
        stimulus
            .bind(&parse_module(MODULE).unwrap(), &mut diagnostics)
            .unwrap()
    }

    #[test]
    fn rows_set_inputs_and_tags_and_empty_cells_nothing() {
        let bound = bind("t_ms,start,N,in.3\n0,1,,\n2.5,,-1,\n10,FALSE,16#7F,1\n");
        let input = Place::root(Root::Input);
        let settings: Vec<&Setting> = bound.columns.iter().map(|column| &column.setting).collect();
        assert_eq!(
            settings,
            [
                &Setting::Input(input.clone().field(0)),
                &Setting::Poke(Place::root(Root::State).field(2)),
                &Setting::Input(input.field(1).bit(Index::Const(3))),
            ]
        );
        let rows: Vec<_> = bound
            .rows
            .into_iter()
            .map(|row| (row.time_ns, row.values))
            .collect();
        assert_eq!(
            rows,
            [
                (0, vec![(0, 1)]),
                (2_500_000, vec![(1, 0xff)]),
                (10_000_000, vec![(0, 0), (1, 0x7f), (2, 1)]),
            ]
        );
    }

    #[test]
    fn setting_the_copy_of_an_input_sets_the_input() {
        let bound = bind("t_us,Local:1:I.0\n0,1\n");
        let expected = Setting::Input(Place::root(Root::Input).field(0));
        assert_eq!(bound.columns[0].setting, expected);
    }

    #[test]
    fn mistakes_are_reported_at_their_cell() {
        for (text, code, place) in [
            ("", Code::E6003, ""),
            ("time,Start\n", Code::E6003, "time"),
            ("t_ms,Start\n0\n", Code::E6004, "0"),
            ("t_ms,Start\n0,1,1\n", Code::E6004, "0,1,1"),
            ("t_ms,Start\n-1,1\n", Code::E6005, "-1"),
            ("t_ms,Start\n,1\n", Code::E6005, ""),
            ("t_ns,Start\n0.5,1\n", Code::E6005, "0.5"),
            ("t_ms,Start\n5,1\n4,0\n", Code::E6006, "4"),
            ("t_ms,Start\n5,1\n5,0\n", Code::E6006, "5"),
            ("t_ms,Start\n0,yes\n", Code::E6007, "yes"),
            ("t_ms,n\n0, 128 \n", Code::E6008, "128"),
            ("t_ms,Strat\n0,1\n", Code::E6009, "Strat"),
            ("t_ms,n.9\n0,1\n", Code::E6010, "n.9"),
            ("t_ms,\n0,1\n", Code::E6009, ""),
            (
                "t_ms,Start,Local:1:I.0\n0,1,1\n",
                Code::E6011,
                "Local:1:I.0",
            ),
            ("t_ms,In,in.3\n0,1,1\n", Code::E6011, "in.3"),
            ("t_ms,Points\n0,1\n", Code::E6012, "Points"),
            ("t_ms,Lamp\n0,1\n", Code::E6012, "Lamp"),
        ] {
            assert_eq!(codes(text), [(code, place.to_owned())], "{text:?}");
        }
    }

    #[test]
    fn all_mistakes_are_reported_at_once_up_to_a_limit() {
        let found = codes("t_ms,Strat,n\n0,1,x\n1,1,y\n");
        let codes_only: Vec<Code> = found.iter().map(|(code, _)| *code).collect();
        assert_eq!(codes_only, [Code::E6009, Code::E6007, Code::E6007]);
        let many: String = (0..100).map(|t| format!("{t},x\n")).collect();
        assert_eq!(codes(&format!("t_ms,n\n{many}")).len(), MAX_MESSAGES);
    }
}
