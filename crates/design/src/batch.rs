//! One template on many bodies: what fails is reported and the rest goes on; an interrupted run is taken up again.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use mesh_kernel::files;
use rayon::prelude::*;
use serde::{Deserialize, Serialize, Serializer};
use template::Template;

use crate::fingerprint::Fingerprint;
use crate::output::{OutputError, OutputFile, write_all};
use crate::regenerate::{Artifact, Settings, regenerate};

/// How a batch runs.
#[derive(Clone, Debug)]
pub struct BatchOptions {
    /// How every garment is built.
    pub settings: Settings,
    /// What is written of it.
    pub artifacts: Vec<Artifact>,
    /// Which part of the list.
    pub shard: Shard,
    /// Build again what is there already.
    pub again: bool,
}

/// A part of a list that several machines share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    part: usize,
    of: usize,
}

impl Shard {
    /// Part `part` of `of`, counted from 1.
    pub fn new(part: usize, of: usize) -> Option<Self> {
        (1 <= part && part <= of).then_some(Self { part, of })
    }

    /// Whether the list's item `index` belongs to it. Neighbours go to different parts, so that all end about together.
    pub fn has(self, index: usize) -> bool {
        index % self.of == self.part - 1
    }

    /// Name of the file that lists what became of its bodies.
    fn list_name(self) -> String {
        match self {
            Self { of: 1, .. } => "batch.json".to_owned(),
            Self { part, of } => format!("batch-{part}-of-{of}.json"),
        }
    }
}

impl Default for Shard {
    /// The whole list.
    fn default() -> Self {
        Self { part: 1, of: 1 }
    }
}

/// What became of all bodies.
#[derive(Clone, Debug, Serialize)]
pub struct Batch {
    /// Name of the template.
    pub template: String,
    /// One entry a body of this shard, in the list's order.
    pub bodies: Vec<BatchBody>,
}

impl Batch {
    /// How many failed.
    pub fn failed(&self) -> usize {
        self.bodies.iter().filter(|b| b.state == BodyState::Failed).count()
    }
}

/// What became of one body.
#[derive(Clone, Debug, Serialize)]
pub struct BatchBody {
    /// Name of its folder of results.
    pub name: String,
    /// The mesh file; in JSON what of its name is no text becomes `\u{fffd}`.
    #[serde(serialize_with = "as_text")]
    pub file: PathBuf,
    /// How it went.
    pub state: BodyState,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Warnings of the report.
    pub warnings: usize,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Names of files are bytes, and JSON is text.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// How a body of a batch went.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyState {
    /// Built now.
    Built,
    /// An earlier run had finished it with the same inputs.
    Kept,
    /// See the error.
    Failed,
}

impl fmt::Display for BodyState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Built => "built",
            Self::Kept => "kept",
            Self::Failed => "failed",
        })
    }
}

/// How many warnings an earlier run's `report.json` has, where it is of the inputs with that fingerprint; `None` for
/// any other bytes.
pub fn finished(report: &[u8], fingerprint: &str) -> Option<usize> {
    #[derive(Deserialize)]
    struct Earlier {
        fingerprint: String,
        warnings: Vec<String>,
    }
    let earlier: Earlier = serde_json::from_slice(report).ok()?;
    (earlier.fingerprint == fingerprint).then_some(earlier.warnings.len())
}

/// Rebuilds `template` on every body of the shard, bodies in parallel, each into a folder of its own under `out`.
///
/// A folder is named after its file; files of one name from different folders are numbered in the list's order. A body
/// whose folder holds the report of the same inputs, and all files that are wanted, is kept as it is. `progress` hears how many of how many are done.
/// `batch.json` (with more than one shard `batch-I-of-N.json`) lists what became of them.
///
/// # Errors
/// Only when `batch.json` cannot be written; everything else is an entry of the result.
pub fn run_batch(
    template: &Template,
    bodies: &[PathBuf],
    out: &Path,
    options: &BatchOptions,
    progress: &(dyn Fn(usize, usize, &str) + Sync),
) -> Result<Batch, OutputError> {
    let names = folder_names(bodies);
    let mine: Vec<(&PathBuf, &String)> = bodies
        .iter()
        .zip(&names)
        .enumerate()
        .filter(|(i, _)| options.shard.has(*i))
        .map(|(_, pair)| pair)
        .collect();
    let done = AtomicUsize::new(0);
    let results = mine
        .par_iter()
        .map(|(file, name)| {
            let started = Instant::now();
            let result = one(template, file, &out.join(name), options);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, mine.len(), name);
            let (state, error, warnings) = match result {
                Ok((state, warnings)) => (state, None, warnings),
                Err(error) => (BodyState::Failed, Some(error), 0),
            };
            let seconds = started.elapsed().as_secs_f64();
            BatchBody { name: (*name).clone(), file: (*file).clone(), state, error, warnings, seconds }
        })
        .collect();
    let batch = Batch { template: template.file().name.clone(), bodies: results };
    let name = options.shard.list_name();
    let bytes = serde_json::to_vec_pretty(&batch)
        .map_err(|e| OutputError { path: out.join(&name), source: e.into() })?;
    write_all(out, &[OutputFile { name: name.into(), bytes }])?;
    Ok(batch)
}

