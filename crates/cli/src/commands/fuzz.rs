//! Fuzzing of what the command line itself reads: its words, the values in them, lists of bodies.

use std::path::Path;

use ::fuzz::{CountingAllocator, Reader, Reading, Shape, fuzz};
use clap::Parser;

use super::{batch, flatten, render};
use crate::failure::Failure;
use crate::words::{Command, Words};

#[global_allocator]
static MEMORY: CountingAllocator = CountingAllocator::new();

fn run(name: &'static str, shape: Shape, seeds: &[&str], read: fn(&str) -> Result<Vec<usize>, Failure>) {
    let reader = Reader {
        name,
        shape,
        seeds: seeds.iter().map(|s| s.as_bytes().to_vec()).collect(),
        words: &["--", "-o", "=", "--json", "--threads", "--levels", "x", "/", "-", ";", ",", "#", "é"],
        inputs: 10_000,
        // The tables of words take half a megabyte, whatever the call.
        base_memory: 2 << 20,
        memory_factor: 400,
        read: Box::new(move |bytes| {
            let Ok(text) = std::str::from_utf8(bytes) else { return Reading::Refused("no text".into()) };
            match read(text) {
                Ok(sizes) => Reading::Sound(sizes),
                Err(failure) => {
                    assert!(matches!(failure.exit_code(), 1 | 2));
                    Reading::Refused(failure.to_string())
                }
            }
        }),
    };
    let report = fuzz(reader, &MEMORY);
    println!("{report}");
    assert!(report.finds.is_empty(), "{report}");
}

#[test]
fn words() {
    let calls = [
        "toile regenerate a.json --body b.obj --out o --formats obj,dxf --levels 3 --paper a4 --dxf gerber --threads 2",
        "toile batch a.json --bodies d --out o --shard 2/5 --again --sample-size M",
        "toile form --bust 98.4 --waist 81.9 --hip 105.4 --height 168 --figure man -o form.obj --head",
        "toile flatten m.obj -o m.svg --cut 3-17-9;4-5 --allowance 10 --unit cm --json -q",
        "toile render m.obj --with b.obj --view back --size 640x480 --color stretch --unit inch -o back.png -v",
        "toile features b.obj -o f.json --picture f.png",
        "toile check m.obj",
        "toile thicken s.obj --thickness 2 --side both --corners mitre -o s.stl --patch-thickness a=3 --mitre-limit 3",
        "toile deflate s.stl --max-thickness 3 --max-draft 5 --simplify 2 --keep 1 -o m.obj --inp m.inp --edge-length 2",
        "toile model s.json -o s.obj",
        "toile bends s.obj --facets planes --unit cm --json",
        "toile unfold s.obj -o s.dxf --thickness 2 --radius 3 --k-factor 0.42 --layer inside --relief round --relief-width 3",
        "toile thicken s.obj --thickness-file s.json --chord 0.01 --unit m -o s.glb",
    ];
    run("words", Shape::Bytes, &calls, |text| {
        // A call has few words; what the system passes on is cut off long before.
        let words = Words::try_parse_from(text.split_whitespace().take(200))
            .map_err(|e| Failure::words(e.to_string().chars().take(300).collect::<String>()))?;
        Ok(match &words.command {
            Command::Batch(words) => {
                words.shard.as_deref().map(batch::shard).transpose()?;
                vec![1]
            }
            Command::Flatten(words) => {
                let cuts = words.cut.as_deref().map(flatten::chains).transpose()?.unwrap_or_default();
                assert!(cuts.iter().all(|c| c.len() > 1));
                vec![2, cuts.len()]
            }
            Command::Render(words) => {
                let (width, height) = render::size(&words.size)?;
                assert!(width > 0 && height > 0);
                vec![3, width as usize, height as usize]
            }
            Command::Form(_) => vec![4],
            Command::Deflate(words) => {
                let lengths = words.max_thickness.iter().chain(&words.simplify).chain(&words.edge_length);
                assert!(lengths.clone().all(|t| t.is_finite() && *t > 0.0));
                vec![7, lengths.count(), words.keep.len()]
            }
            Command::Thicken(words) => {
                let named = words.patch_thickness.iter().map(|n| n.1);
                let all = named.chain(words.thickness).chain(words.chord).chain(words.mitre_limit);
                assert!(all.clone().all(|t| t.is_finite() && t > 0.0));
                vec![6, all.count()]
            }
            Command::Unfold(words) => {
                assert!((0.0..=1.0).contains(&words.k_factor));
                let lengths = [words.thickness, words.radius, words.relief_width, words.relief_depth];
                assert!(lengths.iter().flatten().all(|x| x.is_finite() && *x >= 0.0));
                vec![7, lengths.iter().flatten().count()]
            }
            _ => vec![5],
        })
    });
}

#[test]
fn list_of_bodies() {
    run("body list", Shape::Bytes, &["# bodies\na.obj\n\n  b/c.ply\r\n/d e.stl\n"], |text| {
        let paths = batch::listed(text, Path::new("folder"));
        if paths.is_empty() { Err(Failure::new("names no bodies")) } else { Ok(vec![paths.len()]) }
    });
}
