//! Fairing: the smoothest surface through what is fixed (T5).
//!
//! * [`umbrella`]: the paper's iteration, the damped second-order umbrella, and the limit that it runs to;
//! * [`plate`]: the default, a thin plate whose stencils know the sizes of triangles, solved by one sparse
//!   factorisation ([`factor`]) that is kept as long as connectivity and weights stay.

pub mod factor;
mod ordering;
pub mod plate;
pub mod umbrella;

pub use factor::{FactorError, SparseFactor, SymmetricPattern};
pub use plate::{Flap, Plate, flaps};
pub use umbrella::Umbrella;
