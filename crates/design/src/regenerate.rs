//! The pipeline: a body's features, the template rebuilt on them, the flat pattern, the report.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use mesh_kernel::TriMesh;
use mesh_kernel::body::BodyFileError;
use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use mesh_kernel::glam::DVec3;
use pattern::{
    Dialect, DxfOptions, JsonOptions, Paper, Pattern, PatternError, PatternOptions, PdfOptions, SvgOptions,
};
use rayon::prelude::*;
use reference::human::{self, HumanBody, HumanError, HumanOptions};
use template::{Garment, Prepared, Reference, RegenerateOptions, Template, TemplateError};
use viewer::RenderError;

use crate::document::Document;
use crate::garment_pattern::pattern_input;
use crate::output::{OutputError, OutputFile, write_all_and};
use crate::pictures::{garment_pictures, pattern_picture};
use crate::report::Report;

/// Name of the report among the results.
const REPORT: &str = "report.json";

/// Decimal places of a coordinate in millimetres in text files: a micrometre.
const DECIMALS_MM: u8 = 3;

/// How a garment is built and labelled.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How often every triangle of the template is split in four; the template's own number when `None`.
    pub levels: Option<u8>,
    /// Name of the size, as printed on the pieces.
    pub sample_size: String,
    /// Paper of the PDF.
    pub paper: Paper,
    /// Dialect of the DXF.
    pub dialect: Dialect,
    /// Unit of the body's file; told from its height when `None`.
    pub unit: Option<human::Unit>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            levels: None,
            sample_size: "MADE TO MEASURE".to_owned(),
            paper: Paper::default(),
            dialect: Dialect::default(),
            unit: None,
        }
    }
}

/// A kind of file that a regeneration can write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Artifact {
    /// `garment.obj`
    Obj,
    /// `garment.glb`
    Glb,
    /// `pattern.dxf`
    Dxf,
    /// `pattern.svg`
    Svg,
    /// `pattern.pdf`
    Pdf,
    /// `pattern.json`
    Json,
    /// `front.png`, `back.png`, `pattern.png`
    Png,
    /// `design.toile`
    Toile,
    /// `garment.body.json`: the kernel's native file, with joints, attributes and numbers; in millimetres, y up.
    Body,
}

impl Artifact {
    /// What is written where nothing else is said: all that people use; a body is for programs.
    pub const DEFAULT: [Self; 8] =
        [Self::Obj, Self::Glb, Self::Dxf, Self::Svg, Self::Pdf, Self::Json, Self::Png, Self::Toile];

    /// Names of the files that it is, in the folder of results.
    pub fn file_names(self) -> &'static [&'static str] {
        match self {
            Self::Obj => &["garment.obj"],
            Self::Glb => &["garment.glb"],
            Self::Dxf => &["pattern.dxf"],
            Self::Svg => &["pattern.svg"],
            Self::Pdf => &["pattern.pdf"],
            Self::Json => &["pattern.json"],
            Self::Png => &["front.png", "back.png", "pattern.png"],
            Self::Toile => &["design.toile"],
            Self::Body => &["garment.body.json"],
        }
    }
}

