//! Modules and functions as text. Blocks and values are numbered in the order they are printed.

use crate::{
    Block, Function, Index, Inst, InstData, Layout, MemType, Module, Origin, Place, Projection,
    Root, Scalar, StructId, Target, Terminator, Type, TypeTable, Value, View,
};
use cranelift_entity::SecondaryMap;
use std::fmt::{self, Write};

/// The whole module as text.
pub fn print_module(module: &Module) -> String {
    let mut out = String::new();
    header(&mut out, module).expect("writing to a string");
    for func in module.funcs.values() {
        out.push('\n');
        out.push_str(&print_function(module, func));
    }
    out
}

/// One function as text.
pub fn print_function(module: &Module, func: &Function) -> String {
    let mut out = String::new();
    Printer::new(module, func)
        .function(&mut out)
        .expect("writing to a string");
    out
}

/// A place as text, with the numbering of `func` for index values.
pub fn print_place(module: &Module, func: &Function, place: &Place) -> String {
    let mut out = String::new();
    Printer::new(module, func)
        .place(&mut out, place)
        .expect("writing to a string");
    out
}

fn header(out: &mut String, module: &Module) -> fmt::Result {
    writeln!(out, "module {}", Name(&module.name))?;
    for (id, def) in module.types.structs.iter() {
        if id == module.state || id == module.input || id == module.output {
            write!(out, "{} {{", region_keyword(module, id))?;
        } else {
            write!(out, "struct {} {{", Name(&def.name))?;
        }
        for (index, field) in def.fields.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            write!(out, "{comma} {}: ", Name(&field.name))?;
            mem_type(out, &module.types, field.ty)?;
            if !field.lows.is_empty() {
                write!(out, " from {:?}", field.lows)?;
            }
            if field.view != View::default() {
                write!(out, " as {}", field.view.name())?;
            }
        }
        writeln!(out, " }}")?;
    }
    image(out, module)?;
    for (name, place) in &module.names {
        write!(out, "name {} = ", Name(name))?;
        static_place(
            out,
            &module.types,
            "state",
            MemType::Struct(module.state),
            &place.path,
        )?;
        out.push('\n');
    }
    for (origin, data) in module.origins.iter() {
        write!(out, "origin @{} = {}", number(origin), Quoted(&data.label))?;
        if let Some(span) = data.span {
            write!(out, " {}:{}..{}", span.file.index(), span.start, span.end)?;
        }
        out.push('\n');
    }
    if let Some(prescan) = module.prescan {
        writeln!(out, "prescan @{}", Name(&module.funcs[prescan].name))?;
    }
    writeln!(out, "scan @{}", Name(&module.funcs[module.scan].name))
}

fn number(origin: Origin) -> u32 {
    origin.as_u32()
}

fn region_keyword(module: &Module, id: StructId) -> &'static str {
    if id == module.state {
        "state"
    } else if id == module.input {
        "input"
    } else {
        "output"
    }
}

fn image(out: &mut String, module: &Module) -> fmt::Result {
    let layout = Layout::new(&module.types);
    let start = Place::root(Root::State);
    let mut result = Ok(());
    layout.for_each_leaf(
        &module.types,
        &start,
        MemType::Struct(module.state),
        &mut |place, offset, ty| {
            let value = module.image.get(offset, ty);
            if value.bits != 0 && result.is_ok() {
                result = init_line(out, module, place, value);
            }
        },
    );
    result
}

fn init_line(out: &mut String, module: &Module, place: &Place, value: Scalar) -> fmt::Result {
    out.push_str("init ");
    static_place(
        out,
        &module.types,
        "",
        MemType::Struct(module.state),
        &place.path,
    )?;
    writeln!(out, " = {}", Literal(value))
}

fn mem_type(out: &mut String, types: &TypeTable, ty: MemType) -> fmt::Result {
    match ty {
        MemType::Scalar(scalar) => write!(out, "{scalar}"),
        MemType::Struct(id) => write!(out, "{}", Name(&types.structs[id].name)),
        MemType::Array(id) => {
            let array = types.array_type(id);
            write!(out, "[{} x ", array.len)?;
            mem_type(out, types, array.element)?;
            out.write_char(']')
        }
    }
}

