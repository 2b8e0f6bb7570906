//! A body's features tied to a mesh on the same skin, to go with it when its nodes move.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::ClosestPoint;

use super::{HumanBody, export};
use crate::model::{FeatureCurve, FeaturePoint};

/// A closed curve whose heights differ by less is level, and stays so, mm.
const LEVEL: f64 = 1.0;

/// The nodes nearest to a place, with their weights.
type Tie = ([u32; 3], [f64; 3]);

/// Features that follow the nodes of a mesh.
#[derive(Clone, Debug)]
pub struct TiedFeatures {
    body: HumanBody,
    /// The mesh's nodes in its own frame, and their normals.
    nodes: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// By curve, in their order, and point.
    curves: Vec<Vec<Tie>>,
    points: Vec<Tie>,
}

impl TiedFeatures {
    /// Ties the features of `body` to `mesh`, which has the same skin in the frame of the body's file. `None` without faces.
    /// O(points · log faces).
    pub fn new(body: &HumanBody, mesh: &TriMesh) -> Option<Self> {
        let placed = placed(body, mesh);
        let skin = ClosestPoint::new(&placed);
        let tie = |p: DVec3| {
            let near = skin.closest(p)?;
            Some((mesh.faces[near.face as usize], near.barycentric))
        };
        let curve = |c: &FeatureCurve| c.points.iter().map(|p| tie(*p)).collect::<Option<Vec<Tie>>>();
        Some(Self {
            curves: body.features.curves.values().map(curve).collect::<Option<_>>()?,
            points: body.features.points.values().map(|p| tie(p.position)).collect::<Option<_>>()?,
            normals: placed.node_normals(),
            nodes: mesh.positions.clone(),
            body: HumanBody { mesh: placed, ..body.clone() },
        })
    }

    /// The body with the mesh's nodes at other places, of a person of `height` times the stature. Points go as far as the skin
    /// beside them; level curves stay level.
    pub fn moved(&self, mesh: TriMesh, height: f64) -> HumanBody {
        let mut body = self.body.clone();
        // As bodies are placed: the middle of their depth at z = 0.
        let [before, after] = [&self.nodes, &mesh.positions].map(|p| middle(p));
        body.placement.translation += body.placement.direction_to_file(DVec3::Z * (after - before));
        body.mesh = placed(&body, &mesh);
        let normals = body.mesh.node_normals();
        let sum = |(nodes, weights): &Tie, of: &dyn Fn(usize) -> DVec3| -> DVec3 {
            nodes.iter().zip(weights).map(|(v, w)| *w * of(*v as usize)).sum()
        };
        let way = |v: usize| body.mesh.positions[v] - self.body.mesh.positions[v];
        let turn = |v: usize| normals[v] - self.normals[v];
        let features = &mut body.features;
        features.height *= height;
        for (curve, ties) in features.curves.values_mut().zip(&self.curves) {
            let is_level = curve.closed && spread(&curve.points) < LEVEL;
            for ((p, n), tie) in curve.points.iter_mut().zip(&mut curve.normals).zip(ties) {
                *p += sum(tie, &way);
                *n = (*n + sum(tie, &turn)).normalize_or(*n);
            }
            if is_level {
                let mean = curve.points.iter().map(|p| p.y).sum::<f64>() / curve.points.len() as f64;
                curve.points.iter_mut().for_each(|p| p.y = mean);
            }
        }
        for (FeaturePoint { position, normal }, tie) in features.points.values_mut().zip(&self.points) {
            *position += sum(tie, &way);
            *normal = (*normal + sum(tie, &turn)).normalize_or(*normal);
        }
        body.girths = export::girths(features);
        body
    }
}

/// The mesh in the body's canonical frame.
fn placed(body: &HumanBody, mesh: &TriMesh) -> TriMesh {
    let positions = mesh.positions.iter().map(|p| body.placement.from_file(*p)).collect();
    TriMesh::new(positions, mesh.faces.clone())
}

fn middle(positions: &[DVec3]) -> f64 {
    let fold = |[lo, hi]: [f64; 2], p: &DVec3| [lo.min(p.z), hi.max(p.z)];
    let [lo, hi] = positions.iter().fold([f64::INFINITY, f64::NEG_INFINITY], fold);
    0.5 * (lo + hi)
}

fn spread(points: &[DVec3]) -> f64 {
    let fold = |[lo, hi]: [f64; 2], p: &DVec3| [lo.min(p.y), hi.max(p.y)];
    let [lo, hi] = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], fold);
    hi - lo
}
