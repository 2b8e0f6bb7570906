//! Reading and writing mesh files.

mod formats;
mod obj;
mod reference;
mod sets;
