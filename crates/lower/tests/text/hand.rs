//! Typed programs written by hand, and what they do on the reference interpreter.

use iecc_interp::Interpreter;
use iecc_ir::{FaultCode, Layout, MemType, Module, Place, Root as IrRoot, Scalar, Type, verify};
use iecc_lower::{OnFault, Options, lower};
use iecc_passes::{SOFTWARE, Settings, run_pipeline};
use iecc_sema::hir::code::{
    BinaryOp, Block, Call, CallId, Expr, ExprId, ExprKind, Init, InitId, Local, LocalId, Path,
    PathId, PathStep, RefParam, Root, Stmt, StmtId, StmtKind,
};
use iecc_sema::hir::{
    self, Body, Code, CompareOp, Elementary, MemberDef, Pou, PouId, Program, StructDef, StructKind,
    Tag, TagId, Task, Trigger, View,
};
use iecc_source::{FileId, Span};
use iecc_target::{Engine, region_bytes};

/// A program without anything.
pub(crate) fn program() -> Program {
    Program {
        name: "hand".to_owned(),
        types: hir::Types::default(),
        tags: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        names: Vec::new(),
        pous: Vec::new(),
        stdlib: None,
        inits: hir::Inits::default(),
        tasks: Vec::new(),
        first_scan: None,
    }
}

pub(crate) fn span() -> Span {
    Span::new(FileId::from_index(0), 0, 1)
}

pub(crate) fn one(ty: Elementary) -> hir::Type {
    hir::Type::Elementary(ty)
}

/// Adds a tag that begins as 0.
pub(crate) fn tag(program: &mut Program, name: &str, ty: hir::Type) -> TagId {
    program.tags.push(Tag {
        name: name.to_owned(),
        ty,
        view: View::Number,
        init: None,
        initial: Vec::new(),
        span: None,
    });
    TagId::from_index(program.tags.len() - 1)
}

/// Adds an elementary tag with a value.
pub(crate) fn value(program: &mut Program, name: &str, ty: Elementary, bits: u64) -> TagId {
    let id = tag(program, name, one(ty));
    program.tags[id.index()].init = Some(program.inits.add(Init::Bits(bits)));
    id
}

pub(crate) fn array(program: &mut Program, element: hir::Type, len: u32) -> hir::Type {
    hir::Type::Array(program.types.array(element, len))
}

pub(crate) fn structure(
    program: &mut Program,
    name: &str,
    kind: StructKind,
    members: &[(&str, hir::Type)],
) -> hir::Type {
    let members = members.iter().map(|&(name, ty)| MemberDef {
        name: name.to_owned(),
        ty,
        view: View::Number,
        hidden: false,
    });
    hir::Type::Struct(program.types.add_struct(StructDef {
        name: name.to_owned(),
        kind,
        members: members.collect(),
        unusable: Vec::new(),
    }))
}

/// A string of at most `len` characters of one byte.
pub(crate) fn string(program: &mut Program, len: u32) -> hir::Type {
    let data = array(program, one(Elementary::Usint), len);
    let members = [("LEN", one(Elementary::Dint)), ("DATA", data)];
    structure(
        program,
        &format!("STRING[{len}]"),
        StructKind::Text,
        &members,
    )
}

pub(crate) fn init(program: &mut Program, init: Init) -> InitId {
    program.inits.add(init)
}

/// Adds a unit.
pub(crate) fn unit(program: &mut Program, name: &str, text: Text) -> PouId {
    program.pous.push(Pou {
        name: name.to_owned(),
        parameters: Vec::new(),
        results: Vec::new(),
        body: Body::Text(Box::new(text.0)),
        span: span(),
    });
    PouId::from_index(program.pous.len() - 1)
}

/// Adds a task that runs a unit in every scan.
pub(crate) fn every_scan(program: &mut Program, pou: PouId) {
    program.tasks.push(Task {
        name: "Main".to_owned(),
        trigger: Trigger::EveryScan,
        priority: 0,
        calls: vec![pou],
    });
}

/// A body being written.
#[derive(Debug, Default)]
pub(crate) struct Text(pub(crate) Code);

impl Text {
    pub(crate) fn new() -> Self {
        Self::default()
    }

    // ---- interface ----

    pub(crate) fn reference(&mut self, name: &str, ty: hir::Type) -> Root {
        self.0.refs.push(RefParam {
            name: name.to_owned(),
            ty,
        });
        Root::Ref(self.0.refs.len() as u32 - 1)
    }

    pub(crate) fn local(&mut self, name: &str, ty: hir::Type) -> LocalId {
        self.0.locals.push(Local {
            name: name.to_owned(),
            ty,
        });
        LocalId(self.0.locals.len() as u32 - 1)
    }

