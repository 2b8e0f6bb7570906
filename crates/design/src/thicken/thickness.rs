//! How thick: the same everywhere, by the names of patches, or from a list.

use mesh_kernel::TriMesh;
use sheet::thicken::Thickness;

/// How thick, as somebody says it before the sheet is known. Millimetres.
#[derive(Clone, Debug, PartialEq)]
pub enum ThicknessWish {
    /// By patch.
    Patches {
        /// Where nothing else is said.
        elsewhere: Option<f64>,
        /// Names of patches and their thicknesses; of two for the same patch the later holds.
        named: Vec<(String, f64)>,
    },
    /// A number a triangle of the file, or a number a node.
    Listed(Vec<f64>),
}

/// Why thicknesses do not fit a sheet.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThicknessError {
    /// There is no such patch.
    #[error("there is no patch {name:?}; the sheet has {known}")]
    NoSuchPatch {
        /// The name given.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// Nothing is said about a patch.
    #[error("nothing says how thick the patch {name:?} shall be")]
    NotSaid {
        /// The patch.
        name: String,
    },
    /// A list of another length.
    #[error(
        "the list has {numbers} thicknesses, but the sheet has {faces} triangles and {nodes} nodes: it takes one for each of either"
    )]
    ListLength {
        /// Numbers in the list.
        numbers: usize,
        /// Triangles of the file.
        faces: usize,
        /// Nodes of the file.
        nodes: usize,
    },
    /// A number that is no thickness.
    #[error("number {place} of the list is {value}: a thickness is larger than 0")]
    NotPositive {
        /// Which one, counted from 1.
        place: usize,
        /// The number.
        value: f64,
    },
    /// The list cannot be read.
    #[error("not a JSON list of numbers: {0}")]
    NoList(String),
}

/// Reads a list of thicknesses: JSON, `[2, 2.5, …]`.
///
/// # Errors
/// [`ThicknessError::NoList`].
pub fn list_from_json(text: &str) -> Result<Vec<f64>, ThicknessError> {
    let read: Result<Vec<f64>, serde_json::Error> = serde_json::from_str(text);
    // A message of JSON may quote from the file.
    read.map_err(|e| ThicknessError::NoList(e.to_string().chars().take(300).collect()))
}

impl ThicknessWish {
    /// The largest thickness that is asked for; 0 where none is.
    pub(super) fn thickest(&self) -> f64 {
        match self {
            Self::Patches { elsewhere, named } => {
                named.iter().map(|n| n.1).chain(*elsewhere).fold(0.0, f64::max)
            }
            Self::Listed(list) => list.iter().copied().fold(0.0, f64::max),
        }
    }

    /// What it means on a sheet whose file's nodes have become `node_of`.
    pub(super) fn on(&self, sheet: &TriMesh, node_of: &[u32]) -> Result<Thickness, ThicknessError> {
        match self {
            Self::Patches { elsewhere: Some(all), named } if named.is_empty() => {
                Ok(Thickness::Constant(*all))
            }
            Self::Patches { elsewhere, named } => by_name(sheet, *elsewhere, named),
            Self::Listed(list) => by_list(sheet, node_of, list),
        }
    }
}

fn by_name(
    sheet: &TriMesh,
    elsewhere: Option<f64>,
    named: &[(String, f64)],
) -> Result<Thickness, ThicknessError> {
    let names = patch_names(sheet);
    if let Some((name, _)) = named.iter().find(|(name, _)| !names.contains(name)) {
        let known = listed(&names);
        return Err(ThicknessError::NoSuchPatch { name: name.clone(), known });
    }
    let of = |patch: &String| {
        let own = named.iter().rev().find(|(name, _)| name == patch).map(|(_, t)| *t);
        own.or(elsewhere).ok_or_else(|| ThicknessError::NotSaid { name: patch.clone() })
    };
    let all = names.iter().map(of).collect::<Result<Vec<f64>, ThicknessError>>()?;
    Ok(Thickness::PerPatch(all))
}

fn by_list(sheet: &TriMesh, node_of: &[u32], list: &[f64]) -> Result<Thickness, ThicknessError> {
    if let Some(place) = list.iter().position(|t| !(t.is_finite() && *t > 0.0)) {
        return Err(ThicknessError::NotPositive { place: place + 1, value: list[place] });
    }
    let (faces, nodes) = (sheet.faces.len(), node_of.len());
    // Of a list that fits both, triangles are meant: such lists come with the sheets of solids.
    if list.len() == faces {
        return Ok(per_patch(sheet, list).unwrap_or_else(|| per_node(sheet, list)));
    }
    if list.len() != nodes {
        return Err(ThicknessError::ListLength { numbers: list.len(), faces, nodes });
    }
    let mut sums = vec![(0.0, 0.0); sheet.positions.len()];
    for (&node, t) in node_of.iter().zip(list) {
        add(&mut sums[node as usize], *t, 1.0);
    }
    Ok(Thickness::PerNode(means(&sums, list)))
}

/// One number a patch, where the list has the same for all triangles of it.
fn per_patch(sheet: &TriMesh, list: &[f64]) -> Option<Thickness> {
    let of = |faces: &std::ops::Range<u32>| {
        let own = &list[faces.start as usize..faces.end as usize];
        own.windows(2).all(|w| w[0] == w[1]).then(|| own.first().copied().unwrap_or(list[0]))
    };
    let ranges: Vec<std::ops::Range<u32>> = if sheet.groups.is_empty() {
        vec![0..sheet.faces.len() as u32]
    } else {
        sheet.groups.iter().map(|g| g.faces.clone()).collect()
    };
    ranges.iter().map(of).collect::<Option<Vec<f64>>>().map(Thickness::PerPatch)
}

