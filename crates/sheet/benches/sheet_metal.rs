//! One-piece search, unfolding, and a script of commands, on walls about cells (three facets a cell, four at inner lines).
#![allow(missing_docs, clippy::unwrap_used)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sheet::bends::analyse;
use sheet::facets::{FacetRule, FacetSheet};
use sheet::model::{Limits, Script};
use sheet::unfold::{Effort, UnfoldOptions, unfold};

/// A script of walls about n × n cells, with a floor in every second one.
fn crate_of(n: usize) -> String {
    let mut lines = Vec::new();
    for i in 0..=n {
        lines.push(format!("[[{}, 0, 0], [{}, {}, 0]]", 40 * i, 40 * i, 40 * n));
        lines.push(format!("[[0, {}, 0], [{}, {}, 0]]", 40 * i, 40 * n, 40 * i));
    }
    let mut commands = vec![
        format!("{{\"do\": \"wire\", \"name\": \"w\", \"lines\": [{}]}}", lines.join(", ")),
        "{\"do\": \"extrude\", \"name\": \"wall\", \"wire\": \"w\", \"by\": [0, 0, 30]}".to_owned(),
    ];
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|(i, j)| (i + j) % 2 == 0) {
        let [x, y, u, v] = [40 * i, 40 * j, 40 * (i + 1), 40 * (j + 1)];
        commands.push(format!(
            "{{\"do\": \"add\", \"name\": \"floor {i} {j}\", \"points\": [[{x}, {y}, 0], [{u}, {y}, 0], [{u}, {v}, 0], [{x}, {v}, 0]]}}"
        ));
    }
    format!("{{\"toile_script\": 1, \"commands\": [{}]}}", commands.join(",\n"))
}

fn sheet_metal(c: &mut Criterion) {
    let mut group = c.benchmark_group("sheet_metal");
    group.sample_size(10);
    for n in [2, 4, 8] {
        let text = crate_of(n);
        let run = || Script::read(&text).unwrap().run(Limits::default()).unwrap();
        let sheet = FacetSheet::new(&run().model.to_mesh(), FacetRule::Auto).unwrap();
        let facets = sheet.facets.len();
        group.bench_function(BenchmarkId::new("script", facets), |b| b.iter(run));
        group.bench_function(BenchmarkId::new("one_piece", facets), |b| {
            b.iter(|| analyse(&sheet, Effort::default()).unwrap())
        });
        group.bench_function(BenchmarkId::new("unfold", facets), |b| {
            b.iter(|| unfold(&sheet, &UnfoldOptions::default()).unwrap())
        });
    }
    group.finish();
}

criterion_group!(benches, sheet_metal);
criterion_main!(benches);
