//! Sewing patterns: flattening, pieces, allowances, notches, DXF, SVG, PDF.
