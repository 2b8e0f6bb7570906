//! `batch`: failures are reported and the rest goes on; runs are taken up again; shards share the list.

use std::path::Path;

use serde_json::Value;

use crate::call::{Folder, Outcome, has_keys, list, toile, word};
use crate::fixtures::{ball, dress, form, read};

/// Runs a batch with small outputs.
fn batch(bodies: &Path, out: &Path, more: &[&str]) -> Outcome {
    let words =
        ["batch", word(dress()), "--bodies", word(bodies), "--out", word(out), "--json"].map(str::to_owned);
    let settings = ["--formats", "obj", "--levels", "2"].map(str::to_owned);
    let more: Vec<String> = more.iter().map(|w| (*w).to_owned()).collect();
    toile(&[&words[..], &settings, &more].concat())
}

/// Names and states of a batch's bodies, in its order.
fn states(report: &Value) -> Vec<(String, String)> {
    let bodies = report["bodies"].as_array().unwrap();
    let text = |v: &Value| v.as_str().unwrap().to_owned();
    bodies.iter().map(|b| (text(&b["name"]), text(&b["state"]))).collect()
}

fn pairs(of: &[(&str, &str)]) -> Vec<(String, String)> {
    of.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect()
}

#[test]
fn failures_do_not_stop_the_others_and_runs_resume() {
    let folder = Folder::new("batch");
    let bodies = folder.join("bodies");
    std::fs::create_dir(&bodies).unwrap();
    std::fs::copy(form(), bodies.join("good.obj")).unwrap();
    std::fs::write(bodies.join("ball.obj"), ball()).unwrap();
    std::fs::write(bodies.join("cut.obj"), "v 0 0 0\nv 1 0").unwrap();
    std::fs::write(bodies.join("notes.txt"), "not a body").unwrap();
    let out = folder.join("out");

    let first = batch(&bodies, &out, &[]).refused(1, "2 of 3");
    let report = first.json();
    has_keys(&report, &["template", "bodies"]);
    assert_eq!(states(&report), pairs(&[("ball", "failed"), ("cut", "failed"), ("good", "built")]));
    for body in report["bodies"].as_array().unwrap() {
        has_keys(body, &["name", "file", "state", "seconds"]);
        assert_eq!(body["error"].is_string(), body["state"] == "failed", "{body}");
    }
    assert_eq!(list(&out), ["batch.json", "good/"]);
    let built = read(&out.join("good/garment.obj"));
    assert_eq!(list(&out.join("good")), ["garment.obj", "report.json"]);

    // Again: what is done is kept, byte by byte; what failed is tried again.
    let when = std::fs::metadata(out.join("good/garment.obj")).unwrap().modified().unwrap();
    std::fs::copy(form(), bodies.join("ball.obj")).unwrap();
    let report = batch(&bodies, &out, &[]).refused(1, "1 of 3").json();
    assert_eq!(states(&report), pairs(&[("ball", "built"), ("cut", "failed"), ("good", "kept")]));
    assert_eq!(std::fs::metadata(out.join("good/garment.obj")).unwrap().modified().unwrap(), when);
    assert!(read(&out.join("ball/garment.obj")) == built, "the same body gives the same garment");

    // A changed input or setting is built anew, and so is everything when asked for.
    std::fs::remove_file(bodies.join("cut.obj")).unwrap();
    let report = batch(&bodies, &out, &["--sample-size", "OTHER"]).succeeded().json();
    assert_eq!(states(&report), pairs(&[("ball", "built"), ("good", "built")]));
    let report = batch(&bodies, &out, &["--sample-size", "OTHER", "--again"]).succeeded().json();
    assert_eq!(states(&report), pairs(&[("ball", "built"), ("good", "built")]));
    // A report that was cut off by a crash is not taken for a finished body.
    let report_path = out.join("good/report.json");
    let whole = std::fs::read(&report_path).unwrap();
    std::fs::write(&report_path, &whole[..whole.len() / 2]).unwrap();
    let report = batch(&bodies, &out, &["--sample-size", "OTHER"]).succeeded().json();
    assert_eq!(states(&report), pairs(&[("ball", "kept"), ("good", "built")]));
}

