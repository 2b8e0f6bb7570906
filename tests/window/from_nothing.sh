#!/usr/bin/env bash
# From an empty window to a cutter's file with a real mouse: the program under Xvfb, hands by xdotool.
# What the hands do stands in from_nothing.hand, which the interface tests write and check.
# usage: tests/window/from_nothing.sh [FOLDER FOR SCREENSHOTS]
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v Xvfb >/dev/null || ! command -v xdotool >/dev/null || ! command -v import >/dev/null; then
  apt-get update -qq
  apt-get install -y -qq xvfb xdotool imagemagick x11-utils libgl1-mesa-dri libgl1 libegl1 libx11-6 libx11-xcb1 \
    libxcursor1 libxi6 libxrender1 libxkbcommon0 libxkbcommon-x11-0
fi
[ -x target/release/toile ] || cargo build --release -p cli --locked
work=$(mktemp -d)
export XDG_STATE_HOME=$work/state OUT=$work/skirt.export
unset WAYLAND_DISPLAY
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
xvfb=$!
toile=
trap 'kill $toile $xvfb 2>/dev/null || true; rm -rf "$work"' EXIT
for _ in $(seq 50); do [ -s "$work/display" ] && break; sleep 0.1; done
export DISPLAY=:$(cat "$work/display")
target/release/toile view >"$work/log" 2>&1 &
toile=$!
# Without a window manager nobody gives a window the keyboard; the window is as large as the screen.
window=$(timeout 30 xdotool search --sync --onlyvisible --pid $toile | head -1)
xdotool windowmove "$window" 0 0 windowsize "$window" 1280 800 windowfocus "$window"
sleep 3
while read -r what rest; do
  case $what in
    key) xdotool key --clearmodifiers "$rest" ;;
    type) xdotool type --delay 15 "${rest/\$OUT/$OUT}" ;;
    away) xdotool key Escape ;;
    wait) sleep 4; [ $# -gt 0 ] && import -window root "$1/built.png" ;;
    click)
      read -r x y _ <<<"$rest"
      xdotool mousemove "$x" "$y"; sleep 0.15
      xdotool mousedown 1; sleep 0.05; xdotool mouseup 1 ;;
  esac
  sleep 0.25
done < tests/window/from_nothing.hand
for _ in $(seq 60); do [ -f "$OUT/report.json" ] && break; sleep 0.5; done
[ $# -gt 0 ] && import -window root "$1/exported.png"
for file in pattern.dxf garment.obj pattern.pdf report.json; do
  [ -s "$OUT/$file" ] || { echo "the window did not export $file"; cat "$work/log"; exit 1; }
done
tail -1 "$OUT/pattern.dxf" | grep -q EOF
pieces=$(grep -c '"label"' "$OUT/pattern.json" || true)
echo "drawn, built and exported by hand: $(ls "$OUT" | wc -l) files, $pieces pieces or more"
# Killed, the work is there: at the next start it is offered.
sleep 3
kill -9 $toile; wait $toile 2>/dev/null || true
ls "$XDG_STATE_HOME"/toile/*.journal >/dev/null
grep -q '"edit":"fill_face"' "$XDG_STATE_HOME"/toile/*.journal
echo "killed, and the work is in its journal"
