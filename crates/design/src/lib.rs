//! The document: reference, template and pieces; the regenerate pipeline and its reports.
