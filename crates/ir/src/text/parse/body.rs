//! Functions: blocks, instructions and terminators.

use super::{Parser, Result, duration};
use crate::text::lex::Token;
use crate::{
    BinaryOp, Block, CompareOp, ConvertOp, FaultCode, Function, Index, InstData, LocalData,
    MemType, Module, Origin, Place, RefParamData, Root, Target, Terminator, Type, UnaryOp, Value,
};
use std::collections::HashMap;

impl Parser {
    /// A function behind `fn`.
    pub(super) fn function(&mut self, module: &Module) -> Result<Function> {
        self.expect("@")?;
        let name = self.name()?;
        let mut func = Function::new(name, Vec::new());
        self.expect("[")?;
        let refs = self.list("]", |p| {
            let name = p.name()?;
            p.expect(":")?;
            Ok(RefParamData {
                name,
                ty: p.mem_type(0)?,
            })
        })?;
        func.refs = refs.into_iter().collect();
        self.expect("(")?;
        let params = self.list(")", Self::value_type)?;
        self.expect("->")?;
        self.expect("(")?;
        func.results = self.list(")", Self::value_type)?;
        self.expect("{")?;
        while self.accept_word("local") {
            let name = self.name()?;
            self.expect(":")?;
            let ty = self.mem_type(0)?;
            func.locals.push(LocalData { name, ty });
        }
        let at = self.offset();
        let mut body = Body {
            roots: roots(module, &func),
            module,
            func,
            values: HashMap::new(),
            blocks: HashMap::new(),
        };
        while !self.accept("}") {
            self.block(&mut body)?;
        }
        let func = body.finish().map_err(|message| (at, message))?;
        if func.param_types() != params {
            return Err((
                at,
                "the parameters of the first block differ from those of the function".to_owned(),
            ));
        }
        Ok(func)
    }

    fn block(&mut self, body: &mut Body<'_>) -> Result<()> {
        let number = self.numbered('b', "a block `bN:`")?;
        let block = body.func.add_block();
        if body.blocks.insert(number, block).is_some() {
            self.next -= 1;
            return self.fail("a block that is not defined yet");
        }
        if self.accept("(") {
            self.list(")", |p| {
                let (number, ty) = p.typed_value()?;
                let value = body.func.add_param(block, ty);
                body.define(p, number, value)
            })?;
        }
        self.expect(":")?;
        while body.func.block(block).terminator.is_none() {
            self.line(body, block)?;
        }
        Ok(())
    }

    fn typed_value(&mut self) -> Result<(u32, Type)> {
        let number = self.numbered('v', "a value `vN`")?;
        self.expect(":")?;
        Ok((number, self.value_type()?))
    }

    fn line(&mut self, body: &mut Body<'_>, block: Block) -> Result<()> {
        let Token::Word(word) = self.peek().clone() else {
            return self.fail("an instruction or terminator");
        };
        if let Some(terminator) = self.terminator(&word)? {
            let origin = self.origin(body)?;
            body.func.set_terminator(block, terminator, origin);
            return Ok(());
        }
        let results = match word.as_str() {
            "store" | "copy" | "clear" | "call" => Vec::new(),
            _ => self.results()?,
        };
        let types: Vec<Type> = results.iter().map(|(_, ty)| *ty).collect();
        let data = self.inst(body, &types)?;
        let origin = self.origin(body)?;
        let inst = body.func.append_inst(block, data, &types, origin);
        let values = body.func.results_of(inst).to_vec();
        results
            .iter()
            .zip(values)
            .try_for_each(|(&(number, _), value)| body.define(self, number, value))
    }

    /// `v1: i32, v2: i1 =`
    fn results(&mut self) -> Result<Vec<(u32, Type)>> {
        let mut results = vec![self.typed_value()?];
        while self.accept(",") {
            results.push(self.typed_value()?);
        }
        self.expect("=")?;
        Ok(results)
    }

    fn origin(&mut self, body: &Body<'_>) -> Result<Option<Origin>> {
        if !self.accept("@") {
            return Ok(None);
        }
        let number: u32 = self.number("the number of an origin")?;
        if number as usize >= body.module.origins.len() {
            self.next -= 1;
            return self.fail("an origin of the header");
        }
        Ok(Some(Origin::from_u32(number)))
    }

    fn value(&mut self) -> Result<Value> {
        self.numbered('v', "a value `vN`").map(Value::from_u32)
    }

