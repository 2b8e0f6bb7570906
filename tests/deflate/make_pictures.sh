#!/usr/bin/env bash
# The pictures of docs/deflation.md, made by the program. By hand.
set -euo pipefail
cd "$(dirname "$0")/../.."
toile=${TOILE:-target/release/toile}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
pictures=docs/deflation
mkdir -p "$pictures"

"$toile" thicken samples/desk-tray.obj --thickness 2 -o "$work/tray.obj"
"$toile" render "$work/tray.obj" --unit mm --view iso --size 640x480 -o "$pictures/solid.png"
"$toile" deflate "$work/tray.obj" -o "$work/mid.obj"
"$toile" render "$work/mid.obj" --unit mm --view iso --size 640x480 -o "$pictures/sheet.png"
"$toile" thicken samples/desk-tray.obj --thickness 1.6 --patch-thickness front=3 -o "$work/uneven.obj"
"$toile" deflate "$work/uneven.obj" -o "$work/uneven-mid.obj"
"$toile" render "$work/uneven-mid.obj" --unit mm --view iso --color thickness --size 640x480 -o "$pictures/thickness.png"
