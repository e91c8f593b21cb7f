//! What paths lead to, and what is said of those that lead nowhere.

use super::*;
use iecc_ir::{parse_module, print_place};

const MODULE: &str = "module m
struct TIMER { DN: i1, PRE: i32, last: i64 }
struct Fan { speed: i8 }
struct Blower { \"base'\": Fan, heat: i8 }
state { Motor: i1, t: TIMER, b: Blower, \"Local:1:I.Data\": i16, grid: [2 x [3 x i8]], r: f32 }
input { Start: i1 }
output { Motor: i1 }
name Alias = state.\"Local:1:I.Data\".3
name Word = state.\"Local:1:I.Data\"
scan @s
fn @s[]() -> () {
b0:
  v0: i32 = elapsed state.t.last, 1ms
  return
}
";

fn show(module: &Module, place: &Place) -> String {
    print_place(module, &module.funcs[module.scan], place)
}

#[test]
fn paths_are_followed_ignoring_case() {
    let module = parse_module(MODULE).unwrap();
    let (watch, set) = (Names::to_watch(&module), Names::to_set(&module));
    for (path, expected) in [
        ("start", "input.Start"),
        ("T.pre", "state.t.PRE"),
        ("alias", "state.\"Local:1:I.Data\".3"),
        ("WORD.15", "state.\"Local:1:I.Data\".15"),
        ("local:1:i.data.0", "state.\"Local:1:I.Data\".0"),
        ("grid[1][2]", "state.grid[1][2]"),
        ("grid[1, 2]", "state.grid[1][2]"),
        ("grid[0,1].7", "state.grid[0][1].7"),
        ("t", "state.t"),
        ("b.Heat", "state.b.heat"),
        ("b.Speed", "state.b.\"base'\".speed"),
    ] {
        assert_eq!(
            show(&module, &watch.find(path).unwrap()),
            expected,
            "{path}"
        );
        assert_eq!(show(&module, &set.find(path).unwrap()), expected, "{path}");
    }
    assert_eq!(show(&module, &watch.find("motor").unwrap()), "output.Motor");
    assert_eq!(show(&module, &set.find("motor").unwrap()), "state.Motor");
}

#[test]
fn paths_are_shown_as_the_program_spells_them() {
    let module = parse_module(MODULE).unwrap();
    let names = Names::to_watch(&module);
    for (path, expected) in [
        ("start", "Start"),
        ("T.pre", "t.PRE"),
        ("WORD.15", "Word.15"),
        ("GRID[1, 2].7", "grid[1, 2].7"),
        ("B.Speed", "b.speed"),
    ] {
        let spelled = names.find_spelled(path).unwrap().0;
        assert!(spelled.eq_ignore_ascii_case(path), "{path}");
        assert_eq!(spelled, expected, "{path}");
    }
}

#[test]
fn what_is_not_found_is_explained() {
    let module = parse_module(MODULE).unwrap();
    let names = Names::to_watch(&module);
    for (path, message, suggestion) in [
        ("Strat", "no tag or point is named `Strat`", Some("Start")),
        ("xyzzy.3", "no tag or point is named `xyzzy`", None),
        ("t.PER", "`t` has no member `PER`", Some("PRE")),
        (
            "grid[2]",
            "index 2 is outside `grid`, which has elements 0 to 1",
            None,
        ),
        ("grid[x]", "`x` is no index of `grid`", None),
        ("grid[0", "the bracket after `grid` is not closed", None),
        (
            "grid.x",
            "`grid` is an array; an index must come before `.x`",
            None,
        ),
        (
            "t[0]",
            "`t` has no elements to count, or fewer dimensions",
            None,
        ),
        (
            "t.PRE.32",
            "bit 32 is outside `t.PRE`, which has bits 0 to 31",
            None,
        ),
        (
            "t.PRE.x",
            "`t.PRE` is an integer: `x` is no number of a bit",
            None,
        ),
        ("t.DN.0", "`t.DN` is one bit and has no part `0`", None),
        ("alias.0", "`alias` is one bit and has no parts", None),
        ("r.0", "`r` is a real number and has no part `0`", None),
        ("grid[0]x", "`x` cannot follow `grid[0]`", None),
    ] {
        let error = names.find(path).unwrap_err();
        assert_eq!(
            (error.message.as_str(), error.suggestion.as_deref()),
            (message, suggestion)
        );
    }
    assert!(names.find("").is_err());
}

#[test]
fn a_structure_stands_for_its_values_without_kept_times() {
    let module = parse_module(MODULE).unwrap();
    let names = Names::to_watch(&module);
    let all = |path: &str, most| {
        let found = leaves(&module, path, &names.find(path).unwrap(), most)?;
        Ok::<_, NameError>(found.into_iter().map(|(name, _)| name).collect::<Vec<_>>())
    };
    assert_eq!(all("t", 9).unwrap(), ["t.DN", "t.PRE"]);
    assert_eq!(all("t.last", 9).unwrap(), ["t.last"]);
    assert_eq!(
        all("grid[1]", 9).unwrap(),
        ["grid[1][0]", "grid[1][1]", "grid[1][2]"]
    );
    assert_eq!(all("alias", 9).unwrap(), ["alias"]);
    let error = all("grid", 5).unwrap_err();
    assert_eq!(
        error.message,
        "`grid` has 6 values, at most 5 can be shown at once"
    );
}

const FROM: &str = "module m
struct ROW { cells: [2 x [2 x i16]] from [1, -1], n: i8 }
state { rows: [2 x ROW] from [5], plain: [2 x i8] }
input { }
output { }
scan @s
fn @s[]() -> () {
b0:
  return
}
";

#[test]
fn elements_have_the_numbers_that_people_give_them() {
    let module = parse_module(FROM).unwrap();
    iecc_ir::verify(&module).unwrap();
    let names = Names::to_watch(&module);
    for (path, expected) in [
        ("rows[5].cells[1,-1]", "state.rows[0].cells[0][0]"),
        ("rows[6].cells[2][0].3", "state.rows[1].cells[1][1].3"),
        ("plain[1]", "state.plain[1]"),
    ] {
        assert_eq!(
            show(&module, &names.find(path).unwrap()),
            expected,
            "{path}"
        );
    }
    for (path, expected) in [
        (
            "rows[4]",
            "index 4 is outside `rows`, which has elements 5 to 6",
        ),
        (
            "rows[5].cells[0]",
            "index 0 is outside `rows[5].cells`, which has elements 1 to 2",
        ),
    ] {
        assert_eq!(names.find(path).unwrap_err().message, expected);
    }
    let place = names.find("rows[6]").unwrap();
    let found = leaves(&module, "rows[6]", &place, 10).unwrap();
    let found: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    let cells = ["[1][-1]", "[1][0]", "[2][-1]", "[2][0]"].map(|i| format!("rows[6].cells{i}"));
    assert_eq!(found[..4], cells);
    assert_eq!(found[4], "rows[6].n");
}
