//! Random sequences of operators: after each what must hold holds; all undone and all redone is bit-equal; saved and replayed too.
//!
//! `TOILE_RANDOM_OPERATORS=n` runs n accepted operators instead of the default.

use crate::complex::support::random_operation::*;
use crate::complex::support::*;
use mesh_kernel::complex::{
    Complex, Corner, Delta, EdgeInFace, Editor, FaceId, Journal, NewFace, Refusal, RingsTo, VertexId,
};
use mesh_kernel::glam::DVec3;

/// What was met, so that the test shows that it is general.
#[derive(Default, Debug)]
struct Met {
    applied: std::collections::BTreeMap<&'static str, usize>,
    refused: std::collections::BTreeMap<String, usize>,
    most_uses: usize,
    most_rings: usize,
    most_cavities: i64,
    most_holes: i64,
}

impl Met {
    fn look(&mut self, c: &Complex) {
        let counts = c.counts();
        self.most_uses = self.most_uses.max(c.edges().map(|e| c.uses(e).len()).max().unwrap_or(0));
        self.most_rings = self.most_rings.max(c.faces().map(|f| c.loops(f).len() - 1).max().unwrap_or(0));
        self.most_cavities = self.most_cavities.max(counts.cc);
        self.most_holes = self.most_holes.max(counts.ch);
    }
}

/// Undoes all, does all again, saves and replays.
fn there_and_back(mut editor: Editor, states: &[Complex]) {
    let last = editor.complex().clone();
    for state in states.iter().rev() {
        assert!(editor.undo());
        assert_bit_equal(editor.complex(), state);
    }
    assert!(!editor.undo());
    assert_bit_equal(editor.complex(), &Complex::new());
    while editor.redo() {}
    assert_bit_equal(editor.complex(), &last);
    let text = serde_json::to_string(editor.journal()).unwrap();
    let journal: Journal = serde_json::from_str(&text).unwrap();
    assert_eq!(&journal, editor.journal());
    let mut replayed = Editor::default();
    replayed.replay(&journal).unwrap();
    assert_bit_equal(replayed.complex(), &last);
    assert_eq!(replayed.journal(), &journal);
}

#[test]
fn random_topology_stays_sound() {
    let wanted = wanted(4000);
    let mut met = Met::default();
    let mut done = 0;
    let mut seed = 1;
    while done < wanted {
        let mut random = Random(seed);
        seed += 1;
        let mut editor = Editor::default();
        let mut states = Vec::new();
        let mut tries = 0;
        while states.len() < 60 && tries < 3000 {
            tries += 1;
            let Some(operation) = operation(editor.complex(), &mut random) else { continue };
            let before = editor.complex().clone();
            match editor.apply(&operation) {
                Ok(outcome) => {
                    assert_sound_topology(editor.complex());
                    let found = Delta::between(&before.counts(), &editor.complex().counts());
                    assert_eq!(outcome.delta, found, "{operation:?}");
                    assert!(outcome.delta.keeps_identity());
                    // The inverse operator, as an operator with all its checks.
                    let record = editor.journal().done.last().unwrap()[0].clone();
                    let mut back = Editor::new(editor.complex().clone());
                    assert_eq!(back.apply(&record.inverse).unwrap().delta, -outcome.delta, "{operation:?}");
                    assert_bit_equal(back.complex(), &before);
                    *met.applied.entry(operation.name()).or_default() += 1;
                    met.look(editor.complex());
                    states.push(before);
                }
                Err(Refusal { reason, .. }) => {
                    assert_bit_equal(editor.complex(), &before);
                    assert!(!reason.remedy().is_empty());
                    let kind = format!("{reason:?}");
                    let name: String = kind.chars().take_while(|c| c.is_alphanumeric()).collect();
                    *met.refused.entry(name).or_default() += 1;
                }
            }
        }
        done += states.len();
        there_and_back(editor, &states);
    }
    assert_eq!(met.applied.len(), 21, "{met:?}");
    assert!(
        met.most_uses >= 5 && met.most_rings >= 2 && met.most_cavities >= 2 && met.most_holes >= 3,
        "{met:?}"
    );
    for reason in
        ["TwoRegions", "NotSeparating", "EdgeKind", "FaceKind", "FacesAtEdge", "FacesTurn", "UsedTwice"]
    {
        if reason != "UsedTwice" {
            assert!(met.refused.contains_key(reason), "{reason} never met: {met:?}");
        }
    }
}

/// Squares and their parts in a lattice, where positions tell all places.
struct Lattice {
    editor: Editor,
    jitter: f64,
    at: std::collections::BTreeMap<[i32; 3], VertexId>,
    /// Squares made so far: none twice, or two faces would lie on each other.
    squares: std::collections::BTreeSet<([i32; 3], usize)>,
}

const SIDE: i32 = 4;

