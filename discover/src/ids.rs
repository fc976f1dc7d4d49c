//! Typed indices, with one type for each kind of object, so that the compiler finds wrong indices.
//! Lists are indexed by them; [`index`](ChannelId::index) returns the number for rows and columns
//! of matrices.

/// Consecutive windows.
pub type WindowRange = std::iter::Map<std::ops::Range<usize>, fn(usize) -> WindowId>;

impl WindowId {
    /// Returns consecutive windows in order.
    pub fn range(indices: std::ops::Range<usize>) -> WindowRange {
        indices.map(Self::new as fn(usize) -> Self)
    }
}

eomgen_model_spec::ids! {
    /// Channel of a dataset.
    ChannelId;
    /// Window of training or test records.
    WindowId;
    /// Independent parameter of a model, as an index into its parameter values.
    ParameterId;
    /// Unknown of a fit.
    UnknownId;
    /// Observable of a model.
    ObservableId;
    /// Equation of motion in which a force may be missing.
    EquationId;
    /// Family of basis functions of a regression.
    FamilyId;
    /// Basis function of a regression, that is, a column; counted over all families.
    BasisFunctionId;
    /// Candidate in a list of screened candidates.
    CandidateId;
    /// Candidate whose response changes the outputs, in a list of responses.
    ResponseId;
    /// Effect in a list of accepted effects, or in a hypothesis.
    EffectId;
    /// Hypothesis in a list of fully fitted hypotheses.
    FittedId;
}