/// Why a garment could not be rebuilt or written.
#[derive(Debug, thiserror::Error)]
pub enum RegenerateError {
    /// The body.
    #[error(transparent)]
    Body(#[from] HumanError),
    /// The template on this body.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// The flat pattern.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// A picture.
    #[error("a picture could not be drawn: {0}")]
    Picture(#[from] RenderError),
    /// The garment as a native body.
    #[error(transparent)]
    BodyFile(#[from] BodyFileError),
    /// A file.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The caller said stop.
    #[error("stopped")]
    Cancelled,
}

/// A garment on a body with its pattern.
#[derive(Clone, Debug)]
pub struct Regenerated {
    /// How it was made.
    pub settings: Settings,
    /// The body with its features, in the canonical frame.
    pub body: HumanBody,
    /// The garment.
    pub garment: Garment,
    /// The garment as one mesh: a group a surface, nodes shared on joints, texture coordinates from the pattern.
    pub mesh: TriMesh,
    /// The flat pattern.
    pub pattern: Pattern,
    /// What is reported; `export` and `total` of its seconds are filled in by [`Regenerated::write`].
    pub report: Report,
    document: Document,
}

/// Rebuilds `template` on the body `raw`, which is in any unit, axes and heading; `file` is its name.
///
/// `progress` hears what is being done and says whether to go on. Takes about a second for 10 000 garment triangles on
/// a body of 27 000.
///
/// # Errors
/// [`RegenerateError`]; nothing is changed then.
pub fn regenerate(
    template: &Template,
    file: &str,
    raw: &TriMesh,
    settings: &Settings,
    progress: &(dyn Fn(&str) -> bool + Sync),
) -> Result<Regenerated, RegenerateError> {
    let go_on = |step: &str| if progress(step) { Ok(()) } else { Err(RegenerateError::Cancelled) };
    go_on("finding the body's features")?;
    let started = Instant::now();
    let body = human::extract(raw, &HumanOptions { unit: settings.unit, ..HumanOptions::default() })?;
    let features = started.elapsed().as_secs_f64();
    let mut made = regenerate_on(template, file, body, settings, progress)?;
    made.report.seconds.features = features;
    Ok(made)
}

/// The same on a body whose features are known; the extraction's seconds stay 0.
///
/// # Errors
/// [`RegenerateError`]; nothing is changed then.
pub fn regenerate_on(
    template: &Template,
    file: &str,
    body: HumanBody,
    settings: &Settings,
    progress: &(dyn Fn(&str) -> bool + Sync),
) -> Result<Regenerated, RegenerateError> {
    let go_on = |step: &str| if progress(step) { Ok(()) } else { Err(RegenerateError::Cancelled) };
    go_on("building the garment")?;
    let started = Instant::now();
    let reference = Reference { mesh: &body.mesh, features: &body.features };
    let options = RegenerateOptions { levels: settings.levels, ..RegenerateOptions::default() };
    let garment = template::regenerate(template, &reference, &options)?;
    finish(template, file, body, garment, settings, started, progress)
}

/// The same with the body's search structures at hand. Asks at every stage of the construction whether to go on.
pub(crate) fn regenerate_prepared(
    template: &Template,
    file: &str,
    body: HumanBody,
    prepared: &Prepared,
    settings: &Settings,
    progress: &(dyn Fn(&str) -> bool + Sync),
) -> Result<Regenerated, RegenerateError> {
    let started = Instant::now();
    let reference = Reference { mesh: &body.mesh, features: &body.features };
    let stop = AtomicBool::new(false);
    let listen = |_: f64, step: &str| {
        if !progress(step) {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let options = RegenerateOptions {
        levels: settings.levels,
        prepared: Some(prepared),
        cancel: Some(&stop),
        progress: Some(&listen),
        ..RegenerateOptions::default()
    };
    let garment = match template::regenerate(template, &reference, &options) {
        Err(TemplateError::Cancelled) => return Err(RegenerateError::Cancelled),
        other => other?,
    };
    finish(template, file, body, garment, settings, started, progress)
}

/// A step of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportStep {
    /// A file is made in memory.
    Making,
    /// All are made and are written.
    Writing,
}

/// From a garment to its pattern and report.
fn finish(
    template: &Template,
    file: &str,
    body: HumanBody,
    garment: Garment,
    settings: &Settings,
    started: Instant,
    progress: &(dyn Fn(&str) -> bool + Sync),
) -> Result<Regenerated, RegenerateError> {
    let construct = started.elapsed().as_secs_f64();
    if !progress("flattening") {
        return Err(RegenerateError::Cancelled);
    }
    let started = Instant::now();
    let pattern = pattern::make(&pattern_input(&garment), &PatternOptions::default())?;
    let mut mesh = garment.body.to_tri_mesh();
    mesh.corner_uvs = Some(
        pattern
            .flats
            .iter()
            .zip(&pattern.layout.offsets)
            .flat_map(|(flat, offset)| flat.corner_uvs().into_iter().map(|c| c.map(|p| p + *offset)))
            .collect(),
    );
    let flatten = started.elapsed().as_secs_f64();

    let mut report = Report::new(template, file, &body, &garment, &pattern);
    report.seconds.construct = construct;
    report.seconds.flatten = flatten;
    let document = Document::new(template, settings.levels, file, &body, &garment);
    Ok(Regenerated { settings: settings.clone(), body, garment, mesh, pattern, report, document })
}

impl Regenerated {
    /// The files of the given kinds, made in memory, in the order of [`Artifact`]. The same garment gives the same
    /// bytes.
    ///
    /// # Errors
    /// [`RegenerateError::Picture`].
    pub fn files(&self, artifacts: &[Artifact]) -> Result<Vec<OutputFile>, RegenerateError> {
        self.files_while(artifacts, &|| true)
    }

    fn files_while(
        &self,
        artifacts: &[Artifact],
        goes_on: &(dyn Fn() -> bool + Sync),
    ) -> Result<Vec<OutputFile>, RegenerateError> {
        let mut wanted = artifacts.to_vec();
        wanted.sort_unstable();
        wanted.dedup();
        // The pictures take longest, so they start first.
        let make = |a: &Artifact| if goes_on() { self.make(*a) } else { Err(RegenerateError::Cancelled) };
        let made: Vec<Result<Vec<OutputFile>, RegenerateError>> =
            wanted.par_iter().rev().with_max_len(1).map(make).collect();
        let mut files = Vec::new();
        for some in made.into_iter().rev() {
            files.extend(some?);
        }
        Ok(files)
    }

    /// Writes the files of the given kinds and `report.json` into `folder`: all of them, or none when one cannot be written.
    ///
    /// `started` is when the work began: the report's seconds count from then.
    ///
    /// # Errors
    /// [`RegenerateError::Picture`], [`RegenerateError::Output`].
    pub fn write(
        &mut self,
        folder: &Path,
        artifacts: &[Artifact],
        started: Instant,
    ) -> Result<(), RegenerateError> {
        self.write_while(folder, artifacts, started, &|_| true)
    }

    /// The same as long as `progress`, which is told the steps, says yes: before every file that is made, and, last, before
    /// any is written.
    ///
    /// # Errors
    /// Those of [`write`](Self::write); [`RegenerateError::Cancelled`] when it said no: nothing is written then.
    pub fn write_while(
        &mut self,
        folder: &Path,
        artifacts: &[Artifact],
        started: Instant,
        progress: &(dyn Fn(ExportStep) -> bool + Sync),
    ) -> Result<(), RegenerateError> {
        let export = Instant::now();
        let files = self.files_while(artifacts, &|| progress(ExportStep::Making))?;
        if !progress(ExportStep::Writing) {
            return Err(RegenerateError::Cancelled);
        }
        // The report counts the time that writing takes.
        let report = || {
            self.report.seconds.export = export.elapsed().as_secs_f64();
            self.report.seconds.total = started.elapsed().as_secs_f64();
            let mut bytes = serde_json::to_vec_pretty(&self.report)
                .map_err(|e| OutputError { path: folder.join(REPORT), source: e.into() })?;
            bytes.push(b'\n');
            Ok(OutputFile { name: REPORT.into(), bytes })
        };
        Ok(write_all_and(folder, &files, report)?)
    }

    fn make(&self, artifact: Artifact) -> Result<Vec<OutputFile>, RegenerateError> {
        let style_name = self.report.template.clone();
        let sample_size = self.settings.sample_size.clone();
        let contents = match artifact {
            Artifact::Obj => vec![self.garment_obj()],
            // Millimetres, y up: the format's metres are the writer's own default scale.
            Artifact::Glb => vec![to_bytes(Format::Glb, &self.mesh, &WriteOptions::default())],
            Artifact::Dxf => {
                let options = DxfOptions { dialect: self.settings.dialect, sample_size, style_name };
                vec![pattern::to_dxf(&self.pattern, &options).into_bytes()]
            }
            Artifact::Svg => {
                let options = SvgOptions { title: style_name, sample_size };
                vec![pattern::to_svg(&self.pattern, &options).into_bytes()]
            }
            Artifact::Pdf => {
                let options = PdfOptions { paper: self.settings.paper, title: style_name, sample_size };
                vec![pattern::to_pdf(&self.pattern, &options)]
            }
            Artifact::Json => {
                let options = JsonOptions { style_name, sample_size };
                vec![pattern::to_json(&self.pattern, &options).into_bytes()]
            }
            Artifact::Png => {
                let pictures = garment_pictures(
                    &style_name,
                    &self.body.mesh,
                    &self.mesh,
                    &self.seam_lines(),
                    &self.profile_lines(),
                )?;
                let pattern = pattern_picture(&self.pattern)?;
                [pictures.front, pictures.back, pattern].map(|image| image.to_png()).into()
            }
            Artifact::Toile => vec![self.document.to_bytes()],
            Artifact::Body => vec![self.garment.body.to_file_bytes()?],
        };
        let named = artifact.file_names().iter().zip(contents);
        Ok(named.map(|(&name, bytes)| OutputFile { name: name.into(), bytes }).collect())
    }

    /// The garment over the body's file: its unit, its axes.
    fn garment_obj(&self) -> Vec<u8> {
        let mut mesh = self.mesh.clone();
        for p in &mut mesh.positions {
            *p = self.body.placement.to_file(*p);
        }
        let more = self.body.unit.millimetres().log10().round() as u8;
        let options = WriteOptions {
            decimals: Some(DECIMALS_MM + more),
            comments: vec![format!(
                "{}, in {} as {}; texture coordinates are the flat pattern in mm",
                self.report.template,
                self.body.unit.symbol(),
                self.report.body.file
            )],
            ..WriteOptions::default()
        };
        to_bytes(Format::Obj, &mesh, &options)
    }

    /// Every seam as a polyline.
    fn seam_lines(&self) -> Vec<Vec<DVec3>> {
        let garment = &self.garment;
        let line = |side: &template::SurfaceChain| {
            let positions = garment.body.surface(garment.surfaces[side.surface].id).positions();
            side.nodes.iter().map(|n| positions[*n as usize]).collect()
        };
        garment.seams.iter().filter_map(|seam| seam.sides.first().map(line)).collect()
    }

    /// Every line of the template as a polyline.
    fn profile_lines(&self) -> Vec<Vec<DVec3>> {
        self.garment
            .lines
            .iter()
            .filter(|l| l.written && l.points.len() > 1)
            .map(|l| l.points.clone())
            .collect()
    }
}
