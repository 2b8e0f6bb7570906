#!/usr/bin/env bash
# Edits a second beside OpenMesh and CGAL, run in turn; see README.md. By hand, not in CI.
set -euo pipefail
cd "$(dirname "$0")/../.."
rounds=${1:-5}
work=target/peers
mkdir -p "$work"

cargo build --release -q --locked -p mesh_kernel --example peer_ours
ours=target/release/examples/peer_ours
"$ours" panel "$work"
for peer in openmesh cgal; do
  libs=$([ $peer = openmesh ] && echo "-lOpenMeshCore" || echo "-lgmp -lmpfr")
  if [ ! -x "$work/$peer" ] || [ "tests/peers/$peer.cpp" -nt "$work/$peer" ] || [ tests/peers/common.h -nt "$work/$peer" ]; then
    g++ -O3 -DNDEBUG -std=c++17 -w "tests/peers/$peer.cpp" -o "$work/$peer" $libs
  fi
done

: > "$work/lines.tsv"
for round in $(seq "$rounds"); do
  for program in "$work/openmesh" "$work/cgal" "$ours run"; do
    $program "$work" >> "$work/lines.tsv"
  done
  echo "round $round of $rounds" >&2
done

awk -F'\t' '
  function rate(l, o) { return (l, o) in least ? valid[l, o] / least[l, o] / 1e6 : 0 }
  function show(x) { return x > 0 ? sprintf("%.2f", x) : "-" }
  function over(x, y) { return x > 0 && y > 0 ? sprintf("%.2f", x / y) : "-" }
  { key = $1 SUBSEP $2
    if (!(key in least) || $4 < least[key]) { least[key] = $4; valid[key] = $3 }
    if (!($2 in seen)) { seen[$2] = 1; order[++n] = $2 } }
  END {
    printf "%-20s %9s %9s %9s %12s %12s %12s   %s\n", "M/s a CPU second", "OpenMesh", "CGAL", "ours", "no journal", "ours/OpenMesh", "ours/CGAL", "valid operations"
    for (i = 1; i <= n; i++) {
      o = order[i]; a = rate("openmesh", o); b = rate("cgal", o); c = rate("ours", o); d = rate("ours without journal", o)
      printf "%-20s %9s %9s %9s %12s %12s %12s   %d %d %d\n", o, show(a), show(b), show(c), show(d), over(c, a), over(c, b), valid["openmesh", o], valid["cgal", o], valid["ours", o]
    } }' "$work/lines.tsv"
