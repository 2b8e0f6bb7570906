//! Mid-surfaces for ParaView and others: legacy VTK, text.

use std::fmt::Write;

use mesh_kernel::TriMesh;

/// The bytes of a file with the triangles, their thickness in mm and the number of their patch, from 1. Coordinates in mm.
pub(super) fn to_bytes(sheet: &TriMesh, thickness: &[f64]) -> Vec<u8> {
    let faces = sheet.faces.len();
    let mut text = String::from("# vtk DataFile Version 3.0\nmid-surface [mm]\nASCII\nDATASET POLYDATA\n");
    // Writing to a string does not fail.
    let _ = writeln!(text, "POINTS {} double", sheet.positions.len());
    for p in &sheet.positions {
        let _ = writeln!(text, "{} {} {}", p.x, p.y, p.z);
    }
    let _ = writeln!(text, "POLYGONS {faces} {}", 4 * faces);
    for [a, b, c] in &sheet.faces {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    let _ = writeln!(text, "CELL_DATA {faces}\nSCALARS thickness double 1\nLOOKUP_TABLE default");
    for t in thickness {
        let _ = writeln!(text, "{t}");
    }
    text.push_str("SCALARS patch int 1\nLOOKUP_TABLE default\n");
    for (number, group) in (1..).zip(&sheet.groups) {
        for _ in group.faces.clone() {
            let _ = writeln!(text, "{number}");
        }
    }
    text.into_bytes()
}