#[test]
fn shards_share_a_list_and_give_what_one_run_gives() {
    let folder = Folder::new("shards");
    let text = std::fs::read(form()).unwrap();
    for i in 0..3 {
        folder.write(&format!("b{i}.obj"), &text);
    }
    let names = folder.write("list.txt", "# three of a kind\nb0.obj\n\nb1.obj\nb2.obj\n");
    let out = folder.join("out");
    let first = batch(&names, &out, &["--shard", "1/2"]).succeeded().json();
    let second = batch(&names, &out, &["--shard", "2/2"]).succeeded().json();
    let mut all = [states(&first), states(&second)].concat();
    all.sort();
    assert_eq!(all, pairs(&[("b0", "built"), ("b1", "built"), ("b2", "built")]));
    assert_eq!(
        list(&out).into_iter().filter(|n| n.ends_with('/')).collect::<Vec<_>>(),
        ["b0/", "b1/", "b2/"]
    );
    // The whole list finds everything done.
    let whole = batch(&names, &out, &[]).succeeded().json();
    assert_eq!(states(&whole), pairs(&[("b0", "kept"), ("b1", "kept"), ("b2", "kept")]));
}

#[test]
fn lists_that_name_nothing_are_refused() {
    let folder = Folder::new("no-bodies");
    let empty = folder.join("empty");
    std::fs::create_dir(&empty).unwrap();
    let out = folder.join("out");
    batch(&empty, &out, &[]).refused(1, "empty");
    batch(&folder.write("list.txt", "\n# nothing\n"), &out, &[]).refused(1, "list.txt");
    batch(&folder.join("nowhere"), &out, &[]).refused(1, "nowhere");
    let report = batch(&folder.write("list.txt", "nowhere.obj\n"), &out, &[]).refused(1, "1 of 1").json();
    assert_eq!(states(&report), pairs(&[("nowhere", "failed")]));
}

#[test]
#[cfg(unix)]
fn names_that_are_no_text_are_reported_as_far_as_they_are() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = Folder::new("odd-names");
    let bodies = folder.join("bodies");
    std::fs::create_dir(&bodies).unwrap();
    std::fs::write(bodies.join(std::ffi::OsStr::from_bytes(b"x\xff.obj")), "v 0 0 0\n").unwrap();
    let out = folder.join("out");
    let said = batch(&bodies, &out, &[]).refused(1, "1 of 1").json();
    assert_eq!(states(&said), pairs(&[("x\u{fffd}", "failed")]));
    let written: Value = serde_json::from_slice(&std::fs::read(out.join("batch.json")).unwrap()).unwrap();
    assert_eq!(said, written);
}

#[test]
fn results_stay_within_their_folder() {
    let folder = Folder::new("dotted");
    let bodies = folder.join("bodies");
    std::fs::create_dir(&bodies).unwrap();
    for name in ["...obj", "batch.json.obj"] {
        std::fs::copy(form(), bodies.join(name)).unwrap();
    }
    let out = folder.join("deep/out");
    batch(&bodies, &out, &[]).succeeded();
    assert_eq!(list(&folder.join("deep")), ["out/"]);
    assert_eq!(list(&out), ["batch.json", "batch.json-2/", "body/"]);
}

#[test]
fn a_body_whose_results_are_gone_is_built_again() {
    let folder = Folder::new("gone");
    // Lists of some editors begin with a mark of the byte order.
    let list = folder.write("list.txt", "\u{feff}one.obj\n");
    std::fs::copy(form(), folder.join("one.obj")).unwrap();
    let out = folder.join("out");
    let state = || states(&batch(&list, &out, &[]).succeeded().json());
    assert_eq!(state(), pairs(&[("one", "built")]));
    assert_eq!(state(), pairs(&[("one", "kept")]));
    std::fs::remove_file(out.join("one/garment.obj")).unwrap();
    assert_eq!(state(), pairs(&[("one", "built")]));
    assert!(out.join("one/garment.obj").is_file());
}
