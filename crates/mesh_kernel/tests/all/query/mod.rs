//! Questions put to a mesh: closest points, crossings, sections, geodesics.

mod closest;
mod crossing;
mod geodesic;
mod reference;
mod section;
mod signed;
