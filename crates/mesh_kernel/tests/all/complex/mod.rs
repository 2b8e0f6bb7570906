//! The complex with wires and regions of Lee and Kim.

mod examples;
mod faces;
mod lee_kim;
mod operators;
mod random;
mod random_sequences;
mod support;
