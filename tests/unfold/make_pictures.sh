#!/usr/bin/env bash
# The pictures of docs/sheet-modelling.md, made by the program. By hand: CI only looks whether the commands work.
set -euo pipefail
cd "$(dirname "$0")/../.."
toile=${TOILE:-target/release/toile}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
pictures=docs/sheet-modelling
mkdir -p "$pictures"

# Pictures look along −z with y up; parts stand on z = 0.
upright() { awk '$1 == "v" { print "v", $2, $4, -$3; next } { print }' "$1" > "$2"; }
for name in bracket three-cells four-cells box-partition square-torus hexagon-prism mount; do
  "$toile" model "samples/sheets/$name.json" -o "$work/$name.obj" --quiet
  upright "$work/$name.obj" "$work/up.obj"
  "$toile" render "$work/up.obj" --unit mm --view iso --size 480x400 -o "$pictures/$name.png"
done
"$toile" unfold samples/sheets/bracket.json -o "$pictures/bracket-flat.svg" --quiet
"$toile" unfold samples/sheets/bracket.json --thickness 2 --radius 2 --relief round -o "$pictures/bracket-2mm.svg" --quiet
"$toile" unfold samples/sheets/three-cells.json -o "$pictures/three-cells-flat.svg" --quiet
"$toile" unfold samples/sheets/four-cells.json -o "$pictures/four-cells-flat.svg" --quiet
"$toile" unfold samples/sheets/mount.json -o "$pictures/mount-flat.svg" --quiet
"$toile" thicken samples/sheets/mount.json --thickness 3 -o "$work/solid.obj" --quiet
upright "$work/solid.obj" "$work/up.obj"
"$toile" render "$work/up.obj" --unit mm --view iso --size 480x400 -o "$pictures/mount-solid.png"
