//! The radial-edge body: operators, journal, file.

mod build;
mod collapse;
mod counts;
mod edit;
mod euler;
mod file;
mod journal;
mod operations;
mod pairing;
mod pairing_support;
mod radial;
mod random;
mod sequences;
mod sheets;
mod soup;
mod support;
mod triangulate;
