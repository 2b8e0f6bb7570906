//! Pictures of models and patterns without GPU or display.
//!
//! A [`Scene`] is a draw list: surfaces, lines, points, labels, a legend. A [`Camera`] looks at it. [`render`] makes an
//! [`Image`]: faces by watertight scan conversion with many samples a pixel, soft shadows by ray casting
//! ([`RenderOptions::occlusion`]), lines and text crisp on top. [`Drawing2d`] is the same for flat patterns, and
//! [`montage`] puts pictures side by side.
//!
//! Everything is in millimetres, y up; the model faces +z. The same input gives the same bytes, whatever the number
//! of threads.
//!
//! ```
//! use glam::DVec3;
//! use viewer::{Camera, Color, Lens, RenderOptions, Scene, SceneMesh, View, render};
//!
//! let corners = vec![DVec3::ZERO, DVec3::X * 100.0, DVec3::Y * 100.0];
//! let scene = Scene { meshes: vec![SceneMesh::new(corners, vec![[0, 1, 2]], Color([200, 60, 60]))], ..Scene::default() };
//! let options = RenderOptions::sized(64, 64);
//! let camera = Camera::new(View::Front, Lens::Orthographic).fit(&scene, &options)?;
//! let png = render(&scene, &camera, &options)?.to_png();
//! assert_eq!(&png[1..4], b"PNG");
//! # Ok::<(), viewer::RenderError>(())
//! ```

mod buffers;
mod camera;
mod color;
mod color_map;
mod drawing2d;
mod error;
mod image;
mod labels;
mod legend;
mod lines;
mod montage;
mod normals;
mod occlusion;
mod painter;
mod raster;
mod render;
mod scene;
mod shade;
mod text;

pub use buffers::MeshBuffer;
pub use camera::{Camera, Lens, View};
pub use color::{Color, cloth_color};
pub use color_map::{ColorMap, Scale};
pub use drawing2d::{Drawing2d, Item2d, Length, PageOptions, Pen};
pub use error::{MAX_MEGAPIXELS, MAX_SIDE, RenderError};
pub use image::Image;
pub use legend::{ColorBar, KeySign, Legend, LegendKey};
pub use montage::{MontageOptions, montage};
pub use render::{Occlusion, RenderOptions, render};
pub use scene::{Hidden, Label, Paint, Reverse, Scene, SceneLine, SceneMesh, ScenePoint, Shading};
pub use text::Align;
