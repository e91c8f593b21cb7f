//! n mistakes give n messages, at the right places, and every unit still gives a tree.

use crate::check::{messages, messages_in_body, one, parse};
use iecc_ast::Names;
use iecc_ast::st::UnitKind;
use iecc_diag::Code;
use iecc_grammar::st::{Dialect, FragmentKind, lex, slice};
use std::fmt::Write as _;

/// A function block of some 500 lines. Blocks whose number is in `without_end` have no END_IF.
fn long_block(without_end: &[usize]) -> String {
    let mut text = "FUNCTION_BLOCK long\nVAR a, b : INT; END_VAR\n".to_owned();
    for number in 0..80 {
        let end = if without_end.contains(&number) {
            ""
        } else {
            "  END_IF;\n"
        };
        write!(
            text,
            "  IF a > {number} THEN\n    FOR b := 1 TO 3 DO\n      a := a - b;\n    END_FOR;\n  ELSE\n    b := 0;\n{end}"
        )
        .unwrap();
    }
    text + "END_FUNCTION_BLOCK\n"
}

#[test]
fn three_missing_end_ifs_in_500_lines_give_three_messages() {
    let text = long_block(&[3, 40, 77]);
    assert!(text.lines().count() > 500);
    let parsed = parse(&text, Dialect::Iec);
    let lines: Vec<_> = parsed
        .diagnostics
        .iter()
        .map(|diagnostic| {
            let place = diagnostic.primary.as_ref().unwrap().span;
            (
                diagnostic.code,
                text[..place.start as usize].lines().count(),
            )
        })
        .collect();
    // Block n begins on line 3 + 7n, less one line for each END_IF that is missing before.
    let line = |number: usize, missing: usize| 3 + 7 * number - missing;
    assert_eq!(
        lines,
        [
            (Code::E0011, line(3, 0)),
            (Code::E0011, line(40, 1)),
            (Code::E0011, line(77, 2))
        ]
    );
    assert!(matches!(parsed.file.units[0].kind, UnitKind::Pou(_)));
}

#[test]
fn indentation_tells_which_block_is_not_closed() {
    let inner =
        "IF a THEN\n  WHILE b DO\n    IF c THEN\n      x := 1;\n    y := 2;\n  END_WHILE;\nEND_IF;";
    one(inner, Code::E0011, "IF");
    let text =
        "PROGRAM p\nIF a THEN\n  IF b THEN\n    x := 1;\nELSE\n  x := 2;\nEND_IF;\nEND_PROGRAM\n";
    let parsed = parse(text, Dialect::Iec);
    let place = parsed
        .diagnostics
        .iter()
        .next()
        .unwrap()
        .primary
        .as_ref()
        .unwrap()
        .span;
    assert_eq!(parsed.diagnostics.len(), 1);
    assert_eq!(place.start as usize, text.find("IF b").unwrap());
}

#[test]
fn a_closer_of_an_outer_block_closes_the_inner_ones() {
    one(
        "WHILE a DO\nIF b THEN\nx := 1;\nEND_WHILE;",
        Code::E0011,
        "IF",
    );
    one(
        "CASE a OF\n1: IF b THEN x := 1;\n2: x := 2;\nEND_CASE;",
        Code::E0011,
        "IF",
    );
    one(
        "IF a THEN\nREPEAT x := 1;\nELSE\nx := 2;\nEND_IF;",
        Code::E0011,
        "REPEAT",
    );
    one(
        "IF a THEN x := 1;\nELSE IF b THEN x := 2;\nEND_IF;",
        Code::E0011,
        "IF",
    );
}

#[test]
fn closers_and_dividers_without_block_are_left_out() {
    one("x := 1;\nEND_IF;\ny := 2;", Code::E0012, "END_IF");
    one("ELSE\ny := 2;", Code::E0012, "ELSE");
    one(
        "a > b THEN\n x := 1;\nELSE\n x := 2;\nEND_IF;",
        Code::E0012,
        "THEN",
    );
    one("a < b DO\n x := 1;\nEND_WHILE;", Code::E0012, "DO");
    one("i := 1 TO 3 DO\n x := 1;\nEND_FOR;", Code::E0012, "DO");
    one("s OF\n 1: x := 1;\nEND_CASE;", Code::E0012, "OF");
    one("x := 1;\nUNTIL x = 1 END_REPEAT;", Code::E0012, "UNTIL");
}

