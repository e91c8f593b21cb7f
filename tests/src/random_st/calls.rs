//! Calls of functions, methods and instances of the program, and of blocks of the library.

use super::Generator;
use super::scope::Route;
use super::signatures::{Param, Signature, Way};
use super::types::Type;

/// Statements that a body executes at most.
const MAX_COST: u64 = 2_000;

impl Generator<'_> {
    /// A function that fits, that is cheap enough here, and that finds in-outs.
    pub(super) fn callable_function(
        &mut self,
        fits: impl Fn(&Signature) -> bool,
    ) -> Option<Signature> {
        // The program's own functions more often than the many of the library.
        let first = if self.rng.one_in(3) {
            0
        } else {
            self.stdlib_functions
        };
        let functions = self.functions.iter().enumerate().skip(first);
        let fitting: Vec<usize> = functions
            .filter(|(_, function)| fits(function) && self.can_call(function))
            .map(|(at, _)| at)
            .collect();
        if fitting.is_empty() {
            return None;
        }
        let function = self.functions[self.rng.pick(&fitting)].clone();
        self.spend(function.cost);
        Some(function)
    }

    fn can_call(&self, callee: &Signature) -> bool {
        // Else calls as arguments of calls could go on for ever.
        let affordable = self.nested < 2 && self.cost + (callee.cost + 1) * self.turns <= MAX_COST;
        affordable
            && callee.of(Way::InOut).all(|param| {
                self.routes
                    .iter()
                    .any(|route| self.fits_in_out(route, param.ty))
            })
    }

    pub(super) fn spend(&mut self, statements: u64) {
        self.cost += statements * self.turns;
    }

    /// Arguments in parentheses: all by position, or some by name.
    pub(super) fn arguments(&mut self, callee: &Signature, by_position: bool) {
        self.nested += 1;
        self.write_arguments(callee, by_position);
        self.nested -= 1;
    }

    fn write_arguments(&mut self, callee: &Signature, by_position: bool) {
        let mut inputs = callee.of(Way::In);
        let by_position = by_position && inputs.all(|param| self.can_give(param.ty));
        self.put("(");
        let mut comma = false;
        if !by_position && self.rng.one_in(10) {
            self.put("EN := ");
            self.operand(Type::BOOL, 1);
            comma = true;
        }
        // Overloaded functions of the library are found by all their arguments.
        let complete = self.is_library(callee);
        for param in &callee.params {
            let needed = by_position || param.way == Way::InOut || complete;
            if needed || !self.rng.one_in(3) {
                self.argument(param, by_position, complete, &mut comma);
            }
        }
        if !by_position && self.rng.one_in(10) && self.has(Type::BOOL) {
            self.put(if comma { ", ENO => " } else { "ENO => " });
            self.target(Type::BOOL);
        }
        self.put(")");
    }

    fn is_library(&self, callee: &Signature) -> bool {
        let mut library = self.functions[..self.stdlib_functions].iter();
        library.any(|known| known.name == callee.name)
    }

    fn argument(&mut self, param: &Param, by_position: bool, exact: bool, comma: &mut bool) {
        let name = if by_position {
            String::new()
        } else {
            match param.way {
                Way::In | Way::InOut => format!("{} := ", param.name),
                Way::Out => format!("{} => ", param.name),
            }
        };
        let possible = match param.way {
            Way::In => self.can_give(param.ty),
            Way::Out => self.has(param.ty),
            Way::InOut => true,
        };
        if !possible {
            return;
        }
        let start = self.draft.position();
        self.put(if *comma { ", " } else { "" });
        let removable = *comma && param.way != Way::InOut && !by_position;
        *comma = true;
        self.put(&name);
        match param.way {
            Way::In if exact => self.operand(param.ty, 1),
            Way::In => self.given(param.ty),
            Way::Out => self.target(param.ty),
            Way::InOut => self.in_out(param.ty),
        }
        if removable {
            self.draft.mark(start, "");
        }
    }

    fn can_give(&self, ty: Type) -> bool {
        ty.is_value()
            || matches!(ty, Type::Reference(_))
            || self.routes.iter().any(|route| route.ty == ty)
    }

    /// A value for an input, whatever its type.
    fn given(&mut self, ty: Type) {
        match ty {
            Type::Elementary(_) | Type::Text { .. } | Type::Enumeration(_) => self.value(ty),
            Type::Subrange(_) => self.limited(ty),
            Type::Reference(_) => self.operand(ty, 0),
            Type::Array(_) | Type::Open(_) | Type::Structure(_) | Type::Instance(_) => {
                self.way(|route| route.ty == ty);
            }
        }
    }

    /// A value of a subrange, outside of it now and then.
    pub(super) fn limited(&mut self, ty: Type) {
        let Type::Subrange(at) = ty else {
            unreachable!("only subranges are asked for");
        };
        let range = self.types.subranges[at].clone();
        if self.rng.one_in(5) {
            return self.operand(ty, 1);
        }
        let word = range.base.word();
        self.put(&format!("LIMIT({word}#{}, ", range.low));
        self.operand(ty, 1);
        self.put(&format!(", {word}#{})", range.high));
    }

    /// Whether something of a type can be assigned.
    fn has(&self, ty: Type) -> bool {
        self.routes
            .iter()
            .any(|route| route.ty == ty && route.write)
    }

    /// Something of a type that can be assigned.
    fn target(&mut self, ty: Type) {
        self.way(|route| route.ty == ty && route.write);
    }

    /// A call as a statement: an instance, a method of one, or a function.
    pub(super) fn call_statement(&mut self) -> bool {
        match self.rng.below(4) {
            0 => self.function_statement(),
            1 => self.method_statement(),
            2 if self.rng.one_in(3) => self.input_statement(),
            _ => self.instance_statement(),
        }
    }

    fn function_statement(&mut self) -> bool {
        let found = self.callable_function(|_| true);
        let Some(function) = found else { return false };
        self.put(&function.name);
        self.arguments(&function, false);
        self.put(";\n");
        true
    }

    fn instance_statement(&mut self) -> bool {
        let routes = self.instances(|unit, this| {
            let body = unit.body.as_ref();
            body.is_some_and(|body| this.can_call(body))
        });
        let Some((route, at)) = routes else {
            return false;
        };
        let body = self.units[at].body.clone().expect("it has a body");
        self.spend(body.cost);
        self.write_route(&route);
        self.arguments(&body, false);
        self.put(";\n");
        true
    }

    /// An input of an instance is assigned, without a call.
    fn input_statement(&mut self) -> bool {
        let is_input = |param: &&Param| param.way == Way::In && param.ty.is_value();
        let found = self.instances(|unit, _| {
            let mut params = unit.body.iter().flat_map(|body| &body.params);
            params.any(|param| is_input(&param) && param.edge.is_empty())
        });
        let Some((route, at)) = found else {
            return false;
        };
        let body = self.units[at].body.clone().expect("it has inputs");
        let inputs = body.params.iter().filter(is_input);
        let inputs: Vec<&Param> = inputs.filter(|param| param.edge.is_empty()).collect();
        let input = inputs[self.rng.below(inputs.len())];
        self.write_route(&route);
        self.put(&format!(".{} := ", input.name));
        self.given(input.ty);
        self.put(";\n");
        true
    }

    fn method_statement(&mut self) -> bool {
        let found = self.instances(|unit, this| {
            let mut methods = unit.methods.iter();
            methods.any(|method| this.can_call(method))
        });
        let Some((route, at)) = found else {
            return false;
        };
        let methods = self.units[at].methods.iter();
        let methods: Vec<Signature> = methods.filter(|m| self.can_call(m)).cloned().collect();
        let method = methods[self.rng.below(methods.len())].clone();
        self.spend(method.cost);
        let result = method.result.filter(|ty| self.has(*ty));
        if let Some(ty) = result {
            self.target(ty);
            self.put(" := ");
        }
        self.write_route(&route);
        self.put(".");
        self.put(&method.name);
        self.arguments(&method, false);
        self.put(";\n");
        true
    }

    /// An instance whose unit fits.
    fn instances(
        &mut self,
        fits: impl Fn(&super::signatures::Unit, &Self) -> bool,
    ) -> Option<(Route, usize)> {
        let routes = self.routes.iter();
        let found: Vec<(usize, usize)> = routes
            .enumerate()
            .filter_map(|(index, route)| {
                let at = route.ty.as_instance()?;
                fits(&self.units[at], self).then_some((index, at))
            })
            .collect();
        if found.is_empty() {
            return None;
        }
        let (index, at) = self.rng.pick(&found);
        Some((self.routes[index].clone(), at))
    }

    /// Whether something can be passed as an in-out.
    fn fits_in_out(&self, route: &Route, ty: Type) -> bool {
        let below = match (route.ty, ty) {
            (Type::Array(at), Type::Open(element)) => {
                let array = &self.types.arrays[at];
                let fits = array.bounds.len() == 1 && array.element == Type::Elementary(element);
                fits && route.write
            }
            (Type::Instance(given), Type::Instance(wanted)) => {
                given == wanted || self.units[given].above.contains(&wanted)
            }
            (given, wanted) => given == wanted && route.write,
        };
        below && route.whole
    }

    fn in_out(&mut self, ty: Type) {
        let routes = self.routes.iter().enumerate();
        let fitting: Vec<usize> = routes
            .filter(|(_, route)| self.fits_in_out(route, ty))
            .map(|(at, _)| at)
            .collect();
        let route = self.routes[self.rng.pick(&fitting)].clone();
        self.write_route(&route);
    }

    /// A call of a method with this result; says whether there is one.
    pub(super) fn method_of(&mut self, ty: Type) -> bool {
        let fits = |method: &Signature| method.result == Some(ty);
        let found = self.instances(|unit, this| {
            let mut methods = unit.methods.iter();
            methods.any(|method| fits(method) && this.can_call(method))
        });
        let Some((route, at)) = found else {
            return false;
        };
        let methods = self.units[at].methods.iter();
        let methods: Vec<Signature> = methods
            .filter(|method| fits(method) && self.can_call(method))
            .cloned()
            .collect();
        let method = methods[self.rng.below(methods.len())].clone();
        self.spend(method.cost);
        self.write_route(&route);
        self.put(&format!(".{}", method.name));
        self.arguments(&method, false);
        true
    }
}
