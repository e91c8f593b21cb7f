//! Trees by hand-written canonical text with full brackets, messages by text and place.

use super::*;
use iecc_ast::rung::{Element, Expr, ExprKind, Member, Operand, OperandKind};
use iecc_source::FileId;

/// Parses a text that stands at offset 1000 of its file.
fn parse(text: &str) -> Result<Rung, Vec<Diagnostic>> {
    let mut diagnostics = Diagnostics::new();
    let mapped = MappedText::verbatim(FileId::from_index(0), 1000, text);
    let rung = parse_rung(&mapped, &mut diagnostics);
    assert_eq!(rung.is_none(), diagnostics.has_errors());
    rung.ok_or_else(|| diagnostics.iter().cloned().collect())
}

fn rung(text: &str) -> Rung {
    parse(text).unwrap_or_else(|errors| panic!("{text}: {errors:#?}"))
}

/// The only message for a text, with the text under its place.
fn message(text: &str) -> (Code, String, String) {
    let errors = parse(text).expect_err(text);
    let [error] = &errors[..] else {
        panic!("{errors:#?}")
    };
    let place = error.primary.as_ref().unwrap().span.range();
    let under = &text[place.start - 1000..place.end - 1000];
    (error.code, error.message.clone(), under.to_owned())
}

fn operand(text: &str) -> Operand {
    let rung = rung(&format!("CPT(x,{text});"));
    rung.instructions()[0].operands[1].clone()
}

fn expr(text: &str) -> Expr {
    match operand(text).kind {
        OperandKind::Expr(expr) => expr,
        other @ (OperandKind::Empty | OperandKind::InTag | OperandKind::Words(_)) => {
            panic!("{text}: {other:?}")
        }
    }
}

/// An expression with brackets around every operation.
fn bracketed(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Unary { op, operand } => {
            format!("{{{} {}}}", op.node.symbol(), bracketed(operand))
        }
        ExprKind::Binary { op, left, right } => {
            format!(
                "{{{} {} {}}}",
                bracketed(left),
                op.node.symbol(),
                bracketed(right)
            )
        }
        ExprKind::Int(_)
        | ExprKind::Real(_)
        | ExprKind::String(_)
        | ExprKind::Reference(_)
        | ExprKind::Call { .. } => expr.to_string(),
    }
}

#[test]
fn series_branches_and_empty_legs_keep_their_shape() {
    let rung = rung("XIC(a)[XIC(b) ,[XIC(c) , XIC(d) ] , ]OTE(e);");
    assert_eq!(
        rung.to_string(),
        "XIC(a)[XIC(b) ,[XIC(c) ,XIC(d) ] , ]OTE(e);"
    );
    let Element::Branch(branch) = &rung.elements[1] else {
        panic!("{rung:?}")
    };
    assert_eq!(branch.legs.len(), 3);
    assert!(branch.legs[2].elements.is_empty());
    assert_eq!(
        branch.legs[2].span.range(),
        1036..1036,
        "the point before the closing bracket"
    );
    let names: Vec<_> = rung
        .instructions()
        .iter()
        .map(|i| i.operands[0].to_string())
        .collect();
    assert_eq!(names, ["a", "b", "c", "d", "e"]);
}

#[test]
fn a_lone_semicolon_is_an_empty_rung() {
    assert!(rung(";").elements.is_empty());
    assert!(rung(" \r\n ;\r\n").elements.is_empty());
}

#[test]
fn mnemonics_may_be_spelled_like_word_operators() {
    let rung = rung("AND(a,b,c)or(a,b,c)NOT(a,b)MOD(a,b,c)XOR(a,b,c);");
    let mnemonics: Vec<_> = rung
        .instructions()
        .iter()
        .map(|i| i.mnemonic.node.as_str())
        .collect();
    assert_eq!(mnemonics, ["AND", "or", "NOT", "MOD", "XOR"]);
}

#[test]
fn operators_bind_in_the_order_of_the_controller() {
    for (text, tree) in [
        ("a+b*c", "{a + {b * c}}"),
        ("a-b-c", "{{a - b} - c}"),
        ("-a**b", "{- {a ** b}}"),
        ("a**b**c", "{{a ** b} ** c}"),
        ("a**-b", "{a ** {- b}}"),
        ("NOT a AND b", "{{NOT a} AND b}"),
        ("a AND b OR c XOR d", "{{a AND b} OR {c XOR d}}"),
        ("a & b = c", "{a AND {b = c}}"),
        (
            "a-b > hi || a-b < lo && !c",
            "{{{a - b} > hi} || {{{a - b} < lo} && {! c}}}",
        ),
        ("a mod b*c", "{{a MOD b} * c}"),
        ("(a+b)*c", "{{a + b} * c}"),
        ("a^^b", "{a ^^ b}"),
    ] {
        assert_eq!(bracketed(&expr(text)), tree, "{text}");
    }
}

#[test]
fn references_take_members_bits_and_indexes() {
    for text in [
        "Local:2:I.Data.0",
        "S:FS",
        "Mod:I1",
        "\\Main.count",
        "a[1,2,3].b.5",
        "T[n/32].[n AND 31]",
        "buf[450*(P-1)+4]",
        "x.not",
        "a[b[c[d]]]",
    ] {
        assert_eq!(expr(text).to_string(), text);
        assert!(expr(text).as_reference().is_some());
    }
    let members = expr("a.b.31.[i][2,3]")
        .as_reference()
        .unwrap()
        .members
        .clone();
    assert!(matches!(
        &members[..],
        [Member::Field(b), Member::Bit(bit), Member::BitIndex(_), Member::Index(two)]
            if b.node == "b" && bit.node == 31 && two.len() == 2
    ));
}

