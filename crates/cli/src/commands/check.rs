//! `toile check`: every broken rule of a model.

use serde::Serialize;

use super::read_body;
use crate::failure::Failure;
use crate::speech::Speech;
use crate::words::Model;

/// So many defects are written out; the rest are counted.
const SHOWN: usize = 30;

#[derive(Serialize)]
struct Checked {
    ok: bool,
    defects: Vec<String>,
}

pub(crate) fn run(words: &Model, speech: &Speech) -> Result<(), Failure> {
    speech.step("reading");
    let body = read_body(&words.model)?;
    speech.step("checking");
    let defects: Vec<String> = body.check().iter().map(ToString::to_string).collect();
    let checked = Checked { ok: defects.is_empty(), defects };
    speech.report(&checked, || {
        if checked.ok {
            return format!("{}: sound\n", words.model.display());
        }
        let mut text: String = checked.defects.iter().take(SHOWN).map(|d| format!("  {d}\n")).collect();
        if checked.defects.len() > SHOWN {
            text.push_str(&format!("  … and {} more\n", checked.defects.len() - SHOWN));
        }
        text
    })?;
    match checked.defects.len() {
        0 => Ok(()),
        n => Err(Failure::new(format!(
            "{}: {n} broken rule{}",
            words.model.display(),
            if n == 1 { "" } else { "s" }
        ))),
    }
}
