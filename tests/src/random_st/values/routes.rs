//! Ways to variables: names, members, subscripts.

use crate::random_st::Generator;
use crate::random_st::scope::{Route, Step};
use crate::random_st::types::{Elementary, Type};

impl Generator<'_> {
    /// A way that fits, written with its subscripts; says whether there is one.
    pub(crate) fn way(&mut self, fits: impl Fn(&Route) -> bool) -> bool {
        let routes = self.routes.iter().enumerate();
        let fitting: Vec<usize> = routes.filter(|(_, r)| fits(r)).map(|(at, _)| at).collect();
        if fitting.is_empty() {
            return false;
        }
        let route = self.routes[self.rng.pick(&fitting)].clone();
        self.write_route(&route);
        true
    }

    pub(crate) fn write_route(&mut self, route: &Route) {
        for step in &route.steps {
            match step {
                Step::Word(word) => self.put(word),
                Step::Index(bounds) => {
                    self.put("[");
                    for (position, &(low, high)) in bounds.iter().enumerate() {
                        self.put(if position > 0 { ", " } else { "" });
                        self.subscript(low, high);
                    }
                    self.put("]");
                }
                Step::Open(name) => {
                    self.put("[");
                    self.open_subscript(name);
                    self.put("]");
                }
                Step::Character(length) => {
                    self.put("[");
                    self.subscript(1, i64::from(*length));
                    self.put("]");
                }
            }
        }
    }

    /// A subscript within bounds that the call gives.
    fn open_subscript(&mut self, name: &str) {
        let plain = format!("LOWER_BOUND({name}, 1)");
        let start = self.draft.position();
        if self.nested > 1 {
            return self.put(&plain);
        }
        self.put(&format!("LIMIT({plain}, "));
        self.nested += 1;
        self.operand(Type::Elementary(Elementary::Dint), 1);
        self.nested -= 1;
        self.put(&format!(", UPPER_BOUND({name}, 1))"));
        self.draft.mark(start, &plain);
    }

    /// A subscript, seldom one outside of the bounds.
    fn subscript(&mut self, low: i64, high: i64) {
        let start = self.draft.position();
        let inside = low + self.rng.below((high - low + 1) as usize) as i64;
        self.nested += 1;
        let choice = if self.nested > 2 {
            7
        } else {
            self.rng.below(8)
        };
        match choice {
            0 => {
                let ty = self
                    .rng
                    .pick(&[Elementary::Int, Elementary::Dint, Elementary::Lint]);
                let ty = Type::Elementary(ty);
                if !self.variable(ty) {
                    self.put(&inside.to_string());
                }
            }
            1 | 2 => {
                self.put(&format!("LIMIT(INT#{low}, "));
                self.operand(Type::INT, 1);
                self.put(&format!(", INT#{high})"));
            }
            3 => {
                self.put(&format!("({low} + ABS("));
                self.operand(Type::INT, 1);
                self.put(&format!(" MOD {}))", high - low + 1));
            }
            _ => self.put(&inside.to_string()),
        }
        self.nested -= 1;
        self.draft.mark(start, &inside.to_string());
    }

    /// A variable, or a part of one, that has a type; strings of any length count as one type.
    pub(crate) fn variable(&mut self, ty: Type) -> bool {
        let subranges: Vec<Elementary> = self.types.subranges.iter().map(|r| r.base).collect();
        self.way(|route| match (route.ty, ty) {
            (Type::Subrange(from), Type::Elementary(to)) => subranges[from] == to,
            (Type::Text { wide, .. }, Type::Text { wide: wanted, .. }) => wide == wanted,
            (from, to) => from == to,
        })
    }
}
