//! Dress forms from tape measurements.
