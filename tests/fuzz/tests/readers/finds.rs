//! What fuzzing found, a test each.
