//! A run: engine, schedule, stimulus and trace together.

use super::instrument::{Instruments, Poke, Watch, instrument};
use super::mirror::initial_inputs;
use super::names::{Names, leaves, view_of};
use super::stimulus::{BoundRow, BoundStimulus, Setting, Stimulus};
use super::texts::characters_behind;
use super::time::Schedule;
use super::trace::Trace;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_ir::{Layout, MemType, Module, Place, PlaceType, Region, Root, Scalar, Type, View};
use iecc_target::{Engine, Fault, region_bytes};
use std::io;

/// Most values one `--watch` name may stand for.
const MAX_VALUES_PER_WATCH: u64 = 1024;

/// Scans between two calls of the progress callback.
const PROGRESS_EVERY: u64 = 256;

/// A column of a trace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name: an input, an output or a watched path.
    pub name: String,
    /// The type of its values.
    pub ty: Type,
    /// How they are shown.
    pub view: View,
    /// Of the length of a string: how many columns with its characters follow. Else 0.
    pub characters: usize,
    cell: Cell,
}

/// A value in the input or output region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cell {
    region: Region,
    offset: usize,
    /// The type in memory, and the bit of it that is meant.
    ty: Type,
    bit: Option<u32>,
}

impl Cell {
    pub(super) fn new(module: &Module, layout: &Layout, place: &Place) -> Self {
        let region = match place.root {
            Root::Input => Region::Input,
            Root::Output => Region::Output,
            Root::State | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => {
                panic!("engines show inputs and outputs only")
            }
        };
        let start = MemType::Struct(module.region(region));
        let (offset, ty, bit) = layout.resolve(&module.types, start, &place.path);
        let ty = PlaceType::Mem(ty).scalar().expect("cells hold one value");
        Self {
            region,
            offset: offset as usize,
            ty,
            bit,
        }
    }

    /// The region it lies in.
    pub(super) fn region(self) -> Region {
        self.region
    }

    pub(super) fn get(self, bytes: &[u8]) -> u64 {
        let bits = Scalar::read(bytes, self.offset, self.ty).bits;
        self.bit.map_or(bits, |bit| (bits >> bit) & 1)
    }

    pub(super) fn set(self, bytes: &mut [u8], bits: u64) {
        let bits = match self.bit {
            None => bits,
            Some(bit) => {
                let others = Scalar::read(bytes, self.offset, self.ty).bits & !(1 << bit);
                others | ((bits & 1) << bit)
            }
        };
        Scalar::new(self.ty, bits).write(bytes, self.offset);
    }
}

/// What a user asks for besides the program.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'r> {
    /// Paths to show.
    pub watches: &'r [String],
    /// What to set and when.
    pub stimulus: Option<&'r Stimulus>,
}

/// A module made ready for a run. Prepare before the passes: they keep inputs and outputs.
#[derive(Debug, Clone)]
pub struct Session {
    columns: Vec<Column>,
    rows: Vec<BoundRow>,
    /// For each column of the stimulus its input, and the input that says it counts.
    settings: Vec<(Cell, Option<Cell>)>,
    inputs: Vec<u8>,
    outputs: Vec<u8>,
}

/// Why a run ended early.
#[derive(Debug)]
pub enum RunError {
    /// A scan was abandoned.
    Fault {
        /// Which, counted from 0.
        scan: u64,
        /// Its time.
        now_ns: u64,
        /// Why and where.
        fault: Fault,
    },
    /// The trace could not be written.
    Write(io::Error),
}

