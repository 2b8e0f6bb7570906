//! Random sequences of operators that unite, divide and turn, on random complexes: exact deltas, or nothing changed.

use std::collections::BTreeMap;

use crate::complex::support::random_operation::*;
use crate::complex::support::*;
use mesh_kernel::complex::{Delta, EdgeInFace, Editor, FaceUse, Refusal, RingsTo};

/// A random sequence: its name, and its delta or why not.
fn sequence(m: &mut Editor, random: &mut Random) -> Option<(&'static str, Result<Delta, Refusal>)> {
    let c = m.complex().clone();
    Some(match random.below(7) {
        0 => ("merge_vertices", {
            let (kept, gone) = (vertex(&c, random)?, vertex(&c, random)?);
            m.merge_vertices(kept, gone).map(|o| o.delta)
        }),
        1 => ("split_vertex", {
            let v = vertex(&c, random)?;
            // The edges of some faces there, so that loops often stay whole.
            let mut edges = c.edges_at(v).to_vec();
            let some = random.pick(&edges)?;
            let faces = c.faces_of(some);
            edges.retain(|e| *e == some || faces.iter().any(|f| c.faces_of(*e).contains(f)));
            m.split_vertex(v, &edges, random.place()).map(|o| o.delta)
        }),
        2 => ("unite_edges", {
            let kept = edge(&c, random)?;
            let [a, b] = c.ends(kept)?;
            let others: Vec<_> = c.edges_between(a, b).into_iter().filter(|e| *e != kept).collect();
            m.unite_edges(kept, random.pick(&others)?, None).map(|o| o.delta)
        }),
        3 => ("divide_edge", {
            let e = edge(&c, random)?;
            let uses: Vec<FaceUse> = c.uses(e).iter().copied().filter(|_| random.below(2) == 0).collect();
            m.divide_edge(e, &uses).map(|o| o.delta)
        }),
        4 => ("flip_face", m.flip_face(face(&c, random)?)),
        5 => ("kef", m.kef(edge(&c, random)?)),
        _ => ("mef", {
            let f = face(&c, random)?;
            let (from, to) = (corner(&c, random, f)?, corner(&c, random, f)?);
            let rings = RingsTo::NewFace(c.vertices().filter(|_| random.below(2) == 0).collect());
            m.mef(&EdgeInFace { face: f, from, to, rings }).map(|x| x.delta)
        }),
    })
}

#[test]
fn sequences_do_what_they_say_or_nothing() {
    let wanted = wanted(1000);
    let (mut done, mut seed) = (0, 1);
    let mut met: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    while done < wanted {
        let mut random = Random(seed * 13);
        seed += 1;
        let mut m = Editor::default();
        let mut states = Vec::new();
        for _ in 0..240 {
            if random.below(4) > 0 {
                let before = m.complex().clone();
                if let Some(operation) = operation(m.complex(), &mut random)
                    && m.apply(&operation).is_ok()
                {
                    states.push(before);
                }
                continue;
            }
            let before = m.complex().clone();
            let steps = m.journal().done.len();
            match sequence(&mut m, &mut random) {
                None => assert_bit_equal(m.complex(), &before),
                Some((name, Ok(delta))) => {
                    assert_sound_topology(m.complex());
                    assert_eq!(Delta::between(&before.counts(), &m.complex().counts()), delta, "{name}");
                    met.entry(name).or_default()[0] += 1;
                    assert_eq!(m.journal().done.len(), steps + 1);
                    states.push(before);
                    done += 1;
                }
                Some((name, Err(_))) => {
                    assert_bit_equal(m.complex(), &before);
                    assert_eq!(m.journal().done.len(), steps);
                    met.entry(name).or_default()[1] += 1;
                }
            }
        }
        let last = m.complex().clone();
        for state in states.iter().rev() {
            assert!(m.undo());
            assert_bit_equal(m.complex(), state);
        }
        while m.redo() {}
        assert_bit_equal(m.complex(), &last);
    }
    assert!(met.len() == 7 && met.values().all(|[done, _]| *done > 5), "{met:?}");
}
