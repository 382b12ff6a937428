//! Ids that cannot be mixed up: a vertex id is not a cell id.

macro_rules! id {
    ($name:ident, $what:literal) => {
        #[doc = concat!("The number of ", $what, ", counted from 0 in the order of the mesh.")]
        #[repr(transparent)]
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name(u32);

        impl $name {
            /// The id of number `index`.
            ///
            /// # Panics
            /// If `index` does not fit 32 bits; meshes are refused before that by the readers.
            #[inline]
            pub fn new(index: usize) -> Self {
                debug_assert!(u32::try_from(index).is_ok(), "id {index} does not fit 32 bits");
                Self(index as u32)
            }

            /// The number, to index arrays with.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }

            /// The number as stored.
            #[inline]
            pub fn raw(self) -> u32 {
                self.0
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}", self.0)
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}", self.0)
            }
        }

        impl From<u32> for $name {
            fn from(index: u32) -> Self {
                Self(index)
            }
        }
    };
}

id!(VertexId, "a vertex");
id!(EdgeId, "an edge");
id!(CellId, "a cell (a triangle of a surface, a tetrahedron of a volume)");
