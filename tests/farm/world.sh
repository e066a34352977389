#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A world that is cut into tiles, cooked in three shards, and merged: its answers against those of one tree of it, bit for bit;
# what is cooked again after an edit; and memory. docs/FARM.md has the figures of larger worlds.
#   tests/farm/world.sh BOXTREE GENERATE SAME_ANSWERS [TRIANGLES [PER_TILE [QUERIES [MEMORY]]]]
#   GENERATE, SAME_ANSWERS   the programs boxtree_generate and boxtree_same_answers
#   MEMORY                   of tile, and of cook --manifest, in MB
# Environment: WORLD_FOLDER, a folder that keeps everything [none]; WORLD_ONE=no cooks no tree of the whole and compares nothing
set -euo pipefail
boxtree=$(realpath "$1") generate=$(realpath "$2") same=$(realpath "$3")
triangles=${4:-200000} per_tile=${5:-10000} queries=${6:-2000} memory=${7:-24}
if [ -n "${WORLD_FOLDER:-}" ]; then
  mkdir -p "$WORLD_FOLDER"
  cd "$WORLD_FOLDER"
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cd "$work"
fi
fail() {
  echo "world.sh: $*" >&2
  exit 1
}
cat >measure.py <<'END'
"""measure.py TITLE COMMAND...: runs it; a line of what it took, and its peak in MB in ./last. Its output goes to ./out."""
import os, subprocess, sys, time
title, *command = sys.argv[1:]
start = time.time()
process = subprocess.Popen(command, stdout=open("out", "w"))
_, status, used = os.wait4(process.pid, 0)
seconds, cpu, peak = time.time() - start, used.ru_utime + used.ru_stime, used.ru_maxrss >> 10
if status:
    sys.exit(f"world.sh: {title}: exit {os.waitstatus_to_exitcode(status)}")
print(f"{title:28} {seconds:8.1f} s {cpu:8.1f} s processor {peak:6} MB", flush=True)
open("last", "w").write(str(peak))
END
measure() { python3 measure.py "$@"; }
peak() { cat last; }

[ -e world.ply ] || "$generate" terrain "$triangles" world.ply
measure "info" "$boxtree" --version
program=$(peak)

measure "tile" "$boxtree" tile world.ply --triangles-per-tile "$per_tile" --memory "${memory}M" -o world.jsonl
cat out
[ "$(peak)" -le $((program + memory + 8)) ] || fail "tile takes $(peak) MB, of which the program has $program"
tiles=$(wc -l <world.jsonl)
[ "$tiles" -gt 12 ] || fail "$tiles tiles are too few"
for i in 0 1 2; do
  measure "cook, shard $i of 3" "$boxtree" cook --manifest world.jsonl --shard "$i/3" --memory "$((memory * 4))M" --journal "shard$i.done" --quiet
done
measure "merge" "$boxtree" merge --manifest world.jsonl -o world.bxt
cat out
[ "$triangles" -gt 1000000 ] || "$boxtree" verify world.bxt

if [ "${WORLD_ONE:-yes}" = yes ]; then
  measure "cook as one tree" "$boxtree" cook world.ply --exact -o one.bxt --quiet
  measure "compare" "$same" one.bxt world.bxt "$queries" || { cat out && fail "answers differ"; }
  cat out
fi

# One corner of the world is edited: the first vertex goes up. Its tile alone is written, and cooked.
cp world.jsonl before.jsonl
python3 - <<'END'
import struct
with open("world.ply", "r+b") as file:
    head = file.read(4096)
    at = head.index(b"end_header\n") + len(b"end_header\n")
    assert b"property float x\nproperty float y\nproperty float z\n" in head
    low = struct.unpack_from("<f", head, at + 8)[0]
    file.seek(at + 8)
    file.write(struct.pack("<f", low + 0.125))
END
"$boxtree" tile world.ply --triangles-per-tile "$per_tile" --memory "${memory}M" -o world.jsonl >out
grep -q ", 1 written" out || fail "an edit of one corner: $(cat out)"
cmp world.jsonl before.jsonl
# Found by an audit: merge took a tile that was cooked before the edit.
refused() { # MESSAGE: merge ends with 2, and the old world is there
  cp world.bxt old.bxt
  status=0
  "$boxtree" merge --manifest world.jsonl -o world.bxt --quiet 2>err || status=$?
  [ "$status" = 2 ] || fail "merge of stale tiles ends with $status"
  grep -q "$1" err || fail "merge of stale tiles: $(cat err)"
  cmp world.bxt old.bxt
}
refused '^boxtree: file_unreadable: world.jsonl:[0-9]*: world/.*.bxt: it was cooked from other bytes than world/.*.ply has now; cook it again: boxtree cook --manifest world.jsonl$'
cooked=0
for i in 0 1 2; do
  "$boxtree" cook --manifest world.jsonl --shard "$i/3" --journal "shard$i.done" >out
  cooked=$((cooked + $(sed -En 's/.*: ([0-9]+) cooked.*/\1/p' out)))
done
[ "$cooked" = 1 ] || fail "$cooked tiles were cooked after an edit of one"
"$boxtree" merge --manifest world.jsonl -o world.bxt --quiet 2>err
[ ! -s err ] || fail "merge of fresh tiles: $(cat err)"
# Cooked elsewhere: nothing to compare with, which one warning says.
cp world.bxt old.bxt
mkdir -p away
mv world/*.ply away
"$boxtree" merge --manifest world.jsonl -o world.bxt --json >out 2>err
cmp world.bxt old.bxt
[ "$(cat err)" = "boxtree: warning: world.jsonl: $tiles of $tiles tiles not compared with the sources, which are not here, or the tile has no cook record (--strip)" ] ||
  fail "merge without sources: $(cat err)"
grep -q "\"unchecked\": *$tiles" out || fail "merge without sources: $(cat out)"
mv away/*.ply world
if [ "${WORLD_ONE:-yes}" = yes ]; then
  "$boxtree" cook world.ply --exact -o one.bxt --quiet
  "$same" one.bxt world.bxt $((queries / 4)) || fail "answers differ after an edit"
fi
echo "world.sh: $triangles triangles in $tiles tiles answer as one tree does"
