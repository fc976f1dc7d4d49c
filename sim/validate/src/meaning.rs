//! Description of each check as a sentence.

/// Returns the statement that a check confirms if it passes; `None` for an unknown name.
pub fn describe(name: &str) -> Option<String> {
    let (first, rest) = name.split_once(' ').unwrap_or((name, ""));
    let nested = |prefix: &str| first.strip_prefix(prefix).and_then(part_of_equations);
    if let Some(part) = nested("nesting_") {
        return Some(format!(
            "With its highest mode held, order S + 1 has the {part} of order S."
        ));
    }
    if let Some(part) = nested("rigid_limit_") {
        return Some(format!(
            "With all modes held, the model has the {part} of the rigid machine."
        ));
    }
    if let Some(sentence) = outputs(first) {
        return Some(sentence.to_owned());
    }
    let sentence = match first {
        "reference" => {
            let equations = match rest {
                "equation_22_dimensionless" => "Eq. (22) in dimensionless form".to_owned(),
                name => name.replace('_', " "),
            };
            return Some(format!(
                "The accelerations satisfy the hand-written equations: {equations}."
            ));
        }
        "coordinate_names" => "The coordinates have the names and the order of the specification.",
        "accelerations" => "The accelerations satisfy equations that were derived independently.",
        "coverage" => "Random states were found in every possible regime.",
        "domain" => "States were found in the domain of the model.",
        "dense_solve" => {
            "The accelerations are those of a dense solve of the independent equations."
        }
        "mass_matrix" => "The mass matrix is that of the independent equations.",
        "mass_matrix_symmetric" => "The mass matrix is symmetric.",
        "mass_matrix_positive_definite" => "The mass matrix is positive definite.",
        "energy" => "The energy is that of the independent equations.",
        "power" => "The power is that of the independent equations.",
        "guards" => "The signs of the switching functions identify the regime.",
        "integrals" => "The quadrature resolves the integrals along fields at typical states.",
        "power_balance" => "Along a motion, the energy changes by the power of the forces.",
        "rates_at_zeros" => "Rates are finite where coordinates or rates are zero.",
        "jacobians_at_zeros" => "Jacobians are finite where coordinates or rates are zero.",
        "emitted_rust" => "The compiled Rust gives the same bits as the equations.",
        "emitted_c" => "The compiled C gives the same bits as the equations.",
        "emitted_casadi" => {
            "The compiled functions for CasADi give the same bits as the equations."
        }
        "unit_description" => "The description of the FMU has the variables of the specification.",
        "unit_library" => "The library in the FMU has the rates and observables of the equations.",
        "f32" => "In single precision, the compiled Rust stays within the bound of its rounding.",
        "regime_kernels" => {
            "The compiled code of each regime gives the same bits as the equations."
        }
        "corners" => "The rates jump as derived where the energies jump.",
        "exact_derivative" => "The exact solver has the rates of the equations.",
        _ => return None,
    };
    Some(sentence.to_owned())
}

/// Returns the statement of a check of a requested output.
fn outputs(name: &str) -> Option<&'static str> {
    let sentence = match name {
        "bias_forces" => "The bias forces are those of the independent equations.",
        "inverse_dynamics" => "The inverse dynamics satisfies the independent equations.",
        "rates_by_state" | "rates_by_inputs" | "rates_by_parameters" => {
            "This Jacobian of the rates agrees with differences of the independent equations."
        }
        "observables_by_state" | "observables_by_inputs" | "observables_by_parameters" => {
            "This Jacobian of the observables agrees with differences of the independent equations."
        }
        "jacobian_vector_product"
        | "vector_jacobian_product"
        | "vector_jacobian_product_by_parameters" => {
            "This product with a Jacobian agrees with differences of the independent equations."
        }
        "rates_by_time" => {
            "The derivatives of the rates with respect to time agree with differences."
        }
        "hessians" => {
            "The second derivatives in the functions for CasADi agree with differences of the Jacobians."
        }
        "guard_rates" => {
            "The rates of the switching functions agree with differences along a motion."
        }
        "emitted_requests" => "The compiled outputs give the same bits as the equations.",
        "linearisation" => "The compiled linearisation gives the same bits as the Jacobians.",
        "lanes" => "The SIMD functions give the same bits as single states.",
        _ => return None,
    };
    Some(sentence)
}

fn part_of_equations(name: &str) -> Option<&'static str> {
    match name {
        "mass" => Some("mass matrix"),
        "bias" => Some("velocity terms"),
        "forces" => Some("forces"),
        _ => None,
    }
}
