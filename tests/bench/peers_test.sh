#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# boxtree_peers: all our codecs and the original agree with brute force on every query that was
# checked, and with each other; every library that answers does so with rows. No time is looked at.
#   peers_test.sh BOXTREE_PEERS
set -euo pipefail
peers=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mesh=$work/potato.obj rows=$work/rows.json

# A closed surface without planes or symmetry: contacts are crossings, not touches.
awk 'BEGIN {
  rings = 24; points = 40; pi = atan2(0, -1)
  for (i = 0; i <= rings; ++i) for (j = 0; j < points; ++j) {
    a = pi * i / rings; b = 2 * pi * j / points
    r = 1 + 0.2 * sin(3 * a + 0.3) * cos(2 * b + 0.7) + 0.05 * sin(7 * b + 5 * a)
    printf "v %.9f %.9f %.9f\n", 1.3 * r * sin(a) * cos(b), r * sin(a) * sin(b), 0.8 * r * cos(a)
  }
  for (i = 0; i < rings; ++i) for (j = 0; j < points; ++j) {
    p = i * points + j + 1; q = i * points + (j + 1) % points + 1
    printf "f %d %d %d\nf %d %d %d\n", p, q, p + points, q, q + points, p + points
  }
}' >"$mesh"
"$peers" "$mesh" --answers --runs 1 --tumble 1 --json >"$rows" 2>/dev/null

# none FILTER WHY: no row may match.
none() {
  local found
  found=$(jq -c ".rows[] | select($1)" "$rows")
  [ -z "$found" ] && return 0
  printf '%s\n%s\n' "$2" "$found"
  exit 1
}
none '(.library == "boxtree" or .library == "original") and (.metric | endswith("_wrong")) and .value != 0' \
  'answers that differ from brute force'
none '.library == "boxtree" and (.metric | endswith("_checked")) and .value < 4' 'hardly anything was checked'

# same METRIC: one value over all our codecs and the original.
same() {
  local values
  values=$(jq -c "[.rows[] | select((.library == \"boxtree\" or .library == \"original\") and .metric == \"$1\") | .value] | unique" "$rows")
  [ "$(jq length <<<"$values")" -eq 1 ] || { echo "$1: expected one value, found $values"; exit 1; }
}
for metric in {ray,camera,segment}{,_batch}_hits cast_{sphere,capsule,cube}_hits overlap_{sphere,capsule,cube}_tris collide_{sphere,capsule,cube}_contacts \
  box_tris pair_hits pair_pairs tumble_first_hits; do
  same "$metric"
done

codecs=$(jq -r '[.rows[] | select(.library == "boxtree" and .metric == "ray_ns")] | length' "$rows")
[ "$codecs" -ge 6 ] || { echo "expected times of all codecs, found $codecs"; exit 1; }
# All but the two that have clusters, and the original.
[ "$(jq '[.rows[] | select(.metric == "tumble_all_level2_misses" and .value > 0)] | length' "$rows")" -gt $((codecs - 2)) ] ||
  { echo "no cache misses"; exit 1; }
echo "$(jq -r '[.rows[] | .library + " " + .variant] | unique | join(", ")' "$rows")"
