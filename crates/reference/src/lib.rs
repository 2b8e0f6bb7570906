//! Reference models: meshes with semantic features; human feature extraction; dress forms.
//!
//! * [`model`]: what a reference model *is*: a mesh with named feature curves and points and their frames;
//! * [`human`]: features of human bodies found from geometry alone;
//! * [`dress_form`]: dress forms made from tape measurements.

pub mod dress_form;
pub mod human;
pub mod model;

pub use model::{FeatureCurve, FeaturePoint, Features, Frame};
