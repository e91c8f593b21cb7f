//! Text to modules. One message for the first mistake, with line and column; no panics, bounded
//! nesting.

mod body;

use super::lex::{Token, UNITS, tokens};
use crate::{
    FieldDef, FuncId, Function, Image, Index, Layout, MAX_REGION_BYTES, MemType, Module, Origin,
    OriginData, Place, Projection, Root, Scalar, StructId, Type, TypeTable, View,
};
use cranelift_entity::PrimaryMap;
use iecc_source::{FileId, LineIndex, Span};
use std::collections::HashMap;
use std::fmt;

/// How deep array types may nest.
const MAX_TYPE_DEPTH: u32 = 16;

/// Fields of a struct that are looked up one after the other.
const FEW_FIELDS: usize = 8;

/// Why a text is not a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseError {
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1.
    pub column: u32,
    /// What is there and what was expected.
    pub message: String,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for ParseError {}

type Result<T> = std::result::Result<T, (usize, String)>;

/// Parses a module. It may still break the verifier's rules.
pub fn parse_module(text: &str) -> std::result::Result<Module, ParseError> {
    parse(text).map_err(|(offset, message)| {
        let at = LineIndex::new(text).line_column(text, offset as u32);
        ParseError {
            line: at.line,
            column: at.column,
            message,
        }
    })
}

fn parse(text: &str) -> Result<Module> {
    let tokens = tokens(text)?;
    let mut parser = Parser {
        tokens,
        next: 0,
        types: TypeTable::default(),
        functions: HashMap::new(),
        fields: HashMap::new(),
    };
    parser.module()
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    next: usize,
    types: TypeTable,
    functions: HashMap<String, FuncId>,
    fields: HashMap<StructId, HashMap<String, u32>>,
}

/// Header lines that need the complete regions or functions; resolved at the end of the header.
#[derive(Default)]
struct Header {
    regions: HashMap<&'static str, StructId>,
    image: Option<(Layout, Image)>,
    names: Vec<(String, Place)>,
    origins: PrimaryMap<Origin, OriginData>,
    scan: Option<FuncId>,
    prescan: Option<FuncId>,
}

impl Parser {
    fn peek(&self) -> &Token {
        &self.tokens[self.next].1
    }

    fn offset(&self) -> usize {
        self.tokens[self.next].0
    }

    fn fail<T>(&self, expected: &str) -> Result<T> {
        Err((
            self.offset(),
            format!("found {}, expected {expected}", self.peek().describe()),
        ))
    }

    fn is(&self, punct: &'static str) -> bool {
        *self.peek() == Token::Punct(punct)
    }

    fn accept(&mut self, punct: &'static str) -> bool {
        let found = self.is(punct);
        if found {
            self.next += 1;
        }
        found
    }

    fn expect(&mut self, punct: &'static str) -> Result<()> {
        if self.accept(punct) {
            Ok(())
        } else {
            self.fail(&format!("`{punct}`"))
        }
    }

    fn accept_word(&mut self, word: &str) -> bool {
        let found = matches!(self.peek(), Token::Word(found) if found == word);
        if found {
            self.next += 1;
        }
        found
    }

    fn name(&mut self) -> Result<String> {
        match self.peek().clone() {
            Token::Word(name) | Token::Quoted(name) => {
                self.next += 1;
                Ok(name)
            }
            Token::Number(_) | Token::Punct(_) | Token::End => self.fail("a name"),
        }
    }

    /// `open item, item close`; with `open` already taken.
    fn list<T>(
        &mut self,
        close: &'static str,
        mut item: impl FnMut(&mut Self) -> Result<T>,
    ) -> Result<Vec<T>> {
        let mut items = Vec::new();
        while !self.accept(close) {
            if !items.is_empty() {
                self.expect(",")?;
            }
            items.push(item(self)?);
        }
        Ok(items)
    }

    fn number<T: std::str::FromStr>(&mut self, expected: &str) -> Result<T> {
        let parsed = match self.peek() {
            Token::Number(text) => text.parse().ok(),
            Token::Word(_) | Token::Quoted(_) | Token::Punct(_) | Token::End => None,
        };
        match parsed {
            Some(value) => {
                self.next += 1;
                Ok(value)
            }
            None => self.fail(expected),
        }
    }

    /// A word made of a letter and a number: `v12`, `b3`.
    fn numbered(&mut self, letter: char, expected: &str) -> Result<u32> {
        let number = match self.peek() {
            Token::Word(word) => word
                .strip_prefix(letter)
                .and_then(|digits| digits.parse::<u32>().ok()),
            Token::Quoted(_) | Token::Number(_) | Token::Punct(_) | Token::End => None,
        };
        match number {
            Some(number) if number < u32::MAX => {
                self.next += 1;
                Ok(number)
            }
            _ => self.fail(expected),
        }
    }

