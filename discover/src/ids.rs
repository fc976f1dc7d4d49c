//! Typed indices, one type for each kind of object, so that they cannot be confused. Lists are
//! indexed by them; [`index`](ChannelId::index) returns the number for rows and columns of
//! matrices.

/// Consecutive windows.
pub type WindowRange = std::iter::Map<std::ops::Range<usize>, fn(usize) -> WindowId>;

impl WindowId {
    /// Returns consecutive windows in order.
    pub fn range(indices: std::ops::Range<usize>) -> WindowRange {
        indices.map(Self::new as fn(usize) -> Self)
    }
}

eomgen_model_spec::ids! {
    /// A channel of a dataset.
    ChannelId;
    /// A window of training or test records.
    WindowId;
    /// An independent parameter of a model, among the values that it is run at.
    ParameterId;
    /// An unknown of a fit.
    UnknownId;
    /// An observable of a model.
    ObservableId;
    /// An equation of motion in which a force may be missing.
    EquationId;
    /// A family of basis functions of a regression.
    FamilyId;
    /// A basis function of a regression, of whatever family: a column.
    BasisFunctionId;
    /// A candidate of a list that was screened.
    CandidateId;
    /// The response of a candidate that changes the outputs.
    ResponseId;
    /// An effect of those that a hypothesis holds together, or that were accepted.
    EffectId;
    /// A hypothesis of those that were fitted in full.
    FittedId;
}
