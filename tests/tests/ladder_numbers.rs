//! Compare, move, compute and logical instructions, each row worked out from the vendor's rules.

use iecc_tests::ladder::check;

#[test]
fn comparisons_of_two_numbers() {
    check(
        "a DINT; b DINT; eq BOOL; ne BOOL; gt BOOL; ge BOOL; lt BOOL; le BOOL",
        &[
            "EQU(a,b)OTE(eq);",
            "NEQ(a,b)OTE(ne);",
            "GRT(a,b)OTE(gt);",
            "GEQ(a,b)OTE(ge);",
            "LES(a,b)OTE(lt);",
            "LEQ(a,b)OTE(le);",
        ],
        "a=3 b=3  | eq=1 ne=0 gt=0 ge=1 lt=0 le=1
         a=-1 b=1 | eq=0 ne=1 gt=0 ge=0 lt=1 le=1
         a=1 b=-1 | eq=0 ne=1 gt=1 ge=1 lt=0 le=0",
    );
}

#[test]
fn names_from_revision_36_mean_the_same() {
    check(
        "a DINT; b DINT; eq BOOL; ne BOOL; gt BOOL; ge BOOL; lt BOOL; le BOOL; lim BOOL; m DINT",
        &[
            "EQ(a,b)OTE(eq);",
            "NE(a,b)OTE(ne);",
            "GT(a,b)OTE(gt);",
            "GE(a,b)OTE(ge);",
            "LT(a,b)OTE(lt);",
            "LE(a,b)OTE(le);",
            "LIMIT(0,a,5)OTE(lim);",
            "MOVE(a,m);",
        ],
        "a=6 b=5 | eq=0 ne=1 gt=1 ge=1 lt=0 le=0 lim=0 m=6
         a=5 b=5 | eq=1 ne=0 gt=0 ge=1 lt=0 le=1 lim=1 m=5",
    );
}

#[test]
fn narrow_integers_are_compared_by_value() {
    check(
        "s SINT; i INT; o BOOL; u USINT; p BOOL",
        &["EQU(s,i)OTE(o);", "GRT(u,s)OTE(p);"],
        "s=-1 i=-1 u=255 | o=1 p=1
         s=-1 i=255      | o=0",
    );
}

#[test]
fn integers_and_reals_are_compared_as_reals() {
    check(
        "n DINT; r REAL; o BOOL; half BOOL",
        &["EQU(n,r)OTE(o);", "LES(n,2.5)OTE(half);"],
        "n=2 r=2.0 | o=1 half=1
         n=3 r=2.5 | o=0 half=0",
    );
}

#[test]
fn nan_compares_false_but_not_equal() {
    check(
        "r REAL; eq BOOL; ne BOOL; le BOOL; lim BOOL",
        &[
            "EQU(r,r)OTE(eq);",
            "NEQ(r,r)OTE(ne);",
            "LEQ(r,1.0)OTE(le);",
            "LIM(0.0,r,1.0)OTE(lim);",
        ],
        "r=NaN | eq=0 ne=1 le=0 lim=0
         r=0.5 | eq=1 ne=0 le=1 lim=1",
    );
}

#[test]
fn a_false_condition_stays_false_behind_a_comparison() {
    check(
        "a BOOL; n DINT; o BOOL",
        &["XIC(a)EQU(n,0)OTE(o);"],
        "a=0 | o=0
         a=1 | o=1",
    );
}

#[test]
fn lim_inside_the_band_outside_the_reversed_band_and_at_equal_limits() {
    check(
        "lo DINT; t DINT; hi DINT; o BOOL",
        &["LIM(lo,t,hi)OTE(o);"],
        "lo=2 hi=5 t=1 | o=0
         t=2           | o=1
         t=5           | o=1
         t=6           | o=0
         lo=5 hi=2 t=2 | o=1
         t=3           | o=0
         t=4           | o=0
         t=5           | o=1
         t=9           | o=1
         lo=4 hi=4 t=3 | o=0
         t=4           | o=1
         t=5           | o=0",
    );
}