#[test]
fn semicolons_may_be_missing_anywhere() {
    one("x := 1\ny := 2;", Code::E0024, "");
    one("IF a THEN\nx := 1\nEND_IF;", Code::E0024, "");
    one("IF a THEN\nx := 1;\nEND_IF\ny := 1;", Code::E0024, "");
    one("f(a)\ng(b);", Code::E0024, "");
    one("RETURN\nx := 1;", Code::E0024, "");
    one("x := 1;\ny := 2", Code::E0024, "");
    one("VAR a : INT\n b : INT; END_VAR", Code::E0024, "");
    one(
        "VAR a : INT; b : ARRAY [1..2] OF INT END_VAR",
        Code::E0024,
        "",
    );
    assert_eq!(
        messages("TYPE a : INT\n b : (x, y); c : STRUCT d : INT\n END_STRUCT END_TYPE").len(),
        2
    );
}

#[test]
fn then_do_of_and_until_may_be_missing() {
    one("IF a\nx := 1;\nEND_IF;", Code::E0031, "");
    one("IF a\nRETURN;\nEND_IF;", Code::E0031, "");
    one("IF a DO x := 1; END_IF;", Code::E0031, "DO");
    one("IF a; THEN x := 1; END_IF;", Code::E0031, ";");
    one("WHILE a < 1\nx := 1;\nEND_WHILE;", Code::E0031, "");
    one("FOR i := 1 TO 3\nx := i;\nEND_FOR;", Code::E0031, "");
    one("CASE a\n1: x := i;\nEND_CASE;", Code::E0031, "");
    one(
        "REPEAT\nx := i;\nx = 1\nEND_REPEAT;",
        Code::E0031,
        "END_REPEAT",
    );
}

#[test]
fn brackets_are_mended_within_their_statement() {
    one("x := (a + b;\ny := 1;", Code::E0025, "(");
    one("x := a + b);\ny := 1;", Code::E0025, ")");
    one("x := a[1;\ny := 1;", Code::E0025, "[");
    one("f(a, b\ny := 1;", Code::E0025, "(");
    one("f(g(a, b);\ny := 1;", Code::E0025, "(");
    one("IF (a AND b THEN x := 1; END_IF;", Code::E0025, "(");
    one("VAR a : ARRAY [1..2 OF INT; END_VAR", Code::E0025, "[");
    one("x := (a + [1);", Code::E0025, "[");
}

#[test]
fn damage_inside_a_statement_stays_there() {
    one("x := a b;\ny := 1;", Code::E0010, "b");
    one("x := ;\ny := 1;", Code::E0010, ";");
    one("x := a + * b;\ny := 1;", Code::E0010, "*");
    one("IF THEN x := 1; END_IF;", Code::E0010, "THEN");
    one("IF a b THEN x := 1; END_IF;", Code::E0010, "b");
    one("FOR i = 1 TO 3 DO x := 1; END_FOR;", Code::E0010, "=");
    one("CASE a OF 1 2: x := 1; END_CASE;", Code::E0010, "2");
    one("CASE a OF x := 1; END_CASE;", Code::E0010, "x := 1;");
    one("VAR a ; b : INT; END_VAR b := 1;", Code::E0010, ";");
    one("f(a := 1, , b);", Code::E0010, ",");
    one("x := 5 5;", Code::E0010, "5");
}

#[test]
fn common_slips_get_a_message_of_their_own() {
    one("a = 3;", Code::E0028, "=");
    one("a + b;", Code::E0028, "a + b");
    one("a + b := 3;", Code::E0029, "a + b");
    one("x := a ! b;", Code::E0014, "!");
    one("x := 'abc;\ny := 1;", Code::E0015, "'abc");
    one("x := f('abc);\ny := 1;", Code::E0015, "'abc");
    one("(* (* *)\nx := 1;", Code::E0016, "(*");
    one("{p\nx := 1;", Code::E0016, "{");
    one(
        "VAR step : INT; END_VAR step := step + 1;",
        Code::E0018,
        "step",
    );
    one("x := 1; VAR a : INT; END_VAR", Code::E0027, "VAR");
    one("a, b : INT;\nx := 1;", Code::E0033, "a");
    one("VAR a : INT;\nx := 1;", Code::E0011, "VAR");
}

