//! Unit tests: TEST, SETUP, TEARDOWN, and the statements that only they have. Their words are
//! names everywhere else.

use crate::check::{messages, outline, statements};
use iecc_diag::Code;

#[test]
fn a_file_of_tests() {
    let text = "SETUP VAR c : Counter; END_VAR c.inc := 2; END_SETUP
        TEST 'it counts' c(); ASSERT_EQ(c.n, 2, 'once'); END_TEST
        TEST \"it does nothing\" END_TEST;
        TEARDOWN c.inc := 0; END_TEARDOWN";
    assert_eq!(
        outline(text),
        "SETUP
  VAR
    var c : Counter
  := (. c inc) 2:Decimal
TEST (single \"it counts\")
  do (call c)
  do (call ASSERT_EQ (. c n) 2:Decimal (single \"once\"))
TEST (double \"it does nothing\")
TEARDOWN
  := (. c inc) 0:Decimal
"
    );
}

#[test]
fn setup_and_teardown_need_no_variables_behind_another_unit() {
    let text = "TEST 'a' END_TEST SETUP x(); END_SETUP TEARDOWN END_TEARDOWN
        FUNCTION f END_FUNCTION TEARDOWN END_TEARDOWN";
    assert_eq!(
        outline(text),
        "TEST (single \"a\")\nSETUP\n  do (call x)\nTEARDOWN\nFUNCTION f\nTEARDOWN\n"
    );
}

#[test]
fn mocks() {
    assert_eq!(
        outline(
            "TEST 'm' MOCK c.sensor; MOCK a[2]; MOCK_FUNCTION lib.read RETURNS 1 + x; END_TEST"
        ),
        "TEST (single \"m\")
  mock (. c sensor)
  mock (index a 2:Decimal)
  mock function (. lib read) returns:(+ 1:Decimal x)
"
    );
}

#[test]
fn words_of_tests_are_names_where_a_name_can_stand() {
    let text = "FUNCTION_BLOCK setup
        VAR test, mock, returns : INT; teardown : setup2; END_VAR
        VAR end_test : INT; END_VAR
        METHOD FINAL setup VAR x : INT; END_VAR END_METHOD
        test := mock + returns; mock(test); teardown.setup(); end_test := 1;
        END_FUNCTION_BLOCK";
    assert_eq!(
        outline(text),
        "FUNCTION_BLOCK setup
  VAR
    var test mock returns : INT
    var teardown : setup2
  VAR
    var end_test : INT
  method FINAL setup
    VAR
      var x : INT
  := test (+ mock returns)
  do (call mock test)
  do (call (. teardown setup))
  := end_test 1:Decimal
"
    );
    assert_eq!(
        statements("mock := 1; MOCK; test(setup := 'a');"),
        ":= mock 1:Decimal\ndo MOCK\ndo (call test setup:=(single \"a\"))\n"
    );
}

#[test]
fn a_test_that_is_not_closed_ends_before_the_next() {
    let text = "TEST 'one' x := 1;\nTEST 'two' x := 2; END_TEST";
    assert_eq!(messages(text), [(Code::E0011, "TEST".to_owned())]);
    let text = "TEST 'one' IF a THEN x := 1; END_TEST\nTEST 'two' END_TEST";
    assert_eq!(messages(text), [(Code::E0011, "IF".to_owned())]);
}

#[test]
fn the_end_of_another_unit_ends_a_test_with_a_message() {
    let text = "TEST 'one' x := 1; END_FUNCTION\nTEST 'two' x := 2; END_TEST";
    assert_eq!(messages(text), [(Code::E0012, "END_FUNCTION".to_owned())]);
}

#[test]
fn what_is_wrong_in_a_test_is_one_message() {
    for (text, code, place) in [
        ("TEST 'a' x := ; END_TEST", Code::E0010, ";"),
        ("TEST 'a' MOCK x END_TEST", Code::E0024, ""),
        ("TEST 'a' MOCK x\nMOCK y; END_TEST", Code::E0024, ""),
        ("TEST b x := 1; END_TEST", Code::E0030, "TEST"),
        ("TEST 'a' 5 x := 1; END_TEST", Code::E0010, "5"),
        ("SETUP VAR x : INT END_VAR END_SETUP", Code::E0024, ""),
        ("TEST 'a' MOCK_FUNCTION f 5; END_TEST", Code::E0010, "5"),
    ] {
        assert_eq!(messages(text), [(code, place.to_owned())], "{text}");
    }
}