fn static_place(
    out: &mut String,
    types: &TypeTable,
    root: &str,
    start: MemType,
    path: &[Projection],
) -> fmt::Result {
    let begin = out.len() + root.len();
    out.push_str(root);
    walk_path(out, types, start, path, &|out, index| match index {
        Index::Const(index) => write!(out, "{index}"),
        Index::Value(_) => panic!("names and initial values are static places"),
    })?;
    if root.is_empty() && out[begin..].starts_with('.') {
        out.remove(begin);
    }
    Ok(())
}

fn walk_path(
    out: &mut String,
    types: &TypeTable,
    start: MemType,
    path: &[Projection],
    index_text: &dyn Fn(&mut String, Index) -> fmt::Result,
) -> fmt::Result {
    let mut at = start;
    for step in path {
        match (at, step) {
            (MemType::Struct(id), Projection::Field(field)) => {
                let field = &types.structs[id].fields[*field as usize];
                write!(out, ".{}", Name(&field.name))?;
                at = field.ty;
            }
            (MemType::Array(id), Projection::Index(index)) => {
                out.push('[');
                index_text(out, *index)?;
                out.push(']');
                at = types.array_type(id).element;
            }
            (MemType::Scalar(_), Projection::Bit(Index::Const(bit))) => write!(out, ".{bit}")?,
            (MemType::Scalar(_), Projection::Bit(index)) => {
                out.push_str(".[");
                index_text(out, *index)?;
                out.push(']');
            }
            // An ill-typed place is for the verifier to report; print what is there.
            (MemType::Struct(_) | MemType::Array(_) | MemType::Scalar(_), step) => {
                write!(out, ".<{step:?}>")?;
            }
        }
    }
    Ok(())
}

struct Printer<'m> {
    module: &'m Module,
    func: &'m Function,
    blocks: SecondaryMap<Block, u32>,
    values: SecondaryMap<Value, u32>,
}

impl<'m> Printer<'m> {
    fn new(module: &'m Module, func: &'m Function) -> Self {
        let mut blocks = SecondaryMap::with_default(u32::MAX);
        let mut values = SecondaryMap::with_default(u32::MAX);
        let mut next = 0;
        for (index, &block) in func.layout.iter().enumerate() {
            blocks[block] = index as u32;
            let data = func.block(block);
            let results = data.insts.iter().flat_map(|&inst| func.results_of(inst));
            for &value in data.params.iter().chain(results) {
                values[value] = next;
                next += 1;
            }
        }
        Self {
            module,
            func,
            blocks,
            values,
        }
    }