#[test]
fn meq_compares_under_the_mask_and_fills_narrow_operands_with_0() {
    // 16#ff80 in an INT fills to 16#0000_ff80, so the upper half of the mask sees zeros.
    check(
        "i INT; c DINT; o BOOL; p BOOL",
        &[
            "MEQ(i,16#ffff_ffff,c)OTE(o);",
            "MEQ(i,16#00f0,16#0050)OTE(p);",
        ],
        "i=-128 c=65408 | o=1 p=0
         i=-128 c=-128  | o=0
         i=81 c=0       | o=0 p=1",
    );
}

#[test]
fn mov_narrows_by_keeping_low_bits() {
    check(
        "d DINT; i INT; s SINT",
        &["MOV(d,i);", "MOV(i,s);"],
        "d=65665 | i=129 s=-127
         d=-1    | i=-1 s=-1",
    );
}

#[test]
fn mov_widens_by_sign_or_with_0() {
    check(
        "s SINT; u USINT; d DINT; e DINT; l LINT",
        &["MOV(s,d);", "MOV(u,e);", "MOV(s,l);"],
        "s=-5 u=251 | d=-5 e=251 l=-5",
    );
}

#[test]
fn a_real_becomes_an_integer_by_rounding_half_to_even() {
    check(
        "r REAL; d DINT; s SINT",
        &["MOV(r,d);", "MOV(r,s);"],
        "r=2.5   | d=2 s=2
         r=1.5   | d=2
         r=-1.5  | d=-2
         r=-2.5  | d=-2
         r=3.5   | d=4
         r=2.49  | d=2
         r=300.0 | d=300 s=44",
    );
}

#[test]
fn a_real_beyond_dint_keeps_its_low_bits() {
    // 3000000000 = 2^32 - 1294967296
    check(
        "r REAL; d DINT",
        &["MOV(r,d);"],
        "r=3000000000.0 | d=-1294967296",
    );
}

#[test]
fn a_dint_becomes_a_real_of_24_bits() {
    check(
        "d DINT; r REAL",
        &["MOV(d,r);"],
        "d=16777217 | r=16777216.0",
    );
}

#[test]
fn literals_in_other_bases_are_filled_with_0() {
    check(
        "a DINT; b DINT; i INT; c DINT",
        &[
            "MOV(16#ffff,a);",
            "MOV(2#1010,b);",
            "MOV(16#ffff,i);",
            "MOV(8#17,c);",
        ],
        "| a=65535 b=10 i=-1 c=15",
    );
}

#[test]
fn a_false_rung_moves_nothing() {
    check(
        "a BOOL; n DINT; m DINT",
        &["XIC(a)MOV(n,m);", "XIC(a)CLR(n);"],
        "a=0 n=5 | m=0 n=5
         a=1     | m=5 n=0",
    );
}

#[test]
fn clr_clears_integers_and_reals() {
    check(
        "s SINT; r REAL",
        &["CLR(s);", "CLR(r);"],
        "s=5 r=2.5 | s=0 r=0.0",
    );
}

#[test]
fn sums_wrap_and_mixed_operands_are_promoted() {
    check(
        "a DINT; i INT; r REAL; sum DINT; small INT; real REAL",
        &["ADD(a,1,sum);", "ADD(i,i,small);", "ADD(i,r,real);"],
        "a=2147483647 i=20000 r=0.5 | sum=-2147483648 small=-25536 real=20000.5
         a=-5 i=-3                  | sum=-4 small=-6 real=-2.5",
    );
}

#[test]
fn differences_and_products() {
    check(
        "a DINT; b DINT; d DINT; p DINT; w INT",
        &["SUB(a,b,d);", "MUL(a,b,p);", "MUL(a,b,w);"],
        "a=3 b=5           | d=-2 p=15 w=15
         a=-2147483648 b=1 | d=2147483647 p=-2147483648 w=0
         a=65536 b=65536   | d=0 p=0 w=0
         a=300 b=300       | d=0 p=90000 w=24464",
    );
}

