//! Names as small numbers. Two names are the same symbol if they differ in the case of ASCII
//! letters only, which is when the languages here hold them to be the same. A symbol also remembers how
//! the name was spelled where it was read, which is how it is shown; no comparison sees that.
//!
//! Symbols are given in the order in which names are first seen, so they are the same in every
//! run over the same texts. A table only grows; a symbol never dangles in its own table.

use iecc_source::fold_hash;
use std::cmp::Ordering;
use std::hash::{Hash, Hasher};

/// A name: compared without regard to case, shown as it was spelled. Only the table that gave it out
/// knows its text.
#[derive(Debug, Clone, Copy)]
pub struct Symbol(u32);

/// The lower bits of a symbol tell which spelling of its name it is.
const SPELLING_BITS: u32 = 4;
/// How many spellings of one name are kept apart. Further ones are shown like the first.
const MOST_SPELLINGS: usize = 1 << SPELLING_BITS;

impl Symbol {
    fn new(index: usize, spelling: usize) -> Self {
        let packed = (index << SPELLING_BITS) + spelling;
        Self(u32::try_from(packed).expect("fewer than 2^28 names"))
    }

    /// Position in the order in which names were first seen, for tables beside the names.
    pub fn index(self) -> usize {
        (self.0 >> SPELLING_BITS) as usize
    }

    fn spelling(self) -> usize {
        self.0 as usize % MOST_SPELLINGS
    }
}

impl PartialEq for Symbol {
    fn eq(&self, other: &Self) -> bool {
        self.index() == other.index()
    }
}

impl Eq for Symbol {}

impl Hash for Symbol {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.index() as u32).hash(state);
    }
}

impl Ord for Symbol {
    fn cmp(&self, other: &Self) -> Ordering {
        self.index().cmp(&other.index())
    }
}

impl PartialOrd for Symbol {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The table of names of one run.
#[derive(Debug, Clone, Default)]
pub struct Names {
    /// All spellings, one behind the other.
    text: String,
    entries: Vec<Entry>,
    /// Spellings of names but the first of each.
    others: Vec<Spelling>,
    /// Open addressing with a power of two of places: an index into `entries` plus one, or 0.
    places: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    hash: u32,
    first: Spelling,
}

/// A part of the text, and the next spelling of the same name: an index into `others` plus one, or 0.
#[derive(Debug, Clone, Copy)]
struct Spelling {
    start: u32,
    end: u32,
    next: u32,
}

impl Names {
    /// No names yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// How many names there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The name as it was spelled where this symbol was read.
    pub fn text(&self, symbol: Symbol) -> &str {
        let mut spellings = self.spellings(symbol.index());
        let spelling = spellings.nth(symbol.spelling());
        self.part(spelling.expect("symbols know spellings that are there"))
    }