    fn function(&self, out: &mut String) -> fmt::Result {
        write!(out, "fn @{}[", Name(&self.func.name))?;
        for (index, param) in self.func.refs.values().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            write!(out, "{comma}{}: ", Name(&param.name))?;
            mem_type(out, &self.module.types, param.ty)?;
        }
        out.push_str("](");
        types(
            out,
            &self
                .func
                .layout
                .first()
                .map_or(Vec::new(), |_| self.func.param_types()),
        )?;
        out.push_str(") -> (");
        types(out, &self.func.results)?;
        out.push_str(") {\n");
        for local in self.func.locals.values() {
            write!(out, "  local {}: ", Name(&local.name))?;
            mem_type(out, &self.module.types, local.ty)?;
            out.push('\n');
        }
        for &block in &self.func.layout {
            self.block(out, block)?;
        }
        out.write_str("}\n")
    }

    fn block(&self, out: &mut String, block: Block) -> fmt::Result {
        let data = self.func.block(block);
        write!(out, "b{}", self.blocks[block])?;
        for (index, &param) in data.params.iter().enumerate() {
            let open = if index == 0 { "(" } else { ", " };
            write!(
                out,
                "{open}{}: {}",
                self.value(param),
                self.func.value_type(param)
            )?;
        }
        out.push_str(if data.params.is_empty() {
            ":\n"
        } else {
            "):\n"
        });
        for &inst in &data.insts {
            self.inst(out, inst)?;
            origin(out, self.func.origin(inst))?;
        }
        if let Some(terminator) = &data.terminator {
            self.terminator(out, terminator)?;
            origin(out, data.terminator_origin)?;
        }
        Ok(())
    }

    fn value(&self, value: Value) -> String {
        format!("v{}", self.values[value])
    }

    fn list(&self, values: &[Value]) -> String {
        values
            .iter()
            .map(|&v| self.value(v))
            .collect::<Vec<_>>()
            .join(", ")
    }

    fn inst(&self, out: &mut String, inst: Inst) -> fmt::Result {
        out.push_str("  ");
        for (index, &value) in self.func.results_of(inst).iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            write!(
                out,
                "{comma}{}: {}",
                self.value(value),
                self.func.value_type(value)
            )?;
        }
        if !self.func.results_of(inst).is_empty() {
            out.push_str(" = ");
        }
        match self.func.inst(inst) {
            InstData::Const { ty, bits } => {
                write!(out, "const {}", Literal(Scalar::new(*ty, *bits)))
            }
            InstData::Unary { op, arg } => write!(out, "{op} {}", self.value(*arg)),
            InstData::Binary { op, args } => write!(out, "{op} {}", self.list(args)),
            InstData::Compare { op, args } => write!(out, "{op} {}", self.list(args)),
            InstData::Convert { op, arg, .. } => write!(out, "{op} {}", self.value(*arg)),
            InstData::Select { cond, args } => {
                write!(out, "select {}, {}", self.value(*cond), self.list(args))
            }
            InstData::Load { place } => {
                out.push_str("load ");
                self.place(out, place)
            }
            InstData::Store { place, value } => {
                out.push_str("store ");
                self.place(out, place)?;
                write!(out, ", {}", self.value(*value))
            }
            InstData::Copy { to, from } => {
                out.push_str("copy ");
                self.place(out, to)?;
                out.push_str(", ");
                self.place(out, from)
            }
            InstData::Clear { place } => {
                out.push_str("clear ");
                self.place(out, place)
            }
            InstData::Address { place } => {
                out.push_str("address ");
                self.place(out, place)
            }
            InstData::Now => out.write_str("now"),
            InstData::Elapsed { place, unit_ns, .. } => {
                out.push_str("elapsed ");
                self.place(out, place)?;
                write!(out, ", {}", Unit(*unit_ns))
            }
            InstData::Step { unit_ns, .. } => write!(out, "step {}", Unit(*unit_ns)),
            InstData::Call { func, refs, args } => {
                write!(out, "call @{}[", Name(&self.module.funcs[*func].name))?;
                for (index, place) in refs.iter().enumerate() {
                    out.push_str(if index == 0 { "" } else { ", " });
                    self.place(out, place)?;
                }
                write!(out, "]({})", self.list(args))
            }
        }
    }

    fn terminator(&self, out: &mut String, terminator: &Terminator) -> fmt::Result {
        out.push_str("  ");
        match terminator {
            Terminator::Jump(target) => write!(out, "jump {}", self.target(target)),
            Terminator::Brif {
                cond,
                then,
                otherwise,
            } => {
                let (then, otherwise) = (self.target(then), self.target(otherwise));
                write!(out, "brif {}, {then}, {otherwise}", self.value(*cond))
            }
            Terminator::Switch {
                value,
                cases,
                default,
            } => {
                write!(
                    out,
                    "switch {}, {} [",
                    self.value(*value),
                    self.target(default)
                )?;
                let ty = self.func.value_type(*value);
                for (index, (bits, target)) in cases.iter().enumerate() {
                    let comma = if index == 0 { "" } else { ", " };
                    let case = Literal(Scalar::new(ty, *bits));
                    write!(out, "{comma}{case}: {}", self.target(target))?;
                }
                out.write_char(']')
            }
            Terminator::Return(values) if values.is_empty() => out.write_str("return"),
            Terminator::Return(values) => write!(out, "return {}", self.list(values)),
            Terminator::Fault(fault) => write!(out, "fault {fault}"),
        }
    }

    fn target(&self, target: &Target) -> String {
        let block = self.blocks[target.block];
        if target.args.is_empty() {
            format!("b{block}")
        } else {
            format!("b{block}({})", self.list(&target.args))
        }
    }

    fn place(&self, out: &mut String, place: &Place) -> fmt::Result {
        match place.root {
            Root::State => out.push_str("state"),
            Root::Input => out.push_str("input"),
            Root::Output => out.push_str("output"),
            Root::Deref { value, ty } => {
                write!(out, "deref {}: ", self.value(value))?;
                mem_type(out, &self.module.types, ty)?;
            }
            Root::Ref(param) => match self.func.refs.get(param) {
                Some(data) => write!(out, "{}", Head(&data.name))?,
                None => write!(out, "<{param}>")?,
            },
            Root::Local(local) => match self.func.locals.get(local) {
                Some(data) => write!(out, "{}", Head(&data.name))?,
                None => write!(out, "<{local}>")?,
            },
        }
        let Some(start) = self.module.root_type(self.func, place.root) else {
            return Ok(());
        };
        walk_path(
            out,
            &self.module.types,
            start,
            &place.path,
            &|out, index| match index {
                Index::Const(index) => write!(out, "{index}"),
                Index::Value(value) => out.write_str(&self.value(value)),
            },
        )
    }
}