    fn pair(&mut self) -> Result<[Value; 2]> {
        let left = self.value()?;
        self.expect(",")?;
        Ok([left, self.value()?])
    }

    fn inst(&mut self, body: &Body<'_>, types: &[Type]) -> Result<InstData> {
        let at = self.next;
        let name = self.name()?;
        let ty = types.first().copied();
        if let Some(data) = self.table_inst(&name, ty)? {
            return Ok(data);
        }
        match (name.as_str(), ty) {
            ("const", Some(ty)) => self.literal(ty).map(|value| InstData::Const {
                ty,
                bits: value.bits,
            }),
            ("select", _) => {
                let cond = self.value()?;
                self.expect(",")?;
                Ok(InstData::Select {
                    cond,
                    args: self.pair()?,
                })
            }
            ("load", _) => Ok(InstData::Load {
                place: self.place(body)?,
            }),
            ("store", _) => {
                let place = self.place(body)?;
                self.expect(",")?;
                Ok(InstData::Store {
                    place,
                    value: self.value()?,
                })
            }
            ("copy", _) => {
                let to = self.place(body)?;
                self.expect(",")?;
                let from = self.place(body)?;
                Ok(InstData::Copy { to, from })
            }
            ("clear", _) => Ok(InstData::Clear {
                place: self.place(body)?,
            }),
            ("address", _) => Ok(InstData::Address {
                place: self.place(body)?,
            }),
            ("now", _) => Ok(InstData::Now),
            ("elapsed", Some(ty)) => {
                let place = self.place(body)?;
                self.expect(",")?;
                Ok(InstData::Elapsed {
                    place,
                    unit_ns: self.unit()?,
                    ty,
                })
            }
            ("step", Some(ty)) => Ok(InstData::Step {
                unit_ns: self.unit()?,
                ty,
            }),
            ("call", _) => {
                let func = self.function_name()?;
                self.expect("[")?;
                let refs = self.list("]", |p| p.place(body))?;
                self.expect("(")?;
                Ok(InstData::Call {
                    func,
                    refs,
                    args: self.list(")", Self::value)?,
                })
            }
            _ => {
                self.next = at;
                self.fail("an instruction")
            }
        }
    }

    fn table_inst(&mut self, name: &str, ty: Option<Type>) -> Result<Option<InstData>> {
        if let Some(op) = UnaryOp::parse(name) {
            return Ok(Some(InstData::Unary {
                op,
                arg: self.value()?,
            }));
        }
        if let Some(op) = BinaryOp::parse(name) {
            return Ok(Some(InstData::Binary {
                op,
                args: self.pair()?,
            }));
        }
        if let Some(op) = CompareOp::parse(name) {
            return Ok(Some(InstData::Compare {
                op,
                args: self.pair()?,
            }));
        }
        match (ConvertOp::parse(name), ty) {
            (Some(op), Some(to)) => Ok(Some(InstData::Convert {
                op,
                to,
                arg: self.value()?,
            })),
            (Some(_), None) => self.fail("a result for the conversion"),
            (None, _) => Ok(None),
        }
    }

    fn unit(&mut self) -> Result<u64> {
        let parsed = match self.peek() {
            Token::Number(text) => duration(text),
            Token::Word(_) | Token::Quoted(_) | Token::Punct(_) | Token::End => None,
        };
        match parsed {
            Some(unit) => {
                self.next += 1;
                Ok(unit)
            }
            None => self.fail("a duration such as 1ms"),
        }
    }

    fn place(&mut self, body: &Body<'_>) -> Result<Place> {
        if self.accept_word("deref") {
            return self.deref();
        }
        let at = self.next;
        let name = self.name()?;
        let Some(&(root, start)) = body.roots.get(&name) else {
            self.next = at;
            return self.fail("state, input, output, a reference parameter or a local");
        };
        let (path, _) = self.path(start, false, &mut |p| p.value().map(Index::Value))?;
        Ok(Place { root, path })
    }

    /// `v3: type` and the way from there.
    fn deref(&mut self) -> Result<Place> {
        let value = self.value()?;
        self.expect(":")?;
        let ty = self.mem_type(0)?;
        let (path, _) = self.path(ty, false, &mut |p| p.value().map(Index::Value))?;
        let root = Root::Deref { value, ty };
        Ok(Place { root, path })
    }

    fn target(&mut self) -> Result<Target> {
        let block = Block::from_u32(self.numbered('b', "a block `bN`")?);
        let args = if self.accept("(") {
            self.list(")", Self::value)?
        } else {
            Vec::new()
        };
        Ok(Target { block, args })
    }

