//! Features of human bodies from geometry alone.
