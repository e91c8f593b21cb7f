//! Expressions of a wanted type.
//!
//! Operands that decide about faults at compile time are never constant: a sum of two literals
//! could be refused for its overflow. Literals stand on the right.

mod numbers;
mod routes;
mod times;

use crate::random_st::Generator;
use crate::random_st::scope::Route;
use crate::random_st::signatures::Way;
use crate::random_st::types::{Elementary, Kind, Type, Types};

/// How deep expressions nest.
const DEPTH: u32 = 3;

const COMPARISONS: [&str; 6] = ["=", "<>", "<", "<=", ">", ">="];

impl Generator<'_> {
    pub(crate) fn put(&mut self, text: &str) {
        self.draft.put(text);
    }

    /// Writes something that a literal of its type can stand for.
    fn marked(&mut self, ty: Type, write: impl FnOnce(&mut Self)) {
        let start = self.draft.position();
        write(self);
        let plain = self.types.plain(ty);
        self.draft.mark(start, &plain);
    }

    /// An expression or a literal for something of a type of one value, perhaps of a type that becomes
    /// it without being told to.
    pub(crate) fn value(&mut self, ty: Type) {
        let depth = self.rng.below(DEPTH as usize + 1) as u32;
        match self.narrower(ty) {
            Some(narrow) => self.operand(narrow, depth),
            None => self.any_value(ty, depth),
        }
    }

    /// Now and then a type that becomes another without being told to.
    fn narrower(&mut self, ty: Type) -> Option<Type> {
        let Type::Elementary(to) = ty else {
            return None;
        };
        let from = Elementary::ALL.iter().copied();
        let narrow: Vec<Elementary> = from.filter(|from| from.widens_to(to)).collect();
        let some = !narrow.is_empty() && self.rng.one_in(6);
        some.then(|| Type::Elementary(self.rng.pick(&narrow)))
    }

    fn any_value(&mut self, ty: Type, depth: u32) {
        if !self.rng.one_in(4) {
            return self.operand(ty, depth);
        }
        let bare = self.rng.one_in(2);
        let constants = self.constants.iter().filter(|(_, of)| *of == ty);
        let constants: Vec<String> = constants.map(|(name, _)| name.clone()).collect();
        let literal = if !constants.is_empty() && self.rng.one_in(2) {
            constants[self.rng.below(constants.len())].clone()
        } else {
            match ty.as_elementary().filter(|_| bare) {
                Some(ty) => self.bare_literal(ty),
                None => self.literal(ty),
            }
        };
        self.marked(ty, |this| this.put(&literal));
    }

    /// An expression that is not constant, if there is any way to it.
    pub(crate) fn operand(&mut self, ty: Type, depth: u32) {
        self.marked(ty, |this| {
            if (depth == 0 || this.rng.one_in(4)) && this.variable(ty) {
                return;
            }
            match ty {
                Type::Elementary(ty) if depth > 0 => this.operation(ty, depth - 1),
                Type::Elementary(ty) => this.converted(ty, 0),
                Type::Text { wide, .. } if depth > 0 => this.text(wide, depth - 1),
                Type::Subrange(at) => {
                    let base = this.types.subranges[at].base;
                    this.operand(Type::Elementary(base), depth);
                }
                Type::Enumeration(_) if depth > 0 => this.selection(ty, depth - 1),
                // A literal as the only argument of a function would be computed at compile time.
                Type::Text { wide, .. } => {
                    this.put(if wide { "TO_WSTRING(" } else { "TO_STRING(" });
                    this.operand(Type::INT, 0);
                    this.put(")");
                }
                Type::Enumeration(_) => {
                    let literal = this.literal(ty);
                    this.put(&literal);
                }
                Type::Reference(_) => this.reference(ty),
                Type::Array(_) | Type::Open(_) | Type::Structure(_) | Type::Instance(_) => {
                    unreachable!("these have no expressions")
                }
            }
        });
    }

    fn operation(&mut self, ty: Elementary, depth: u32) {
        match self.rng.below(10) {
            0 => return self.selection(Type::Elementary(ty), depth),
            1 => return self.converted(ty, depth),
            2 if self.call_of(Type::Elementary(ty)) => return,
            3 if self.method_of(Type::Elementary(ty)) => return,
            _ => {}
        }
        match ty.kind() {
            Kind::Bool => self.condition(depth),
            Kind::Signed | Kind::Unsigned => self.integer_operation(ty, depth),
            Kind::Bits => self.bit_operation(ty, depth),
            Kind::Real => self.real_operation(ty, depth),
            Kind::Duration => self.duration(ty, depth),
            Kind::Clock | Kind::Moment => self.shifted_time(ty, depth),
            Kind::Date | Kind::Character => self.selection(Type::Elementary(ty), depth),
        }
    }

    /// Two operands in parentheses; each can stand for both if it has the type of the result.
    fn binary(&mut self, op: &str, types: [Type; 3], depth: u32) {
        let [left, right, result] = types;
        let start = self.draft.position();
        self.put("(");
        let first = self.draft.position();
        // Times of the short and the long family do not mix in differences of dates.
        let may_narrow = left == right && (result == left || result == Type::BOOL);
        let narrow = if may_narrow {
            self.narrower(left)
        } else {
            None
        };
        self.operand(narrow.unwrap_or(left), depth);
        let middle = self.draft.position();
        self.put(&format!(" {op} "));
        let second = self.draft.position();
        if narrow.is_some() {
            // A literal would take the type of the other operand.
            self.operand(right, depth);
        } else {
            self.any_value(right, depth);
        }
        let last = self.draft.position();
        self.put(")");
        let end = self.draft.position();
        if left == result {
            self.draft
                .mark_all(vec![(start..first, ""), (middle..end, "")]);
        }
        if right == result {
            self.draft
                .mark_all(vec![(start..second, ""), (last..end, "")]);
        }
    }

    fn condition(&mut self, depth: u32) {
        match self.rng.below(12) {
            0..=3 => self.comparison(depth),
            4 => {
                self.put("NOT ");
                self.operand(Type::BOOL, depth);
            }
            5 if self.way(|route| route.ty == Type::BOOL && route.steps.len() > 1) => {}
            6 => {
                let ty = self.rng.pick(&[Elementary::Real, Elementary::Lreal]);
                self.standard_call("IS_VALID", &[Type::Elementary(ty)], depth);
            }
            7 => {
                let name = self.rng.pick(&["GT", "GE", "EQ", "LE", "LT"]);
                let ty = self.compared_type();
                let count = if matches!(ty, Type::Text { .. }) {
                    2
                } else {
                    2 + self.rng.below(2)
                };
                self.standard_call(name, &vec![ty; count], depth);
            }
            8 if self.reference_test() => {}
            9 if self.enumeration_test(depth) => {}
            _ => {
                let op = self.rng.pick(&["AND", "OR", "XOR", "&"]);
                self.binary(op, [Type::BOOL; 3], depth);
            }
        }
    }

    fn compared_type(&mut self) -> Type {
        if self.rng.one_in(8) {
            return Types::text(self.rng);
        }
        Type::Elementary(Types::elementary(self.rng))
    }

    fn comparison(&mut self, depth: u32) {
        let ty = self.compared_type();
        let op = self.rng.pick(&COMPARISONS);
        self.binary(op, [ty, ty, Type::BOOL], depth);
    }

    fn enumeration_test(&mut self, depth: u32) -> bool {
        let count = self.types.enumerations.len();
        if count == 0 {
            return false;
        }
        let ty = Type::Enumeration(self.rng.below(count));
        let op = self.rng.pick(&["=", "<>"]);
        self.binary(op, [ty, ty, Type::BOOL], depth);
        true
    }

    fn reference_test(&mut self) -> bool {
        let is_reference = |route: &Route| matches!(route.ty, Type::Reference(_));
        self.put("(");
        if !self.way(is_reference) {
            self.put("TRUE)");
            return true;
        }
        let op = self.rng.pick(&["=", "<>"]);
        self.put(&format!(" {op} NULL)"));
        true
    }

    /// One of several values of a type.
    fn selection(&mut self, ty: Type, depth: u32) {
        let ordered = !matches!(ty, Type::Enumeration(_));
        match self.rng.below(if ordered { 7 } else { 3 }) {
            0 | 1 => self.standard_call("SEL", &[Type::BOOL, ty, ty], depth),
            2 => {
                let mut args = vec![Type::INT];
                args.extend(vec![ty; 2 + self.rng.below(2)]);
                self.standard_call("MUX", &args, depth);
            }
            3 => self.standard_call("LIMIT", &[ty, ty, ty], depth),
            4 => self.standard_call("MOVE", &[ty], depth),
            _ => {
                let name = self.rng.pick(&["MAX", "MIN"]);
                let count = 2 + self.rng.below(2);
                self.standard_call(name, &vec![ty; count], depth);
            }
        }
    }

    /// A call of a standard function by position. The first argument of each type is not constant and
    /// has the type by itself.
    fn standard_call(&mut self, name: &str, args: &[Type], depth: u32) {
        self.put(name);
        self.put("(");
        for (position, &ty) in args.iter().enumerate() {
            self.put(if position > 0 { ", " } else { "" });
            if args[..position].contains(&ty) {
                self.any_value(ty, depth);
            } else {
                self.operand(ty, depth);
            }
        }
        self.put(")");
    }

    /// A call of a function of the program with this result; says whether there is one.
    pub(crate) fn call_of(&mut self, ty: Type) -> bool {
        let found = self.callable_function(|function| function.result == Some(ty));
        let Some(function) = found else { return false };
        let name = function.name.clone();
        let by_position = function.of(Way::Out).next().is_none() && self.rng.one_in(2);
        self.put(&name);
        self.arguments(&function, by_position);
        true
    }

    fn text(&mut self, wide: bool, depth: u32) {
        let text = Type::Text { wide, length: 10 };
        let int = Type::INT;
        match self.rng.below(10) {
            0 => self.standard_call("LEFT", &[text, int], depth),
            1 => self.standard_call("RIGHT", &[text, int], depth),
            2 => self.standard_call("MID", &[text, int, int], depth),
            3 => self.standard_call("INSERT", &[text, text, int], depth),
            4 => self.standard_call("DELETE", &[text, int, int], depth),
            5 => self.standard_call("REPLACE", &[text, text, int, int], depth),
            6 => {
                let to = if wide { "TO_WSTRING" } else { "TO_STRING" };
                let ty = self.written_type();
                self.standard_call(to, &[ty], depth);
            }
            7 => self.selection(text, depth),
            _ => {
                let count = 2 + self.rng.below(2);
                self.standard_call("CONCAT", &vec![text; count], depth);
            }
        }
    }

    /// A type whose values become texts; those with long library code seldom.
    fn written_type(&mut self) -> Type {
        use Elementary::{Bool, Byte, Char, Dint, Int, Uint, Word};
        if self.rng.one_in(5) {
            return Type::Elementary(Types::elementary(self.rng));
        }
        Type::Elementary(self.rng.pick(&[Bool, Byte, Char, Dint, Int, Uint, Word]))
    }

    /// A reference to something that lives between scans, or NULL.
    pub(crate) fn reference(&mut self, ty: Type) {
        let Type::Reference(at) = ty else {
            unreachable!("only references are asked for");
        };
        let target = self.types.references[at];
        if self.rng.below(4) == 0 && self.way(|route| route.ty == ty) {
            return;
        }
        let fits = |route: &Route| route.ty == target && route.keeps && route.whole;
        if self.rng.one_in(6) || !self.routes.iter().any(fits) {
            return self.put("NULL");
        }
        self.put("REF(");
        self.way(fits);
        self.put(")");
    }
}
