//! Pictures of models and patterns without GPU or display.