    // ---- header ----

    fn module(&mut self) -> Result<Module> {
        if !self.accept_word("module") {
            return self.fail("`module`");
        }
        let name = self.name()?;
        let mut funcs = self.declare_functions()?;
        let mut header = Header::default();
        while !matches!(self.peek(), Token::End) && !self.accept_word("fn") {
            self.header_line(&mut header)?;
        }
        let state = self.region(&mut header, "state");
        let input = self.region(&mut header, "input");
        let output = self.region(&mut header, "output");
        let image = self.image(&mut header)?.1.clone();
        let Some(scan) = header.scan else {
            return self.fail("a line `scan @function` before the functions");
        };
        let mut module = Module {
            name,
            types: std::mem::take(&mut self.types),
            state,
            input,
            output,
            image,
            funcs: PrimaryMap::new(),
            scan,
            prescan: header.prescan,
            names: header.names,
            origins: header.origins,
        };
        for id in funcs.keys() {
            self.types = std::mem::take(&mut module.types);
            let func = self.function(&module);
            module.types = std::mem::take(&mut self.types);
            funcs[id] = func?;
            if !matches!(self.peek(), Token::End) && !self.accept_word("fn") {
                return self.fail("`fn` or the end of the text");
            }
        }
        module.funcs = funcs;
        Ok(module)
    }

    /// Finds all `fn @name`, so that calls and `scan` may stand before the function.
    fn declare_functions(&mut self) -> Result<PrimaryMap<FuncId, Function>> {
        let mut funcs = PrimaryMap::new();
        for window in self.tokens.windows(3) {
            let [
                (offset, Token::Word(word)),
                (_, Token::Punct("@")),
                (_, Token::Word(name) | Token::Quoted(name)),
            ] = window
            else {
                continue;
            };
            if word != "fn" {
                continue;
            }
            let id = funcs.push(Function::new(name.clone(), Vec::new()));
            if self.functions.insert(name.clone(), id).is_some() {
                return Err((*offset, format!("function @{name} is defined twice")));
            }
        }
        Ok(funcs)
    }

    fn header_line(&mut self, header: &mut Header) -> Result<()> {
        let Token::Word(keyword) = self.peek().clone() else {
            return self.fail("a declaration");
        };
        self.next += 1;
        match keyword.as_str() {
            "struct" => {
                let name = self.name()?;
                self.fields(name).map(|_| ())
            }
            "state" | "input" | "output" => {
                let region = match keyword.as_str() {
                    "state" => "state",
                    "input" => "input",
                    _ => "output",
                };
                let id = self.fields(keyword)?;
                header.regions.insert(region, id);
                Ok(())
            }
            "init" => self.init(header),
            "name" => self.alias(header),
            "origin" => self.origin_line(header),
            "scan" => {
                header.scan = Some(self.function_name()?);
                Ok(())
            }
            "prescan" => {
                header.prescan = Some(self.function_name()?);
                Ok(())
            }
            _ => {
                self.next -= 1;
                self.fail("struct, state, input, output, init, name, origin, prescan, scan or fn")
            }
        }
    }

    fn region(&mut self, header: &mut Header, name: &'static str) -> StructId {
        *header
            .regions
            .entry(name)
            .or_insert_with(|| self.types.add_struct(name, Vec::new()))
    }

    fn fields(&mut self, name: String) -> Result<StructId> {
        if self.types.struct_named(&name).is_some() {
            return self.fail(&format!("a new name, {name} is defined already"));
        }
        self.expect("{")?;
        let fields = self.list("}", |p| {
            let name = p.name()?;
            p.expect(":")?;
            let ty = p.mem_type(0)?;
            let lows = p.lows()?;
            let view = p.view()?;
            let field = FieldDef::new(name, ty).with_view(view);
            Ok(FieldDef { lows, ..field })
        })?;
        Ok(self.types.add_struct(name, fields))
    }

    /// `from [numbers]`, if it is there.
    fn lows(&mut self) -> Result<Vec<i64>> {
        if !self.accept_word("from") {
            return Ok(Vec::new());
        }
        self.expect("[")?;
        self.list("]", |p| p.number("the number of a first element"))
    }

    /// `as view`, if it is there.
    fn view(&mut self) -> Result<View> {
        if !self.accept_word("as") {
            return Ok(View::default());
        }
        let at = self.next;
        let name = self.name()?;
        match View::parse(&name) {
            Some(view) => Ok(view),
            None => {
                self.next = at;
                let names = View::ALL.map(View::name).join(", ");
                self.fail(&format!("one of {names}"))
            }
        }
    }

