//! Multiplication order of products. Pairs of factors that several products share are multiplied first, the most
//! frequent pair before all others; therefore each pair is computed only once. Other products keep the order of their
//! factors.

use std::collections::{BTreeSet, BinaryHeap, HashMap};

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Factor {
    Coefficient(usize),
    Node(NodeId),
    Pair(usize),
}

/// Number times powers of nodes that depend only on parameters, computed by `prepare`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PreparedFactor {
    pub(crate) number: f64,
    pub(crate) powers: Vec<(NodeId, i32)>,
}

/// Bits of the magnitude of a numeric factor, and the product that it multiplies.
type ProductKey = (u64, NodeId);

#[derive(Default)]
pub(crate) struct Association {
    coefficients: Vec<PreparedFactor>,
    coefficient_places: HashMap<ProductPowers, usize>,
    pairs: Vec<(Factor, Factor)>,
    products: HashMap<ProductKey, Vec<Factor>>,
    seen: BTreeSet<ProductKey>,
}

type ProductPowers = (u64, Vec<(NodeId, i32)>);

/// Largest number of factors of a reordered product; longer products have too many pairs to compare.
pub(crate) const MAX_FACTORS: usize = 12;

/// Largest exponent of a reordered factor; higher powers are computed by repeated squaring.
const MAX_EXPONENT: i32 = 3;

impl Association {
    /// Returns the factors of a product if it shares a pair with another product.
    pub(crate) fn factors(&self, magnitude: f64, product: NodeId) -> Option<&[Factor]> {
        let factors = self.products.get(&(magnitude.to_bits(), product))?;
        Some(factors)
    }

    pub(crate) fn coefficient(&self, place: usize) -> &PreparedFactor {
        &self.coefficients[place]
    }

    pub(crate) fn pair(&self, place: usize) -> (Factor, Factor) {
        self.pairs[place]
    }

    /// Counts the multiplications per call in all products, with each shared pair counted once.
    fn count_multiplications(&self, graph: &Graph) -> usize {
        let own = self.seen.iter().map(|&(bits, product)| {
            if let Some(factors) = self.products.get(&(bits, product)) {
                return factors.len() - 1;
            }
            let powers = match graph.operation(product) {
                Operation::Product(powers) => powers.to_vec(),
                _ => vec![(product, 1)],
            };
            let (prepared, live): (Vec<_>, Vec<_>) = powers
                .into_iter()
                .partition(|(id, _)| graph.dependence(*id).is_parameter_only());
            let number = f64::from_bits(bits);
            let prepared = usize::from(number != 1.0 || !prepared.is_empty());
            let live = live
                .iter()
                .map(|(_, exponent)| exponent.unsigned_abs() as usize);
            (live.sum::<usize>() + prepared).saturating_sub(1)
        });
        own.sum::<usize>() + self.pairs.len()
    }

    /// Determines the multiplication orders of all new products that `roots` depend on.
    pub(crate) fn extend(&mut self, graph: &Graph, roots: &[NodeId]) {
        let keys = collect_product_keys(graph, roots);
        let mut found: Vec<(ProductKey, Vec<Factor>)> = Vec::new();
        for key in keys {
            if self.seen.insert(key)
                && let Some(factors) = self.factors_of(graph, key)
            {
                found.push((key, factors));
            }
        }
        let mut sharing = Sharing::new(found.iter().map(|(_, factors)| factors.clone()).collect());
        sharing.run(&mut self.pairs);
        for ((key, before), after) in found.into_iter().zip(sharing.products) {
            if before != after {
                self.products.insert(key, after);
            }
        }
    }

    fn factors_of(&mut self, graph: &Graph, (bits, product): ProductKey) -> Option<Vec<Factor>> {
        let powers = match graph.operation(product) {
            Operation::Product(powers) => powers.to_vec(),
            _ => vec![(product, 1)],
        };
        let (prepared, live): (Vec<_>, Vec<_>) = powers
            .into_iter()
            .partition(|(id, _)| graph.dependence(*id).is_parameter_only());
        let mut factors = Vec::new();
        if !prepared.is_empty() || bits != 1.0_f64.to_bits() {
            if prepared
                .iter()
                .any(|(id, _)| graph.shape(*id) != Shape::Scalar)
            {
                return None;
            }
            let number = f64::from_bits(bits);
            let next = self.coefficients.len();
            let place = *self
                .coefficient_places
                .entry((bits, prepared.clone()))
                .or_insert(next);
            if place == next {
                self.coefficients.push(PreparedFactor {
                    number,
                    powers: prepared,
                });
            }
            factors.push(Factor::Coefficient(place));
        }
        for (id, exponent) in live {
            let stays = matches!(
                graph.operation(id),
                Operation::Total(_) | Operation::Call(Function::Contact, _)
            );
            if stays || graph.shape(id) != Shape::Scalar || !(1..=MAX_EXPONENT).contains(&exponent)
            {
                return None;
            }
            factors.extend((0..exponent).map(|_| Factor::Node(id)));
        }
        (2..=MAX_FACTORS)
            .contains(&factors.len())
            .then_some(factors)
    }
}

