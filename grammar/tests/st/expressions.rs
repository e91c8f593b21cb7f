//! Operators bind as the table of the standard says, paths and calls as written.

use crate::check::expression;

#[test]
fn tighter_operators_are_grouped_first() {
    for (text, tree) in [
        ("a + b * c", "(+ a (* b c))"),
        ("a * b + c", "(+ (* a b) c)"),
        ("a OR b XOR c AND d", "(OR a (XOR b (AND c d)))"),
        ("a AND b XOR c OR d", "(OR (XOR (AND a b) c) d)"),
        ("a = b < c", "(= a (< b c))"),
        ("a < b = c", "(= (< a b) c)"),
        (
            "a & b <> c + d MOD e ** f",
            "(AND a (<> b (+ c (MOD d (** e f)))))",
        ),
        ("a ** b MOD c - d >= e", "(>= (- (MOD (** a b) c) d) e)"),
        (
            "a OR b AND c = d + e * f ** g",
            "(OR a (AND b (= c (+ d (* e (** f g))))))",
        ),
        (
            "a ** b * c + d = e AND f OR g",
            "(OR (AND (= (+ (* (** a b) c) d) e) f) g)",
        ),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn equally_tight_operators_group_to_the_left() {
    assert_eq!(expression("a - b + c - d"), "(- (+ (- a b) c) d)");
    assert_eq!(expression("a / b * c MOD d"), "(MOD (* (/ a b) c) d)");
    assert_eq!(
        expression("2 ** 3 ** 2"),
        "(** (** 2:Decimal 3:Decimal) 2:Decimal)"
    );
    assert_eq!(expression("a < b <= c"), "(<= (< a b) c)");
    assert_eq!(expression("a * b + c * d - e"), "(- (+ (* a b) (* c d)) e)");
}

#[test]
fn parentheses_group_and_leave_no_node() {
    assert_eq!(expression("(a + b) * c"), "(* (+ a b) c)");
    assert_eq!(expression("a * (b + c) ** d"), "(* a (** (+ b c) d))");
    assert_eq!(expression("a - (b - c)"), "(- a (- b c))");
    assert_eq!(expression("((a))"), "a");
}

#[test]
fn unary_operators_bind_tighter_than_all_others() {
    assert_eq!(expression("-a ** b"), "(** (Negate a) b)");
    assert_eq!(expression("a ** -b"), "(** a (Negate b))");
    assert_eq!(expression("NOT a AND b"), "(AND (Not a) b)");
    assert_eq!(
        expression("-a.b[1]^"),
        "(Negate (^ (index (. a b) 1:Decimal)))"
    );
    assert_eq!(expression("- - a"), "(Negate (Negate a))");
    assert_eq!(expression("NOT NOT +a"), "(Not (Not (Plus a)))");
    assert_eq!(expression("-(a + b)"), "(Negate (+ a b))");
}

#[test]
fn paths_go_through_members_indices_references_and_parts() {
    for (text, tree) in [
        ("a.b.c", "(. (. a b) c)"),
        ("a[1, i + 1].x", "(. (index a 1:Decimal (+ i 1:Decimal)) x)"),
        ("p^.q^", "(^ (. (^ p) q))"),
        ("w.3", "(part w short Bit 3)"),
        ("w.%X15", "(part w Bit 15)"),
        ("w.%B1", "(part w Byte 1)"),
        ("w.%D1 .%W0", "(part (part w DoubleWord 1) Word 0)"),
        ("w.1 .2", "(part (part w short Bit 1) short Bit 2)"),
        ("THIS.x", "(. THIS x)"),
        ("SUPER.m()", "(call (. SUPER m))"),
        ("a.of.end_if", "(. (. a of) end_if)"),
    ] {
        assert_eq!(expression(text), tree, "{text}");
    }
}

#[test]
fn direct_addresses_have_an_area_a_size_and_fields() {
    assert_eq!(
        expression("%IX1.7"),
        "(direct Some(Input) Some(Bit) Some([1, 7]))"
    );
    assert_eq!(expression("%q3"), "(direct Some(Output) None Some([3]))");
    assert_eq!(
        expression("%MW1.2.3.4"),
        "(direct Some(Memory) Some(Word) Some([1, 2, 3, 4]))"
    );
    assert_eq!(expression("%I*"), "(direct Some(Input) None None)");
    assert_eq!(
        expression("%QD*"),
        "(direct Some(Output) Some(DoubleWord) None)"
    );
    assert_eq!(
        expression("%ML0"),
        "(direct Some(Memory) Some(LongWord) Some([0]))"
    );
    assert_eq!(
        expression("%IB0"),
        "(direct Some(Input) Some(Byte) Some([0]))"
    );
}

#[test]
fn operators_that_are_words_can_be_called() {
    for (text, tree) in [
        ("AND(a, b, c)", "(call AND a b c)"),
        ("x AND AND(a, b)", "(AND x (call AND a b))"),
        (
            "OR(a, XOR(IN1 := b, IN2 := c))",
            "(call OR a (call XOR IN1:=b IN2:=c))",
        ),
        ("MOD(a, b) MOD (c)", "(MOD (call MOD a b) c)"),
    ] {
        assert_eq!(expression(text), tree);
    }
}

#[test]
fn calls_take_arguments_by_position_or_by_name() {
    assert_eq!(expression("f()"), "(call f)");
    assert_eq!(expression("f(1, b)"), "(call f 1:Decimal b)");
    assert_eq!(
        expression("f(EN := a, IN := b + 1, NOT ENO => c, q => d[1], r =>)"),
        "(call f EN:=a IN:=(+ b 1:Decimal) NOT ENO=>c q=>(index d 1:Decimal) r=>nothing)"
    );
    assert_eq!(expression("f(NOT a, NOT (b))"), "(call f (Not a) (Not b))");
    assert_eq!(
        expression("ns.o.m(f(x).y)"),
        "(call (. (. ns o) m) (. (call f x) y))"
    );
}

#[test]
fn references_are_taken_and_compared_with_null() {
    assert_eq!(expression("REF(a.b)"), "(REF (. a b))");
    assert_eq!(expression("r <> NULL"), "(<> r NULL)");
}

#[test]
fn values_of_arrays_and_structures_are_expressions() {
    assert_eq!(
        expression("[1, 3(0), n(1, 2), 4()]"),
        "(array 1:Decimal (repeat 3:Decimal 0:Decimal) (call n 1:Decimal 2:Decimal) (repeat 4:Decimal))"
    );
    assert_eq!(
        expression("(a := 1, b := (c := [2(TRUE)]))"),
        "(struct a:=1:Decimal b:=(struct c:=(array (repeat 2:Decimal true))))"
    );
}