    /// Stands before other locals.
    pub(crate) fn param(&mut self, name: &str, ty: Elementary) -> LocalId {
        self.0.params += 1;
        self.local(name, one(ty))
    }

    pub(crate) fn result(&mut self, name: &str, ty: Elementary) -> LocalId {
        let local = self.local(name, one(ty));
        self.0.results.push(local);
        local
    }

    // ---- places ----

    pub(crate) fn path(&mut self, root: Root, steps: &[PathStep]) -> PathId {
        self.0.paths.push(Path {
            root,
            steps: steps.to_vec(),
            span: span(),
        });
        PathId(self.0.paths.len() as u32 - 1)
    }

    pub(crate) fn tag(&mut self, tag: TagId) -> PathId {
        self.path(Root::Tag(tag), &[])
    }

    pub(crate) fn var(&mut self, local: LocalId) -> PathId {
        self.path(Root::Local(local), &[])
    }

    // ---- expressions ----

    pub(crate) fn expr(&mut self, ty: Elementary, kind: ExprKind) -> ExprId {
        let span = span();
        self.0.exprs.push(Expr { kind, ty, span });
        ExprId(self.0.exprs.len() as u32 - 1)
    }

    pub(crate) fn num(&mut self, ty: Elementary, number: i128) -> ExprId {
        self.expr(ty, ExprKind::Const(number as u64))
    }

    pub(crate) fn load(&mut self, ty: Elementary, path: PathId) -> ExprId {
        self.expr(ty, ExprKind::Load(path))
    }

    pub(crate) fn get(&mut self, ty: Elementary, tag: TagId) -> ExprId {
        let path = self.tag(tag);
        self.load(ty, path)
    }

    pub(crate) fn get_var(&mut self, ty: Elementary, local: LocalId) -> ExprId {
        let path = self.var(local);
        self.load(ty, path)
    }

    pub(crate) fn bin(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> ExprId {
        let ty = self.0.expr(left).ty;
        self.expr(ty, ExprKind::Binary(op, left, right))
    }

    pub(crate) fn add(&mut self, left: ExprId, right: ExprId) -> ExprId {
        self.bin(BinaryOp::Add, left, right)
    }

    pub(crate) fn cmp(&mut self, op: CompareOp, left: ExprId, right: ExprId) -> ExprId {
        self.expr(Elementary::Bool, ExprKind::Compare(op, left, right))
    }

    pub(crate) fn call(
        &mut self,
        callee: PouId,
        refs: &[PathId],
        args: &[ExprId],
        outputs: &[(u32, PathId)],
    ) -> CallId {
        self.0.calls.push(Call {
            callee,
            refs: refs.to_vec(),
            args: args.to_vec(),
            outputs: outputs.to_vec(),
        });
        CallId(self.0.calls.len() as u32 - 1)
    }

    // ---- statements ----

    pub(crate) fn stmt(&mut self, kind: StmtKind) -> StmtId {
        let span = span();
        self.0.stmts.push(Stmt { kind, span });
        StmtId(self.0.stmts.len() as u32 - 1)
    }

    pub(crate) fn set(&mut self, to: PathId, value: ExprId) -> StmtId {
        self.stmt(StmtKind::Assign(to, value))
    }

    pub(crate) fn set_tag(&mut self, to: TagId, value: ExprId) -> StmtId {
        let to = self.tag(to);
        self.set(to, value)
    }

    pub(crate) fn set_var(&mut self, to: LocalId, value: ExprId) -> StmtId {
        let to = self.var(to);
        self.set(to, value)
    }

    /// `tag := tag + number`.
    pub(crate) fn bump(&mut self, ty: Elementary, tag: TagId, number: i128) -> StmtId {
        let (old, more) = (self.get(ty, tag), self.num(ty, number));
        let sum = self.add(old, more);
        self.set_tag(tag, sum)
    }

    pub(crate) fn when(&mut self, condition: ExprId, then: Block, otherwise: Block) -> StmtId {
        self.stmt(StmtKind::If {
            arms: vec![(condition, then)],
            otherwise,
        })
    }

    pub(crate) fn eval(&mut self, call: CallId) -> StmtId {
        let value = self.expr(Elementary::Bool, ExprKind::Call(call));
        self.stmt(StmtKind::Eval(value))
    }

    pub(crate) fn body(mut self, body: &[StmtId]) -> Self {
        self.0.body = body.to_vec();
        self
    }
}

/// A lowered program that runs as it is and, after the passes for software, a second time.
pub(crate) struct Run {
    module: Module,
    layout: Layout,
    engine: Interpreter,
    second: Interpreter,
    pub(crate) outputs: Vec<u8>,
}

/// Errors at run time end the scan.
pub(crate) fn trap() -> Options {
    Options::default()
}

/// Errors at run time have a result.
pub(crate) fn continuing() -> Options {
    Options {
        on_fault: OnFault::Continue,
        ..Options::default()
    }
}

fn after_passes(mut module: Module) -> Interpreter {
    run_pipeline(&mut module, SOFTWARE, &Settings::default(), &mut |_, _| ())
        .expect("the passes exist");
    Interpreter::new(verify(&module).expect("passes keep the rules"))
}

impl Run {
    pub(crate) fn new(program: &Program, options: &Options) -> Self {
        let module = lower(program, options);
        let verified = verify(&module).unwrap_or_else(|errors| {
            let text = iecc_ir::print_module(&module);
            panic!("{}\n{text}", errors[0])
        });
        let engine = Interpreter::new(verified);
        Self {
            layout: Layout::new(&module.types),
            engine,
            second: after_passes(module.clone()),
            outputs: region_bytes(&module, iecc_ir::Region::Output),
            module,
        }
    }

