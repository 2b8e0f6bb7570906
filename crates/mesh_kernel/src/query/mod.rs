//! Geometric queries on triangle meshes.