#[test]
fn headers_end_with_their_line() {
    for (text, code, place) in [
        (
            "FUNCTION_BLOCK END_FUNCTION_BLOCK",
            Code::E0032,
            "FUNCTION_BLOCK",
        ),
        (
            "FUNCTION_BLOCK a b IMPLEMENTS c\nVAR x : INT; END_VAR END_FUNCTION_BLOCK",
            Code::E0010,
            "b",
        ),
        (
            "FUNCTION f :\nVAR x : INT; END_VAR x := 1; END_FUNCTION",
            Code::E0010,
            "VAR",
        ),
        (
            "FUNCTION f INT\nVAR x : INT; END_VAR x := 1; END_FUNCTION",
            Code::E0010,
            "INT",
        ),
        (
            "FUNCTION_BLOCK f EXTENDS\nVAR x : INT; END_VAR END_FUNCTION_BLOCK",
            Code::E0010,
            "VAR",
        ),
        (
            "FUNCTION_BLOCK f METHOD VAR x : INT; END_VAR END_METHOD END_FUNCTION_BLOCK",
            Code::E0032,
            "METHOD",
        ),
        (
            "FUNCTION_BLOCK f PROPERTY p GET p := 1; END_GET END_PROPERTY END_FUNCTION_BLOCK",
            Code::E0010,
            "GET",
        ),
        (
            "FUNCTION_BLOCK f x := 1; END_FUNCTION",
            Code::E0012,
            "END_FUNCTION",
        ),
        (
            "CONFIGURATION c RESOURCE r TASK t(PRIORITY := 1); END_RESOURCE END_CONFIGURATION",
            Code::E0010,
            "TASK",
        ),
    ] {
        assert_eq!(messages(text), [(code, place.to_owned())], "{text}");
        let parsed = parse(text, Dialect::Iec);
        assert!(
            parsed
                .file
                .units
                .iter()
                .all(|unit| unit.kind != UnitKind::Error),
            "{text}"
        );
    }
}

#[test]
fn a_mistake_in_one_unit_does_not_reach_the_next() {
    let text =
        "FUNCTION f\nIF a THEN\nFUNCTION g\nx := ;\nEND_FUNCTION\ny := 1;\nPROGRAM p\nEND_PROGRAM";
    let codes: Vec<Code> = messages(text).into_iter().map(|(code, _)| code).collect();
    assert_eq!(codes, [Code::E0011, Code::E0011, Code::E0010, Code::E0030]);
    let parsed = parse(text, Dialect::Iec);
    let kinds: Vec<_> = parsed
        .file
        .units
        .iter()
        .map(|unit| unit.has_errors)
        .collect();
    assert_eq!(kinds, [true, true, true, false]);
}

#[test]
fn namespaces_that_do_not_balance_are_told() {
    assert_eq!(
        messages("NAMESPACE n FUNCTION f END_FUNCTION"),
        [(Code::E0011, "NAMESPACE".to_owned())]
    );
    assert_eq!(
        messages("FUNCTION f END_FUNCTION END_NAMESPACE"),
        [(Code::E0012, "END_NAMESPACE".to_owned())]
    );
    assert_eq!(
        messages("NAMESPACE a. FUNCTION f END_FUNCTION END_NAMESPACE").len(),
        1
    );
    let deep = "NAMESPACE n ".repeat(100) + &"END_NAMESPACE ".repeat(100);
    assert_eq!(messages(&deep), [(Code::E0013, "NAMESPACE".to_owned())]);
}

#[test]
fn nesting_is_bounded_with_one_message() {
    let parens = format!("x := {}1{};", "(".repeat(128), ")".repeat(128));
    assert_eq!(messages_in_body(&parens), []);
    for body in [
        format!("x := {}1{};", "(".repeat(100_000), ")".repeat(100_000)),
        format!("x := {}1;", "-".repeat(100_000)),
        format!("x := 1{};", " + 1".repeat(100_000)),
        format!("x := {}1{};", "f(".repeat(100_000), ")".repeat(100_000)),
        format!("x := a{};", "[a".repeat(10_000) + &"]".repeat(10_000)),
        format!("x := a{};", ".b".repeat(100_000)),
        format!(
            "{}{}",
            "IF a THEN ".repeat(10_000),
            "END_IF; ".repeat(10_000)
        ),
        format!("VAR x : {} INT; END_VAR", "ARRAY [1..2] OF ".repeat(10_000)),
        format!("VAR x : {} INT; END_VAR", "REF_TO ".repeat(10_000)),
    ] {
        let codes: Vec<Code> = messages_in_body(&body)
            .into_iter()
            .map(|(code, _)| code)
            .collect();
        assert_eq!(codes, [Code::E0013], "{}", &body[..40]);
    }
}

