//! Instances inside of types are complete before the types are used, and contain neither themselves nor
//! more instances in one another than can be looked at.

use crate::st::analysis::{Analysis, MAX_RESOLUTION_DEPTH};
use crate::st::signature::State;
use crate::st::types::{Parts, TypeId};
use iecc_diag::Code;

impl Analysis<'_> {
    /// Completes the instances inside a type; gives the error type for a cycle, and for what is too
    /// large.
    pub(crate) fn complete_contained(&mut self, ty: TypeId, span: iecc_source::Span) -> TypeId {
        if self.memory.is_known(ty) {
            return ty;
        }
        let ty = self.complete_inside(ty, span);
        if ty == TypeId::ERROR || !self.fits_memory(ty, span) {
            return TypeId::ERROR;
        }
        ty
    }

    fn complete_inside(&mut self, ty: TypeId, span: iecc_source::Span) -> TypeId {
        let mut at = ty;
        loop {
            match self.types.parts(at) {
                Parts::Elements { element, .. } => at = element,
                Parts::Variables(inner) => {
                    let name = self.text(self.pou(inner).name);
                    let mut lineage = self.lineage(inner).into_iter();
                    if lineage.any(|id| self.pou(id).state == State::InProgress) {
                        let message = format!("`{name}` contains itself");
                        self.error(Code::E2009, span, message);
                        return TypeId::ERROR;
                    }
                    if self.depth >= MAX_RESOLUTION_DEPTH {
                        self.error(Code::E0013, span, "instances nest too deeply");
                        return TypeId::ERROR;
                    }
                    self.depth += 1;
                    self.complete(inner);
                    self.depth -= 1;
                    return ty;
                }
                Parts::Members(def) => {
                    let members: Vec<TypeId> = def.members.iter().map(|m| m.ty).collect();
                    for member in members {
                        if self.types.is_scalar(member) {
                            continue;
                        }
                        if self.complete_contained(member, span) == TypeId::ERROR {
                            return TypeId::ERROR;
                        }
                    }
                    return ty;
                }
                Parts::None => return ty,
            }
        }
    }
}
