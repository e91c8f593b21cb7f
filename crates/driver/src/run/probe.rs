//! Opens a module at named places to tests, which run scans at times of their own choice: what they set
//! before a scan, and what they look at after it. Unlike columns of a trace, a string is one value.

use super::instrument::{Poke, Watch, instrument};
use super::names::{Names, leaves, view_of};
use super::session::Cell;
use super::texts::{Shape, shape};
use iecc_diag::Diagnostic;
use iecc_ir::{Layout, Module, Place, Root, View};

/// A named place.
#[derive(Debug, Clone)]
pub struct Probe {
    /// Its path as it was given.
    pub path: String,
    /// What it holds.
    pub shape: Shape,
    /// How people see it.
    pub view: View,
    cells: Vec<Cell>,
    /// What says that a value that is set counts, for each cell of a place that is no input.
    counts: Vec<Cell>,
}

/// All places of a test.
#[derive(Debug, Clone)]
pub struct Probes {
    /// What is set.
    pub set: Vec<Probe>,
    /// What is looked at.
    pub seen: Vec<Probe>,
}

/// A place with its values, before the module is opened.
struct Found {
    path: String,
    shape: Shape,
    view: View,
    root: Root,
    leaves: Vec<(String, Place)>,
}

impl Probes {
    /// Opens a module, before any pass.
    ///
    /// # Errors
    /// Paths that name nothing, or something that is not one value.
    pub fn open(
        module: &mut Module,
        set: &[String],
        seen: &[String],
    ) -> Result<Self, Vec<Diagnostic>> {
        let set = find_all(module, &Names::to_set(module), set)?;
        let seen = find_all(module, &Names::to_watch(module), seen)?;
        let output = set.iter().find(|found| found.root == Root::Output);
        if let Some(output) = output {
            let message = format!("`{}` is an output and cannot be set", output.path);
            return Err(vec![Diagnostic::without_place(
                iecc_diag::Code::E6010,
                message,
            )]);
        }
        let inside = |found: &&Found| found.root == Root::State;
        let pokes: Vec<Poke> = set.iter().filter(inside).flat_map(pokes).collect();
        let watches: Vec<Watch> = seen.iter().filter(inside).flat_map(watches).collect();
        let opened = instrument(module, &watches, &pokes);
        let (mut values, mut counts) = (Vec::new(), Vec::new());
        for (value, count) in opened.pokes {
            values.push(value);
            counts.push(count);
        }
        Ok(Self {
            set: place(module, set, &values, &counts),
            seen: place(module, seen, &opened.watches, &[]),
        })
    }

    /// To be called before the inputs of each scan: values of places that are no inputs count once.
    pub fn start_scan(&self, inputs: &mut [u8]) {
        for cell in self.set.iter().flat_map(|probe| &probe.counts) {
            cell.set(inputs, 0);
        }
    }
}

impl Probe {
    /// Sets the value of the place in the next scan: the bits of a scalar, or length and characters.
    pub fn set(&self, inputs: &mut [u8], bits: &[u64]) {
        assert!(bits.len() <= self.cells.len(), "as many as its shape says");
        for (cell, bits) in self.cells.iter().zip(bits) {
            cell.set(inputs, *bits);
        }
        for cell in &self.counts {
            cell.set(inputs, 1);
        }
    }

    /// The value after a scan, from the regions of the engine.
    pub fn get(&self, inputs: &[u8], outputs: &[u8]) -> Vec<u64> {
        let bits = self.cells.iter().map(|cell| match cell.region() {
            iecc_ir::Region::Input => cell.get(inputs),
            iecc_ir::Region::Output | iecc_ir::Region::State => cell.get(outputs),
        });
        bits.collect()
    }
}

fn find_all(
    module: &Module,
    names: &Names<'_>,
    paths: &[String],
) -> Result<Vec<Found>, Vec<Diagnostic>> {
    let (mut found, mut errors) = (Vec::new(), Vec::new());
    for path in paths {
        match find(module, names, path) {
            Ok(one) => found.push(one),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() {
        Ok(found)
    } else {
        Err(errors)
    }
}

fn find(module: &Module, names: &Names<'_>, path: &str) -> Result<Found, Diagnostic> {
    let place = names
        .find(path)
        .map_err(|error| error.into_diagnostic(None))?;
    let Some(shape) = shape(module, &place) else {
        let message = format!("`{path}` is not one value");
        return Err(Diagnostic::without_place(iecc_diag::Code::E6010, message));
    };
    let leaves = leaves(module, path, &place, u64::MAX).expect("no limit");
    Ok(Found {
        path: path.to_owned(),
        shape,
        view: view_of(module, &place),
        root: place.root,
        leaves,
    })
}

fn pokes(found: &Found) -> impl Iterator<Item = Poke> + '_ {
    found.leaves.iter().map(|(name, place)| Poke {
        name: name.clone(),
        place: place.clone(),
    })
}

fn watches(found: &Found) -> impl Iterator<Item = Watch> + '_ {
    found.leaves.iter().map(|(name, place)| Watch {
        name: name.clone(),
        place: place.clone(),
    })
}

/// Gives each place its cells: its own in the regions, or the fields that were added for it.
fn place(module: &Module, found: Vec<Found>, added: &[Place], counts: &[Place]) -> Vec<Probe> {
    let layout = Layout::new(&module.types);
    let cell = |place: &Place| Cell::new(module, &layout, place);
    let (mut added, mut counts) = (added.iter(), counts.iter());
    let probe = |found: Found| {
        let inside = found.root == Root::State;
        let (cells, counts) = if inside {
            let number = found.leaves.len();
            let cells = added.by_ref().take(number).map(cell).collect();
            (cells, counts.by_ref().take(number).map(cell).collect())
        } else {
            let own = found.leaves.iter().map(|(_, place)| cell(place));
            (own.collect(), Vec::new())
        };
        Probe {
            path: found.path,
            shape: found.shape,
            view: found.view,
            cells,
            counts,
        }
    };
    found.into_iter().map(probe).collect()
}