#[test]
fn literals_keep_value_radix_and_suffix() {
    for (text, canonical) in [
        ("16#FFFF_0000", "16#ffff0000"),
        ("2#1010", "2#1010"),
        ("8#17", "8#17"),
        ("1_000", "1000"),
        ("5u", "5U"),
        ("5UL", "5UL"),
        ("16#5L", "16#5L"),
        (".6", ".6"),
        ("1.5e-3", "1.5e-3"),
        ("1.#QNAN", "1.#QNAN"),
        ("'it$'s'", "'it$'s'"),
        ("-1", "-1"),
    ] {
        assert_eq!(operand(text).to_string(), canonical);
    }
}

#[test]
fn operands_may_be_question_marks_and_free_text() {
    assert_eq!(operand("?").kind, OperandKind::InTag);
    assert_eq!(
        operand("% of  Maximum").kind,
        OperandKind::Words("% of Maximum".to_owned())
    );
    assert_eq!(
        operand("Units per sec2").kind,
        OperandKind::Words("Units per sec2".to_owned())
    );
    assert_eq!(operand("ALL").as_name().unwrap().node, "ALL");
    assert_eq!(bracketed(&expr("HIGH/LOW")), "{HIGH / LOW}");
}

#[test]
fn operands_may_be_left_out() {
    let operands = |text: &str| rung(text).instructions()[0].operands.clone();
    assert!(operands("NOP();").is_empty());
    let gsv = operands("GSV(WallClockTime,,DateTime, );");
    assert_eq!(gsv[1].kind, OperandKind::Empty);
    assert_eq!(gsv[1].span.range(), 1018..1018);
    assert_eq!(gsv[3].kind, OperandKind::Empty);
    assert_eq!(gsv.len(), 4);
}

#[test]
fn spans_are_places_in_the_file() {
    let rung = rung("XIC(a)CPT( b , (c + 1) );");
    assert_eq!(rung.span.range(), 1000..1025);
    let cpt = rung.instructions()[1];
    assert_eq!(cpt.mnemonic.span.range(), 1006..1009);
    assert_eq!(cpt.operands[0].span.range(), 1011..1012);
    assert_eq!(
        cpt.operands[1].span.range(),
        1015..1022,
        "with the parentheses"
    );
    assert_eq!(cpt.span.range(), 1006..1024);
}

#[test]
fn messages_say_what_was_found_and_expected() {
    let e5003 = |message: &str, under: &str| (Code::E5003, message.to_owned(), under.to_owned());
    assert_eq!(
        message("XIC(a)OTE(b)"),
        e5003("the rung text does not end with `;`", "")
    );
    assert_eq!(message("NOP;"), e5003("found `;`, expected `(`", ";"));
    assert_eq!(
        message("XIC(a OTE(b);").1,
        "found `(`, expected a name, `)` or `,`"
    );
    assert_eq!(
        message("XIC();XIC(a);"),
        e5003("text behind the `;` that ends the rung", "XIC")
    );
    assert_eq!(
        message("MOV(1,]);"),
        e5003("found `]`, expected an operand, `)` or `,`", "]")
    );
    assert_eq!(
        message("[XIC(a);").1,
        "found `;`, expected an instruction, `[`, `]` or `,`"
    );
    assert_eq!(
        message("XIC(a#b);"),
        e5003("`#` has no meaning in rung text", "#")
    );
    assert_eq!(
        message("MOV('a,b);"),
        e5003("the string is not closed, expected `'`", "'a,b);")
    );
    assert_eq!(
        message("MOV(8#9,b);"),
        e5003("`9` is not a digit of base 8", "8#9")
    );
    assert_eq!(
        message("MOV(99999999999999999999,b);"),
        (
            Code::E5005,
            "the number `99999999999999999999` is too large".into(),
            "99999999999999999999".into()
        )
    );
}

#[test]
fn an_unclosed_bracket_is_pointed_at() {
    let errors = parse("XIC(a)[XIC(b);").unwrap_err();
    assert_eq!(errors[0].secondary[0].span.range(), 1006..1007);
}

#[test]
fn nesting_is_bounded_at_the_stated_limits() {
    let brackets = |n: usize| format!("CMP({}a{});", "(".repeat(n), ")".repeat(n));
    assert!(parse(&brackets(MAX_NESTING - 1)).is_ok());
    assert_eq!(message(&brackets(MAX_NESTING)).0, Code::E5004);
    let operators = |n: usize| format!("CMP(a{});XIC", "+a".repeat(n)).replace("XIC", "");
    assert!(parse(&operators(MAX_OPERATORS)).is_ok());
    assert_eq!(message(&operators(MAX_OPERATORS + 1)).0, Code::E5004);
    assert_eq!(
        message(&format!("CMP({}a);", "-".repeat(100_000))).0,
        Code::E5004
    );
    assert_eq!(message(&"[".repeat(100_000)).0, Code::E5004);
}
