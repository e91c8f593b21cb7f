//! Initial values in which a part is another one.

use crate::hir::code::Init;
use crate::hir::{InitId, Step};
use crate::st::analysis::Analysis;

impl Analysis<'_> {
    /// An initial value as it is with another value at a path of members and elements. Recursion is bounded
    /// by the depth of types.
    pub(crate) fn with_part(
        &mut self,
        init: Option<InitId>,
        path: &[Step],
        value: InitId,
    ) -> InitId {
        let old = init.map(|init| self.hir.inits.get(init).clone());
        match path.split_first() {
            None => value,
            Some((&Step::Field(field), rest)) => {
                let mut members = match old {
                    Some(Init::Struct(members)) => members,
                    Some(Init::Zero | Init::Bits(_) | Init::Address(_) | Init::Array(_)) | None => {
                        Vec::new()
                    }
                };
                let at = members.partition_point(|(member, _)| *member < field);
                let known = members.get(at).filter(|(member, _)| *member == field);
                let known = known.map(|(_, init)| *init);
                let part = self.with_part(known, rest, value);
                match known {
                    Some(_) => members[at].1 = part,
                    None => members.insert(at, (field, part)),
                }
                self.init(Init::Struct(members))
            }
            Some((&Step::Index(index), rest)) => {
                let runs = match old {
                    Some(Init::Array(runs)) => runs,
                    Some(Init::Zero | Init::Bits(_) | Init::Address(_) | Init::Struct(_))
                    | None => Vec::new(),
                };
                let (mut made, known, behind) = cut(&runs, index);
                let part = self.with_part(known, rest, value);
                made.push((index, 1, part));
                made.extend(behind);
                self.init(Init::Array(made))
            }
            Some((Step::Bit(_), _)) => panic!("bits have no initial values of their own"),
        }
    }
}

type Run = (u32, u32, InitId);

/// The runs before an element, its value, and the runs behind it.
fn cut(runs: &[Run], index: u32) -> (Vec<Run>, Option<InitId>, Vec<Run>) {
    let (mut before, mut known, mut behind) = (Vec::new(), None, Vec::new());
    for &(first, count, init) in runs {
        let end = first + count;
        if first < index {
            before.push((first, count.min(index - first), init));
        }
        if (first..end).contains(&index) {
            known = Some(init);
        }
        if end > index + 1 {
            let from = first.max(index + 1);
            behind.push((from, end - from, init));
        }
    }
    (before, known, behind)
}