    fn terminator(&mut self, word: &str) -> Result<Option<Terminator>> {
        if !matches!(word, "jump" | "brif" | "switch" | "return" | "fault") {
            return Ok(None);
        }
        self.next += 1;
        let terminator = match word {
            "jump" => Terminator::Jump(self.target()?),
            "brif" => {
                let cond = self.value()?;
                self.expect(",")?;
                let then = self.target()?;
                self.expect(",")?;
                Terminator::Brif {
                    cond,
                    then,
                    otherwise: self.target()?,
                }
            }
            "switch" => self.switch()?,
            "fault" => {
                let at = self.next;
                let Some(fault) = FaultCode::parse(&self.name()?) else {
                    self.next = at;
                    return self.fail("the name of a fault");
                };
                Terminator::Fault(fault)
            }
            _ => Terminator::Return(self.returned()?),
        };
        Ok(Some(terminator))
    }

    fn returned(&mut self) -> Result<Vec<Value>> {
        let mut values = Vec::new();
        // `return` has no end mark; what follows is a value, a block label, `@` or `}`.
        while values.is_empty() && matches!(self.peek(), Token::Word(word) if word.starts_with('v'))
            || self.accept(",")
        {
            values.push(self.value()?);
        }
        Ok(values)
    }

    fn switch(&mut self) -> Result<Terminator> {
        let value = self.value()?;
        self.expect(",")?;
        let default = self.target()?;
        self.expect("[")?;
        // The type of the selector may not be known yet; `Body::finish` masks the numbers.
        let cases = self.list("]", |p| {
            let bits = p.literal(Type::I64)?.bits;
            p.expect(":")?;
            Ok((bits, p.target()?))
        })?;
        Ok(Terminator::Switch {
            value,
            cases,
            default,
        })
    }
}

/// What places may begin with. Of two things with one name, which the verifier refuses, the first.
fn roots(module: &Module, func: &Function) -> HashMap<String, (Root, MemType)> {
    let regions = [
        ("state", Root::State, module.state),
        ("input", Root::Input, module.input),
        ("output", Root::Output, module.output),
    ];
    let mut roots = HashMap::new();
    for (name, root, id) in regions {
        roots.insert(name.to_owned(), (root, MemType::Struct(id)));
    }
    let refs = func
        .refs
        .iter()
        .map(|(id, data)| (&data.name, Root::Ref(id), data.ty));
    let locals = func
        .locals
        .iter()
        .map(|(id, data)| (&data.name, Root::Local(id), data.ty));
    for (name, root, ty) in refs.chain(locals) {
        roots.entry(name.clone()).or_insert((root, ty));
    }
    roots
}

/// A function whose uses still hold the numbers of the text.
struct Body<'m> {
    module: &'m Module,
    func: Function,
    roots: HashMap<String, (Root, MemType)>,
    values: HashMap<u32, Value>,
    blocks: HashMap<u32, Block>,
}

impl Body<'_> {
    fn define(&mut self, parser: &Parser, number: u32, value: Value) -> Result<()> {
        match self.values.insert(number, value) {
            None => Ok(()),
            Some(_) => Err((parser.offset(), format!("value v{number} is defined twice"))),
        }
    }

    fn finish(mut self) -> std::result::Result<Function, String> {
        if self.func.layout.is_empty() {
            return Err(format!("function @{} has no block", self.func.name));
        }
        let mut undefined = None;
        self.func.map_uses(|value| {
            let number = value.as_u32();
            self.values.get(&number).copied().unwrap_or_else(|| {
                undefined = Some(number);
                value
            })
        });
        if let Some(number) = undefined {
            return Err(format!(
                "value v{number} is used but not defined in @{}",
                self.func.name
            ));
        }
        for block in self.func.layout.clone() {
            let mut terminator = self.func.terminator(block).clone();
            for target in terminator.targets_mut() {
                let number = target.block.as_u32();
                target.block = *self
                    .blocks
                    .get(&number)
                    .ok_or(format!("block b{number} is not defined"))?;
            }
            if let Terminator::Switch { value, cases, .. } = &mut terminator {
                let mask = self.func.value_type(*value).mask();
                cases.iter_mut().for_each(|(bits, _)| *bits &= mask);
            }
            let origin = self.func.block(block).terminator_origin;
            self.func.set_terminator(block, terminator, origin);
        }
        Ok(self.func)
    }
}
