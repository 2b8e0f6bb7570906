//! Thin solids and the mid-surfaces that they become.

mod collars;
mod corners;
mod divided;
mod embossed;
mod features;
mod flush;
mod folded;
mod lumps;
mod plates;
mod rim_support;
mod rims;
mod rounded_files;
mod shells;
mod sides;
mod solid_models;
mod support;
mod whole;
