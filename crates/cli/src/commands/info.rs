//! `toile info`: what a model holds, and whether its counts agree.

use design::model_info::ModelInfo;

use super::read_body;
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::Model;

pub(crate) fn run(words: &Model, speech: &Speech) -> Result<(), Failure> {
    speech.step("reading");
    let body = read_body(&words.model)?;
    speech.step("counting");
    let info = ModelInfo::of(&body);
    speech.report(&info, || {
        let rows = [
            ("surfaces", info.surfaces.to_string()),
            ("joints", info.joints.to_string()),
            ("nodes", info.nodes.to_string()),
            ("edges", info.edges.to_string()),
            ("faces", info.faces.to_string()),
            ("components", info.components.to_string()),
            ("independent cycles", info.cycles.to_string()),
            ("enclosed voids", info.voids.to_string()),
            ("boundary loops", info.boundary_loops.to_string()),
            ("closed", if info.closed { "yes" } else { "no" }.to_owned()),
            ("area [file units²]", format!("{:.6}", info.area)),
            ("volume [file units³]", info.volume.map_or_else(|| "open".to_owned(), |v| format!("{v:.6}"))),
            ("counts agree", if info.identity_holds { "yes" } else { "NO" }.to_owned()),
        ];
        let rows: Vec<Vec<String>> =
            rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
        table(&[&words.model.display().to_string(), ""], &rows)
    })
}
