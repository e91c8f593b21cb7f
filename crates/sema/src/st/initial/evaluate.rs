//! Values of constant expressions that are more than the folding of operators: calls of library
//! functions that are written in Structured Text.
//!
//! What code computes is defined elsewhere, so the expression becomes a program that an [`Evaluator`]
//! runs once: a constant has the bits that the same expression has when it runs. Bodies are made for
//! this alone, once for all constants; they are not part of the user's program.

use crate::hir::code::{Code, Root, StmtKind};
use crate::hir::{self, Place, Step, TagId};
use crate::st::analysis::Analysis;
use crate::st::body::{Body, Operand, OperandKind};
use crate::st::constant::Const;
use crate::st::signature::PouId;
use crate::st::types::{TypeId, TypeKind};
use iecc_diag::Code as Message;
use iecc_source::Span;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::rc::Rc;

/// Runs typed programs.
pub trait Evaluator {
    /// Runs a program without inputs and outputs for one scan, and gives the bits that elementary
    /// places hold after it.
    ///
    /// # Errors
    /// Why it did not end.
    fn run(&self, program: &hir::Program, places: &[Place]) -> Result<Vec<u64>, String>;
}

/// The tag that holds the value.
const RESULT: TagId = TagId(0);

impl Body<'_, '_> {
    /// An operand of a constant expression as a constant.
    pub(crate) fn known(&mut self, operand: Operand) -> Operand {
        let (range, ty) = (operand.range, self.settle(&operand));
        if operand.is_error() || operand.as_const().is_some() || ty == TypeId::NOTHING {
            return operand;
        }
        let Some(places) = self.result_places(ty) else {
            return self.error(Message::E2030, range, "a constant is needed here");
        };
        self.keep_result(&operand);
        let mut code = std::mem::take(&mut self.code);
        code.body = std::mem::take(&mut self.pending);
        let storage = self.an.storage(ty);
        let span = self.an.span(self.unit, range);
        let found = self.an.run(self.mark, code, storage, &places, span);
        match found.map(|bits| self.result_of(ty, &bits)) {
            Ok(value) => Operand::constant(value, ty, range),
            Err(why) => {
                let message = format!("this constant cannot be computed: {why}");
                self.error(Message::E2030, range, message)
            }
        }
    }

    /// Stores the operand where it is looked for.
    fn keep_result(&mut self, operand: &Operand) {
        let range = operand.range;
        let to = self.add_path(Root::Tag(RESULT), Vec::new(), range);
        let kind = match &operand.kind {
            OperandKind::Place(place) if !self.an.types.is_scalar(operand.ty) => {
                StmtKind::Copy(to, self.path_of(place, range))
            }
            OperandKind::Place(_)
            | OperandKind::Value(_)
            | OperandKind::Const(_)
            | OperandKind::Error => StmtKind::Assign(to, self.raw(operand)),
        };
        self.before(kind, range);
    }

    /// Where the value of a type lies in the tag; `None` for what has no constants.
    fn result_places(&self, ty: TypeId) -> Option<Vec<Place>> {
        let whole = Place::whole(RESULT);
        if let TypeKind::Text { length, .. } = *self.an.types.base(ty) {
            let text = whole.clone().step(Step::Field(1));
            let units = (0..length).map(|index| text.clone().step(Step::Index(index)));
            let length = whole.step(Step::Field(0));
            return Some([length].into_iter().chain(units).collect());
        }
        self.an.constant_type(ty).map(|_| vec![whole])
    }

    fn result_of(&self, ty: TypeId, bits: &[u64]) -> Const {
        match self.an.constant_type(ty) {
            Some(el) => Const::from_bits(el, bits[0]),
            None => {
                let units = bits[1..].iter().take(bits[0] as usize);
                Const::Text(units.map(|unit| *unit as u16).collect::<Rc<[u16]>>())
            }
        }
    }
}

