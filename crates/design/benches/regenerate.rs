//! The whole way from a body to files, on the shipped samples.
#![allow(clippy::unwrap_used, reason = "what is unexpected here is a finding")]

use std::path::Path;
use std::time::Instant;

use criterion::{Criterion, criterion_group, criterion_main};
use design::regenerate::{Artifact, Settings, regenerate};
use template::Template;

fn whole(c: &mut Criterion) {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    let body = mesh_kernel::files::read(&samples.join("form-12.obj")).unwrap();
    let mut group = c.benchmark_group("regenerate");
    group.sample_size(10);
    for name in ["princess-dress", "fitted-bodice"] {
        let text = std::fs::read_to_string(samples.join(format!("{name}.json"))).unwrap();
        let template = Template::from_json(&text).unwrap();
        let run = || regenerate(&template, "form-12.obj", &body, &Settings::default(), &|_| true).unwrap();
        group.bench_function(format!("{name} in memory"), |b| b.iter(run));
        let built = run();
        group.bench_function(format!("{name} files"), |b| {
            b.iter(|| {
                let folder = tempfile::tempdir().unwrap();
                built.clone().write(folder.path(), &Artifact::DEFAULT, Instant::now()).unwrap();
            });
        });
    }
    group.finish();
}

criterion_group!(benches, whole);
criterion_main!(benches);
