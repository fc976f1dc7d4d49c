//! Typed indices into the lists of a model: the compiler rejects an index into the wrong list.

/// Defines id types: indices from 0, one type for each kind of list.
///
/// ```
/// eomgen_model_spec::ids! {
///     /// A wheel.
///     WheelId;
/// }
///
/// let radii = vec![0.3, 0.4];
/// let last = WheelId::first(radii.len()).last().unwrap();
/// assert_eq!((radii[last], last.index()), (0.4, 1));
/// ```
#[macro_export]
macro_rules! ids {
    ($($(#[$documentation:meta])* $id:ident;)*) => {$(
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $id(usize);

        impl $id {
            /// Creates an id from an index, from 0.
            pub const fn new(index: usize) -> Self {
                Self(index)
            }

            /// Returns the index, from 0.
            pub const fn index(self) -> usize {
                self.0
            }

            /// Returns the ids `0..count`, in order.
            pub fn first(count: usize) -> impl DoubleEndedIterator<Item = Self> + Clone {
                (0..count).map(Self)
            }
        }

        impl<T> ::std::ops::Index<$id> for [T] {
            type Output = T;

            fn index(&self, id: $id) -> &T {
                &self[id.0]
            }
        }

        impl<T> ::std::ops::IndexMut<$id> for [T] {
            fn index_mut(&mut self, id: $id) -> &mut T {
                &mut self[id.0]
            }
        }

        impl<T> ::std::ops::Index<$id> for Vec<T> {
            type Output = T;

            fn index(&self, id: $id) -> &T {
                &self[id.0]
            }
        }

        impl<T> ::std::ops::IndexMut<$id> for Vec<T> {
            fn index_mut(&mut self, id: $id) -> &mut T {
                &mut self[id.0]
            }
        }
    )*};
}

ids! {
    /// Index into [`Model::parameters`](crate::model::Model::parameters).
    ParameterId;
    /// Index into [`Model::coordinates`](crate::model::Model::coordinates).
    CoordinateId;
    /// Index into [`Model::inputs`](crate::model::Model::inputs).
    InputId;
    /// Index into [`Model::states`](crate::model::Model::states).
    StateId;
    /// Index into [`Model::constraints`](crate::model::Model::constraints).
    ConstraintId;
    /// Index into [`Model::fields`](crate::model::Model::fields).
    FieldId;
    /// Index into [`Model::observables`](crate::model::Model::observables).
    ObservableId;
    /// Index into [`Drawing::points`](crate::model::Drawing::points).
    PointId;
    /// Index into [`Model::definitions`](crate::model::Model::definitions).
    DefinitionId;
    /// Index into [`Model::coefficients`](crate::model::Model::coefficients).
    CoefficientId;
    /// Index into [`RigidTree::frames`](crate::rigid_tree::RigidTree::frames).
    FrameId;
}
