//! Reading and writing mesh files.

mod formats;
mod obj;
mod place;
mod reference;
mod sets;
