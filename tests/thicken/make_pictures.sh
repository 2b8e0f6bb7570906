#!/usr/bin/env bash
# The pictures of docs/thickening.md, made by the program. By hand: CI only looks whether the commands work.
set -euo pipefail
cd "$(dirname "$0")/../.."
toile=${TOILE:-target/release/toile}
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
pictures=docs/thickening
mkdir -p "$pictures"

"$toile" render samples/desk-tray.obj --unit mm --view iso --size 640x480 -o "$pictures/sheet.png"
"$toile" thicken samples/desk-tray.obj --thickness 2 -o "$work/tray.obj"
"$toile" render "$work/tray.obj" --unit mm --view iso --size 640x480 -o "$pictures/solid.png"

# A fold whose end shows its corner.
cat > "$work/fold.obj" <<'OBJ'
v 0 0 0
v 0 0 -20
v 20 0 0
v 20 0 -20
v 0 16 0
v 0 16 -20
g floor
f 1 3 4
f 1 4 2
g wall
f 1 2 6
f 1 6 5
OBJ
for corners in round mitre; do
  "$toile" thicken "$work/fold.obj" --thickness 5 --corners $corners -o "$work/$corners.obj"
  "$toile" render "$work/$corners.obj" --unit mm --view iso --size 480x400 -o "$pictures/$corners.png"
done

"$toile" regenerate samples/fitted-bodice.json --body samples/form-12.obj --out "$work/bodice" --formats obj
"$toile" thicken "$work/bodice/garment.obj" --thickness 4 -o "$work/bodice.obj"
"$toile" render "$work/bodice.obj" --view iso --size 640x640 -o "$pictures/bodice.png"