/// Cost of a sine or a cosine, in additions. It is moderate because both functions of an angle are computed together,
/// and because they can run in parallel with other operations.
const TRIG_COST: usize = 20;

/// Counts the operations of scalar nodes per call with shared products, for the selection between two forms.
pub(crate) fn count_shared_operations(graph: &Graph, roots: &[NodeId]) -> usize {
    let mut association = Association::default();
    association.extend(graph, roots);
    let others = graph.reachable(roots).into_iter().map(|id| {
        if graph.dependence(id).is_parameter_only() {
            return 0;
        }
        match graph.operation(id) {
            Operation::Sum(terms) => {
                let prepared =
                    |(_, term): &&(_, NodeId)| graph.dependence(*term).is_parameter_only();
                let live = terms.len() - terms.iter().filter(prepared).count();
                live - usize::from(live == terms.len())
            }
            Operation::Call(Function::Sin | Function::Cos, _) => TRIG_COST,
            Operation::Call(..) | Operation::Power(..) | Operation::Select { .. } => 1,
            _ => 0,
        }
    });
    others.sum::<usize>() + association.count_multiplications(graph)
}

/// Returns the products that are terms of sums, with their numeric factors, and all other products.
fn collect_product_keys(graph: &Graph, roots: &[NodeId]) -> Vec<ProductKey> {
    let one = 1.0_f64.to_bits();
    let mut keys = BTreeSet::new();
    let is_product = |id: NodeId| matches!(graph.operation(id), Operation::Product(_));
    for id in graph.reachable(roots) {
        if graph.dependence(id).is_parameter_only() {
            continue;
        }
        match graph.operation(id) {
            Operation::Sum(terms) => {
                let live = terms
                    .iter()
                    .filter(|(_, term)| !graph.dependence(*term).is_parameter_only());
                keys.extend(live.map(|(c, term)| (c.value().abs().to_bits(), *term)));
            }
            operation => {
                let operands = graph.operands(operation).into_iter();
                keys.extend(operands.filter(|a| is_product(*a)).map(|a| (one, a)));
            }
        }
    }
    keys.extend(
        roots
            .iter()
            .filter(|id| is_product(**id))
            .map(|id| (one, *id)),
    );
    keys.into_iter()
        .filter(|(_, id)| !graph.dependence(*id).is_parameter_only())
        .collect()
}

type Pair = (Factor, Factor);

/// Products to be reordered, with the products that contain each pair of factors.
struct Sharing {
    products: Vec<Vec<Factor>>,
    holders: HashMap<Pair, BTreeSet<usize>>,
}

impl Sharing {
    fn new(products: Vec<Vec<Factor>>) -> Self {
        let mut sharing = Self {
            products,
            holders: HashMap::new(),
        };
        for place in 0..sharing.products.len() {
            for pair in collect_product_pairs(&sharing.products[place]) {
                sharing.holders.entry(pair).or_default().insert(place);
            }
        }
        sharing
    }

    /// Repeatedly replaces the most frequent pair by one factor, until no pair is shared.
    fn run(&mut self, pairs: &mut Vec<Pair>) {
        let mut queue: BinaryHeap<(usize, std::cmp::Reverse<Pair>)> = self
            .holders
            .iter()
            .filter(|(_, holders)| holders.len() > 1)
            .map(|(pair, holders)| (holders.len(), std::cmp::Reverse(*pair)))
            .collect();
        while let Some((count, std::cmp::Reverse(pair))) = queue.pop() {
            let holders = self.holders.get(&pair).map_or(0, BTreeSet::len);
            if holders != count {
                if holders > 1 && holders < count {
                    queue.push((holders, std::cmp::Reverse(pair)));
                }
                continue;
            }
            let made = Factor::Pair(pairs.len());
            pairs.push(pair);
            let holders = self.holders.remove(&pair).unwrap_or_default();
            let mut raised = BTreeSet::new();
            for place in holders {
                raised.extend(self.replace(place, pair, made));
            }
            for pair in raised {
                let holders = self.holders.get(&pair).map_or(0, BTreeSet::len);
                if holders > 1 {
                    queue.push((holders, std::cmp::Reverse(pair)));
                }
            }
        }
    }

    /// Replaces two factors of a product by their pair; returns the pairs that the product now contains.
    fn replace(&mut self, place: usize, pair: Pair, made: Factor) -> BTreeSet<Pair> {
        for held in collect_product_pairs(&self.products[place]) {
            if let Some(holders) = self.holders.get_mut(&held) {
                holders.remove(&place);
            }
        }
        let product = &mut self.products[place];
        for factor in [pair.0, pair.1] {
            if let Some(at) = product.iter().position(|other| *other == factor) {
                product.remove(at);
            }
        }
        product.push(made);
        let now = collect_product_pairs(product);
        for held in &now {
            self.holders.entry(*held).or_default().insert(place);
        }
        now
    }
}

/// Returns every pair of factors in a product.
fn collect_product_pairs(product: &[Factor]) -> BTreeSet<Pair> {
    let mut pairs = BTreeSet::new();
    for (place, &a) in product.iter().enumerate() {
        for &b in &product[..place] {
            pairs.insert((a.min(b), a.max(b)));
        }
    }
    pairs
}