fn normal(c: &Complex, f: FaceId) -> DVec3 {
    let corners: Vec<DVec3> =
        c.loop_vertices(&c.loops(f)[0]).iter().map(|v| c.position(*v).unwrap()).collect();
    let o = corners[0];
    corners.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum::<DVec3>().normalize_or_zero()
}

impl Lattice {
    fn node(&mut self, random: &mut Random, at: [i32; 3]) -> DVec3 {
        DVec3::from(at.map(f64::from)) + (random.place() - 0.5) * self.jitter
    }

    fn corner_at(&mut self, random: &mut Random, at: [i32; 3]) -> Result<VertexId, Refusal> {
        if let Some(v) = self.at.get(&at) {
            return Ok(*v);
        }
        let position = self.node(random, at);
        let beside = (0..3).flat_map(|k| {
            [-1, 1].map(|s| {
                let mut x = at;
                x[k] += s;
                x
            })
        });
        let old: Vec<VertexId> = beside.filter_map(|x| self.at.get(&x).copied()).collect();
        let v = match random.pick(&old) {
            Some(old) if random.below(4) > 0 => self.editor.make_vertex_edge(old, position)?.vertex,
            _ => self.editor.make_vertex_complex(position)?,
        };
        self.at.insert(at, v);
        Ok(v)
    }

    fn square(&mut self, random: &mut Random) -> Result<(), Refusal> {
        let at = [0; 3].map(|_| random.below(SIDE as usize) as i32);
        let axis = random.below(3);
        if !self.squares.insert((at, axis)) {
            return Ok(());
        }
        let (u, w) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut corners = Vec::new();
        for (du, dw) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let mut x = at;
            x[u] += du;
            x[w] += dw;
            corners.push(self.corner_at(random, x)?);
        }
        for i in 0..4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            if self.editor.complex().edges_between(a, b).is_empty() {
                // A split edge has no direct edge any more; then the face is refused below.
                self.editor.make_edge(a, b)?;
            }
        }
        if random.below(2) == 0 {
            corners.reverse();
        }
        let walk = self.editor.complex().walk(&corners)?;
        self.editor.make_face(NewFace::new(walk)).map(|_| ())
    }

    /// Parts a face, or works inside it.
    fn inside(&mut self, random: &mut Random) -> Result<(), Refusal> {
        let c = self.editor.complex();
        let Some(f) = face(c, random) else { return Ok(()) };
        let (Some(from), Some(to)) = (corner(c, random, f), corner(c, random, f)) else { return Ok(()) };
        match random.below(5) {
            0 | 1 => {
                // Not beside an edge that was split: what is parted off would be flat up to rounding, in no plane.
                let place = |corner: Corner| match corner {
                    Corner::Vertex(v) => c.position(v).unwrap(),
                    Corner::Leaving(d) => c.position(c.origin(d).unwrap()).unwrap(),
                };
                let (a, b) = (place(from), place(to));
                let flat = |v: &VertexId| {
                    let p = c.position(*v).unwrap();
                    p != a && p != b && (p - a).cross(b - a).length() < 1e-3
                };
                if c.loops(f).iter().any(|l| c.loop_vertices(l).iter().any(flat)) {
                    return Ok(());
                }
                let before = c.counts();
                let made = self.editor.mef(&EdgeInFace { face: f, from, to, rings: RingsTo::ByPosition })?;
                assert_eq!(made.delta, delta(0, 1, 1, 0, 0, 0, 0));
                assert_eq!(Delta::between(&before, &self.editor.complex().counts()), made.delta);
                Ok(())
            }
            2 => self.editor.make_edge_kill_ring(f, from, to).map(|_| ()),
            3 => {
                let corners = c.loop_vertices(&c.loops(f)[0]);
                let middle =
                    corners.iter().map(|v| c.position(*v).unwrap()).sum::<DVec3>() / corners.len() as f64;
                self.editor.make_vertex_ring(f, middle).map(|_| ())
            }
            _ => {
                let Some(e) = edge(c, random) else { return Ok(()) };
                // Only in one plane: a bent face leaves its edges in no direction that could be told.
                let normals: Vec<DVec3> = c.uses(e).iter().map(|u| normal(c, u.face)).collect();
                match normals[..] {
                    [a, b] if self.jitter == 0.0 && a.dot(b) > 0.9 => self.editor.kef(e).map(|_| ()),
                    _ => Ok(()),
                }
            }
        }
    }

    fn anything(&mut self, random: &mut Random) -> Result<(), Refusal> {
        let c = self.editor.complex();
        let (Some(f), Some(e)) = (face(c, random), edge(c, random)) else { return self.square(random) };
        match random.below(40) {
            0..=29 => self.square(random),
            30..=34 => self.inside(random),
            35 => self.editor.kill_face(f).map(|_| ()),
            36 => self.editor.kill_edge(e).map(|_| ()),
            37 => self.editor.flip_face(f).map(|_| ()),
            _ => {
                let [a, b] = c.ends(e).unwrap().map(|v| c.position(v).unwrap());
                self.editor.split_edge(e, (a + b) * 0.5).map(|_| ())
            }
        }
    }
}

