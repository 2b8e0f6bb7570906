//! Which side of every face is the front of the sheet, for thickening to one side (Lee & Kim 2001, section 6).

use glam::DVec3;

use super::ThickenError;
use super::clean_sheet::CleanSheet;
use super::entities::{Entities, face_of, next, use_of};

/// For every face whether it is wound against the rest of its connected part, so that its back is the sheet's front.
///
/// In every connected part the front is the side that more of its faces name, where they disagree.
///
/// # Errors
/// [`ThickenError::NonManifold`] where more than two faces meet at an edge or fans of faces at a node;
/// [`ThickenError::NotOrientable`] where a part has one side only. O(n).
pub(super) fn turned_faces(sheet: &CleanSheet, entities: &Entities) -> Result<Vec<bool>, ThickenError> {
    if let Some(joint) = entities.joints.first() {
        return Err(non_manifold(sheet, joint));
    }
    let mut turned: Vec<Option<bool>> = vec![None; sheet.faces.len()];
    let (mut part, mut result) = (Vec::new(), vec![false; sheet.faces.len()]);
    for seed in 0..sheet.faces.len() {
        if turned[seed].is_some() {
            continue;
        }
        turned[seed] = Some(false);
        part.clear();
        part.push(seed);
        let (mut done, mut against) = (0, 0);
        while let Some(&f) = part.get(done) {
            done += 1;
            let own = turned[f] == Some(true);
            against += usize::from(own);
            for edge_use in 6 * f as u32..6 * f as u32 + 3 {
                if entities.is_sharp(edge_use) {
                    continue;
                }
                let mate = entities.mate[edge_use as usize];
                let g = face_of(mate);
                let wanted = own ^ !use_of(mate).is_multiple_of(2);
                match turned[g] {
                    None => {
                        turned[g] = Some(wanted);
                        part.push(g);
                    }
                    Some(found) if found != wanted => {
                        return Err(ThickenError::NotOrientable {
                            patches: sheet.patches_of([f, g]),
                            at: middle(sheet, entities, edge_use),
                        });
                    }
                    Some(_) => {}
                }
            }
        }
        let other_side = 2 * against > part.len();
        for &f in &part {
            result[f] = (turned[f] == Some(true)) != other_side;
        }
    }
    Ok(result)
}

fn middle(sheet: &CleanSheet, entities: &Entities, edge_use: u32) -> DVec3 {
    let [a, b] = [edge_use, next(edge_use)].map(|c| sheet.positions[entities.node[c as usize] as usize]);
    0.5 * (a + b)
}

/// The refusal at a joint: its middle is that of the nodes which all its faces share.
fn non_manifold(sheet: &CleanSheet, joint: &[u32]) -> ThickenError {
    let mut faces: Vec<usize> = joint.iter().map(|&f| f as usize).collect();
    faces.sort_unstable();
    faces.dedup();
    let shared: Vec<DVec3> = sheet.faces[faces[0]]
        .iter()
        .filter(|v| faces.iter().all(|&f| sheet.faces[f].contains(v)))
        .map(|&v| sheet.positions[v as usize])
        .collect();
    let at = shared.iter().sum::<DVec3>() / shared.len().max(1) as f64;
    ThickenError::NonManifold { patches: sheet.patches_of(faces.iter().copied()), at, faces: faces.len() }
}