    fn mem_type(&mut self, depth: u32) -> Result<MemType> {
        if self.accept("[") {
            if depth == MAX_TYPE_DEPTH {
                return self.fail("fewer nested array types");
            }
            let len = self.number("a number of elements")?;
            if !self.accept_word("x") {
                return self.fail("`x`");
            }
            let element = self.mem_type(depth + 1)?;
            self.expect("]")?;
            return Ok(MemType::Array(self.types.array(element, len)));
        }
        let at = self.next;
        let name = self.name()?;
        if let Some(ty) = Type::parse(&name) {
            return Ok(MemType::Scalar(ty));
        }
        match self.types.struct_named(&name) {
            Some(id) => Ok(MemType::Struct(id)),
            None => {
                self.next = at;
                self.fail("a type defined above")
            }
        }
    }

    fn value_type(&mut self) -> Result<Type> {
        match self.mem_type(0)? {
            MemType::Scalar(ty) => Ok(ty),
            MemType::Struct(_) | MemType::Array(_) => {
                self.next -= 1;
                self.fail("a value type")
            }
        }
    }

    fn image<'h>(&mut self, header: &'h mut Header) -> Result<&'h mut (Layout, Image)> {
        let state = self.region(header, "state");
        if header.image.is_none() {
            let layout = Layout::new(&self.types);
            if layout.size(&self.types, MemType::Struct(state)) > MAX_REGION_BYTES {
                return self.fail("a smaller state region");
            }
            let image = Image::zero(&layout, &self.types, state);
            header.image = Some((layout, image));
        }
        Ok(header.image.as_mut().expect("just set"))
    }

    fn init(&mut self, header: &mut Header) -> Result<()> {
        let state = self.region(header, "state");
        let at = self.next;
        let (path, ty) = self.static_path(MemType::Struct(state), true)?;
        let (MemType::Scalar(ty), false) = (ty, matches!(path.last(), Some(Projection::Bit(_))))
        else {
            self.next = at;
            return self.fail("a scalar of the state");
        };
        self.expect("=")?;
        let value = self.literal(ty)?;
        self.image(header)?;
        let (layout, image) = header.image.as_mut().expect("just set");
        let place = Place {
            root: Root::State,
            path,
        };
        image.set_place(layout, &self.types, state, &place, value.bits);
        Ok(())
    }

    fn alias(&mut self, header: &mut Header) -> Result<()> {
        let name = self.name()?;
        self.expect("=")?;
        if !self.accept_word("state") {
            return self.fail("`state`");
        }
        let state = self.region(header, "state");
        let (path, _) = self.static_path(MemType::Struct(state), false)?;
        header.names.push((
            name,
            Place {
                root: Root::State,
                path,
            },
        ));
        Ok(())
    }

    fn origin_line(&mut self, header: &mut Header) -> Result<()> {
        self.expect("@")?;
        let number: usize = self.number("the number of the origin")?;
        if number != header.origins.len() {
            self.next -= 1;
            return self.fail(&format!("origin @{}", header.origins.len()));
        }
        self.expect("=")?;
        let label = self.name()?;
        let mut span = None;
        if matches!(self.peek(), Token::Number(_)) {
            let file: u32 = self.number("a file number")?;
            self.expect(":")?;
            let start: u32 = self.number("a byte offset")?;
            self.expect("..")?;
            let end: u32 = self.number("a byte offset")?;
            if end < start {
                return self.fail("a span that ends behind its start");
            }
            span = Some(Span::new(FileId::from_index(file as usize), start, end));
        }
        header.origins.push(OriginData {
            label: label.into(),
            span,
        });
        Ok(())
    }

    fn function_name(&mut self) -> Result<FuncId> {
        self.expect("@")?;
        let at = self.next;
        let name = self.name()?;
        match self.functions.get(&name) {
            Some(id) => Ok(*id),
            None => {
                self.next = at;
                self.fail("the name of a function in this text")
            }
        }
    }

    fn literal(&mut self, ty: Type) -> Result<Scalar> {
        let parsed = match self.peek() {
            Token::Number(text) => literal(ty, text),
            Token::Word(_) | Token::Quoted(_) | Token::Punct(_) | Token::End => None,
        };
        match parsed {
            Some(bits) => {
                self.next += 1;
                Ok(Scalar::new(ty, bits))
            }
            None => self.fail(&format!("a number of type {ty}")),
        }
    }

    // ---- places ----

    fn static_path(&mut self, start: MemType, bare: bool) -> Result<(Vec<Projection>, MemType)> {
        let at = self.next;
        let found = self.path(start, bare, &mut |p| p.fail("a constant index"))?;
        if !self.is_within(start, &found.0) {
            self.next = at;
            return self.fail("a path with indices below the lengths of its arrays");
        }
        Ok(found)
    }

    /// Whether constant indices lie within their arrays. Those of code are for the verifier.
    fn is_within(&self, start: MemType, path: &[Projection]) -> bool {
        let mut at = start;
        path.iter().all(|step| match (at, step) {
            (MemType::Array(id), Projection::Index(index)) => {
                let array = self.types.array_type(id);
                at = array.element;
                matches!(index, Index::Const(index) if *index < array.len)
            }
            (MemType::Struct(id), Projection::Field(field)) => {
                at = self.types.structs[id].fields[*field as usize].ty;
                true
            }
            (
                MemType::Scalar(_) | MemType::Struct(_) | MemType::Array(_),
                Projection::Bit(_) | Projection::Field(_) | Projection::Index(_),
            ) => true,
        })
    }

    /// Projections from `start`; a `bare` path begins with a field name without its dot. Also
    /// gives the type at the end; a bit counts as its integer.
    fn path(
        &mut self,
        start: MemType,
        bare: bool,
        value: &mut dyn FnMut(&mut Self) -> Result<Index>,
    ) -> Result<(Vec<Projection>, MemType)> {
        let (mut path, mut at, mut first) = (Vec::new(), start, bare);
        while first || self.is(".") || self.is("[") {
            let dotted = first || self.accept(".");
            first = false;
            let step = match at {
                MemType::Struct(id) if dotted => {
                    let (field, ty) = self.field(id)?;
                    at = ty;
                    field
                }
                MemType::Array(id) if !dotted => {
                    at = self.types.array_type(id).element;
                    Projection::Index(self.bracketed(value)?)
                }
                MemType::Scalar(ty) if dotted && ty.is_int() => {
                    let bit = if self.is("[") {
                        self.bracketed(value)?
                    } else {
                        Index::Const(self.number("a bit number")?)
                    };
                    path.push(Projection::Bit(bit));
                    return Ok((path, at));
                }
                MemType::Struct(_) => return self.fail("`.` and a field"),
                MemType::Array(_) => return self.fail("`[` and an index"),
                MemType::Scalar(_) => return self.fail("nothing behind a scalar"),
            };
            path.push(step);
        }
        Ok((path, at))
    }

    fn field(&mut self, id: StructId) -> Result<(Projection, MemType)> {
        let at = self.next;
        let name = self.name()?;
        match self.field_number(id, &name) {
            Some(field) => Ok((
                Projection::Field(field),
                self.types.structs[id].fields[field as usize].ty,
            )),
            None => {
                self.next = at;
                self.fail(&format!("a field of {}", self.types.structs[id].name))
            }
        }
    }

    /// Fields are looked up by a table once a struct has many.
    fn field_number(&mut self, id: StructId, name: &str) -> Option<u32> {
        let def = &self.types.structs[id];
        if def.fields.len() <= FEW_FIELDS {
            return def.field(name);
        }
        let numbers = self.fields.entry(id).or_insert_with(|| {
            let mut numbers = HashMap::new();
            for (number, field) in (0..).zip(&def.fields) {
                numbers.entry(field.name.clone()).or_insert(number);
            }
            numbers
        });
        numbers.get(name).copied()
    }

    fn bracketed(&mut self, value: &mut dyn FnMut(&mut Self) -> Result<Index>) -> Result<Index> {
        self.expect("[")?;
        let index = match self.peek() {
            Token::Number(_) => Index::Const(self.number("an index")?),
            Token::Word(_) | Token::Quoted(_) | Token::Punct(_) | Token::End => value(self)?,
        };
        self.expect("]")?;
        Ok(index)
    }
}

fn literal(ty: Type, text: &str) -> Option<u64> {
    if let Some(hex) = text.strip_prefix("0x") {
        return u64::from_str_radix(hex, 16)
            .ok()
            .filter(|bits| bits & !ty.mask() == 0);
    }
    match ty {
        Type::F32 => text.parse::<f32>().ok().map(|x| u64::from(x.to_bits())),
        Type::F64 => text.parse::<f64>().ok().map(f64::to_bits),
        Type::I1 => text.parse::<u64>().ok().filter(|&bits| bits < 2),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
            let value = text.parse::<i128>().ok()?;
            let low = i128::from(i64::MIN) >> (64 - ty.bits());
            let range = low..=i128::from(ty.mask());
            range.contains(&value).then_some(value as u64 & ty.mask())
        }
    }
}

fn duration(text: &str) -> Option<u64> {
    let split = text.find(|c: char| !c.is_ascii_digit())?;
    let (number, unit) = text.split_at(split);
    let (_, ns) = UNITS.into_iter().find(|(name, _)| *name == unit)?;
    number.parse::<u64>().ok()?.checked_mul(ns)
}
