//! Templates, forms and bodies that the tests run on.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

use crate::call::{toile, word};

/// The repository's root.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("crates/cli lies two folders deep")
}

/// All templates among the samples.
pub(crate) fn templates() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = std::fs::read_dir(root().join("samples"))
        .expect("the repository has samples")
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .filter(|path| std::fs::read_to_string(path).unwrap().contains("\"toile_template\""))
        .collect();
    found.sort();
    assert!(found.len() >= 2, "two templates at least, not {found:?}");
    found
}

/// The dress template.
pub(crate) fn dress() -> &'static Path {
    static DRESS: OnceLock<PathBuf> = OnceLock::new();
    DRESS.get_or_init(|| root().join("samples/princess-dress.json"))
}

/// A dress form of an average woman, made once by the binary.
pub(crate) fn form() -> &'static Path {
    static FORM: OnceLock<PathBuf> = OnceLock::new();
    FORM.get_or_init(|| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("form-{}.obj", std::process::id()));
        let words =
            ["form", "--bust", "97.4", "--waist", "80.3", "--hip", "104.1", "--height", "166.2", "-o"];
        toile(&[&words[..], &[word(&path)]].concat()).succeeded();
        path
    })
}

/// The bodies of `../shared/bodies`, by name; `None` when the folder is missing and may be.
pub(crate) fn shared_bodies() -> Option<Vec<PathBuf>> {
    let folder = root().join("../shared/bodies");
    if !folder.is_dir() {
        let required = std::env::var("TOILE_REQUIRE_SHARED").is_ok_and(|v| v == "1");
        assert!(!required, "{} is missing, and TOILE_REQUIRE_SHARED is set", folder.display());
        return None;
    }
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "obj"))
        .collect();
    found.sort();
    assert!(!found.is_empty());
    Some(found)
}

/// A ball of radius 1 m about (0, 1, 0): no body.
pub(crate) fn ball() -> String {
    let n = 24;
    let mut text = String::new();
    for j in 0..=n {
        for i in 0..n {
            let (a, b) = (
                f64::from(i) / f64::from(n) * std::f64::consts::TAU,
                f64::from(j) / f64::from(n) * std::f64::consts::PI,
            );
            let p = DVec3::new(b.sin() * a.sin(), 1.0 - b.cos(), b.sin() * a.cos());
            text.push_str(&format!("v {:.6} {:.6} {:.6}\n", p.x, p.y, p.z));
        }
    }
    for j in 0..n {
        for i in 0..n {
            let (a, b) = (j * n + i + 1, j * n + (i + 1) % n + 1);
            if j > 0 {
                text.push_str(&format!("f {a} {b} {}\n", a + n));
            }
            if j + 1 < n {
                text.push_str(&format!("f {b} {} {}\n", b + n, a + n));
            }
        }
    }
    text
}

/// Three square sheets of `n` x `n` cells that meet in the line x = y = 0: groups `a`, `b`, `c`, in millimetres.
pub(crate) fn three_sheets(n: u32) -> String {
    let mut text = String::new();
    let mut faces = [String::new(), String::new(), String::new()];
    let line = |j: u32| j + 1;
    for j in 0..=n {
        text.push_str(&format!("v 0 0 {}\n", 10 * j));
    }
    for (s, faces) in faces.iter_mut().enumerate() {
        let angle = s as f64 * 2.0;
        let node =
            |i: u32, j: u32| if i == 0 { line(j) } else { (n + 1) * (1 + s as u32 * n + i - 1) + j + 1 };
        for i in 1..=n {
            for j in 0..=n {
                let r = f64::from(10 * i);
                text.push_str(&format!("v {:.6} {:.6} {}\n", r * angle.cos(), r * angle.sin(), 10 * j));
            }
        }
        faces.push_str(&format!("g {}\n", ["a", "b", "c"][s]));
        for i in 0..n {
            for j in 0..n {
                let [p, q, r, t] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                faces.push_str(&format!("f {p} {q} {r}\nf {p} {r} {t}\n"));
            }
        }
    }
    text + &faces.concat()
}

/// Reads a mesh that the binary wrote.
pub(crate) fn read(path: &Path) -> TriMesh {
    mesh_kernel::files::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}
