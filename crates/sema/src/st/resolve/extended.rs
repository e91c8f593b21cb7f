//! Structures that extend others (CODESYS): the members of the base come first.

use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::types::{Member, StructDef, TypeId};
use iecc_ast::st;
use iecc_diag::Code;
use rustc_hash::FxHashMap;

impl Analysis<'_> {
    /// A structure with the members of another before its own.
    pub(crate) fn extended_struct(
        &mut self,
        scope: TypeScope<'_>,
        own: TypeId,
        base: st::Id<st::Expr>,
    ) -> TypeId {
        let range = self.unit(scope.unit).arena[base].range;
        let base = self.type_by_path(scope, base);
        if own == TypeId::ERROR || base == TypeId::ERROR {
            return TypeId::ERROR;
        }
        let (Some(base), Some(own)) = (self.plain_struct(base), self.plain_struct(own)) else {
            let span = self.span(scope.unit, range);
            let message = "a structure extends another, and the members of both lie side by side";
            self.error(Code::E2022, span, message);
            return TypeId::ERROR;
        };
        let mut members: Vec<Member> = base.members;
        let mut by_name: FxHashMap<_, _> = base.by_name;
        for member in own.members {
            if let Some(&first) = by_name.get(&member.name) {
                let first = members[first as usize].span;
                self.declared_twice(member.name, member.span, first);
                continue;
            }
            by_name.insert(member.name, members.len() as u32);
            members.push(member);
        }
        self.types.add_struct(StructDef {
            members,
            by_name,
            packed: own.packed || base.packed,
            ..own
        })
    }

    fn plain_struct(&self, ty: TypeId) -> Option<StructDef> {
        let def = self.types.structure(ty)?;
        def.overlay.is_none().then(|| def.clone())
    }
}
