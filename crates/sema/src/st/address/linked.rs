//! Variables at `%I*` and `%Q*`, whose addresses are not in the program. VAR_CONFIG gives them; in
//! CODESYS, where the plant is linked to variables outside of the program, those without an address are inputs
//! and outputs by their own names.

use crate::hir::{Place, Step, TagId};
use crate::st::analysis::Analysis;
use crate::st::objects::InstancePart;
use crate::st::signature::{Global, PouId, Spot, State};
use crate::st::types::{Parts, TypeId};
use iecc_ast::Symbol;
use iecc_ast::st::Area;
use iecc_diag::Code;

/// A variable at an address with `*`.
struct Linked {
    path: String,
    place: Place,
    ty: TypeId,
    area: Area,
    /// Whether it is in an array of which one element stands for all: one that is too large, or outside of
    /// CODESYS.
    repeated: bool,
}

/// Something to look into, with its place and path.
struct Part {
    of: Of,
    place: Place,
    path: String,
    repeated: bool,
}

enum Of {
    Type(TypeId),
    /// An instance, or the part of one that is a base.
    Instance(PouId),
}

/// The most elements of an array that are linked each for itself.
const MAX_LINKED: u64 = 4096;

fn elements(dimensions: &[(i64, i64)]) -> u64 {
    let extents = dimensions.iter().map(|(low, high)| low.abs_diff(*high) + 1);
    extents.fold(1, u64::saturating_mul)
}

impl Analysis<'_> {
    /// A global variable that is an input or output by its name.
    pub(crate) fn linked_global(&mut self, global: &Global, area: Area) -> Spot {
        let name = self.global_name(global);
        let name = self.free_tag_name(name);
        let (storage, view) = (self.storage(global.ty), self.view(global.ty));
        let tag = self.add_tag(&name, storage, view, None, Some(global.span));
        self.link(&name, Place::whole(tag), global.ty, area);
        let steps = Vec::new();
        Spot { tag, steps }
    }

    fn link(&mut self, name: &str, place: Place, ty: TypeId, area: Area) {
        match area {
            Area::Input => self.points(name, place, ty, true),
            Area::Output => self.points(name, place, ty, false),
            Area::Memory => {}
        }
    }

    /// Every variable at an address with `*` needs VAR_CONFIG, or is linked.
    pub(crate) fn check_places(
        &mut self,
        program: PouId,
        tag: TagId,
        name: &str,
        placed: &[Place],
    ) {
        if self.pou(program).state != State::Done {
            return;
        }
        for linked in self.linked_places(program, tag, name) {
            if placed.contains(&linked.place) {
                continue;
            }
            if self.options.codesys && !linked.repeated {
                self.link(&linked.path, linked.place, linked.ty, linked.area);
                continue;
            }
            let span = self.pou(program).span;
            let message = format!("no VAR_CONFIG says at which address `{}` lies", linked.path);
            self.error(Code::E6044, span, message);
        }
    }

    /// Everything below a program whose address is given outside of it.
    fn linked_places(&self, program: PouId, tag: TagId, name: &str) -> Vec<Linked> {
        let mut found = Vec::new();
        let mut stack = vec![Part {
            of: Of::Instance(program),
            place: Place::whole(tag),
            path: name.to_owned(),
            repeated: false,
        }];
        while let Some(part) = stack.pop() {
            match part.of {
                Of::Instance(pou) => self.parts_of_instance(pou, &part, &mut stack, &mut found),
                Of::Type(ty) => self.parts_of_type(ty, &part, &mut stack, &mut found),
            }
        }
        found.sort_by(|a, b| a.path.cmp(&b.path));
        found
    }

    fn parts_of_instance(
        &self,
        pou: PouId,
        part: &Part,
        stack: &mut Vec<Part>,
        found: &mut Vec<Linked>,
    ) {
        for (field, inner) in (0..).zip(self.instance_parts(pou)) {
            match inner {
                InstancePart::Base(base) => stack.push(Part {
                    of: Of::Instance(base),
                    place: part.place.clone().step(Step::Field(field)),
                    path: part.path.clone(),
                    repeated: part.repeated,
                }),
                InstancePart::Var(index) => {
                    let var = &self.pou(pou).vars[index];
                    let member = (var.name, field, var.partly, var.ty);
                    self.look(part, member, stack, found);
                }
                InstancePart::TypeNumber | InstancePart::Mock | InstancePart::Edge(_) => {}
            }
        }
    }

    fn parts_of_type(
        &self,
        ty: TypeId,
        part: &Part,
        stack: &mut Vec<Part>,
        found: &mut Vec<Linked>,
    ) {
        match self.types.parts(ty) {
            Parts::Members(def) => {
                for (field, member) in (0..).zip(&def.members) {
                    let member = (member.name, field, member.partly, member.ty);
                    self.look(part, member, stack, found);
                }
            }
            Parts::Variables(pou) => self.parts_of_instance(pou, part, stack, found),
            Parts::Elements {
                element,
                dimensions,
            } => {
                if self.options.codesys && elements(dimensions) <= MAX_LINKED {
                    self.each_element(element, dimensions, part, stack);
                } else {
                    stack.push(Part {
                        of: Of::Type(element),
                        place: part.place.clone().step(Step::Index(0)),
                        path: format!("{}[]", part.path),
                        repeated: true,
                    });
                }
            }
            Parts::None => {}
        }
    }

    /// Every element of an array of something that has parts.
    fn each_element(
        &self,
        element: TypeId,
        dimensions: &[(i64, i64)],
        part: &Part,
        stack: &mut Vec<Part>,
    ) {
        if self.types.is_scalar(element) {
            return;
        }
        let mut parts = vec![(part.place.clone(), part.path.clone())];
        for (low, high) in dimensions {
            let each = |(place, path): &(Place, String)| {
                let (place, path) = (place.clone(), path.clone());
                let indexes = (0..).zip(*low..=*high);
                indexes.map(move |(index, number)| {
                    let place = place.clone().step(Step::Index(index));
                    (place, format!("{path}[{number}]"))
                })
            };
            parts = parts.iter().flat_map(each).collect();
        }
        stack.extend(parts.into_iter().map(|(place, path)| Part {
            of: Of::Type(element),
            place,
            path,
            repeated: part.repeated,
        }));
    }

    fn look(
        &self,
        part: &Part,
        (name, field, partly, ty): (Symbol, u32, Option<Area>, TypeId),
        stack: &mut Vec<Part>,
        found: &mut Vec<Linked>,
    ) {
        let path = format!("{}.{}", part.path, self.text(name));
        let place = part.place.clone().step(Step::Field(field));
        let repeated = part.repeated;
        match partly {
            Some(area) => found.push(Linked {
                path,
                place,
                ty,
                area,
                repeated,
            }),
            None => stack.push(Part {
                of: Of::Type(ty),
                place,
                path,
                repeated,
            }),
        }
    }
}
