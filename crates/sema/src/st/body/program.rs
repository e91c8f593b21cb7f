//! Programs by their names (CODESYS): a program has one instance, which others may call and whose
//! variables they see.

use super::{Body, Operand, Rights};
use crate::hir::code::Root;
use crate::st::signature::PouId;
use crate::st::types::TypeKind;
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// The instance that the name of a program stands for.
    pub(super) fn program(&mut self, program: PouId, range: TextRange) -> Operand {
        if !self.an.options.codesys {
            self.an
                .foreign(self.unit, range, "a program by its name in another unit");
            return Operand::error(range);
        }
        if self.constant_only {
            return self.error(Message::E2030, range, "a constant is needed here");
        }
        let Some(tag) = self.an.named_program(program) else {
            let name = self.text(self.an.pou(program).name);
            let message = format!("the configuration has several instances of `{name}`");
            let note = "in CODESYS a program has one, which its name stands for";
            let diagnostic = Diagnostic::new(Message::E8002, self.span(range), message);
            self.report(diagnostic.note(note));
            return Operand::error(range);
        };
        let ty = self.an.types.intern(TypeKind::Instance(program));
        self.place_operand(Root::Tag(tag), Vec::new(), Rights::All, ty, range)
    }
}