#[test]
fn integer_division_truncates_and_division_by_0_keeps_the_destination() {
    check(
        "a DINT; b DINT; q DINT; m DINT",
        &["DIV(a,b,q);", "MOD(a,b,m);"],
        "a=7 b=2   | q=3 m=1
         a=-7 b=2  | q=-3 m=-1
         a=7 b=-2  | q=-3 m=1
         a=9 b=0   | q=-3 m=1
         a=-2147483648 b=-1 | q=-2147483648 m=0",
    );
}

#[test]
fn real_division_goes_by_ieee_and_rounds_into_integers() {
    check(
        "a REAL; b REAL; q REAL; n DINT; i DINT; j DINT; k DINT",
        &["DIV(a,b,q);", "DIV(a,2.0,n);", "DIV(i,j,k);"],
        "a=1.0 b=4.0 i=3 j=2 | q=0.25 n=0 k=1
         a=7.0 b=2.0         | q=3.5 n=4
         a=5.0 b=0.0         | q=inf n=2
         a=-5.0              | q=-inf n=-2",
    );
}

#[test]
fn an_integer_quotient_is_taken_before_a_real_destination() {
    check("a DINT; r REAL", &["DIV(a,2,r);"], "a=7 | r=3.0");
}

#[test]
fn real_modulo_follows_the_vendors_formula() {
    check(
        "a REAL; b REAL; m REAL",
        &["MOD(a,b,m);"],
        "a=7.5 b=2.0       | m=1.5
         a=-7.5            | m=-1.5
         a=7.5 b=-2.0      | m=1.5
         a=5.75 b=1.5      | m=1.25
         a=1.0 b=3.0       | m=1.0
         a=16777216.0 b=1.0 | m=0.0",
    );
}

#[test]
fn neg_and_abs_wrap_at_the_smallest_number() {
    check(
        "a DINT; s SINT; r REAL; n DINT; b DINT; ns SINT; nr REAL; br REAL",
        &[
            "NEG(a,n);",
            "ABS(a,b);",
            "NEG(s,ns);",
            "NEG(r,nr);",
            "ABS(r,br);",
        ],
        "a=5 s=-128 r=-2.5   | n=-5 b=5 ns=-128 nr=2.5 br=2.5
         a=-5                | n=5 b=5
         a=-2147483648 r=1.0 | n=-2147483648 b=-2147483648 nr=-1.0 br=1.0",
    );
}

#[test]
fn logical_instructions_work_bit_by_bit() {
    check(
        "a DINT; b DINT; x DINT; o DINT; n DINT; t DINT",
        &["AND(a,b,n);", "OR(a,b,o);", "XOR(a,b,x);", "NOT(a,t);"],
        "a=12 b=10 | n=8 o=14 x=6 t=-13",
    );
}

#[test]
fn logical_instructions_fill_narrow_operands_with_0() {
    // -1 in a SINT is 16#0000_00ff as a DINT.
    check(
        "s SINT; d DINT; o DINT; n DINT; t SINT",
        &["AND(s,-1,d);", "OR(s,0,o);", "NOT(s,n);", "NOT(s,t);"],
        "s=-1 | d=255 o=255 n=-256 t=0",
    );
}

#[test]
fn elements_of_arrays_with_constant_indexes() {
    check(
        "a DINT[4]; m INT[2,3]; b BOOL[32]; o BOOL",
        &[
            "MOV(7,a[3]);",
            "MOV(5,m[1,2]);",
            "XIC(b[31])OTE(o);",
            "ADD(a[3],a[0],a[1]);",
        ],
        "a[0]=2 b[31]=1 | a[3]=7 a[1]=9 a[2]=0 m[1,2]=5 m[0,0]=0 o=1",
    );
}

#[test]
fn one_instruction_reads_its_operands_before_it_writes() {
    check("n DINT", &["ADD(n,n,n);"], "n=3 | n=6\n | n=12");
}
