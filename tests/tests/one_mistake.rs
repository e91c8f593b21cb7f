//! One mistake gives one message: words and signs of a whole program are left out or misspelled, one
//! at a time, through the whole front end.

use iecc_ast::Names;
use iecc_diag::Diagnostics;
use iecc_driver::{FrontOptions, ParsedLibrary, parallel_map};
use iecc_grammar::st::{Dialect, Token, lex};
use iecc_source::FileId;

const PLANT: &str = include_str!("../st/plant.st");

/// The words and signs of the program.
fn tokens() -> Vec<Token> {
    let file = FileId::from_index(0);
    let tokens = lex(file, PLANT, Dialect::Iec, &mut Names::new());
    let list = tokens.list.into_iter();
    list.filter(|token| !token.kind.is_trivia()).collect()
}

fn errors(library: &ParsedLibrary, text: &str) -> usize {
    let mut diagnostics = Diagnostics::new();
    let module = library.compile(text, &FrontOptions::default(), &mut diagnostics);
    let count = diagnostics.iter().count();
    assert!(
        module.is_some() || count > 0,
        "refused without a message:\n{text}"
    );
    if module.is_some() { 0 } else { count }
}

/// How many of the changed programs give no, one, two and more messages.
fn counts(change: impl Fn(Token) -> Option<String> + Sync) -> [usize; 4] {
    let library = ParsedLibrary::parse();
    assert_eq!(errors(&library, PLANT), 0, "the program is right");
    let changed: Vec<String> = tokens().into_iter().filter_map(change).collect();
    let found = parallel_map(&changed, |text| errors(&library, text));
    let mut counts = [0; 4];
    for count in found {
        counts[count.min(3)] += 1;
    }
    counts
}

fn without(token: Token) -> String {
    let mut text = PLANT.to_owned();
    text.replace_range(token.start as usize..token.end as usize, " ");
    text
}

/// A word with a letter more. Most names are used in two units, one of which is right where the
/// other is not: those give one message in each.
fn misspelled(token: Token) -> Option<String> {
    let range = token.start as usize..token.end as usize;
    let word = PLANT[range.clone()].starts_with(|first: char| first.is_ascii_alphabetic());
    let mut text = PLANT.to_owned();
    text.insert(range.end, 'x');
    word.then_some(text)
}

#[test]
fn a_word_or_sign_left_out_is_one_message() {
    let [_, one, two, more] = counts(|token| Some(without(token)));
    let wrong = one + two + more;
    assert!(wrong > 900, "{wrong} of the changes are mistakes");
    assert!(one * 100 >= wrong * 97, "{one} of {wrong} give one message");
    assert!(more * 100 <= wrong, "{more} of {wrong} give three or more");
}

#[test]
fn a_misspelled_word_is_one_message() {
    let [_, one, two, more] = counts(misspelled);
    let wrong = one + two + more;
    assert!(wrong > 400, "{wrong} of the changes are mistakes");
    assert!(one * 100 >= wrong * 95, "{one} of {wrong} give one message");
    assert_eq!(more, 0);
}
