//! Which side of a wall is kept: the one that knows what stands on it.

use crate::deflate::solid_models::prism;
use sheet::deflate::{DeflateOptions, Nobody, deflate};

/// Half a tube whose edges are bent sharply inward would rather be kept on its inside, which does not know of the fin.
#[test]
fn fins_outside_of_a_bent_wall_share_its_nodes() {
    let arc = |radius: f64, from: f64, to: f64, chords: u32| {
        (0..=chords).map(move |k| {
            let angle = from + (to - from) * f64::from(k) / f64::from(chords);
            [radius * angle.cos(), radius * angle.sin()]
        })
    };
    for (outer, inner) in [(9, 17), (20, 20), (40, 31)] {
        let low = (-2.0f64 / 20.0).asin();
        let fin = (1.0f64 / 20.0).acos();
        let mut profile = vec![[10.0, -2.0]];
        profile.extend(arc(20.0, low, fin, outer));
        profile.extend([[1.0, 30.0], [-1.0, 30.0]]);
        profile.extend(arc(20.0, std::f64::consts::PI - fin, std::f64::consts::PI - low, outer));
        profile.extend([[-10.0, -2.0], [-10.0, 0.0]]);
        profile.extend(arc(18.0, std::f64::consts::PI, 0.0, inner));
        profile.push([10.0, 0.0]);
        let solid = prism(&profile, 40.0, 2);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        assert_eq!([r.patches, r.joints, r.components], [5, 1, 1], "{outer} chords, {inner} inside");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{outer} chords, {inner} inside");
    }
}