    /// One scan of a unit that is all there is to run.
    pub(crate) fn once(program: &mut Program, text: Text, options: &Options) -> Self {
        let main = unit(program, "Main", text);
        every_scan(program, main);
        let mut run = Self::new(program, options);
        assert_eq!(run.scan(0), Ok(()));
        run
    }

    pub(crate) fn scan(&mut self, now_ns: u64) -> Result<(), FaultCode> {
        let inputs = region_bytes(&self.module, iecc_ir::Region::Input);
        let mut outputs = self.outputs.clone();
        let second = self.second.step(now_ns, &inputs, &mut outputs);
        let ended = self.engine.step(now_ns, &inputs, &mut self.outputs);
        let [ended, second] = [ended, second].map(|ended| ended.map_err(|fault| fault.code));
        assert_eq!(ended, second, "after the passes");
        assert_eq!(self.outputs, outputs, "after the passes");
        assert_eq!(self.engine.state(), self.second.state(), "after the passes");
        ended
    }

    /// Where a fault of the next scan comes from.
    pub(crate) fn fault_label(&mut self) -> String {
        let fault = self.engine.step(0, &[], &mut self.outputs).unwrap_err();
        let origin = fault.origin.expect("known");
        self.module.origins[origin].label.to_string()
    }

    fn place(&self, path: &str) -> Place {
        let names: Vec<&str> = path.split('/').collect();
        let mut at = MemType::Struct(self.module.state);
        let mut place = Place::root(IrRoot::State);
        for name in names {
            match at {
                MemType::Struct(id) => {
                    let def = &self.module.types.structs[id];
                    let field = def.field(name).unwrap_or_else(|| panic!("{path}"));
                    at = def.fields[field as usize].ty;
                    place = place.field(field);
                }
                MemType::Array(id) => {
                    at = self.module.types.array_type(id).element;
                    place = place.index(iecc_ir::Index::Const(name.parse().unwrap()));
                }
                MemType::Scalar(_) => panic!("{path}"),
            }
        }
        place
    }

    /// The value at a path (`tag/member/3`), by its bits.
    pub(crate) fn bits(&self, path: &str) -> u64 {
        let place = self.place(path);
        let start = MemType::Struct(self.module.state);
        let (offset, ty, _) = self.layout.resolve(&self.module.types, start, &place.path);
        let MemType::Scalar(ty) = ty else {
            panic!("{path} is not one value")
        };
        Scalar::read(self.engine.state(), offset as usize, ty).bits
    }

    /// The value at a path as a signed number.
    pub(crate) fn number(&self, path: &str) -> i64 {
        let place = self.place(path);
        let start = MemType::Struct(self.module.state);
        let (_, ty, _) = self.layout.resolve(&self.module.types, start, &place.path);
        match ty {
            MemType::Scalar(Type::I1) => self.bits(path) as i64,
            MemType::Scalar(ty) => ty.signed(self.bits(path)),
            MemType::Struct(_) | MemType::Array(_) => panic!("{path} is not one value"),
        }
    }

    /// Changes the value at a path.
    pub(crate) fn poke(&mut self, path: &str, bits: u64) {
        let place = self.place(path);
        let start = MemType::Struct(self.module.state);
        let (offset, ty, _) = self.layout.resolve(&self.module.types, start, &place.path);
        let MemType::Scalar(ty) = ty else {
            panic!("{path} is not one value")
        };
        let mut state = self.engine.state().to_vec();
        Scalar::new(ty, bits).write(&mut state, offset as usize);
        self.engine.set_state(&state);
        self.second.set_state(&state);
    }

    pub(crate) fn module(&self) -> &Module {
        &self.module
    }
}