#[test]
fn fixes_mend_what_they_say() {
    for body in [
        "x := 1\ny := 2;",
        "x := (a + b;",
        "x := a + b);",
        "IF a x := 1; END_IF;",
        "IF a\nx := 1;\nEND_IF;",
        "IF a THEN\nx := 1;",
        "WHILE a THEN x := 1; END_WHILE;",
        "IF a; THEN x := 1; END_IF;",
        "a = 3;",
        "x := 1E5;",
        "x := 'a$b';",
        "x := 'abc;",
        "{p",
        "END_IF;",
    ] {
        let text = format!("PROGRAM p\n{body}\nEND_PROGRAM\n");
        let parsed = parse(&text, Dialect::Iec);
        let first = parsed.diagnostics.iter().next().expect("a message");
        if let Some(fix) = &first.fix {
            let mut mended = text.clone();
            mended.replace_range(fix.span.range(), &fix.replacement);
            assert_eq!(messages(&mended), [], "{mended}");
        }
    }
}

/// Each token of the sample is taken out in turn. Most of these mistakes, nine in ten and more,
/// give one message; hardly any gives more than three.
#[test]
fn one_token_less_rarely_gives_more_than_one_message() {
    let sample = include_str!("../../../tests/st/sample.st");
    let tokens = lex(
        crate::check::file_id(),
        sample,
        Dialect::Iec,
        &mut Names::new(),
    );
    assert!(
        slice(&tokens)
            .iter()
            .all(|fragment| fragment.kind != FragmentKind::Stray)
    );
    let mut counts = [0usize; 4];
    for token in tokens.list.iter().filter(|token| !token.kind.is_trivia()) {
        let mut text = sample.to_owned();
        text.replace_range(token.start as usize..token.end as usize, " ");
        let count = parse(&text, Dialect::Iec).diagnostics.len();
        counts[count.min(3)] += 1;
    }
    let wrong: usize = counts[1..].iter().sum();
    assert!(counts[1] * 100 >= wrong * 95, "{counts:?}");
    assert!(counts[3] * 100 <= wrong * 3, "{counts:?}");
}

/// Whoever comes from another language is told what is written here, once for each slip.
#[test]
fn signs_and_words_of_other_languages_are_known() {
    for (body, code, place, instead) in [
        ("IF a == b THEN x := 1; END_IF;", Code::E0010, "==", "="),
        ("IF a != b THEN x := 1; END_IF;", Code::E0014, "!=", "<>"),
        ("x := a && b;", Code::E0010, "&&", "AND"),
        ("x := a || b;", Code::E0014, "||", "OR"),
        ("x := !a;", Code::E0014, "!", "NOT "),
        ("x := a % b;", Code::E0010, "%", " MOD "),
        ("x := a %2;", Code::E0010, "%", " MOD "),
        ("x := 0xFF;", Code::E0019, "0xFF", "16#FF"),
        ("x := 0b101;", Code::E0019, "0b101", "2#101"),
        ("t(PT := 500ms);", Code::E0019, "500ms", "T#500ms"),
        ("x := a ANDN b;", Code::E0010, "ANDN", "AND NOT"),
        ("x := 3,14;", Code::E0010, ",", "."),
        ("x := .5;", Code::E0010, ".", "0"),
        ("IF x := 1 THEN y := 2; END_IF;", Code::E0010, ":=", "="),
        (
            "IF a THEN x := 1;\nELSEIF b THEN x := 2; END_IF;",
            Code::E0037,
            "ELSEIF",
            "ELSIF",
        ),
        ("IF a THEN x := 1; ENDIF;", Code::E0037, "ENDIF", "END_IF"),
        ("IF a THEN x := 1; END IF;", Code::E0037, "END IF", "END_IF"),
        (
            "WHILE a DO x := 1; EndWhile;",
            Code::E0037,
            "EndWhile",
            "END_WHILE",
        ),
        (
            "VAR a : INT;\nENDVAR\na := 1;",
            Code::E0037,
            "ENDVAR",
            "END_VAR",
        ),
        (
            "IF a THEN\n  x := 1;\nEND_FOR;",
            Code::E0012,
            "END_FOR",
            "END_IF",
        ),
        ("# a remark that's long\nx := 1;", Code::E0014, "#", "//"),
    ] {
        one(body, code, place);
        assert_eq!(fix(body).as_deref(), Some(instead), "{body}");
    }
    for (body, place) in [
        ("x++;", "++"),
        ("a.b--;", "--"),
        ("x += 2;", "+="),
        ("x /= 2;", "/="),
    ] {
        one(body, Code::E0010, place);
    }
    one("x := a ? 1 : 2;", Code::E0014, "?");
    one("RETURN a + 1;", Code::E0010, "a");
}

