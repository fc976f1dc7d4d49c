//! Evaluators of the tested variants, interpreted and as machine code.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::variant::Variant;

/// Path of a specification and the order of its fields.
pub type Specification = (&'static str, usize);

type Pair = Rc<RefCell<[Evaluator; 2]>>;

thread_local! {
    static KNOWN: RefCell<HashMap<Specification, Pair>> = RefCell::default();
}

pub fn with_both<R>(
    specification: Specification,
    work: impl FnOnce(&mut [Evaluator; 2]) -> R,
) -> R {
    let pair = KNOWN.with_borrow_mut(|known| {
        known
            .entry(specification)
            .or_insert_with(|| Rc::new(RefCell::new(derive(specification))))
            .clone()
    });
    work(&mut pair.borrow_mut())
}

fn derive((path, order): Specification) -> [Evaluator; 2] {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let Ok(checked) = eomgen_model_spec::load(&path) else {
        panic!("{} is not a specification", path.display());
    };
    let orders = checked.model.orders(Some(order)).expect("an order");
    let Ok(variant) = Variant::derive_with(&checked.model, &orders, &Output::ALL) else {
        panic!("{} cannot be derived", path.display());
    };
    let interpreted = Evaluator::new(variant.program.clone());
    [interpreted, eomgen_jit::evaluator(variant.program)]
}
