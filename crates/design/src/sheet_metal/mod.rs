//! Sheet metal: a sheet's file to the reports and drawings of bends, welds and flat plates.
//!
//! The work is [`mod@sheet::bends`]'s and [`mod@sheet::unfold`]'s; here are units, names for people, files.

mod bends;
mod drawing;
mod solid;
mod unfold;

pub use bends::{AssignmentReport, BendReport, BendsFileReport, LineReport, WeldReport, bends};
pub use solid::{SolidError, mid_surface};
pub use unfold::{PlateReport, UnfoldFileReport, UnfoldedFile, unfold};

use mesh_kernel::TriMesh;
use mesh_kernel::complex::SheetPlan;
use serde::Serialize;
use sheet::facets::{FacetError, FacetRule, FacetSheet};

/// Millimetres in one unit of a sheet, and which faces are a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetReading {
    /// Millimetres in one unit of the coordinates.
    pub unit: f64,
    /// What is one facet.
    pub rule: FacetRule,
}

/// A kind of drawing that plates are written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingFormat {
    /// DXF, release 12.
    Dxf,
    /// SVG.
    Svg,
}

/// The operators that build a part: `P · M⁻¹`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub struct OperatorCounts {
    /// Vertex components.
    pub mcv: i64,
    /// Edges with a vertex.
    pub mev: i64,
    /// Edges with a facet.
    pub mef: i64,
    /// Bends that make a hole of a ring.
    pub mgb: i64,
    /// Free edges to bends.
    pub mbke: i64,
    /// Free edges united to close a volume.
    pub muke: i64,
    /// Bends to welds.
    pub mwkb: i64,
}

impl From<SheetPlan> for OperatorCounts {
    fn from(p: SheetPlan) -> Self {
        Self { mcv: p.mcv, mev: p.mev, mef: p.mef, mgb: p.mgb, mbke: p.mbke, muke: p.muke, mwkb: p.mwkb }
    }
}

/// A mesh in millimetres as facets.
fn facets(mesh: &TriMesh, reading: &SheetReading) -> Result<FacetSheet, FacetError> {
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p *= reading.unit);
    FacetSheet::new(&mesh, reading.rule)
}

/// Name of a line in reports and drawings, counted from 1.
fn line_name(line: u32) -> String {
    format!("L{}", line + 1)
}

/// Curved facets, by name, in words.
fn curved(sheet: &FacetSheet) -> Option<String> {
    let names: Vec<&str> = sheet.facets.iter().filter(|f| !f.plane).map(|f| f.name.as_str()).collect();
    const SHOWN: usize = 5;
    if names.is_empty() {
        return None;
    }
    let more = if names.len() > SHOWN { format!(" and {} more", names.len() - SHOWN) } else { String::new() };
    Some(format!(
        "not plane, and counted as one facet each: {}{more}; --facets planes cuts them into plane ones",
        names[..names.len().min(SHOWN)].join(", ")
    ))
}
