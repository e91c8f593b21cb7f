//! A unit as an outline in which every node and nothing but nodes is seen: no places, and no
//! precedence, because each operator stands before its operands in parentheses. Two units with the
//! same outline are the same tree. For tests, and for people who ask how a text is understood.

use super::{
    Arena, Argument, ArgumentKind, Block, Declarations, Dimension, Expr, ExprKind, Id, Ident, List,
    Literal, Member, Modifier, Pou, ProgramElement, Resource, Stmt, StmtKind, Stored, Test,
    TypeKind, TypeSpec, Unit, UnitKind, VarDecl, VarSection,
};
use crate::names::{Names, Symbol};

/// The outline of a unit.
pub fn dump(unit: &Unit, names: &Names) -> String {
    let mut dump = Dump {
        arena: &unit.arena,
        names,
        out: String::new(),
        indent: 0,
    };
    for pragma in &unit.pragmas {
        dump.line(format!("pragma {:?}", pragma.text));
    }
    dump.unit(&unit.kind);
    dump.out
}

struct Dump<'d> {
    arena: &'d Arena,
    names: &'d Names,
    out: String,
    indent: usize,
}

impl Dump<'_> {
    fn line(&mut self, text: impl AsRef<str>) {
        self.out.push_str(&"  ".repeat(self.indent));
        self.out.push_str(text.as_ref().trim_end());
        self.out.push('\n');
    }

    /// A line, and lines below it.
    fn under(&mut self, text: impl AsRef<str>, below: impl FnOnce(&mut Self)) {
        self.line(text);
        self.indent += 1;
        below(self);
        self.indent -= 1;
    }

    fn name(&self, symbol: Symbol) -> &str {
        self.names.text(symbol)
    }

    fn ident(&self, ident: Ident) -> &str {
        self.name(ident.name)
    }

    /// The elements, with a space before each.
    fn each<T: Stored + Copy>(&self, list: List<T>, show: impl Fn(T) -> String) -> String {
        let show = |&element: &T| format!(" {}", show(element));
        self.arena[list].iter().map(show).collect()
    }

    fn exprs(&self, list: List<Id<Expr>>) -> String {
        self.each(list, |expr| self.expr(expr))
    }

    /// `key:value`, or nothing.
    fn option(&self, key: &str, expr: Option<Id<Expr>>) -> String {
        expr.map_or_else(String::new, |expr| format!(" {key}:{}", self.expr(expr)))
    }

    fn modifiers(&self, list: List<Modifier>) -> String {
        self.each(list, |modifier| modifier.kind.as_str().to_owned())
    }

    fn expr(&self, expr: Id<Expr>) -> String {
        match self.arena[expr].kind {
            ExprKind::Literal(literal) => literal_text(&self.arena[literal]),
            ExprKind::Name(name) => self.name(name).to_owned(),
            ExprKind::Typed { ty, value } => {
                format!("(# {} {})", self.expr(ty), self.expr(value))
            }
            ExprKind::Member { base, member } => {
                format!("(. {} {})", self.expr(base), self.ident(member))
            }
            ExprKind::Part { base, part } => {
                let base = self.expr(base);
                let short = if part.short { "short " } else { "" };
                format!("(part {base} {short}{:?} {})", part.size, part.index)
            }
            ExprKind::Index { base, indices } => {
                format!("(index {}{})", self.expr(base), self.exprs(indices))
            }
            ExprKind::Deref(base) => format!("(^ {})", self.expr(base)),
            ExprKind::Direct(direct) => {
                let fields = direct.fields.map(|fields| self.arena[fields].to_vec());
                let of = direct
                    .resource
                    .map(|name| format!(" of {}", self.name(name)));
                let of = of.unwrap_or_default();
                format!(
                    "(direct {:?} {:?} {fields:?}{of})",
                    direct.area, direct.size
                )
            }
            ExprKind::This => "THIS".to_owned(),
            ExprKind::Super => "SUPER".to_owned(),
            ExprKind::Null => "NULL".to_owned(),
            ExprKind::Ref(operand) => format!("(REF {})", self.expr(operand)),
            ExprKind::Call { callee, arguments } => {
                format!("(call {}{})", self.expr(callee), self.arguments(arguments))
            }
            ExprKind::Unary { op, operand } => format!("({op:?} {})", self.expr(operand)),
            ExprKind::Binary {
                op, left, right, ..
            } => format!("({} {} {})", op.as_str(), self.expr(left), self.expr(right)),
            ExprKind::ArrayValue(values) => format!("(array{})", self.exprs(values)),
            ExprKind::Repeat { count, values } => {
                format!("(repeat {}{})", self.expr(count), self.exprs(values))
            }
            ExprKind::StructValue(fields) => format!("(struct{})", self.arguments(fields)),
            ExprKind::Error => "ERROR".to_owned(),
        }
    }

    fn arguments(&self, list: List<Argument>) -> String {
        self.each(list, |argument| {
            let value = argument.value.map(|value| self.expr(value));
            let value = value.unwrap_or_else(|| "nothing".to_owned());
            match argument.kind {
                ArgumentKind::Positional => value,
                ArgumentKind::Input(name) => format!("{}:={value}", self.ident(name)),
                ArgumentKind::Output(name) => format!("{}=>{value}", self.ident(name)),
                ArgumentKind::NegatedOutput(name) => format!("NOT {}=>{value}", self.ident(name)),
            }
        })
    }

    fn block(&mut self, block: Block) {
        for &stmt in &self.arena[block] {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: Id<Stmt>) {
        match self.arena[stmt].kind {
            StmtKind::Assign { target, op, value } => {
                let (target, value) = (self.expr(target), self.expr(value));
                self.line(format!("{} {target} {value}", op.as_str()));
            }
            StmtKind::AssignAll { targets, value } => {
                let targets = self.arena[targets].iter();
                let targets: Vec<String> = targets.map(|target| self.expr(*target)).collect();
                let value = self.expr(value);
                self.line(format!(":= {} {value}", targets.join(" := ")));
            }
            StmtKind::Call(call) => self.line(format!("do {}", self.expr(call))),
            StmtKind::If { arms, otherwise } => {
                for arm in &self.arena[arms] {
                    let condition = self.expr(arm.condition);
                    self.under(format!("if {condition}"), |dump| dump.block(arm.body));
                }
                self.otherwise(otherwise);
            }
            StmtKind::Case {
                selector,
                arms,
                otherwise,
            } => {
                self.line(format!("case {}", self.expr(selector)));
                for arm in &self.arena[arms] {
                    let labels = self.each(arm.labels, |label| {
                        let low = self.expr(label.low);
                        label
                            .high
                            .map_or(low.clone(), |high| format!("{low}..{}", self.expr(high)))
                    });
                    self.under(format!("of{labels}"), |dump| dump.block(arm.body));
                }
                self.otherwise(otherwise);
            }
            StmtKind::For {
                variable,
                from,
                to,
                by,
                body,
            } => {
                let [variable, from, to] = [variable, from, to].map(|expr| self.expr(expr));
                let by = self.option("by", by);
                let head = format!("for {variable} from:{from} to:{to}{by}");
                self.under(head, |dump| dump.block(body));
            }
            StmtKind::While { condition, body } => {
                let condition = self.expr(condition);
                self.under(format!("while {condition}"), |dump| dump.block(body));
            }
            StmtKind::Repeat { body, until } => {
                let until = self.expr(until);
                self.under(format!("repeat until:{until}"), |dump| dump.block(body));
            }
            StmtKind::Return => self.line("return"),
            StmtKind::Exit => self.line("exit"),
            StmtKind::Continue => self.line("continue"),
            StmtKind::Mock(instance) => self.line(format!("mock {}", self.expr(instance))),
            StmtKind::MockFunction { function, value } => {
                let (function, value) = (self.expr(function), self.expr(value));
                self.line(format!("mock function {function} returns:{value}"));
            }
            StmtKind::Empty => self.line("empty"),
            StmtKind::Error => self.line("ERROR"),
        }
    }

    fn otherwise(&mut self, block: Option<Block>) {
        if let Some(block) = block {
            self.under("else", |dump| dump.block(block));
        }
    }

    fn ty(&self, ty: Id<TypeSpec>) -> String {
        match self.arena[ty].kind {
            TypeKind::Named(path) => self.expr(path),
            TypeKind::Subrange { base, low, high } => {
                let [base, low, high] = [base, low, high].map(|expr| self.expr(expr));
                format!("(subrange {base} {low} {high})")
            }
            TypeKind::Sized {
                base,
                length,
                round,
            } => {
                let round = if round { " round" } else { "" };
                format!("(sized {} {}{round})", self.expr(base), self.expr(length))
            }
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let dimensions = self.each(dimensions, |dimension| match dimension {
                    Dimension::Range { low, high } => {
                        format!("{}..{}", self.expr(low), self.expr(high))
                    }
                    Dimension::Open => "*".to_owned(),
                });
                format!("(array{dimensions} of {})", self.ty(element))
            }
            TypeKind::Struct { overlap, members } => {
                let overlap = if overlap { " overlap" } else { "" };
                format!("(struct{overlap}{})", self.members(members))
            }
            TypeKind::Union { members } => format!("(union{})", self.members(members)),
            TypeKind::Enum { base, values } => {
                let base = self.option("base", base);
                let values = self.each(values, |value| {
                    let initial = self.option("is", value.value);
                    format!("[{}{initial}]", self.ident(value.name))
                });
                format!("(enum{base}{values})")
            }
            TypeKind::RefTo(target) => format!("(REF_TO {})", self.ty(target)),
            TypeKind::PointerTo(target) => format!("(POINTER_TO {})", self.ty(target)),
            TypeKind::ReferenceTo(target) => format!("(REFERENCE_TO {})", self.ty(target)),
            TypeKind::Error => "ERROR".to_owned(),
        }
    }

    fn members(&self, list: List<VarDecl>) -> String {
        self.each(list, |member| format!("[{}]", self.variable(member)))
    }

    fn variable(&self, variable: VarDecl) -> String {
        let names = self.each(variable.names, |name| self.ident(name).to_owned());
        let location = self.option("at", variable.location);
        let ty = self.ty(variable.ty);
        let edge = variable
            .edge
            .map_or_else(String::new, |edge| format!(" {edge:?}"));
        let initial = self.option("is", variable.initial);
        format!("var{names}{location} : {ty}{edge}{initial}")
    }

    fn sections(&mut self, list: List<VarSection>) {
        for section in &self.arena[list] {
            self.section(section);
        }
    }

    fn section(&mut self, section: &VarSection) {
        let head = format!(
            "{}{}",
            section.kind.as_str(),
            self.modifiers(section.modifiers)
        );
        self.under(head, |dump| match section.declarations {
            Declarations::Variables(list) => {
                for &variable in &dump.arena[list] {
                    dump.line(dump.variable(variable));
                }
            }
            Declarations::Accesses(list) => {
                for access in &dump.arena[list] {
                    let (name, path) = (dump.ident(access.name), dump.expr(access.path));
                    let ty = dump.ty(access.ty);
                    dump.line(format!(
                        "access {name} {path} : {ty} {:?}",
                        access.direction
                    ));
                }
            }
            Declarations::Instances(list) => {
                for config in &dump.arena[list] {
                    let (path, ty) = (dump.expr(config.path), dump.ty(config.ty));
                    let location = dump.option("at", config.location);
                    let initial = dump.option("is", config.initial);
                    dump.line(format!("config {path}{location} : {ty}{initial}"));
                }
            }
        });
    }

    fn unit(&mut self, kind: &UnitKind) {
        match kind {
            UnitKind::Types { modifiers, types } => {
                let head = format!("types{}", self.modifiers(*modifiers));
                self.under(head, |dump| {
                    for decl in &dump.arena[*types] {
                        let (name, ty) = (dump.ident(decl.name), dump.ty(decl.ty));
                        let extends = dump.option("extends", decl.extends);
                        let initial = dump.option("is", decl.initial);
                        dump.line(format!("type {name}{extends} : {ty}{initial}"));
                    }
                });
            }
            UnitKind::Pou(pou) => self.pou(pou),
            UnitKind::Configuration(configuration) => {
                let head = format!("CONFIGURATION {}", self.ident(configuration.name));
                self.under(head, |dump| {
                    dump.sections(configuration.sections);
                    for resource in &dump.arena[configuration.resources] {
                        dump.resource(resource);
                    }
                });
            }
            UnitKind::Test(test) => self.test(test),
            UnitKind::Globals(section) => self.section(section),
            UnitKind::Using(paths) => self.line(format!("using{}", self.exprs(*paths))),
            UnitKind::Nothing => self.line("nothing"),
            UnitKind::Error => self.line("ERROR"),
        }
    }

    fn pou(&mut self, pou: &Pou) {
        let (kind, name) = (pou.kind.as_str(), self.ident(pou.name));
        let modifiers = self.modifiers(pou.modifiers);
        self.under(format!("{kind}{modifiers} {name}"), |dump| {
            dump.result(pou.result);
            dump.paths("extends", pou.extends);
            dump.paths("implements", pou.implements);
            dump.paths("using", pou.usings);
            dump.sections(pou.sections);
            for member in &dump.arena[pou.members] {
                dump.member(member);
            }
            dump.block(pou.body);
        });
    }

    fn test(&mut self, test: &Test) {
        let title = test.title.map(|title| self.expr(title)).unwrap_or_default();
        self.under(format!("{} {title}", test.kind.as_str()), |dump| {
            dump.sections(test.sections);
            dump.block(test.body);
        });
    }

    fn result(&mut self, result: Option<Id<TypeSpec>>) {
        if let Some(result) = result {
            self.line(format!("result {}", self.ty(result)));
        }
    }

    fn paths(&mut self, word: &str, paths: List<Id<Expr>>) {
        if !paths.is_empty() {
            self.line(format!("{word}{}", self.exprs(paths)));
        }
    }

    fn member(&mut self, member: &Member) {
        match member {
            Member::Method(method) => {
                let modifiers = self.modifiers(method.modifiers);
                let head = format!("method{modifiers} {}", self.ident(method.name));
                self.under(head, |dump| {
                    dump.result(method.result);
                    dump.sections(method.sections);
                    dump.block(method.body);
                });
            }
            Member::Property(property) => {
                let modifiers = self.modifiers(property.modifiers);
                let (name, ty) = (self.ident(property.name), self.ty(property.ty));
                self.under(format!("property{modifiers} {name} : {ty}"), |dump| {
                    for (word, accessor) in [("get", property.get), ("set", property.set)] {
                        let Some(accessor) = accessor else { continue };
                        let head = format!("{word}{}", dump.modifiers(accessor.modifiers));
                        dump.under(head, |dump| {
                            dump.sections(accessor.sections);
                            dump.block(accessor.body);
                        });
                    }
                });
            }
            Member::Action(action) => {
                let head = format!("action {}", self.ident(action.name));
                self.under(head, |dump| dump.block(action.body));
            }
        }
    }

    fn resource(&mut self, resource: &Resource) {
        let name = resource.name.map_or("unnamed", |name| self.ident(name));
        let on = resource.on.map_or("", |on| self.ident(on));
        self.under(format!("resource {name} {on}"), |dump| {
            dump.sections(resource.sections);
            for task in &dump.arena[resource.tasks] {
                let parameters = dump.arguments(task.parameters);
                dump.line(format!("task {}{parameters}", dump.ident(task.name)));
            }
            for program in &dump.arena[resource.programs] {
                let modifiers = dump.modifiers(program.modifiers);
                let (name, ty) = (dump.ident(program.name), dump.expr(program.program));
                let task = program.task.map_or("no task", |task| dump.ident(task));
                let elements = dump.each(program.elements, |element| dump.element(element));
                dump.line(format!("program{modifiers} {name} : {ty} {task}{elements}"));
            }
        });
    }

    fn element(&self, element: ProgramElement) -> String {
        match element {
            ProgramElement::Source { variable, source } => {
                format!("{}:={}", self.expr(variable), self.expr(source))
            }
            ProgramElement::Sink { variable, sink } => {
                format!("{}=>{}", self.expr(variable), self.expr(sink))
            }
            ProgramElement::Task { block, task } => {
                format!("(with {} {})", self.expr(block), self.ident(task))
            }
        }
    }
}

fn literal_text(literal: &Literal) -> String {
    match literal {
        Literal::Bool(value) => format!("{value}"),
        Literal::Int(int) => {
            let sign = if int.negative { "-" } else { "" };
            format!("{sign}{}:{:?}", int.value, int.radix)
        }
        Literal::Real { negative, digits } => {
            let sign = if *negative { "-" } else { "" };
            format!("{sign}{}", digits.0)
        }
        Literal::String(string) => {
            let quotes = if string.double { "double" } else { "single" };
            format!("({quotes} {:?})", String::from_utf16_lossy(&string.units))
        }
        Literal::Time(time) => format!("({:?} {})", time.kind, time.ns),
    }
}
