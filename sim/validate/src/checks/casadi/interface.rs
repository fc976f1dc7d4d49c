//! Functions of CasADi's C interface, as the documentation of the tested version describes them, and sparsity patterns
//! in compressed column storage.

use eomgen_codegen::program::Program;
use nalgebra::DMatrix;

/// Arguments of the rates.
pub const ARGUMENTS: [&str; 4] = ["t", "x", "u", "p"];

/// Names of a function, its arguments and its results.
pub struct Function {
    pub name: &'static str,
    /// Names and lengths of the arguments, which are column vectors.
    pub given: Vec<(String, usize)>,
    /// Names of the results with their numbers of rows and columns.
    pub results: Vec<(String, (usize, usize))>,
}

/// Returns the lengths of time, state, inputs and parameters.
pub fn lengths(program: &Program) -> [usize; 4] {
    [
        1,
        program.states(),
        program.inputs.len(),
        program.parameters.len(),
    ]
}

/// Returns the functions that the emitted file must contain.
pub fn functions(program: &Program) -> Vec<Function> {
    let states = program.states();
    let arguments = ARGUMENTS.into_iter().zip(lengths(program));
    let arguments: Vec<(String, usize)> = arguments
        .map(|(name, length)| (name.to_owned(), length))
        .collect();
    let and = |more: &[(&str, usize)]| -> Vec<(String, usize)> {
        let more = more
            .iter()
            .map(|(name, length)| ((*name).to_owned(), *length));
        arguments.iter().cloned().chain(more).collect()
    };
    let mut all = vec![
        Function {
            name: "rates",
            given: arguments.clone(),
            results: vec![("rates".to_owned(), (states, 1))],
        },
        Function {
            name: "jac_rates",
            given: and(&[("out_rates", states)]),
            results: (arguments.iter())
                .map(|(by, length)| (format!("jac_rates_{by}"), (states, *length)))
                .collect(),
        },
    ];
    if program.outputs.gradient_derivative.is_none() {
        return all;
    }
    let weighted = and(&[("out_rates", states), ("adj_rates", states)]);
    all.push(Function {
        name: "adj1_rates",
        given: weighted.clone(),
        results: (arguments.iter())
            .map(|(of, length)| (format!("adj_{of}"), (*length, 1)))
            .collect(),
    });
    let gradient = arguments
        .iter()
        .map(|(of, length)| (format!("out_adj_{of}"), *length));
    let mut results = Vec::new();
    for (of, rows) in &arguments {
        for (by, columns) in &arguments {
            results.push((format!("jac_adj_{of}_{by}"), (*rows, *columns)));
        }
        for by in ["out_rates", "adj_rates"] {
            results.push((format!("jac_adj_{of}_{by}"), (*rows, states)));
        }
    }
    all.push(Function {
        name: "jac_adj1_rates",
        given: weighted.into_iter().chain(gradient).collect(),
        results,
    });
    all
}

/// Sparsity pattern in compressed column storage.
pub struct Sparsity {
    pub rows: usize,
    pub columns: usize,
    /// Index of the first nonzero of each column, then the number of nonzeros.
    starts: Vec<usize>,
    /// Row of each nonzero.
    nonzeros: Vec<usize>,
}

impl Sparsity {
    /// Returns the pattern of a dense column vector.
    pub fn column(rows: usize) -> Self {
        Self {
            rows,
            columns: 1,
            starts: vec![0, rows],
            nonzeros: (0..rows).collect(),
        }
    }

    /// Returns the pattern in the format that the harness prints, each number after a space.
    pub fn text(&self) -> String {
        let sizes = [self.rows, self.columns];
        let all = sizes.iter().chain(&self.starts).chain(&self.nonzeros);
        all.map(|number| format!(" {number}")).collect()
    }

    /// Reads the printed line of a result; `None` if the name differs or the sparsity pattern is invalid.
    pub fn parse(line: &str, name: &str) -> Option<Self> {
        let mut words = line.split(' ');
        if words.next() != Some(name) {
            return None;
        }
        let numbers: Option<Vec<usize>> = words.map(|word| word.parse().ok()).collect();
        let numbers = numbers?;
        let (sizes, rest) = numbers.split_at_checked(2)?;
        let (rows, columns) = (sizes[0], sizes[1]);
        let (starts, nonzeros) = rest.split_at_checked(columns + 1)?;
        let ends = (starts.first(), starts.last());
        let columns_are_ordered = ends == (Some(&0), Some(&nonzeros.len()))
            && starts.windows(2).all(|pair| pair[0] <= pair[1]);
        if !columns_are_ordered {
            return None;
        }
        let rows_are_ordered = starts.windows(2).all(|pair| {
            let column = &nonzeros[pair[0]..pair[1]];
            column.windows(2).all(|pair| pair[0] < pair[1]) && column.iter().all(|row| *row < rows)
        });
        rows_are_ordered.then(|| Self {
            rows,
            columns,
            starts: starts.to_vec(),
            nonzeros: nonzeros.to_vec(),
        })
    }

    /// Returns the matrix with the nonzeros of a line of bits; `None` if their number differs from the pattern.
    pub fn dense(&self, line: &str) -> Option<DMatrix<f64>> {
        let words = line.split(' ').filter(|word| !word.is_empty());
        let numbers = words.map(|word| u64::from_str_radix(word, 16).ok().map(f64::from_bits));
        let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
        if numbers.len() != self.nonzeros.len() {
            return None;
        }
        let mut matrix = DMatrix::zeros(self.rows, self.columns);
        for (column, pair) in self.starts.windows(2).enumerate() {
            for place in pair[0]..pair[1] {
                matrix[(self.nonzeros[place], column)] = numbers[place];
            }
        }
        Some(matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonzeros_have_their_rows_and_columns() {
        let sparsity = Sparsity::parse("J 2 3 0 1 1 3 1 0 1", "J").expect("a sparsity");
        let numbers = [1.0, 2.0, 3.0].map(|number: f64| format!("{:016x}", number.to_bits()));
        let found = sparsity.dense(&numbers.join(" ")).expect("a matrix");
        let expected = DMatrix::from_row_slice(2, 3, &[0.0, 0.0, 2.0, 1.0, 0.0, 3.0]);
        assert_eq!(found, expected);
        assert!(sparsity.dense(&numbers[..2].join(" ")).is_none());
    }

    #[test]
    fn invalid_sparsity_is_rejected() {
        for line in [
            "K 1 1 0 1 0",
            "J 1",
            "J 1 1 0 1 1",
            "J 2 1 0 2 1 0",
            "J 2 1 0 2 1 1",
            "J 2 1 0 1 0 1",
            "J 2 2 0 2 1 0",
            "J 2 1 0 -1 0",
        ] {
            assert!(Sparsity::parse(line, "J").is_none(), "{line}");
        }
    }
}