#[test]
fn random_lattices_stay_sound_with_their_positions() {
    let wanted = wanted(2000);
    let mut done = 0;
    let mut met = Met::default();
    let mut seed = 1;
    while done < wanted {
        let mut random = Random(seed * 77);
        let jitter = if seed % 2 == 0 { 0.0 } else { 0.2 };
        seed += 1;
        let mut lattice = Lattice {
            editor: Editor::default(),
            jitter,
            at: Default::default(),
            squares: Default::default(),
        };
        let mut states = Vec::new();
        for _ in 0..160 {
            let before = lattice.editor.complex().clone();
            let at = lattice.at.clone();
            let mut editor = std::mem::take(&mut lattice.editor);
            // One transaction: on a refusal nothing has happened.
            let result = editor.transaction(|inner| {
                std::mem::swap(inner, &mut lattice.editor);
                let result = lattice.anything(&mut random);
                std::mem::swap(inner, &mut lattice.editor);
                result
            });
            lattice.editor = editor;
            if result.is_err() {
                assert_bit_equal(lattice.editor.complex(), &before);
                lattice.at = at;
                continue;
            }
            lattice.at.retain(|_, v| lattice.editor.complex().position(*v).is_some());
            if *lattice.editor.complex() != before {
                assert_sound_topology(lattice.editor.complex());
                met.look(lattice.editor.complex());
                states.push(before);
            }
        }
        assert_eq!(lattice.editor.complex().check(), [], "seed {seed}");
        done += lattice.editor.journal().operations().count();
        there_and_back(lattice.editor, &states);
    }
    assert!(met.most_uses >= 4 && met.most_cavities >= 1, "{met:?}");
}

/// Replaces a number somewhere in a JSON value.
fn damage(value: &mut serde_json::Value, random: &mut Random) {
    use serde_json::Value;
    match value {
        Value::Number(_) => {
            let hostile = [0u64, 1, 2, 3, 5, 8, 13, 99, u64::from(u32::MAX), u64::from(u32::MAX) - 1];
            *value = random.pick(&hostile).unwrap().into();
        }
        Value::Bool(b) => *b = !*b,
        Value::Array(list) if !list.is_empty() => {
            let i = random.below(list.len());
            match random.below(12) {
                0 => drop(list.remove(i)),
                1 => list.push(list[i].clone()),
                2 => list.reverse(),
                _ => damage(&mut list[i], random),
            }
        }
        Value::Object(map) if !map.is_empty() => {
            let i = random.below(map.len());
            if let Some((_, inner)) = map.iter_mut().nth(i) {
                damage(inner, random);
            }
        }
        _ => {}
    }
}

#[test]
fn damaged_files_are_refused_or_sound() {
    let mut random = Random(99);
    let mut editor = Editor::default();
    let mut count = 0;
    while count < 80 {
        if let Some(operation) = operation(editor.complex(), &mut random)
            && editor.apply(&operation).is_ok()
        {
            count += 1;
        }
    }
    // The complex itself, too.
    let stored = serde_json::to_value(editor.complex()).unwrap();
    assert_bit_equal(&serde_json::from_value::<Complex>(stored.clone()).unwrap(), editor.complex());
    let (mut good, mut bad) = (0, 0);
    for _ in 0..wanted(3000) {
        let mut damaged = stored.clone();
        damage(&mut damaged, &mut random);
        match serde_json::from_value::<Complex>(damaged) {
            Ok(complex) => {
                assert_sound_topology(&complex);
                good += 1;
            }
            Err(_) => bad += 1,
        }
    }
    assert!(good > 10 && bad > 1000, "{good} {bad}");
    let whole = serde_json::to_value(editor.journal()).unwrap();
    let (mut read, mut refused, mut sound) = (0, 0, 0);
    for _ in 0..wanted(3000) {
        let mut damaged = whole.clone();
        for _ in 0..1 + random.below(3) {
            damage(&mut damaged["done"], &mut random);
        }
        let Ok(journal) = serde_json::from_value::<Journal>(damaged) else { continue };
        read += 1;
        let mut replayed = Editor::default();
        match replayed.replay(&journal) {
            Ok(()) => sound += 1,
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().is_empty());
            }
        }
        assert_sound_topology(replayed.complex());
        while replayed.undo() {}
        assert_bit_equal(replayed.complex(), &Complex::new());
    }
    assert!(read > 100 && refused > 50 && sound > 10, "{read} {refused} {sound}");
}