fn types(out: &mut String, types: &[Type]) -> fmt::Result {
    let names: Vec<_> = types.iter().map(|ty| ty.name()).collect();
    out.write_str(&names.join(", "))
}

fn origin(out: &mut String, origin: Option<Origin>) -> fmt::Result {
    match origin {
        Some(origin) => writeln!(out, " @{}", number(origin)),
        None => out.write_char('\n'),
    }
}

/// A name, quoted unless it is a plain identifier.
struct Name<'a>(&'a str);

impl fmt::Display for Name<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if super::lex::is_plain(self.0) {
            f.write_str(self.0)
        } else {
            Quoted(self.0).fmt(f)
        }
    }
}

/// A name a place begins with.
struct Head<'a>(&'a str);

impl fmt::Display for Head<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            "deref" => Quoted(self.0).fmt(f),
            name => Name(name).fmt(f),
        }
    }
}

struct Quoted<'a>(&'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('"')?;
        for c in self.0.chars() {
            match c {
                '"' | '\\' => write!(f, "\\{c}")?,
                c if c.is_control() => write!(f, "\\u{{{:x}}}", c as u32)?,
                c => f.write_char(c)?,
            }
        }
        f.write_char('"')
    }
}

/// Integers signed (`i1` as 0 or 1), finite floats in shortest decimal, other floats as bits.
struct Literal(Scalar);

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Scalar { ty, bits } = self.0;
        let finite = match ty {
            Type::F32 => Some(f32::from_bits(bits as u32))
                .filter(|x| x.is_finite())
                .map(|x| format!("{x:?}")),
            Type::F64 => Some(f64::from_bits(bits))
                .filter(|x| x.is_finite())
                .map(|x| format!("{x:?}")),
            Type::I1 => Some(bits.to_string()),
            Type::I8 | Type::I16 | Type::I32 | Type::I64 => Some(self.0.signed().to_string()),
        };
        f.write_str(&finite.unwrap_or_else(|| format!("{bits:#x}")))
    }
}

/// A duration in its largest whole unit.
struct Unit(u64);

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let units = super::lex::UNITS
            .iter()
            .filter(|(_, ns)| self.0.is_multiple_of(*ns));
        let (name, ns) = units
            .max_by_key(|(_, ns)| ns)
            .expect("1 ns divides everything");
        write!(f, "{}{name}", self.0 / ns)
    }
}
