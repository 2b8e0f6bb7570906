//! Reference models: meshes with semantic features; human feature extraction; dress forms.
//!
//! * [`model`]: what a reference model *is*: a mesh with named feature curves and points and their frames.

pub mod model;

pub use model::{FeatureCurve, FeaturePoint, Features, Frame};