impl Analysis<'_> {
    /// The bits that some places of the result hold after code has run. Bodies that are wanted from
    /// `mark` on are forgotten again.
    fn run(
        &mut self,
        mark: usize,
        code: Code,
        storage: hir::Type,
        places: &[Place],
        span: Span,
    ) -> Result<Vec<u64>, String> {
        std::mem::swap(&mut self.unit_names, &mut self.computed.names);
        let pous = self.closed(code, span);
        std::mem::swap(&mut self.unit_names, &mut self.computed.names);
        self.drop_wanted(mark);
        let mut program = hir::Program {
            types: std::mem::take(&mut self.hir.types),
            inits: std::mem::take(&mut self.hir.inits),
            tags: vec![result_tag(storage)],
            pous,
            tasks: vec![hir::Task {
                name: "constant".to_owned(),
                calls: vec![hir::PouId::from_index(0)],
                ..hir::Task::default()
            }],
            ..hir::Program::empty()
        };
        let found = self.evaluator.run(&program, places);
        self.hir.types = std::mem::take(&mut program.types);
        self.hir.inits = std::mem::take(&mut program.inits);
        found
    }

    /// A unit with some code, and all that it calls.
    fn closed(&mut self, code: Code, span: Span) -> Vec<hir::Pou> {
        let constant = hir::Pou {
            name: "constant".to_owned(),
            parameters: Vec::new(),
            results: Vec::new(),
            body: hir::Body::Text(Box::new(code)),
            span,
        };
        let mut linked = vec![self.loose(constant)];
        let mut ids: BTreeMap<PouId, hir::PouId> = BTreeMap::new();
        let mut next = 0;
        while next < linked.len() {
            let calling = Rc::clone(&linked[next]);
            for &callee in &calling.callees {
                if let Entry::Vacant(unknown) = ids.entry(callee) {
                    unknown.insert(hir::PouId::from_index(linked.len()));
                    linked.push(self.computed_body(callee));
                }
            }
            next += 1;
        }
        linked.iter().map(|loose| loose.linked(&ids)).collect()
    }

    /// The body of a library unit, looked at once for all constants.
    fn computed_body(&mut self, unit: PouId) -> Rc<Loose> {
        if let Some(known) = self.computed.bodies.get(&unit) {
            return Rc::clone(known);
        }
        let (pou, _) = self.checked_pou(unit);
        let loose = self.loose(pou);
        self.computed.bodies.insert(unit, Rc::clone(&loose));
        loose
    }

    fn loose(&self, mut pou: hir::Pou) -> Rc<Loose> {
        let calls = text_of(&mut pou).calls.iter();
        let callees = calls.map(|call| self.wanted[call.callee.index()]).collect();
        Rc::new(Loose { pou, callees })
    }
}

/// What constants have in common.
#[derive(Debug, Default)]
pub(crate) struct Computed {
    bodies: FxHashMap<PouId, Rc<Loose>>,
    /// How many of their units have a name.
    names: FxHashMap<String, u32>,
}

/// A body that no program has yet.
#[derive(Debug)]
struct Loose {
    pou: hir::Pou,
    /// What each of its calls runs.
    callees: Vec<PouId>,
}

impl Loose {
    /// The body in a program that has units at these places.
    fn linked(&self, ids: &BTreeMap<PouId, hir::PouId>) -> hir::Pou {
        let mut pou = self.pou.clone();
        for (call, callee) in text_of(&mut pou).calls.iter_mut().zip(&self.callees) {
            call.callee = ids[callee];
        }
        pou
    }
}

fn text_of(pou: &mut hir::Pou) -> &mut Code {
    match &mut pou.body {
        hir::Body::Text(code) => code,
        hir::Body::Ladder(_) => unreachable!("library functions are text"),
    }
}

fn result_tag(ty: hir::Type) -> hir::Tag {
    hir::Tag {
        name: "result".to_owned(),
        ty,
        view: hir::View::Number,
        init: None,
        initial: Vec::new(),
        span: None,
    }
}