#[test]
fn characters_of_word_processors_are_known() {
    for (body, place, instead) in [
        ("x := “two words”;", "“two words”", "'two words'"),
        ("x := ‘a’ + b;", "‘a’", "'a'"),
        ("x := a – b;", "–", "-"),
        ("x := a − 1;", "−", "-"),
        ("x := a ≤ b;", "≤", "<="),
        ("x := a ≠ b;", "≠", "<>"),
        ("x := 2 × b;", "×", "*"),
        ("x :=\u{a0}1;\u{a0}y :=\u{a0}2;", "\u{a0}", " "),
        ("x := 1;\u{200b}", "\u{200b}", " "),
    ] {
        one(body, Code::E0014, place);
        assert_eq!(fix(body).as_deref(), Some(instead), "{body}");
    }
}

/// What looks like a slip elsewhere and is right here stays as it is.
#[test]
fn signs_that_only_look_foreign_mean_what_they_mean() {
    for body in [
        "x := a--b;",
        "x := a - -b;",
        "x := a&b & c;",
        "x := %IX0.1;",
        "endif(a := 1);",
        "elseif := 1;",
        "end := a;",
        "IF elseif THEN x := 1; END_IF;",
    ] {
        assert!(messages_in_body(body).is_empty(), "{body}");
    }
}

/// What the first message would write instead.
fn fix(body: &str) -> Option<String> {
    let parsed = parse(&format!("PROGRAM p\n{body}\nEND_PROGRAM\n"), Dialect::Iec);
    let first = parsed.diagnostics.iter().next()?;
    first.fix.as_ref().map(|fix| fix.replacement.clone())
}

/// A reserved word that is declared as a name is told once, wherever else it stands.
#[test]
fn reserved_words_declared_as_names_are_told_once() {
    let text = "PROGRAM p\nVAR by : INT; x : INT; END_VAR\nx := f(by) + by;\nFOR x := by TO 9 BY 2 DO\n  by := x;\nEND_FOR;\nEND_PROGRAM";
    assert_eq!(messages(text), [(Code::E0018, "by".to_owned())]);
}

/// A declaration that cannot be read is told once, and leaves its section open.
#[test]
fn declarations_with_a_slip_stay_declarations() {
    for (line, place) in [
        ("x INT;", "INT"),
        ("INT x;", "x"),
        ("y := INT;", ":="),
        ("z : INT = 5;", "="),
    ] {
        let text = format!(
            "PROGRAM p\nVAR\n  a : INT;\n  {line}\n  b : INT;\nEND_VAR\na := b;\nEND_PROGRAM"
        );
        assert_eq!(messages(&text), [(Code::E0010, place.to_owned())], "{line}");
    }
}

/// What recovery costs must not depend on what stands around the mistake.
#[test]
fn many_mistakes_take_linear_time() {
    let wrong = "x y;\n".repeat(20_000);
    assert_eq!(messages_in_body(&wrong).len(), 1000);
    for body in [
        format!("{}{wrong}", "IF a THEN ".repeat(100)),
        format!("{} x := 1;", "a ".repeat(200_000)),
        "IF a THEN ".repeat(100_000),
        "END_IF; ".repeat(100_000),
        "x := (1;\n".repeat(50_000),
        "CASE a OF b: ".repeat(50_000),
        "(* (* *) 'a ".repeat(50_000),
        "? ".repeat(100_000),
        format!("VAR {} END_VAR", "x := 1; ".repeat(50_000)),
        "ELSEIF a ".repeat(50_000),
        "x := “a” ".repeat(50_000),
        "x := “a ".repeat(50_000),
        "x++; ".repeat(50_000),
        "RETURN 1 ".repeat(50_000),
        "# ".repeat(50_000),
        "\u{a0}≤ ".repeat(50_000),
        "END IF; ".repeat(50_000),
        "IF a THEN ELSE ".repeat(50_000),
    ] {
        assert!(!messages_in_body(&body).is_empty(), "{}", &body[..20]);
    }
}
