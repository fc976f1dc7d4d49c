#[derive(Clone, Copy)]
struct Eight([f64; 8]);

impl Eight {
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }
    fn both(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|lane| function(self.0[lane], other.0[lane])))
    }
    fn chosen(select: fn(f64, f64, f64, f64) -> f64, of: [Self; 4]) -> Self {
        let [a, b, then, otherwise] = of;
        Self(std::array::from_fn(|i| select(a.0[i], b.0[i], then.0[i], otherwise.0[i])))
    }
}

impl Add for Eight {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.both(other, |a, b| a + b)
    }
}

impl Sub for Eight {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.both(other, |a, b| a - b)
    }
}

impl Mul for Eight {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.both(other, |a, b| a * b)
    }
}

impl Div for Eight {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.both(other, |a, b| a / b)
    }
}

impl Neg for Eight {
    type Output = Self;
    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl Scalar for Eight {
    fn number(value: f64) -> Self {
        Self([value; 8])
    }
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self::chosen(<f64 as Scalar>::select_greater, [a, b, then, otherwise])
    }
    fn all_greater(a: Self, b: Self) -> bool {
        a.0.iter().zip(b.0).all(|(a, b)| *a > b)
    }
    fn function<F: Function>(self) -> Self {
        F::value(self)
    }
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self {
        F::value(self, other)
    }
}

impl Real for Eight {
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self::chosen(<f64 as Real>::select_equal, [a, b, then, otherwise])
    }
    fn magnitude(self) -> Self {
        self.each(<f64 as Real>::magnitude)
    }
    fn copy_sign(self, sign: Self) -> Self {
        self.both(sign, <f64 as Real>::copy_sign)
    }
    fn power_of_two(self) -> Self {
        self.each(<f64 as Real>::power_of_two)
    }
    fn exponent(self) -> Self {
        self.each(<f64 as Real>::exponent)
    }
    fn significand(self) -> Self {
        self.each(<f64 as Real>::significand)
    }
}

impl model::Coefficient<Eight> for f64 {
    fn read(self) -> Eight {
        Eight([self; 8])
    }
}

type State = (f64, [f64; model::STATES], [f64; INPUTS]);

/// Counts the results of eight states that differ from single states, and all results.
fn compare_lanes(states: &[State], coefficients: &model::Coefficients) -> [usize; 2] {
    let t = Eight(std::array::from_fn(|k| states[k].0));
    let state: [Eight; model::STATES] =
        std::array::from_fn(|i| Eight(std::array::from_fn(|k| states[k].1[i])));
    let inputs: [Eight; INPUTS] =
        std::array::from_fn(|i| Eight(std::array::from_fn(|k| states[k].2[i])));
    let inputs = inputs_of(inputs);
    let rates = model::inlined_rates(t, &state, &inputs, coefficients);
    let observables = model::inlined_observables(t, &state, &inputs, coefficients);
    let mut found = [0, 0];
    for (k, (t, state, inputs)) in states.iter().enumerate() {
        let inputs = inputs_of(*inputs);
        let alone = model::rates(*t, state, &inputs, coefficients);
        let others = model::observables(*t, state, &inputs, coefficients);
        let lanes = rates.iter().chain(&observables);
        for (lanes, alone) in lanes.zip(alone.iter().chain(&others)) {
            let same = lanes.0[k].to_bits() == alone.to_bits();
            found[0] += usize::from(!same && !(lanes.0[k].is_nan() && alone.is_nan()));
            found[1] += 1;
        }
    }
    found
}
