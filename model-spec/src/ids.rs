//! Which one of a model's lists is meant: an index with a type of its own for every list, so
//! that none is taken for another.

/// Defines ids: indices from 0, each into lists of one kind of thing.
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
            /// The one that stands there, from 0.
            pub const fn new(index: usize) -> Self {
                Self(index)
            }

            /// Where it stands, from 0.
            pub const fn index(self) -> usize {
                self.0
            }

            /// So many, in order.
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
    /// One of [`Model::parameters`](crate::model::Model::parameters).
    ParameterId;
    /// One of [`Model::coordinates`](crate::model::Model::coordinates).
    CoordinateId;
    /// One of [`Model::inputs`](crate::model::Model::inputs).
    InputId;
    /// One of [`Model::states`](crate::model::Model::states).
    StateId;
    /// One of [`Model::constraints`](crate::model::Model::constraints).
    ConstraintId;
    /// One of [`Model::fields`](crate::model::Model::fields).
    FieldId;
    /// One of [`Model::observables`](crate::model::Model::observables).
    ObservableId;
    /// One of [`Drawing::points`](crate::model::Drawing::points).
    PointId;
    /// One of [`Model::definitions`](crate::model::Model::definitions).
    DefinitionId;
    /// One of [`Model::coefficients`](crate::model::Model::coefficients).
    CoefficientId;
    /// One of [`RigidTree::frames`](crate::rigid_tree::RigidTree::frames).
    FrameId;
}
