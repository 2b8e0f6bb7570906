//! Building dress forms: the default mesh, a coarse and a fine one.

use criterion::{Criterion, criterion_group, criterion_main};
use reference::dress_form::{DressForm, FormOptions, Preset};

fn forms(c: &mut Criterion) {
    let mut group = c.benchmark_group("dress_form");
    group.sample_size(10);
    for name in ["astm-12", "average-man", "child-128"] {
        let Some(preset) = Preset::find(name) else { continue };
        group.bench_function(name, |b| {
            b.iter(|| DressForm::build(&preset.measurements, &FormOptions::default()))
        });
    }
    for triangles in [8_000, 80_000] {
        let Some(preset) = Preset::find("eu-38") else { continue };
        let options = FormOptions { triangles, ..FormOptions::default() };
        group.bench_function(format!("eu-38 {triangles} triangles"), |b| {
            b.iter(|| DressForm::build(&preset.measurements, &options));
        });
    }
    group.finish();
}

criterion_group!(benches, forms);
criterion_main!(benches);
