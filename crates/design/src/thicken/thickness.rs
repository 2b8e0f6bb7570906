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

    /// What it means on a sheet. The sheet comes back as it is thickened: its patches have nodes of their own where that
    /// lets the thickness step from one to the next.
    pub(super) fn on(&self, sheet: &TriMesh) -> Result<(TriMesh, Thickness), ThicknessError> {
        match self {
            Self::Patches { elsewhere: Some(all), named } if named.is_empty() => {
                Ok((sheet.clone(), Thickness::Constant(*all)))
            }
            Self::Patches { elsewhere, named } => {
                Ok((sheet.clone(), Thickness::PerPatch(by_name(sheet, *elsewhere, named)?)))
            }
            Self::Listed(list) => by_list(sheet, list),
        }
    }
}

fn by_name(
    sheet: &TriMesh,
    elsewhere: Option<f64>,
    named: &[(String, f64)],
) -> Result<Vec<f64>, ThicknessError> {
    let names = patch_names(sheet);
    if let Some((name, _)) = named.iter().find(|(name, _)| !names.contains(name)) {
        let known = listed(&names);
        return Err(ThicknessError::NoSuchPatch { name: name.clone(), known });
    }
    let of = |patch: &String| {
        let own = named.iter().rev().find(|(name, _)| name == patch).map(|(_, t)| *t);
        own.or(elsewhere).ok_or_else(|| ThicknessError::NotSaid { name: patch.clone() })
    };
    names.iter().map(of).collect()
}

fn by_list(sheet: &TriMesh, list: &[f64]) -> Result<(TriMesh, Thickness), ThicknessError> {
    if let Some(place) = list.iter().position(|t| !(t.is_finite() && *t > 0.0)) {
        return Err(ThicknessError::NotPositive { place: place + 1, value: list[place] });
    }
    let (faces, nodes) = (sheet.faces.len(), sheet.positions.len());
    // Of a list that fits both, triangles are meant: such lists come with the sheets of solids.
    if list.len() == faces {
        let parted = parted_by_patch(sheet);
        let means = means_at_nodes(&parted, list);
        Ok((parted, Thickness::PerNode(means)))
    } else if list.len() == nodes {
        Ok((sheet.clone(), Thickness::PerNode(list.to_vec())))
    } else {
        Err(ThicknessError::ListLength { numbers: list.len(), faces, nodes })
    }
}

/// The sheet with nodes of its own for every patch.
fn parted_by_patch(sheet: &TriMesh) -> TriMesh {
    const NONE: u32 = u32::MAX;
    let mut parted = TriMesh { positions: Vec::with_capacity(sheet.positions.len()), ..sheet.clone() };
    let mut patch_of_face = vec![0; sheet.faces.len()];
    for (patch, group) in (1u32..).zip(&sheet.groups) {
        patch_of_face[group.faces.start as usize..group.faces.end as usize].fill(patch);
    }
    // A patch's faces are in a row, so the last copy of a node is the right one or of another patch.
    let mut copies = vec![(NONE, 0); sheet.positions.len()];
    for (face, patch) in parted.faces.iter_mut().zip(patch_of_face) {
        for v in face {
            let copy = &mut copies[*v as usize];
            if copy.0 != patch {
                *copy = (patch, parted.positions.len() as u32);
                parted.positions.push(sheet.positions[*v as usize]);
            }
            *v = copy.1;
        }
    }
    parted
}

/// Means of the numbers of the triangles at every node, by area.
fn means_at_nodes(sheet: &TriMesh, list: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); sheet.positions.len()];
    for (f, (face, t)) in (0..).zip(sheet.faces.iter().zip(list)) {
        // Triangles without area are not thickened, but their nodes want a number too.
        let area = sheet.area_normal(f).length().max(f64::MIN_POSITIVE);
        for &v in face {
            let (sum, weight) = &mut sums[v as usize];
            *sum += t * area;
            *weight += area;
        }
    }
    sums.into_iter().map(|(sum, weight)| sum / weight).collect()
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
pub(super) fn listed(names: &[String]) -> String {
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
        wish.on(sheet).map(|(_, thickness)| thickness)
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
    fn a_list_a_triangle_is_a_mean_inside_a_patch_and_a_step_between_two() {
        let wish = ThicknessWish::Listed(vec![1.0, 2.0]);
        let (parted, thickness) = wish.on(&pair()).unwrap();
        assert_eq!(parted.faces, [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(
            (0..2).map(|f| parted.corners(f)).collect::<Vec<_>>(),
            [pair().corners(0), pair().corners(1)]
        );
        assert_eq!(thickness, Thickness::PerNode(vec![1.0, 1.0, 1.0, 2.0, 2.0, 2.0]));
        let one = TriMesh { groups: Vec::new(), ..pair() };
        // The lower triangle has three times the area.
        assert_eq!(on(&wish, &one), Ok(Thickness::PerNode(vec![1.75, 1.75, 1.0, 2.0])));
    }

    #[test]
    fn a_list_a_node_is_taken_as_it_is() {
        let wish = ThicknessWish::Listed(vec![1.0, 2.0, 3.0, 5.0]);
        assert_eq!(on(&wish, &pair()), Ok(Thickness::PerNode(vec![1.0, 2.0, 3.0, 5.0])));
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