impl RunError {
    /// As a message to the user.
    pub fn to_diagnostic(&self, module: &Module) -> Diagnostic {
        match self {
            Self::Write(error) => Diagnostic::without_place(
                Code::E6013,
                format!("the trace cannot be written: {error}"),
            ),
            Self::Fault {
                scan,
                now_ns,
                fault,
            } => {
                let origin = fault.origin.map(|origin| &module.origins[origin]);
                let place = origin.map_or(String::new(), |origin| format!(" in {}", origin.label));
                let message = format!(
                    "scan {scan} at {} ms was abandoned{place}: {fault}",
                    *now_ns as f64 / 1e6
                );
                match origin.and_then(|origin| origin.span) {
                    Some(span) => Diagnostic::new(Code::E6014, span, message),
                    None => Diagnostic::without_place(Code::E6014, message),
                }
            }
        }
    }
}

impl Session {
    /// Resolves all names and adds what is needed to the module; `None` after mistakes.
    pub fn prepare(
        module: &mut Module,
        request: &Request<'_>,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let public = public_columns(module);
        let watched = watched(module, request.watches, diagnostics);
        let bound = match request.stimulus {
            Some(stimulus) => stimulus.bind(module, diagnostics),
            None => Some(BoundStimulus::default()),
        };
        let (watched, bound) = (watched?, bound?);
        let (seen, watches): (Vec<_>, Vec<_>) = watched
            .into_iter()
            .partition(|watch| watch.place.root != Root::State);
        let instruments = instrument(module, &watches, &pokes(&bound));
        let hidden = watches.iter().zip(&instruments.watches);
        let hidden = hidden.map(|(watch, output)| (watch.name.clone(), output.clone()));
        let seen = seen.into_iter().map(|watch| (watch.name, watch.place));
        let seen: Vec<_> = seen
            .filter(|(_, place)| public.iter().all(|(_, known)| known != place))
            .collect();
        let shown = public.iter().chain(&seen).map(|(_, place)| place.clone());
        let own = watches.iter().map(|watch| watch.place.clone());
        let places: Vec<Place> = shown.chain(own).collect();
        let columns = public.into_iter().chain(seen).chain(hidden).collect();
        let mut session = Self::new(module, columns, bound, &instruments);
        for (at, column) in session.columns.iter_mut().enumerate() {
            column.characters = characters_behind(module, &places[at..]);
        }
        Some(session)
    }

    fn new(
        module: &Module,
        columns: Vec<(String, Place)>,
        bound: BoundStimulus,
        instruments: &Instruments,
    ) -> Self {
        let layout = Layout::new(&module.types);
        let cell = |place: &Place| Cell::new(module, &layout, place);
        let columns = columns.into_iter().map(|(name, place)| {
            let cell = cell(&place);
            let ty = if cell.bit.is_some() {
                Type::I1
            } else {
                cell.ty
            };
            let view = view_of(module, &place);
            Column {
                name,
                ty,
                view,
                characters: 0,
                cell,
            }
        });
        let mut pokes = instruments.pokes.iter();
        let settings = bound.columns.iter().map(|column| match &column.setting {
            Setting::Input(place) => (cell(place), None),
            Setting::Poke(_) => {
                let (value, counts) = pokes.next().expect("every poke has inputs");
                (cell(value), Some(cell(counts)))
            }
        });
        Self {
            columns: columns.collect(),
            settings: settings.collect(),
            rows: bound.rows,
            inputs: initial_inputs(module),
            outputs: region_bytes(module, Region::Output),
        }
    }

    /// The input region before each scan of a schedule, for hardware: the module stays as it is, so
    /// only inputs can be set. `None` after mistakes.
    pub fn replay(
        module: &Module,
        stimulus: &Stimulus,
        schedule: Schedule,
        diagnostics: &mut Diagnostics,
    ) -> Option<Vec<Vec<u8>>> {
        let bound = stimulus.bind_inputs(module, diagnostics)?;
        let unchanged = Instruments {
            watches: Vec::new(),
            pokes: Vec::new(),
        };
        let session = Self::new(module, Vec::new(), bound, &unchanged);
        let (mut inputs, mut rows) = (session.inputs.clone(), session.rows.as_slice());
        let scans = (0..schedule.scans()).map(|scan| {
            session.apply(&mut rows, schedule.time_ns(scan), &mut inputs);
            inputs.clone()
        });
        Some(scans.collect())
    }

