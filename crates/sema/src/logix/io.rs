//! I/O points: which words and bits of modules the program uses, and their public names.
//!
//! A word that is only used by bits gives one point per bit, any other use one point of the whole
//! word. A point is named by an alias tag, else by the comment on it in the module's tag, else by
//! its address. A name made from a comment never hides a tag, and two points never share a name.

use super::Analysis;
use super::tasks::Schedule;
use super::types::fold;
use crate::hir::{Access, Body, IoPoint, Place, Pou, Program, Step, TagId, Task};
use iecc_ast::logix::ModuleTagDirection;
use std::collections::{BTreeMap, BTreeSet};

/// How a word is used.
#[derive(Debug, Default)]
struct Uses {
    whole: bool,
    bits: BTreeSet<u32>,
}

/// The longest name that is made from a comment; the vendor's tags have at most 40 letters.
const MAX_NAME: usize = 40;

impl Analysis<'_> {
    /// The typed program, when every routine is checked.
    pub(crate) fn finish(
        &mut self,
        schedule: &Schedule,
        pous: Vec<Pou>,
        library: Program,
    ) -> Program {
        self.resolve_idle_aliases();
        let points = self.points(&pous);
        let names = self.point_names(&points);
        let (mut inputs, mut outputs) = (Vec::new(), Vec::new());
        for (place, name) in points.into_iter().zip(names) {
            let module = self.module_of(place.tag).expect("points are of modules");
            let point = IoPoint { name, place };
            match module.direction {
                ModuleTagDirection::Input => inputs.push(point),
                ModuleTagDirection::Output => outputs.push(point),
                ModuleTagDirection::Configuration => unreachable!("no points"),
            }
        }
        let mut names = self.other_names();
        self.add_point_names(&mut names, inputs.iter().chain(&outputs));
        let calls = schedule.mains.iter();
        let calls = calls.filter_map(|main| schedule.units.get(main).copied());
        Program {
            name: self.project.controller.name.node.clone(),
            tasks: vec![Task {
                name: schedule.task.clone(),
                trigger: crate::hir::Trigger::EveryScan,
                priority: 0,
                calls: calls.collect(),
            }],
            inits: crate::hir::Inits::default(),
            types: std::mem::take(&mut self.types.table),
            tags: std::mem::take(&mut self.tags),
            first_scan: self.symbols.first_scan.map(Place::whole),
            inputs,
            outputs,
            names,
            pous,
            stdlib: Some(Box::new(library)),
        }
    }

    /// Aliases that no rung uses still name places to watch; their mistakes harm nobody.
    fn resolve_idle_aliases(&mut self) {
        self.silently(|analysis| {
            for alias in 0..analysis.symbols.aliases.len() {
                analysis.alias_place(alias);
            }
        });
    }

    /// The points that routines use, by module tag and address.
    fn points(&self, pous: &[Pou]) -> Vec<Place> {
        let mut uses: BTreeMap<Place, Uses> = BTreeMap::new();
        let modules = self.module_tags();
        let mut note = |place: &Place, _: Access| {
            if modules.contains(&place.tag) {
                let (word, bit) = place.split_bit();
                let uses = uses.entry(word).or_default();
                match bit {
                    Some(bit) => _ = uses.bits.insert(bit),
                    None => uses.whole = true,
                }
            }
        };
        for pou in pous {
            match &pou.body {
                Body::Ladder(rungs) => rungs.iter().for_each(|rung| {
                    rung.for_each_instruction(&mut |i| i.op.for_each_place(&mut note));
                }),
                Body::Text(_) => unreachable!("routines in text are refused"),
            }
        }
        uses.into_iter()
            .flat_map(|(word, uses)| split(&word, &uses))
            .collect()
    }

    /// Storage of input and output tags of modules.
    fn module_tags(&self) -> BTreeSet<TagId> {
        let symbols = self.symbols.modules.values();
        symbols
            .filter(|symbol| symbol.tag.direction != ModuleTagDirection::Configuration)
            .filter_map(|symbol| symbol.storage.as_ref()?.as_ref().ok().copied())
            .collect()
    }

    fn point_names(&self, points: &[Place]) -> Vec<String> {
        let aliases = self.alias_names();
        let mut taken: BTreeSet<String> = BTreeSet::new();
        let mut names: Vec<Option<String>> = Vec::with_capacity(points.len());
        for place in points {
            let alias = aliases.get(place).filter(|name| taken.insert(fold(name)));
            names.push(alias.cloned());
        }
        let comments = self.comment_names(points);
        for (name, comment) in names.iter_mut().zip(comments) {
            if name.is_none() {
                *name = comment.filter(|comment| taken.insert(fold(comment)));
            }
        }
        let addresses = points.iter().map(|place| self.display(place));
        names
            .into_iter()
            .zip(addresses)
            .map(|(name, address)| name.unwrap_or(address))
            .collect()
    }

    /// The alias of each place: the first of the controller, else the first of a program whose
    /// name no other tag has.
    fn alias_names(&self) -> BTreeMap<Place, String> {
        let tags: BTreeSet<String> = self.tags.iter().map(|tag| fold(&tag.name)).collect();
        let mut names = BTreeMap::new();
        for of_controller in [true, false] {
            for (index, alias) in self.symbols.aliases.iter().enumerate() {
                let name = &alias.tag.name.node;
                if alias.program.is_none() == of_controller
                    && !tags.contains(&fold(name))
                    && let Some(place) = self.resolved_alias(index)
                {
                    names.entry(place).or_insert_with(|| name.clone());
                }
            }
        }
        names
    }

    /// Names from comments; none where two points have the same or a tag is called so.
    fn comment_names(&self, points: &[Place]) -> Vec<Option<String>> {
        let names: Vec<Option<String>> = points.iter().map(|place| self.comment(place)).collect();
        let mut count: BTreeMap<String, u32> = BTreeMap::new();
        for name in names.iter().flatten() {
            *count.entry(fold(name)).or_default() += 1;
        }
        names
            .into_iter()
            .map(|name| {
                name.filter(|name| count[&fold(name)] == 1 && !self.symbols.is_declared(name))
            })
            .collect()
    }

    fn comment(&self, place: &Place) -> Option<String> {
        let module = self.module_of(place.tag)?;
        let address = self.display(place);
        let operand = &address[module.name.node.len()..];
        let comment = module
            .comments
            .iter()
            .find(|comment| comment.operand.node.eq_ignore_ascii_case(operand))?;
        name_from_comment(comment.text.text())
    }

    fn add_point_names<'i>(
        &self,
        names: &mut Vec<(String, Place)>,
        points: impl Iterator<Item = &'i IoPoint>,
    ) {
        let mut known: BTreeSet<String> = names.iter().map(|(name, _)| fold(name)).collect();
        for point in points {
            if known.insert(fold(&point.name)) {
                names.push((point.name.clone(), point.place.clone()));
            }
        }
        names.sort_by_key(|(name, _)| fold(name));
    }
}

fn split(word: &Place, uses: &Uses) -> Vec<Place> {
    if uses.whole {
        return vec![word.clone()];
    }
    let bits = uses.bits.iter();
    bits.map(|&bit| word.clone().step(Step::Bit(bit))).collect()
}

/// A legal name out of free text: words joined by `_`.
fn name_from_comment(text: &str) -> Option<String> {
    let words: Vec<&str> = text
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
        .collect();
    let name = words.join("_");
    let legal = name.len() <= MAX_NAME
        && text.is_ascii()
        && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    legal.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::name_from_comment;

    #[test]
    fn comments_become_names_where_they_can() {
        let name = |text| name_from_comment(text);
        assert_eq!(name("Start"), Some("Start".to_owned()));
        assert_eq!(
            name("Motor 1\r\nrunning!"),
            Some("Motor_1_running".to_owned())
        );
        assert_eq!(name("24V ok"), None, "names do not start with a digit");
        assert_eq!(name("Überdruck"), None);
        assert_eq!(name(" - "), None);
        assert_eq!(name(&"x".repeat(41)), None);
    }
}
