//! Features of a dress form of some 20,000 triangles and, where they lie beside the checkout, of a model and a scan.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use reference::dress_form::{DressForm, FormOptions, presets};
use reference::human::{HumanOptions, extract};

fn features(c: &mut Criterion) {
    let mut group = c.benchmark_group("human");
    group.sample_size(20);
    let options = HumanOptions::default();
    if let Some(form) =
        presets().first().and_then(|p| DressForm::build(&p.measurements, &FormOptions::default()).ok())
    {
        group.bench_function("form", |b| b.iter(|| black_box(extract(&form.mesh, &options))));
    }
    for name in ["female-average", "scan-noisy-plus", "scan-remeshed"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../../shared/bodies/{name}.obj"));
        if let Ok(mesh) = mesh_kernel::files::read(&path) {
            group.bench_function(name, |b| b.iter(|| black_box(extract(&mesh, &options))));
        }
    }
    group.finish();
}

criterion_group!(benches, features);
criterion_main!(benches);
