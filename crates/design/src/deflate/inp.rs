//! Shell models in the input format that Abaqus and CalculiX share.

use std::fmt::Write;

use mesh_kernel::TriMesh;

use super::elements::quadratic;

/// Which shell elements are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Element {
    /// Triangles with nodes in the middle of their sides. (`STRI65` is Abaqus' name; both read `S6` in CalculiX.)
    #[default]
    S6,
    /// Triangles with corner nodes only; much too stiff in bending unless the mesh is very fine.
    S3,
}

/// How the thickness is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sections {
    /// A section for every thickness.
    #[default]
    ByThickness,
    /// One section; a thickness at every node, the mean of the elements about it.
    Nodal,
}

/// What a shell model is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InpOptions {
    /// The elements.
    pub element: Element,
    /// The thickness.
    pub sections: Sections,
    /// Young's modulus in MPa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Default for InpOptions {
    /// Steel.
    fn default() -> Self {
        Self { element: Element::default(), sections: Sections::default(), young: 210_000.0, poisson: 0.3 }
    }
}

/// Thicknesses that differ by less than this share of the thickest are one section.
const SAME_SECTION: f64 = 1e-4;

/// The bytes of a model in N, mm, MPa: nodes, an element set a patch and a section, a material. Supports, loads and steps are
/// the analyst's.
pub(super) fn to_bytes(sheet: &TriMesh, thickness: &[f64], options: &InpOptions) -> Vec<u8> {
    let quadratic = quadratic(sheet);
    let (nodes, kind) = match options.element {
        Element::S6 => (quadratic.positions.len(), "S6"),
        Element::S3 => (sheet.positions.len(), "S3"),
    };
    let mut text = String::from("** mid-surface: N, mm, MPa\n*NODE, NSET=NALL\n");
    // Writing to a string does not fail.
    for (k, p) in quadratic.positions[..nodes].iter().enumerate() {
        let _ = writeln!(text, "{}, {}, {}, {}", k + 1, number(p.x), number(p.y), number(p.z));
    }
    let _ = writeln!(text, "*ELEMENT, TYPE={kind}, ELSET=EALL");
    for (f, element) in quadratic.elements.iter().enumerate() {
        let corners = if options.element == Element::S6 { &element[..] } else { &element[..3] };
        let _ = write!(text, "{}", f + 1);
        for v in corners {
            let _ = write!(text, ", {}", v + 1);
        }
        text.push('\n');
    }
    for group in &sheet.groups {
        let _ = writeln!(text, "*ELSET, ELSET={}", group.name.to_ascii_uppercase());
        list(&mut text, group.faces.clone().map(|f| f + 1));
    }
    let _ = write!(
        text,
        "*MATERIAL, NAME=SHEET\n*ELASTIC\n{}, {}\n",
        number(options.young),
        number(options.poisson)
    );
    match options.sections {
        Sections::ByThickness => sections(&mut text, thickness),
        Sections::Nodal => {
            let at_nodes = nodal(sheet, thickness);
            let _ = writeln!(text, "*SHELL SECTION, ELSET=EALL, MATERIAL=SHEET, NODAL THICKNESS");
            let _ = writeln!(text, "{}", number(thickness.iter().copied().fold(0.0, f64::max)));
            text.push_str("*NODAL THICKNESS\n");
            for (k, t) in at_nodes.iter().enumerate() {
                let _ = writeln!(text, "{}, {}", k + 1, number(*t));
            }
            if options.element == Element::S6 {
                for (k, [a, b]) in quadratic.edges.iter().enumerate() {
                    let t = (at_nodes[*a as usize] + at_nodes[*b as usize]) / 2.0;
                    let _ = writeln!(text, "{}, {}", sheet.positions.len() + k + 1, number(t));
                }
            }
        }
    }
    text.into_bytes()
}

/// An element set and a section for every thickness, the thinnest first.
fn sections(text: &mut String, thickness: &[f64]) {
    let thickest = thickness.iter().copied().fold(0.0, f64::max);
    let mut order: Vec<u32> = (0..thickness.len() as u32).collect();
    order.sort_by(|a, b| thickness[*a as usize].total_cmp(&thickness[*b as usize]).then(a.cmp(b)));
    let mut from = 0;
    let mut count = 0;
    while from < order.len() {
        let first = thickness[order[from] as usize];
        let within = |f: &u32| thickness[*f as usize] - first <= SAME_SECTION * thickest;
        let to = from + order[from..].partition_point(within);
        count += 1;
        let mut elements: Vec<u32> = order[from..to].iter().map(|f| f + 1).collect();
        let mean = order[from..to].iter().map(|f| thickness[*f as usize]).sum::<f64>() / (to - from) as f64;
        elements.sort_unstable();
        let _ = writeln!(text, "*ELSET, ELSET=THICKNESS_{count}");
        list(text, elements.into_iter());
        let _ = writeln!(text, "*SHELL SECTION, ELSET=THICKNESS_{count}, MATERIAL=SHEET\n{}", number(mean));
        from = to;
    }
}

/// Means of the elements about every corner node.
fn nodal(sheet: &TriMesh, thickness: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); sheet.positions.len()];
    for (f, face) in (0..).zip(&sheet.faces) {
        let area = sheet.area_normal(f).length();
        for v in face {
            let sum = &mut sums[*v as usize];
            sum.0 += area * thickness[f as usize];
            sum.1 += area;
        }
    }
    sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { 0.0 }).collect()
}

/// Numbers as members of a set, sixteen a line.
fn list(text: &mut String, numbers: impl Iterator<Item = u32>) {
    let numbers: Vec<String> = numbers.map(|n| n.to_string()).collect();
    for line in numbers.chunks(16) {
        text.push_str(&line.join(", "));
        text.push_str(",\n");
    }
}

/// Twelve digits, with a point: a whole number would be read as one by some.
fn number(x: f64) -> String {
    format!("{x:.11e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::Group;
    use mesh_kernel::glam::DVec3;

    fn square() -> TriMesh {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mut mesh = TriMesh::new(positions, vec![[0, 1, 2], [0, 2, 3]]);
        mesh.groups = vec![Group { name: "patch_1".into(), faces: 0..2 }];
        mesh
    }

    #[test]
    fn triangles_share_the_middle_of_their_edge() {
        let text = String::from_utf8(to_bytes(&square(), &[2.0, 2.0], &InpOptions::default())).unwrap();
        let elements: Vec<&str> =
            text.lines().skip_while(|l| !l.starts_with("*ELEMENT")).skip(1).take(2).collect();
        let numbers = |line: &str| -> Vec<u32> { line.split(", ").map(|n| n.parse().unwrap()).collect() };
        let (a, b) = (numbers(elements[0]), numbers(elements[1]));
        // Node 0–2 is the last side of the first and the first side of the second.
        assert_eq!(a[6], b[4]);
        assert_eq!(text.matches("*SHELL SECTION").count(), 1);
    }

    #[test]
    fn a_section_a_thickness_or_a_thickness_a_node() {
        let text = String::from_utf8(to_bytes(&square(), &[2.0, 3.0], &InpOptions::default())).unwrap();
        assert_eq!(text.matches("*SHELL SECTION").count(), 2);
        let nodal = InpOptions { sections: Sections::Nodal, element: Element::S3, ..InpOptions::default() };
        let text = String::from_utf8(to_bytes(&square(), &[2.0, 3.0], &nodal)).unwrap();
        assert!(text.contains("*NODAL THICKNESS\n1, 2.50000000000e0\n2, 2.00000000000e0\n"));
    }
}
