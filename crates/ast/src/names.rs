//! Names as small numbers. Two names are the same symbol if they differ in the case of ASCII
//! letters only, which is when the languages here hold them to be the same.
//!
//! Symbols are given in the order in which names are first seen, so they are the same in every
//! run over the same texts. A table only grows; a symbol never dangles in its own table.

use iecc_source::fold_hash;

/// A name without regard to case. Only the table that gave it out knows its text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(u32);

impl Symbol {
    /// Position in the order in which names were first seen, for tables beside the names.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The table of names of one run.
#[derive(Debug, Clone, Default)]
pub struct Names {
    /// All spellings, one behind the other.
    text: String,
    entries: Vec<Entry>,
    /// Open addressing with a power of two of places: an index into `entries` plus one, or 0.
    places: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    start: u32,
    end: u32,
    hash: u32,
    /// Whether it is in the table only because it means something in the language.
    reserved: bool,
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

    /// The name as it was spelled when first seen in a text.
    pub fn text(&self, symbol: Symbol) -> &str {
        self.spelling(self.entries[symbol.index()])
    }

    /// The symbol of a name, which is added when it is new.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if (self.entries.len() + 1) * 2 > self.places.len() {
            self.grow();
        }
        let hash = short_hash(name);
        let place = self.place(name, hash);
        match self.places[place] {
            0 => self.add(name, hash, place),
            index => {
                let symbol = Symbol(index - 1);
                if self.entries[symbol.index()].reserved {
                    self.respell(symbol, name);
                }
                symbol
            }
        }
    }

    /// The symbol of a word of the language. It does not count as seen: whoever uses it as a name
    /// gives it its spelling.
    pub fn reserve(&mut self, word: &str) -> Symbol {
        if let Some(known) = self.find(word) {
            return known;
        }
        let symbol = self.intern(word);
        self.entries[symbol.index()].reserved = true;
        symbol
    }

    /// Makes all names so far words that do not count as seen.
    pub fn reserve_all(&mut self) {
        for entry in &mut self.entries {
            entry.reserved = true;
        }
    }

    fn respell(&mut self, symbol: Symbol, name: &str) {
        let (start, end) = self.store(name);
        let entry = &mut self.entries[symbol.index()];
        (entry.start, entry.end) = (start, end);
        entry.reserved = false;
    }

    fn store(&mut self, name: &str) -> (u32, u32) {
        let start = self.text.len() as u32;
        self.text.push_str(name);
        let end = u32::try_from(self.text.len()).expect("less than 4 GiB of names");
        (start, end)
    }

    /// The symbol of a name that has been seen before.
    pub fn find(&self, name: &str) -> Option<Symbol> {
        if self.places.is_empty() {
            return None;
        }
        let index = self.places[self.place(name, short_hash(name))];
        index.checked_sub(1).map(Symbol)
    }

    fn spelling(&self, entry: Entry) -> &str {
        &self.text[entry.start as usize..entry.end as usize]
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
        entry.hash == hash && self.spelling(entry).eq_ignore_ascii_case(name)
    }

    fn add(&mut self, name: &str, hash: u32, place: usize) -> Symbol {
        let (start, end) = self.store(name);
        self.entries.push(Entry {
            start,
            end,
            hash,
            reserved: false,
        });
        self.places[place] = self.entries.len() as u32;
        Symbol(self.entries.len() as u32 - 1)
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
    fn names_that_differ_in_case_only_are_one_symbol_with_the_first_spelling() {
        let mut names = Names::new();
        let motor = names.intern("Motor");
        assert_eq!(names.intern("MOTOR"), motor);
        assert_eq!(names.text(motor), "Motor");
        assert_ne!(names.intern("Motor_"), motor);
        assert_eq!(names.find("motor"), Some(motor));
        assert_eq!(names.find("pump"), None);
        assert_eq!(Names::new().find("pump"), None);
    }

    #[test]
    fn reserved_words_take_the_spelling_of_the_text() {
        let mut names = Names::new();
        let step = names.reserve("STEP");
        assert_eq!(names.reserve("STEP"), step);
        assert_eq!(names.text(step), "STEP");
        assert_eq!(names.intern("Step"), step);
        assert_eq!(names.reserve("STEP"), step);
        assert_eq!(names.text(step), "Step");
        names.intern("step");
        assert_eq!(names.text(step), "Step");
    }

    #[test]
    fn all_names_can_become_words() {
        let mut names = Names::new();
        let step = names.intern("STEP");
        names.reserve_all();
        assert_eq!(names.intern("Step"), step);
        names.intern("step");
        assert_eq!(names.text(step), "Step");
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
