//! Bounds of the functions of `functions.c`, computed from their disassembly in `functions.txt`.

use eomgen_instruction_bounds::{Bound, bound_functions};

const LISTING: &str = include_str!("functions.txt");

/// Bounds one function and no others.
fn bound(listing: &str, name: &str) -> Result<Bound, String> {
    let hidden: String = listing
        .lines()
        .map(
            |line| match line.contains(" g     F ") && !line.ends_with(&format!(" {name}")) {
                true => line.replace(" g     F ", " l     F ") + "\n",
                false => format!("{line}\n"),
            },
        )
        .collect();
    let functions = bound_functions(&hidden).expect("a listing");
    assert_eq!(functions.len(), 1);
    functions.into_iter().next().expect("the function").bound
}

#[test]
fn counted_loops_are_bounded_by_their_limit() {
    let counted = bound(LISTING, "counted").expect("a bound");
    // Five instructions per iteration, two before and one after the loop.
    assert_eq!((counted.instructions, counted.stack), (38, 0));
    let limited = bound(LISTING, "limited").expect("a bound");
    assert_eq!(limited.instructions, 38);
}

#[test]
fn functions_without_proven_limit_have_no_bound() {
    let functions = bound_functions(LISTING).expect("a listing");
    for (name, reason) in [
        (
            "by_data",
            "a loop or branches with more than 20000 states, at by_data+",
        ),
        (
            "by_argument",
            "a loop or branches with more than 20000 states, at by_argument+",
        ),
        ("recursive", "recursive calls itself"),
        ("by_pointer", "an indirect call, at by_pointer+"),
        (
            "with_missing",
            "a call of `missing`, which neither the object nor libgcc contains, at with_missing+",
        ),
        (
            "of_variable_stack",
            "a stack pointer that is not known, at of_variable_stack+",
        ),
    ] {
        let function = functions.iter().find(|function| function.name == name);
        let found = function.expect(name).bound.as_ref().expect_err(name);
        assert!(found.starts_with(reason), "{found}");
    }
}

#[test]
fn unknown_instructions_have_no_bound() {
    let changed = LISTING.replacen("vmul.f32", "vpadd.f32", 1);
    let found = bound(&changed, "counted").expect_err("no bound");
    assert!(
        found.starts_with("the unknown instruction `vpadd`, at counted+"),
        "{found}"
    );
}

/// Each of the three products and quotients may normalise two subnormal operands.
#[test]
fn subnormal_operands_of_libgcc_count_their_shifts() {
    let product = bound(LISTING, "product").expect("a bound");
    let shifts = 3 * 2 * 2 * 51 * 6;
    let difference = product.instructions - product.without_subnormals;
    assert!(difference >= shifts, "{product:?}");
    // If the machine code of the library differs, its loops are not known.
    let changed = LISTING.replace(" 3da:\tfba0 ce02", " 3da:\tfba0 ce12");
    assert_ne!(changed, LISTING);
    let found = bound(&changed, "product").expect_err("no bound");
    assert!(found.starts_with("a loop"), "{found}");
}

#[test]
fn objects_of_other_processors_are_rejected() {
    let other = LISTING.replace("elf32-littlearm", "elf64-x86-64");
    let message = bound_functions(&other).expect_err("another format");
    assert_eq!(
        message,
        "the object is elf64-x86-64 instead of elf32-littlearm"
    );
}
