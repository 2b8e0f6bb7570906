//! Deleting what is selected.

use design::draft::Edit;

use crate::designer::Designer;
use crate::selection::Element;

impl Designer {
    /// Deletes what is selected: several things are one entry of the history.
    pub(crate) fn delete(&mut self) {
        let mut edits = Vec::new();
        let mut faces: Vec<(String, usize)> = Vec::new();
        for element in &self.session.selection.elements {
            match element {
                Element::Node(name) => edits.push(Edit::DeleteNode { name: name.clone() }),
                Element::Edge(ends) => edits.push(match self.line_on(ends) {
                    Some(name) => Edit::DeleteProfile { name },
                    None => Edit::DeleteEdge { from: ends[0].clone(), to: ends[1].clone() },
                }),
                Element::Face { surface, face } => faces.push((surface.clone(), *face)),
                Element::Joint(_) => {
                    return self.problem(
                        "joints go with the edges that surfaces share; split them in the inspector",
                    );
                }
            }
        }
        // The last first, so that the numbers of the others stay.
        faces.sort();
        edits.extend(faces.into_iter().rev().map(|(surface, face)| Edit::DeleteFace { surface, face }));
        match edits.len() {
            0 => self.problem("nothing is selected"),
            1 => edits.into_iter().for_each(|edit| self.edit(edit)),
            n => self.edit(Edit::Together { label: format!("delete {n} things"), edits }),
        }
    }
}