    /// The symbol of a name in its spelling, both of which are added when they are new.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if (self.entries.len() + 1) * 2 > self.places.len() {
            self.grow();
        }
        let hash = short_hash(name);
        let place = self.place(name, hash);
        let Some(index) = self.places[place].checked_sub(1) else {
            return self.add(name, hash, place);
        };
        let index = index as usize;
        match self.spelled(index, name) {
            Ok(spelling) => Symbol::new(index, spelling),
            Err(count) if count < MOST_SPELLINGS => {
                self.add_spelling(index, name);
                Symbol::new(index, count)
            }
            Err(_) => Symbol::new(index, 0),
        }
    }

    /// The symbol of a name that has been seen before, in its spelling if that has been.
    pub fn find(&self, name: &str) -> Option<Symbol> {
        if self.places.is_empty() {
            return None;
        }
        let index = self.places[self.place(name, short_hash(name))].checked_sub(1)? as usize;
        Some(Symbol::new(index, self.spelled(index, name).unwrap_or(0)))
    }

    /// The number of a spelling of a name, or how many others there are.
    fn spelled(&self, index: usize, name: &str) -> Result<usize, usize> {
        let mut count = 0;
        for spelling in self.spellings(index) {
            if self.part(spelling) == name {
                return Ok(count);
            }
            count += 1;
        }
        Err(count)
    }

    /// The spellings of a name, in the order in which they were first seen.
    fn spellings(&self, index: usize) -> impl Iterator<Item = Spelling> {
        let first = self.entries[index].first;
        std::iter::successors(Some(first), |spelling| {
            let next = spelling.next.checked_sub(1)?;
            Some(self.others[next as usize])
        })
    }

    fn part(&self, spelling: Spelling) -> &str {
        &self.text[spelling.start as usize..spelling.end as usize]
    }

    fn store(&mut self, name: &str) -> Spelling {
        let start = self.text.len() as u32;
        self.text.push_str(name);
        let end = u32::try_from(self.text.len()).expect("less than 4 GiB of names");
        Spelling {
            start,
            end,
            next: 0,
        }
    }

    fn add_spelling(&mut self, index: usize, name: &str) {
        let spelling = self.store(name);
        self.others.push(spelling);
        let added = self.others.len() as u32;
        let mut last = &mut self.entries[index].first.next;
        while let Some(next) = last.checked_sub(1) {
            last = &mut self.others[next as usize].next;
        }
        *last = added;
    }

    /// Where the name is, or where it would go.
    fn place(&self, name: &str, hash: u32) -> usize {
        let mask = self.places.len() - 1;
        let mut place = hash as usize & mask;
        while self.places[place] != 0 && !self.is_at(place, name, hash) {
            place = (place + 1) & mask;
        }
        place
    }

    fn is_at(&self, place: usize, name: &str, hash: u32) -> bool {
        let entry = self.entries[self.places[place] as usize - 1];
        entry.hash == hash && self.part(entry.first).eq_ignore_ascii_case(name)
    }

    fn add(&mut self, name: &str, hash: u32, place: usize) -> Symbol {
        let first = self.store(name);
        self.entries.push(Entry { hash, first });
        self.places[place] = self.entries.len() as u32;
        Symbol::new(self.entries.len() - 1, 0)
    }

    fn grow(&mut self) {
        let size = (self.places.len() * 2).max(1024);
        self.places.clear();
        self.places.resize(size, 0);
        for (index, entry) in self.entries.iter().enumerate() {
            let mut place = entry.hash as usize & (size - 1);
            while self.places[place] != 0 {
                place = (place + 1) & (size - 1);
            }
            self.places[place] = index as u32 + 1;
        }
    }
}

fn short_hash(name: &str) -> u32 {
    let hash = fold_hash(name);
    (hash ^ (hash >> 32)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_differ_in_case_only_are_one_symbol() {
        let mut names = Names::new();
        let motor = names.intern("Motor");
        assert_eq!(names.intern("MOTOR"), motor);
        assert_eq!(names.intern("MOTOR").cmp(&motor), Ordering::Equal);
        assert_eq!(names.len(), 1);
        assert_ne!(names.intern("Motor_"), motor);
        assert_eq!(names.find("motor"), Some(motor));
        assert_eq!(names.find("pump"), None);
        assert_eq!(Names::new().find("pump"), None);
    }

    #[test]
    fn a_symbol_is_shown_as_it_was_spelled() {
        let mut names = Names::new();
        let spellings = ["Motor", "MOTOR", "motor"];
        let symbols = spellings.map(|spelling| names.intern(spelling));
        assert_eq!(symbols.map(|symbol| names.text(symbol)), spellings);
        for spelling in spellings {
            assert_eq!(names.text(names.find(spelling).unwrap()), spelling);
        }
        assert_eq!(names.text(names.find("mOTOR").unwrap()), "Motor");
    }

    #[test]
    fn too_many_spellings_are_shown_like_the_first() {
        let mut names = Names::new();
        let spell = |i: usize| -> String {
            let bit = |at: usize| if i >> at & 1 == 1 { 'A' } else { 'a' };
            (0..5).map(bit).collect()
        };
        for i in 0..32 {
            let symbol = names.intern(&spell(i));
            assert_eq!(symbol.index(), 0);
            let shown = if i < MOST_SPELLINGS { i } else { 0 };
            assert_eq!(names.text(symbol), spell(shown));
        }
    }

    #[test]
    fn signs_that_hash_alike_are_different_names() {
        let mut names = Names::new();
        assert_ne!(names.intern("a_"), names.intern("a\x7f"));
        assert_ne!(names.intern("{"), names.intern("["));
    }

    #[test]
    fn symbols_stay_when_the_table_grows() {
        let mut names = Names::new();
        let symbols: Vec<_> = (0..5000).map(|i| names.intern(&format!("v{i}"))).collect();
        for (i, symbol) in symbols.into_iter().enumerate() {
            assert_eq!(symbol.index(), i);
            assert_eq!(names.find(&format!("V{i}")), Some(symbol));
        }
    }
}