/// Means over the triangles of every node, by area.
fn per_node(sheet: &TriMesh, list: &[f64]) -> Thickness {
    let mut sums = vec![(0.0, 0.0); sheet.positions.len()];
    for (f, (face, t)) in (0..).zip(sheet.faces.iter().zip(list)) {
        let area = sheet.area_normal(f).length();
        face.iter().for_each(|&v| add(&mut sums[v as usize], *t, area));
    }
    Thickness::PerNode(means(&sums, list))
}

fn add(sum: &mut (f64, f64), value: f64, weight: f64) {
    sum.0 += value * weight;
    sum.1 += weight;
}

/// Weighted means; nodes without a triangle get a thickness too, which nothing asks for.
fn means(sums: &[(f64, f64)], list: &[f64]) -> Vec<f64> {
    let any = list.first().copied().unwrap_or(1.0);
    sums.iter().map(|(sum, weight)| if *weight > 0.0 { sum / weight } else { any }).collect()
}

/// Names of the patches; the one of a sheet without groups is nameless.
pub(super) fn patch_names(sheet: &TriMesh) -> Vec<String> {
    if sheet.groups.is_empty() {
        vec![String::new()]
    } else {
        sheet.groups.iter().map(|g| g.name.clone()).collect()
    }
}

/// Names for a message, the first few of many.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 12;
    if names.iter().all(String::is_empty) {
        return "one patch without a name".to_owned();
    }
    let shown: Vec<String> = names.iter().take(SHOWN).map(|n| format!("{n:?}")).collect();
    let more = names.len().saturating_sub(SHOWN);
    shown.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::Group;
    use mesh_kernel::glam::DVec3;

    /// Two triangles of unequal area that share the edge 0–1, a patch each.
    fn pair() -> TriMesh {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, -3.0 * DVec3::Y];
        let mut mesh = TriMesh::new(positions, vec![[0, 1, 2], [1, 0, 3]]);
        let group = |name: &str, f: u32| Group { name: name.into(), faces: f..f + 1 };
        mesh.groups = vec![group("upper", 0), group("lower", 1)];
        mesh
    }

    fn on(wish: &ThicknessWish, sheet: &TriMesh) -> Result<Thickness, ThicknessError> {
        wish.on(sheet, &(0..sheet.positions.len() as u32).collect::<Vec<_>>())
    }

    #[test]
    fn patches_by_name_and_the_rest_as_elsewhere() {
        let named = vec![("lower".to_owned(), 3.0)];
        let wish = ThicknessWish::Patches { elsewhere: Some(2.0), named: named.clone() };
        assert_eq!(on(&wish, &pair()), Ok(Thickness::PerPatch(vec![2.0, 3.0])));
        let wish = ThicknessWish::Patches { elsewhere: None, named };
        assert_eq!(on(&wish, &pair()), Err(ThicknessError::NotSaid { name: "upper".into() }));
        let wish = ThicknessWish::Patches { elsewhere: Some(1.0), named: vec![("sleeve".into(), 1.0)] };
        let told = on(&wish, &pair()).unwrap_err().to_string();
        assert!(told.contains("\"sleeve\"") && told.contains("\"upper\", \"lower\""), "{told}");
    }

    #[test]
    fn a_list_a_triangle_is_a_step_between_patches_or_a_mean_inside_one() {
        let wish = ThicknessWish::Listed(vec![1.0, 2.0]);
        assert_eq!(on(&wish, &pair()), Ok(Thickness::PerPatch(vec![1.0, 2.0])));
        let one = TriMesh { groups: Vec::new(), ..pair() };
        // The lower triangle has three times the area.
        assert_eq!(on(&wish, &one), Ok(Thickness::PerNode(vec![1.75, 1.75, 1.0, 2.0])));
    }

    #[test]
    fn a_list_a_node_follows_the_nodes_that_became_one() {
        let wish = ThicknessWish::Listed(vec![1.0, 2.0, 3.0, 5.0]);
        assert_eq!(on(&wish, &pair()), Ok(Thickness::PerNode(vec![1.0, 2.0, 3.0, 5.0])));
        let mut tip = pair();
        tip.positions.pop();
        tip.faces[1] = [1, 0, 2];
        assert_eq!(wish.on(&tip, &[0, 1, 2, 2]), Ok(Thickness::PerNode(vec![1.0, 2.0, 4.0])));
    }

    #[test]
    fn lists_that_are_none_are_refused_in_words() {
        let refused = |list: &[f64]| on(&ThicknessWish::Listed(list.to_vec()), &pair()).unwrap_err();
        assert_eq!(refused(&[1.0]), ThicknessError::ListLength { numbers: 1, faces: 2, nodes: 4 });
        assert_eq!(refused(&[1.0, 0.0]), ThicknessError::NotPositive { place: 2, value: 0.0 });
        for text in ["", "{}", "[1, \"thick\"]", "[1, NaN]", "[1e999]", "[1"] {
            assert!(list_from_json(text).unwrap_err().to_string().contains("JSON list"), "{text}");
        }
        assert_eq!(list_from_json("[1, 2.5]"), Ok(vec![1.0, 2.5]));
    }
}
