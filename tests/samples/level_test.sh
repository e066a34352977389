#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The sample level: its file is what the script writes, and the programs say what the README says.
#   level_test.sh FOLDER_OF_PROGRAMS SOURCE_FOLDER
set -euo pipefail
programs=$1 level=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

python3 "$level/make_level.py" level.gltf
cmp level.gltf "$level/level.gltf"

"$programs/cook_level" "$level/scene.toml" level.bxt >cooked
grep -q '^53 instances (1 moving) of 8 meshes: 9648 triangles' cooked
grep -q 'wall .* wide4, geometry grid' cooked
grep -q 'left out: face ids of mesh floor, about .*: scene.toml:[0-9]*: face_ids = false' cooked

"$programs/walk_level" level.bxt >walk
grep -q 'on grass of Floor' walk
grep -q 'on stone of Floor' walk
for step in 1 2 3 4 5 6 7 8 9 10; do
  grep -q "on stone of Step $step\$" walk
done
grep -q 'on stone of Landing' walk
# Past a lamp, over a barrel and down to the wall.
grep -q 'on glass of Lamp' walk
grep -q 'on wood of Barrel' walk
grep -q '^blocked at (7.49, 0.00, -7.00)$' walk

cp level.bxt before.bxt
"$programs/drop_crate" level.bxt >drop
# The top of step 7 is at 1.26, and the crate's centre 0.4 above its bottom.
grep -Eq 'rests at height 1\.66[0-9]* on "Step 7"$|rests at height 1\.6[56][0-9]* on "Step 7"$' drop
cmp before.bxt level.bxt

# What the profile left out is refused by its line when it is requested.
sed 's/queries = \["ray", "box", "pair"\]/queries = ["ray", "box"]/' "$level/scene.toml" >"$work/no_pairs.toml"
cp "$level/level.gltf" "$work/level.gltf"
"$programs/cook_level" no_pairs.toml no_pairs.bxt >/dev/null
if "$programs/drop_crate" no_pairs.bxt 2>err; then
  echo "a level without contacts was bound for them"
  exit 1
fi
grep -q 'pair queries were left out by no_pairs.toml:[0-9]*: queries = \["ray", "box"\]' err
