#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A cook farm on one machine: generated meshes, a manifest, shards side by side, a cache that they share, one edited
# mesh, keys, an audit, a pack, a world in tiles. docs/FARM.md goes through it.
#   samples/farm/farm.sh [MESHES [SHARDS]]       200 meshes in 4 shards by default; boxtree is on the PATH
set -euo pipefail
meshes=${1:-200} shards=${2:-4}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A hill of N x N cells of two triangles.
make_mesh() {
  awk -v n="$1" 'BEGIN {
    for (y = 0; y <= n; ++y) for (x = 0; x <= n; ++x) printf "v %d %d %.6f\n", x, y, n * sin(x / n * 3) * sin(y / n * 3)
    for (y = 0; y < n; ++y) for (x = 1; x <= n; ++x) {
      corner = y * (n + 1) + x
      printf "f %d %d %d\nf %d %d %d\n", corner, corner + 1, corner + n + 2, corner, corner + n + 2, corner + n + 1
    }
  }'
}
mkdir meshes cooked
for ((i = 0; i < meshes; ++i)); do
  make_mesh $((22 + i % 40)) >"meshes/hill$i.obj"
  echo "{\"inputs\": [\"meshes/hill$i.obj\"], \"output\": \"cooked/hill$i.bxt\"}"
done >jobs.jsonl

echo "one run:"
boxtree cook --manifest jobs.jsonl
(cd cooked && sha256sum ./*.bxt) >one_run.sums

echo "$shards shards at once, each with a part of the jobs, and all with one cache:"
rm cooked/*.bxt
for ((i = 0; i < shards; ++i)); do
  boxtree cook --manifest jobs.jsonl --shard "$i/$shards" --cache cache --jobs 1 &
done
wait
(cd cooked && sha256sum --check --quiet ../one_run.sums)
echo "they wrote the bytes of one run"

echo "another checkout, with the same cache:"
mkdir elsewhere elsewhere/cooked
cp -r meshes jobs.jsonl elsewhere
(cd elsewhere && boxtree cook --manifest jobs.jsonl --cache ../cache)
(cd elsewhere/cooked && sha256sum --check --quiet ../../one_run.sums)

echo "one mesh is edited:"
echo "# edited" >>elsewhere/meshes/hill0.obj
(cd elsewhere && boxtree cook --manifest jobs.jsonl --cache ../cache)

echo "keys, which an engine's own cache may be keyed by, and the files that the first job reads:"
boxtree key --manifest jobs.jsonl | head -2 || true
boxtree key meshes/hill0.obj -o cooked/hill0.bxt --inputs

echo "an audit cooks some of the cache's hits again and compares:"
rm elsewhere/cooked/*.bxt
(cd elsewhere && boxtree cook --manifest jobs.jsonl --cache ../cache --audit 0.1)

echo "one file of all outputs, and all of them out of it again:"
boxtree key --manifest jobs.jsonl | cut -f2 >outputs.txt
boxtree pack @outputs.txt --names path -o assets.bxt
rm cooked/*.bxt
boxtree split assets.bxt -o . --quiet
(cd cooked && sha256sum --check --quiet ../one_run.sums)
boxtree query assets.bxt --tree cooked/hill0 ray --origin 5,5,99 --direction 0,0,-1 | head -2

echo "a world in tiles, of which an edit cooks its own:"
for ((i = 0; i < 4; ++i)); do
  awk -v dx=$((i % 2 * 100)) -v dy=$((i / 2 * 100)) '$1 == "v" { print "v", $2 + dx, $3 + dy, $4; next } { print }' "meshes/hill$i.obj" >"part$i.obj"
done
boxtree tile part[0-3].obj -o world.jsonl --triangles-per-tile 800
boxtree cook --manifest world.jsonl --cache cache
boxtree merge --manifest world.jsonl -o world.bxt
boxtree query world.bxt ray --origin 105,105,99 --direction 0,0,-1 | head -2
sed -i '1s/.*/v 0 0 1/' part0.obj
boxtree tile part[0-3].obj -o world.jsonl --triangles-per-tile 800
boxtree cook --manifest world.jsonl --cache cache
boxtree merge --manifest world.jsonl -o world.bxt
