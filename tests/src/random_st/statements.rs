//! Statements. Every loop ends after a few passes, whatever its bounds are.

use super::Generator;
use super::types::{Elementary, Kind, Type};

impl Generator<'_> {
    /// Some statements, one at least, that shrinking may leave out one by one.
    pub(super) fn block(&mut self, depth: u32) {
        for _ in 0..1 + self.rng.below(3) {
            self.statement(depth);
        }
    }

    pub(super) fn statement(&mut self, depth: u32) {
        self.left = self.left.saturating_sub(1);
        self.spend(1);
        let start = self.draft.position();
        let nest = depth > 0 && self.left > 0;
        match self.rng.below(20) {
            0 | 1 if nest => self.if_statement(depth - 1),
            2 | 3 if nest => self.case_statement(depth - 1),
            4 | 5 if nest => self.for_statement(depth - 1),
            6 if nest => self.while_statement(depth - 1),
            7 if nest => self.repeat_statement(depth - 1),
            8 => self.leave(),
            9..=12 if self.call_statement() => {}
            13 if self.copy() => {}
            14 if self.refer() => {}
            _ => self.assignment(),
        }
        self.draft.mark(start, "");
    }

    fn assignment(&mut self) {
        let routes = self.routes.iter().enumerate();
        let targets: Vec<usize> = routes
            .filter(|(_, route)| route.write && route.ty.is_value())
            .map(|(at, _)| at)
            .collect();
        if targets.is_empty() {
            return self.put(";\n");
        }
        let route = self.routes[self.rng.pick(&targets)].clone();
        self.write_route(&route);
        self.put(" := ");
        if let Type::Subrange(_) = route.ty {
            self.limited(route.ty);
        } else {
            self.value(route.ty);
        }
        self.put(";\n");
    }

    /// A whole structure or array.
    fn copy(&mut self) -> bool {
        let whole = |ty| matches!(ty, Type::Array(_) | Type::Structure(_));
        let routes = self.routes.iter().enumerate();
        let targets: Vec<usize> = routes
            .filter(|(_, route)| route.write && whole(route.ty))
            .map(|(at, _)| at)
            .collect();
        if targets.is_empty() {
            return false;
        }
        let route = self.routes[self.rng.pick(&targets)].clone();
        self.write_route(&route);
        self.put(" := ");
        if !self.rng.one_in(2) || !self.call_of(route.ty) {
            self.way(|from| from.ty == route.ty);
        }
        self.put(";\n");
        true
    }

    /// A reference or an interface gets something to refer to.
    pub(super) fn refer(&mut self) -> bool {
        let interface = |ty: Type| {
            let unit = ty.as_instance();
            unit.is_some_and(|at| self.units[at].is_interface)
        };
        let routes = self.routes.iter().enumerate();
        let targets: Vec<usize> = routes
            .filter(|(_, route)| route.write || interface(route.ty))
            .filter(|(_, route)| matches!(route.ty, Type::Reference(_)) || interface(route.ty))
            .map(|(at, _)| at)
            .collect();
        if targets.is_empty() {
            return false;
        }
        let route = self.routes[self.rng.pick(&targets)].clone();
        self.write_route(&route);
        self.put(" := ");
        match route.ty.as_instance() {
            Some(interface) => self.implementor(interface),
            None => self.reference(route.ty),
        }
        self.put(";\n");
        true
    }

    fn implementor(&mut self, interface: usize) {
        let units: Vec<bool> = self
            .units
            .iter()
            .map(|u| u.above.contains(&interface))
            .collect();
        let implements = |ty| matches!(ty, Type::Instance(at) if units[at]);
        if !self.way(|route| implements(route.ty) && route.keeps) {
            self.put("NULL");
        }
    }

    fn if_statement(&mut self, depth: u32) {
        let start = self.draft.position();
        self.put("IF ");
        self.operand(Type::BOOL, 2);
        self.put(" THEN\n");
        let body = self.draft.position();
        self.block(depth);
        let end = self.draft.position();
        while self.rng.one_in(4) {
            let arm = self.draft.position();
            self.put("ELSIF ");
            self.operand(Type::BOOL, 1);
            self.put(" THEN\n");
            self.block(depth);
            self.draft.mark(arm, "");
        }
        if self.rng.one_in(2) {
            let arm = self.draft.position();
            self.put("ELSE\n");
            self.block(depth);
            self.draft.mark(arm, "");
        }
        self.put("END_IF;\n");
        self.unwrap(start, body, end);
    }

    /// A statement can be what stands in it.
    fn unwrap(&mut self, start: usize, body: usize, end: usize) {
        let last = self.draft.position();
        self.draft
            .mark_all(vec![(start..body, ""), (end..last, "")]);
    }

    fn case_statement(&mut self, depth: u32) {
        let enumerations = self.types.enumerations.len();
        self.put("CASE ");
        let labels = match self.rng.below(3) {
            0 if enumerations > 0 => {
                let at = self.rng.below(enumerations);
                self.operand(Type::Enumeration(at), 1);
                let count = self.types.enumerations[at].values.len();
                let values = (0..count).map(|value| self.types.enumerator(at, value));
                values.collect()
            }
            _ => self.number_labels(),
        };
        self.put(" OF\n");
        for label in labels {
            let start = self.draft.position();
            self.put(&format!("{label} :\n"));
            self.block(depth);
            self.draft.mark(start, "");
        }
        if self.rng.one_in(2) {
            let start = self.draft.position();
            self.put("ELSE\n");
            self.block(depth);
            self.draft.mark(start, "");
        }
        self.put("END_CASE;\n");
    }

    /// A selector, and labels that fit it and do not overlap.
    fn number_labels(&mut self) -> Vec<String> {
        let ty = loop {
            let ty = self.rng.pick(Elementary::ALL);
            if ty.is_integer() || ty.kind() == Kind::Bits {
                break ty;
            }
        };
        self.operand(Type::Elementary(ty), 1);
        let mut next = if ty.kind() == Kind::Signed { -3 } else { 0 };
        let mut labels = Vec::new();
        for _ in 0..1 + self.rng.below(4) {
            let mut parts = Vec::new();
            for _ in 0..1 + self.rng.below(2) {
                let low = next + self.rng.below(3) as i64;
                let high = low + self.rng.below(12) as i64;
                parts.push(if self.rng.one_in(3) {
                    format!("{low}..{high}")
                } else {
                    low.to_string()
                });
                next = high + 1;
            }
            labels.push(parts.join(", "));
        }
        labels
    }

    fn for_statement(&mut self, depth: u32) {
        let Some(counter) = self.counters.pop() else {
            return self.assignment();
        };
        let (name, ty) = counter.clone();
        let full = Type::Elementary(ty);
        let start = self.draft.position();
        let any = self.rng.one_in(3);
        self.put(&format!("FOR {name} := "));
        if any {
            self.value(full);
            self.put(" TO ");
            self.value(full);
        } else {
            let (from, to) = self.few(ty);
            self.put(&format!("{from} TO {to}"));
        }
        match self.rng.below(4) {
            0 => {
                let step = if ty.kind() == Kind::Signed { -1 } else { 2 };
                self.put(&format!(" BY {step}"));
            }
            1 if any => {
                self.put(" BY ");
                self.operand(full, 0);
            }
            _ => {}
        }
        self.put(" DO\n");
        self.passes(depth, start, any, "END_FOR;\n");
        self.counters.push(counter);
    }

    /// Bounds with a few passes between them.
    fn few(&mut self, ty: Elementary) -> (i64, i64) {
        let low = match self.rng.below(3) {
            0 if ty.kind() == Kind::Signed => -2,
            0 => 250,
            _ => self.rng.below(4) as i64,
        };
        let high = low + self.rng.below(5) as i64;
        let top = if ty == Elementary::Sint { 127 } else { 255 };
        (low.min(top), high.min(top))
    }

    /// The body of a loop; where its bounds are anything, a guard leaves it.
    fn passes(&mut self, depth: u32, start: usize, guarded: bool, tail: &str) {
        let body = self.draft.position();
        self.turns *= 4;
        self.loops += 1;
        if guarded {
            self.put("guard := guard + 1;\nIF guard > 3 THEN EXIT; END_IF;\n");
        }
        self.block(depth);
        self.loops -= 1;
        self.turns /= 4;
        let end = self.draft.position();
        self.put(tail);
        self.unwrap(start, body, end);
    }

    fn while_statement(&mut self, depth: u32) {
        let Some(counter) = self.counters.pop() else {
            return self.assignment();
        };
        let name = counter.0.clone();
        let start = self.draft.position();
        self.put(&format!("{name} := 0;\nWHILE {name} < 4 AND "));
        self.operand(Type::BOOL, 1);
        self.put(&format!(" DO\n{name} := {name} + 1;\n"));
        self.passes(depth, start, false, "END_WHILE;\n");
        self.counters.push(counter);
    }

    fn repeat_statement(&mut self, depth: u32) {
        let Some(counter) = self.counters.pop() else {
            return self.assignment();
        };
        let name = counter.0.clone();
        let start = self.draft.position();
        self.put(&format!("{name} := 0;\nREPEAT\n{name} := {name} + 1;\n"));
        let body = self.draft.position();
        self.turns *= 4;
        self.loops += 1;
        self.block(depth);
        self.loops -= 1;
        self.turns /= 4;
        let end = self.draft.position();
        self.put(&format!("UNTIL {name} >= 4 OR "));
        self.operand(Type::BOOL, 1);
        self.put(" END_REPEAT;\n");
        self.unwrap(start, body, end);
        self.counters.push(counter);
    }

    /// EXIT, CONTINUE or RETURN, on a condition so that what follows is reached.
    fn leave(&mut self) {
        let word = match self.rng.below(3) {
            0 if self.loops > 0 => "EXIT",
            1 if self.loops > 0 => "CONTINUE",
            _ if self.rng.one_in(3) => "RETURN",
            _ => return self.assignment(),
        };
        self.put("IF ");
        self.operand(Type::BOOL, 1);
        self.put(&format!(" THEN\n{word};\nEND_IF;\n"));
    }
}