fn one(
    template: &Template,
    file: &Path,
    folder: &Path,
    options: &BatchOptions,
) -> Result<(BodyState, usize), String> {
    let started = Instant::now();
    let format = files::Format::of_path(file)
        .ok_or_else(|| format!("{}: not an OBJ, PLY, STL, OFF or GLB file", file.display()))?;
    let bytes = std::fs::read(file).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
    let fingerprint = Fingerprint::default()
        .with(env!("CARGO_PKG_VERSION").as_bytes())
        .with(template.to_json().as_bytes())
        .with(format!("{:?} {:?}", options.settings, options.artifacts).as_bytes())
        .with(&bytes)
        .text();
    if !options.again
        && let Ok(text) = std::fs::read(folder.join("report.json"))
        && let Some(warnings) = finished(&text, &fingerprint)
        && options.artifacts.iter().flat_map(|a| a.file_names()).all(|name| folder.join(name).is_file())
    {
        return Ok((BodyState::Kept, warnings));
    }
    let mesh = files::parse(format, &bytes).map_err(|e| e.to_string())?;
    let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let load = started.elapsed().as_secs_f64();
    let mut built =
        regenerate(template, &name, &mesh, &options.settings, &|_| true).map_err(|e| e.to_string())?;
    built.report.seconds.load = load;
    built.report.fingerprint = Some(fingerprint);
    built.write(folder, &options.artifacts, started).map_err(|e| e.to_string())?;
    Ok((BodyState::Built, built.report.warnings.len()))
}

/// Folder names: the files' stems; a stem that comes again gets a number, and so does what the batch names its own list.
fn folder_names(bodies: &[PathBuf]) -> Vec<String> {
    // Many systems take names that differ in case for one.
    let key = |name: &str| name.to_lowercase();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let stems: Vec<String> = bodies.iter().map(|p| stem(p)).collect();
    let wanted: BTreeSet<String> = stems.iter().map(|stem| key(stem)).collect();
    let mut taken: BTreeSet<String> = BTreeSet::new();
    let mut names: Vec<String> = Vec::with_capacity(stems.len());
    for stem in &stems {
        let count = seen.entry(key(stem)).or_insert(0);
        *count += 1;
        let mut name = if *count == 1 { stem.clone() } else { format!("{stem}-{count}") };
        while taken.contains(&key(&name))
            || is_list(&key(&name))
            || (*count > 1 && wanted.contains(&key(&name)))
        {
            *count += 1;
            name = format!("{stem}-{count}");
        }
        taken.insert(key(&name));
        names.push(name);
    }
    names
}

/// A file's name without its extension; one of dots alone, which would be another folder's name, is `body`.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    if stem.chars().all(|c| c == '.') { "body".to_owned() } else { stem }
}

/// Whether a batch may write its list under that name, whatever the number of shards.
fn is_list(name: &str) -> bool {
    name == "batch.json" || name.starts_with("batch-") && name.ends_with(".json")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_the_list_once() {
        for of in 1..6 {
            for index in 0..20 {
                let holders = (1..=of).filter(|&part| Shard::new(part, of).unwrap().has(index)).count();
                assert_eq!(holders, 1);
            }
        }
        assert!(Shard::new(0, 3).is_none() && Shard::new(4, 3).is_none() && Shard::new(1, 0).is_none());
    }

    #[test]
    fn folders_do_not_collide() {
        let bodies: Vec<PathBuf> =
            ["a/x.obj", "b/x.ply", "x-2.obj", "c/x.stl", "d/X.obj"].iter().map(PathBuf::from).collect();
        let names = folder_names(&bodies);
        let mut unique: Vec<String> = names.iter().map(|name| name.to_lowercase()).collect();
        unique.sort();
        unique.dedup();
        assert_eq!(unique.len(), bodies.len(), "{names:?}");
        assert_eq!((names[0].as_str(), names[2].as_str()), ("x", "x-2"));
    }

    #[test]
    fn folders_lie_within_the_folder_of_results() {
        let bodies: Vec<PathBuf> =
            ["a/...obj", "a/..obj", "batch.json.obj", "batch-1-of-2.json.ply", "..", "body.off"]
                .iter()
                .map(PathBuf::from)
                .collect();
        assert_eq!(
            folder_names(&bodies),
            ["body", "body-2", "batch.json-2", "batch-1-of-2.json-2", "body-3", "body-4"]
        );
    }
}