    /// The columns of a trace: inputs, outputs, then what is watched.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Runs all scans of the schedule. `progress` is told now and then how many are done.
    ///
    /// # Errors
    /// A scan was abandoned, or the trace cannot be written. The trace holds the scans before.
    pub fn run(
        &self,
        engine: &mut dyn Engine,
        schedule: Schedule,
        trace: &mut dyn Trace,
        progress: &mut dyn FnMut(u64),
    ) -> Result<(), RunError> {
        let (mut inputs, mut outputs) = (self.inputs.clone(), self.outputs.clone());
        let mut rows = self.rows.as_slice();
        let mut values = Vec::with_capacity(self.columns.len());
        for scan in 0..schedule.scans() {
            let now_ns = schedule.time_ns(scan);
            self.apply(&mut rows, now_ns, &mut inputs);
            engine
                .step(now_ns, &inputs, &mut outputs)
                .map_err(|fault| RunError::Fault {
                    scan,
                    now_ns,
                    fault,
                })?;
            values.clear();
            values.extend(self.columns.iter().map(|column| match column.cell.region {
                Region::Input => column.cell.get(&inputs),
                Region::Output | Region::State => column.cell.get(&outputs),
            }));
            trace.row(now_ns, &values).map_err(RunError::Write)?;
            if scan % PROGRESS_EVERY == 0 {
                progress(scan);
            }
        }
        progress(schedule.scans());
        Ok(())
    }

    /// Applies the rows whose time has come. A poke counts in one scan only.
    fn apply(&self, rows: &mut &[BoundRow], now_ns: u64, inputs: &mut [u8]) {
        for counts in self.settings.iter().filter_map(|(_, counts)| *counts) {
            counts.set(inputs, 0);
        }
        while let Some((row, rest)) = rows.split_first().filter(|(row, _)| row.time_ns <= now_ns) {
            for &(column, bits) in &row.values {
                let (value, counts) = self.settings[column];
                value.set(inputs, bits);
                if let Some(counts) = counts {
                    counts.set(inputs, 1);
                }
            }
            *rows = rest;
        }
    }
}

/// Every value of the inputs and outputs as they are before anything is added.
fn public_columns(module: &Module) -> Vec<(String, Place)> {
    let mut columns = Vec::new();
    for (root, id) in [(Root::Input, module.input), (Root::Output, module.output)] {
        for (index, field) in module.types.structs[id].fields.iter().enumerate() {
            let place = Place::root(root).field(index as u32);
            let found = leaves(module, &field.name, &place, u64::MAX);
            columns.extend(found.expect("no limit"));
        }
    }
    columns
}

/// The watched values, each once.
fn watched(module: &Module, paths: &[String], diagnostics: &mut Diagnostics) -> Option<Vec<Watch>> {
    let names = Names::to_watch(module);
    let (mut watches, mut faultless) = (Vec::<Watch>::new(), true);
    for path in paths {
        let found = names.find_spelled(path.trim());
        let found =
            found.and_then(|(path, place)| leaves(module, &path, &place, MAX_VALUES_PER_WATCH));
        match found {
            Ok(found) => {
                for (name, place) in found {
                    if watches.iter().all(|watch| watch.place != place) {
                        watches.push(Watch { name, place });
                    }
                }
            }
            Err(error) => {
                diagnostics.push(error.into_diagnostic(None));
                faultless = false;
            }
        }
    }
    faultless.then_some(watches)
}

fn pokes(bound: &BoundStimulus) -> Vec<Poke> {
    let columns = bound.columns.iter();
    let pokes = columns.filter_map(|column| match &column.setting {
        Setting::Poke(place) => Some(Poke {
            name: column.name.clone(),
            place: place.clone(),
        }),
        Setting::Input(_) => None,
    });
    pokes.collect()
}
