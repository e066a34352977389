#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The command line: outputs, errors, exit statuses, same bytes, old file kept on failure.
set -euo pipefail
# shellcheck source=tests/cli/expect.sh
. "$(dirname "$0")/expect.sh"
boxtree=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >cube.obj <<'OBJ'
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
v 0 0 1
v 1 0 1
v 0 1 1
v 1 1 1
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
OBJ

expect 0 "$boxtree" cook cube.obj -o cube.bxt --json --depfile cube.d
same "$(jq -r '.trees[0].triangles' out)" 12
same "$(jq -r '.trees[0].import.quads_kept' out)" 6
same "$(jq -r '[.trees[0].candidates[] | select(.rejected == null)] | length' out)" 1
grep -q '^cube.bxt:' cube.d
grep -q 'cube.obj' cube.d
expect 0 "$boxtree" verify cube.bxt
expect 0 "$boxtree" info cube.bxt --json
same "$(jq -c '.trees[0].bounds' out)" '{"min":[0,0,0],"max":[1,1,1]}'
same "$(jq -r '.trees[0].name' out)" cube
same "$(jq -r .cook_record out | jq -c '[.options.codec, .sources[0].name, .sources[0].faces]')" '["auto","cube",6]'
expect 0 "$boxtree" cook cube.obj -o stripped.bxt --strip
expect 0 "$boxtree" info stripped.bxt --json
same "$(jq -c '[.cook_record, .trees[0].name]' out)" '[null,""]'
# A renamed source changes no byte then; names of several trees are kept, by which they are found.
cp cube.obj renamed.obj
expect 0 "$boxtree" cook renamed.obj -o renamed.bxt --strip
cmp stripped.bxt renamed.bxt
expect 0 "$boxtree" cook cube.obj renamed.obj -o renamed.bxt --strip
expect 0 "$boxtree" info renamed.bxt --json
same "$(jq -c '[.trees[].name]' out)" '["cube","renamed"]'

# A grid: coarse enough to move vertices, fine enough for a tolerance, one of the two.
expect 0 "$boxtree" cook cube.obj -o grid.bxt --grid-bits 8 --json
same "$(jq -r '.trees[0].candidates[0].geometry' out)" grid
same "$(jq -r '.trees[0].candidates[0].error.max_vertex_error' out)" 0
expect 0 "$boxtree" verify grid.bxt
expect 0 "$boxtree" query grid.bxt ray --origin 0.25,0.5,5 --direction 0,0,-1 --json
same "$(jq -c '[.hit,.t,.face]' out)" '[true,4,1]'
sed 's/^v 1 /v 1.1 /' cube.obj >uneven.obj
expect 0 "$boxtree" cook uneven.obj cube.obj -o grid.bxt --tolerance 0.01 --json
jq -e '[.trees[].candidates[] | select(.geometry == "grid") | .error.max_vertex_error] | .[0] > 0 and max <= 0.01' out >/dev/null
same "$(jq -c '[.trees[].candidates[] | select(.geometry == "exact") | .error.max_vertex_error] | unique' out)" '[0,2.3841857821338408e-08]' # f32 takes that of 1.1
# One geometry for all trees of a file.
same "$(jq -r '[.trees[].chosen_geometry] | unique | length' out)" 1
expect 0 "$boxtree" info grid.bxt --json
jq -e '[.trees[].max_vertex_error] | max <= 0.01' out >/dev/null
expect 0 "$boxtree" cook uneven.obj cube.obj -o grid.bxt --grid-bits 8
expect 0 "$boxtree" info grid.bxt --json
jq -e '.trees | .[0].geometry == "grid" and .[0].max_vertex_error > 0 and .[0].max_vertex_error <= 0.01' out >/dev/null
expect 0 "$boxtree" verify grid.bxt
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-bits 7
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-bits 31
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-bits 8 --tolerance 1
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-bits 8 --exact
for length in 0 -1 inf nan; do expect 1 "$boxtree" cook cube.obj -o grid.bxt --tolerance=$length; done
# Tiles that are cooked apart have what they share in one place on grids of one step, whatever their extents. A tolerance
# takes the step by what each of them holds.
printf 'v %s\n' '0 0 0' '1.3 0 0' '1.3 1.7 0.3' '0 1.5 0' >left.obj
printf 'v %s\n' '1.3 0 0' '90.1 0 0' '88.9 1.2 2' '1.3 1.7 0.3' >right.obj
for tile in left right; do
  printf 'f %s\n' '1 2 3' '1 3 4' >>$tile.obj
  expect 0 "$boxtree" cook $tile.obj -o $tile.bxt --grid-step 2^-5
  same "$(grep -o 'step 2^[-0-9]*' out)" 'step 2^-5'
  expect 0 "$boxtree" export $tile.bxt -o $tile.stored.obj --triangles
done
same "$(grep -h '^v ' left.stored.obj right.stored.obj | sort -u | grep -c '^v 1\.3125 ')" 2
same "$(grep -h '^v ' left.stored.obj right.stored.obj | sort -u | grep '^v 1\.3125 1')" 'v 1.3125 1.6875 0.3125'
power='boxtree: usage: cook: --grid-step: expected a power of two from 2^-994 to 2^994, as cook prints it (2^-13) or in decimals, found'
for step in -5 0 nan inf 1e-310 1e999 2^ 2^x 2^0.5 2^9999 0.25m; do
  expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-step="$step"
  same "$(head -1 err)" "$power \"$step\""
done
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-step 0.1
same "$(head -1 err)" "$power \"0.1\"; the nearest are 2^-4 and 2^-3"
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-step 5
same "$(head -1 err)" "$power \"5\"; the nearest are 2^2 and 2^3"
for step in 0.125=-3 1.25e-1=-3 1=0 4=2; do
  expect 0 "$boxtree" cook cube.obj -o grid.bxt --grid-step "${step%=*}"
  same "$(grep -o 'step 2^[-0-9]*' out)" "step 2^${step#*=}"
done
# The step of one cook is that of the next: as its text, its JSON and `info` say it.
expect 0 "$boxtree" cook uneven.obj cube.obj -o steps.bxt --tolerance 0.01 --for memory --json
step=$(jq '.trees[0].grid_step' out)
same "$(jq -c '[.trees[].grid_step]' out)" "[$step,$step]"
expect 0 "$boxtree" info steps.bxt --json
same "$(jq -c '[.trees[].grid_step]' out)" "[$step,$step]"
expect 0 "$boxtree" info steps.bxt
same "$(grep -c '^  grid: step 2^-[0-9]*, no vertex moved by more than [0-9.e-]*$' out)" 1
same "$(grep -c '^  grid: step 2^-[0-9]*, no vertex moved$' out)" 1
expect 0 "$boxtree" cook uneven.obj -o steps.bxt --grid-step "$step" --json
same "$(jq '.trees[0].grid_step' out)" "$step"
expect 0 "$boxtree" cook cube.obj -o steps.bxt --exact --json
same "$(jq -c '[.trees[].grid_step]' out)" '[null]'
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-step 2^-5 --tolerance 1
expect 1 "$boxtree" cook cube.obj -o grid.bxt --grid-step 2^-5 --grid-bits 8
expect 5 "$boxtree" cook cube.obj -o grid.bxt --grid-step 2^-40
grep -q 'a step of 2^-40' err
# What a grid takes is told where it is half of the triangles or more, and is in the JSON where it is less.
expect 0 "$boxtree" cook cube.obj -o grid.bxt --tolerance 100 --for memory --quiet --json
same "$(cat err)" 'boxtree: warning: tree cube: 12 of 12 triangles lost their area on a grid of step 2^6, which moved a vertex by up to 1.74; a smaller tolerance or more --grid-bits keep it, --exact keeps all'
same "boxtree: warning: $(jq -r '.warnings[]' out)" "$(cat err)"
same "$(jq '.trees[0].lost_area' out)" 12
expect 0 "$boxtree" cook cube.obj -o grid.bxt --tolerance 0.1 --for memory --json
same "$(cat err; jq -c '[.warnings, .trees[0].lost_area]' out)" '[[],0]'
# Trees of one name, too.
mkdir -p other && cp uneven.obj other/cube.obj && cp cube.obj crate.obj
expect 0 "$boxtree" cook cube.obj other/cube.obj crate.obj -o named.bxt --json
same "$(cat err)" 'boxtree: warning: tree cube: 2 trees of the file have this name; --tree cube and find_tree() take the first, --tree NUMBER any'
same "boxtree: warning: $(jq -r '.warnings[]' out)" "$(cat err)"
expect 0 "$boxtree" cook --scene cube.obj other/cube.obj crate.obj -o named.bxt --quiet
same "$(cat err)" 'boxtree: warning: tree cube: 2 trees of the file have this name; --tree cube and find_tree() take the first, --tree NUMBER any'
# Finer than any grid: exact geometry keeps to it.
expect 0 "$boxtree" cook cube.obj -o grid.bxt --tolerance 1e-20 --json
jq -e '.trees[0].chosen_geometry | . == "exact" or . == "arrays"' out >/dev/null
jq -e '[.trees[0].not_tried[].geometry] | any(. == "grid")' out >/dev/null
# Budgets are kept, or refused with what is possible.
for goal in memory speed balance; do
  expect 0 "$boxtree" cook cube.obj -o grid.bxt --for "$goal" --max-bytes-per-triangle 100 --json
  jq -e '.trees[0].candidates[] | select(.rejected == null) | .bytes_per_triangle.total <= 100' out >/dev/null
  expect 0 "$boxtree" cook cube.obj -o grid.bxt --for "$goal" --max-slowdown 1.5 --json
  jq -e '.trees[0].candidates[] | select(.rejected == null) | .slowdown <= 1.5' out >/dev/null
done
expect 1 "$boxtree" cook cube.obj -o refused.bxt --max-bytes-per-triangle 1
grep -q '^boxtree: budget_unreachable: refused.bxt: wanted at most 1 B/tri; .* takes .* B/tri.*; fewer bytes take a tolerance, or a larger one, .*(cook --tolerance LENGTH in place of --exact' err
[ ! -e refused.bxt ]
for budget in 0 -1 nan; do expect 1 "$boxtree" cook cube.obj -o grid.bxt --max-slowdown=$budget; done
# Slowdowns below 1, faster than wide8 with arrays, may be requested, on the command line and in a profile.
expect 1 "$boxtree" cook cube.obj -o refused.bxt --max-slowdown 0.5
grep -q '^boxtree: budget_unreachable: refused.bxt: wanted a slowdown of at most 0.5; .* takes .* B/tri, slowdown [0-9.]* (slowdown: ' err
expect 0 "$boxtree" cook cube.obj -o refused.bxt --max-slowdown "$(sed -n 's/.*, slowdown \([0-9.]*\) (slowdown: .*/\1/p' err)"
rm refused.bxt
printf '[budget]\nslowdown = 0.5\n' >fast.toml
expect 1 "$boxtree" cook cube.obj -o refused.bxt --profile fast.toml
grep -q '^boxtree: budget_unreachable: fast.toml:2: slowdown = 0.5: wanted a slowdown of at most 0.5; .*, slowdown [0-9.]* (' err
[ ! -e refused.bxt ]

expect 0 "$boxtree" query cube.bxt ray --origin 0.25,0.5,5 --direction 0,0,-1 --json
same "$(jq -c '[.hit,.t,.face]' out)" '[true,4,1]'
expect 0 "$boxtree" query cube.bxt ray --origin 3,0.5,5 --direction 0,0,-1 --json
same "$(jq -c '.hit' out)" false
# Casts: a ball of radius 0.5 that falls on the top, a capsule with an end 1 below the other, a box that stands on an edge.
falls() {
  expect 0 "$boxtree" query cube.bxt cast --at 0.25,0.5,5 --direction 0,0,-1 --json "$@"
}
falls --sphere 0.5
same "$(jq -c 'keys_unsorted[1:]' out)" \
  '["hit","t","t_lower","face","triangle","point","normal","feature","initially_touching"]'
same "$(jq -c '[.hit,.face,.point,.normal,.feature,.initially_touching]' out)" \
  '[true,1,[0.25,0.5,1],[0,0,1],"face",false]'
jq -e '.t_lower <= 3.5 and .t >= .t_lower and (.t - 3.5 | fabs) < 1e-12' out >/dev/null
falls --sphere 0.5 --t-max 3.25
same "$(jq -c 'del(.schema)' out)" '{"hit":false}'
falls --capsule 0,0,-1,0.5 --any
same "$(jq -c .hit out)" true
falls --capsule 0,0,-1,0.5
same "$(jq -c '[.hit,(.t * 1e9 | round / 1e9)]' out)" '[true,2.5]'
falls --box 1,1,1 --rotation 0.5,0,0,1.20710678118654752
same "$(jq -c '[.hit,(.t * 1e9 | round / 1e9)]' out)" '[true,2.585786438]'
falls --box 1,1,1
same "$(jq -c '[.face,(.t * 1e9 | round / 1e9),.feature]' out)" '[1,3,"face"]'
# On its way through the cube a ball touches both halves of the top, of the side that is near, and of the bottom.
falls --sphere 0.375 --all
same "$(jq -c '[.count,(.hits == (.hits | sort_by(.t_lower, .face)))]' out)" '[6,true]'
same "$(jq -c '[.hits[] | [.face,.triangle]]' out)" '[[1,1],[1,0],[4,0],[4,1],[0,0],[0,1]]'
falls --sphere 0.375 --all --t-max 1
same "$(jq -c 'del(.schema)' out)" '{"count":0,"hits":[]}'
expect 0 "$boxtree" query cube.bxt cast --sphere 0.5 --at 0.5,0.25,1.25 --direction 0,0,0 --json
same "$(jq -c '[.t,.t_lower,.initially_touching]' out)" '[0,0,true]'
# Exactly one shape.
shapeless() {
  local said=$1
  shift
  expect 1 "$boxtree" query cube.bxt cast --at 0,0,9 --direction 0,0,-1 "$@"
  same "$(cat err)" "boxtree: usage: query cast: expected $said"
}
shapeless 'one shape, --sphere, --capsule, --box or --hull, found none'
shapeless 'one shape, --sphere, --capsule, --box or --hull, found --sphere and --box' --sphere 1 --box 1,1,1
shapeless '--rotation with --box or --hull, found it with --sphere' --sphere 1 --rotation 0,0,0,1
shapeless '--any or --all, found both' --sphere 1 --any --all
shapeless 'one shape, --sphere, --capsule, --box or --hull, found --sphere and --capsule' --sphere 1 --capsule 0,0,1,1 --batch -
# A ray passes the top from outside and the bottom from inside.
expect 0 "$boxtree" query cube.bxt ray --origin 0.25,0.5,5 --direction 0,0,-1 --all --json
same "$(jq -c '[.count,[.hits[] | [.t,.face,.normal[2]]]]' out)" '[2,[[4,1,1],[5,0,-1]]]'
side() {
  expect 0 "$boxtree" query cube.bxt ray --origin 0.25,0.5,5 --direction 0,0,-1 --back-faces "$1" --json
  same "$(jq -c '[.t,.face]' out)" "$2"
}
side hit '[4,1]'
side ignore '[4,1]'
side only '[5,0]'
expect 1 "$boxtree" query cube.bxt ray --origin 0,0,9 --direction 0,0,-1 --back-faces both
grep -q 'back-faces: expected hit, ignore or only, found "both"' err
expect 1 "$boxtree" query cube.bxt ray --origin 0,0,9 --direction 0,0,-1 --any --all
same "$(cat err)" 'boxtree: usage: query ray: expected --any or --all, found both'
falls --sphere 0.5 --back-faces only
same "$(jq -c '[.face,(.t * 1e9 | round / 1e9)]' out)" '[0,4.5]'
# A ball that is 1/4 deep in the top, whose two triangles meet below its center.
expect 0 "$boxtree" query cube.bxt collide --sphere 0.5 --at 0.25,0.5,1.25 --json
same "$(jq -c '[.count,(.contacts | max_by(.depth) | .face,.point,.normal,.depth,.feature)]' out)" \
  '[3,1,[0.25,0.5,1],[0,0,1],0.25,"face"]'
expect 0 "$boxtree" query cube.bxt collide --sphere 0.5 --at 0.5,0.5,1.25 --merge 0.001 --json
same "$(jq -c '[.count,(.contacts | map(.depth) | max)]' out)" '[1,0.25]'
expect 0 "$boxtree" query cube.bxt collide --box 0.25,0.25,0.5 --at 0.5,0.5,1.375 --json
same "$(jq -c '[.count,(.contacts | map([.normal,.depth]) | unique)]' out)" '[2,[[[0,0,1],0.125]]]'
# Beside the face below it the ball touches the edge of the other one, across which the floor goes on flat.
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n' >floor.obj
expect 0 "$boxtree" cook floor.obj -o floor.bxt --active-edges 5 -q
expect 0 "$boxtree" query floor.bxt collide --sphere 0.5 --at 0.75,0.5,0.25 --json
same "$(jq -c '[.contacts[] | [.feature,.is_active,.face_normal]]' out)" '[["face",true,[0,0,1]],["edge",false,[0,0,1]]]'
expect 0 "$boxtree" query floor.bxt cast --sphere 0.5 --at 0.75,0.5,2 --direction 0,0,-1 --json
same "$(jq -c '[.feature,.is_active,.face_normal]' out)" '["face",true,[0,0,1]]'
expect 0 "$boxtree" cook --scene floor.obj -o floors.bxt --active-edges 5 -q
expect 0 "$boxtree" query floors.bxt collide --sphere 0.5 --at 0.75,0.5,0.25 --json
same "$(jq -c '[.contacts[] | [.feature,.is_active]]' out)" '[["face",true],["edge",false]]'
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n' >hull.obj
expect 0 "$boxtree" query cube.bxt cast --hull hull.obj --at 0.25,0.25,3 --direction 0,0,-1 --json
same "$(jq -c '[.hit,.feature,([.t,.normal[2]] | map(. * 1e9 | round / 1e9))]' out)" '[true,"face",[2,1]]'
expect 0 "$boxtree" query cube.bxt collide --hull hull.obj --at 0.25,0.25,0.875 --rotation 0,0,0,2 --json
same "$(jq -c '[.contacts[].depth * 1e9 | round / 1e9] | max' out)" 0.125
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 0.5,0.5,1 --contacts --json
same "$(jq -c '[.hit,([.contacts[].depth] | max),([.contacts[].point[2] * 1e9 | round / 1e9] | max)]' out)" '[true,0,1]'
expect 1 "$boxtree" query cube.bxt collide --at 0,0,0
same "$(cat err)" 'boxtree: usage: query collide: expected one shape, --sphere, --capsule, --box or --hull, found none'
expect 0 "$boxtree" query cube.bxt box --min=0.9,0.4,0.4 --max 1.5,0.6,0.6 --json
same "$(jq -c '.faces' out)" '[5]'
expect 0 "$boxtree" query cube.bxt sphere --center 0.5,0.5,1.5 --radius 0.5 --json
same "$(jq -c '.faces' out)" '[1]'
# What is in x and y from -1 to 1 and z from 0 to 1/2, of OpenGL from -1/2 to 1/2: not the top.
expect 0 "$boxtree" query cube.bxt frustum --matrix 1,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1 --json
bottom=$(jq -c '.faces | sort' out)
expect 0 "$boxtree" query cube.bxt box --min=-1,-1,0 --max 1,1,0.5 --json
same "$(jq -c '.faces | sort' out)" "$bottom"
expect 0 "$boxtree" query cube.bxt frustum --matrix 1,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1 --open-gl --json
same "$(jq -c '.faces | sort' out)" "$bottom"
printf '%s\n' '{"kind":"frustum","matrix":[1,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1]}' >frustum.jsonl
expect 0 "$boxtree" query cube.bxt --batch frustum.jsonl
same "$(jq -c '.faces | sort' out)" "$bottom"
expect 1 "$boxtree" query cube.bxt frustum --matrix 1,2,3
grep -q 'matrix: expected 16 numbers between commas, found "1,2,3"' err
expect 1 "$boxtree" query cube.bxt frustum --matrix inf,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1
grep -q 'invalid_query: cube.bxt: frustum: planes: expected a matrix of finite numbers, .*found matrix \[inf,0,0,0,' err
expect 1 "$boxtree" query cube.bxt frustum --matrix 1,0,0,0,0,1,0,0,0,0,2,0,0,0,0,1 --instances
same "$(cat err)" 'boxtree: no_scene: cube.bxt: instances are those of a scene, and this is one tree; leave --instances out for its faces, or query a file of cook --scene, without --tree (of a pack, with --scene NAME)'
expect 1 "$boxtree" query cube.bxt contacts
same "$(cat err)" 'boxtree: no_scene: cube.bxt: contacts are those of a scene, and this is one tree; of a tree use collide or pair, or query a file of cook --scene, without --tree (of a pack, with --scene NAME)'
# The error of a hull's file is told by its name, not by that of the tree.
for kind in collide 'cast --direction 0,0,-1'; do
  # shellcheck disable=SC2086
  expect 2 "$boxtree" query cube.bxt $kind --hull no-hull.obj --at 0,0,3
  grep -q '^boxtree: file_not_found: no-hull.obj: no such file; ' err
done
expect 0 "$boxtree" query cube.bxt point --at 0.5,0.5,3 --json
same "$(jq -c '[.distance,.point]' out)" '[2,[0.5,0.5,1]]'
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 1,0.25,0.25 --json
same "$(jq -c '.hit' out)" true
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 1.001,0.25,0.25 --json
same "$(jq -c '.hit' out)" false

# As text, lists of lists have a line for each; other lists are one.
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 1,0.25,0.25
count=$(sed -n 's/^count: //p' out)
[ "$count" -gt 1 ]
grep -q '^pairs:$' out
same "$(grep -cE '^  \[[0-9]+,[0-9]+\]$' out)" "$count"
same "$(wc -l <out)" $((count + 3))
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 1.001,0.25,0.25
grep -q '^pairs: \[\]$' out
expect 0 "$boxtree" query cube.bxt sphere --center 0.5,0.5,0.5 --radius 0.5
grep -q '^faces: \[[0-5],' out

# Answers with bounds: exact ones, allowed errors, budgets. The cube is one leaf.
expect 0 "$boxtree" query cube.bxt distance cube.bxt --pose 3,0,0 --json
same "$(jq -c '[.lower <= 2, .upper >= 2, .upper - .lower < 1e-12, .converged, .found]' out)" \
  '[true,true,true,true,true]'
same "$(jq -c '[.points[][0], .faces[]]' out)" '[1,3,5,4]'
expect 0 "$boxtree" query cube.bxt distance cube.bxt --pose 1,0.25,0.25 --json
same "$(jq -c '[.lower,.upper]' out)" '[0,0]'
expect 0 "$boxtree" query cube.bxt distance cube.bxt --pose 3,0,0 --max-distance 1 --json
same "$(jq -c '[.lower >= 1, .lower <= 2, .upper, .found]' out)" '[true,true,null,false]'
for kind in 'point --at 3,0.5,0.5' 'distance cube.bxt --pose 3,0,0'; do
  expect 0 "$boxtree" query cube.bxt $kind --relative-error 0.5 --absolute-error 0.1 --json
  jq -e '.lower <= 2 and .upper >= 2 and .upper <= 1.5 * .lower + 1e-12 and .converged' out >/dev/null
  expect 0 "$boxtree" query cube.bxt $kind --budget 0 --json
  jq -e '.lower <= 2 and .lower > 1.9 and .upper == null and .converged == false and .nodes == 0' \
    out >/dev/null
  expect 0 "$boxtree" query cube.bxt $kind --budget 9 --json
  jq -e '.lower <= 2 and .upper >= 2 and .converged and .nodes > 0 and .nodes <= 9' out >/dev/null
  for bad in '--relative-error=-1' '--absolute-error=nan' '--budget=-1' '--budget=x'; do
    expect 1 "$boxtree" query cube.bxt $kind "$bad"
  done
done
# Overlap: overlapping and disjoint are certain; what is closer may be left undecided, even where it touches.
for kind in 'overlap cube.bxt --pose' 'box --max 9,9,9 --min'; do
  expect 0 "$boxtree" query cube.bxt $kind 1,0.25,0.25 --within 0 --json
  same "$(jq -c '.overlap' out)" '"overlapping"'
  expect 0 "$boxtree" query cube.bxt $kind 1.25,0.25,0.25 --within 0 --json
  same "$(jq -c '[.overlap, .face, .faces]' out)" '["disjoint",null,null]'
  expect 0 "$boxtree" query cube.bxt $kind 1,0.25,0.25 --within 99 --json
  same "$(jq -c '.overlap' out)" '"undecided"'
  expect 0 "$boxtree" query cube.bxt $kind 1.0009765625,0.25,0.25 --within 0.0001 --json
  same "$(jq -c '.overlap' out)" '"disjoint"'
  expect 0 "$boxtree" query cube.bxt $kind 1,0.25,0.25 --budget 0 --json
  same "$(jq -c '[.overlap, .nodes]' out)" '["budget_spent",0]'
  for bad in '--within=-1' '--within=nan' '--budget=-1'; do
    expect 1 "$boxtree" query cube.bxt $kind 1,0.25,0.25 "$bad"
  done
done
expect 0 "$boxtree" query cube.bxt overlap cube.bxt --pose 1,0.25,0.25 --json
contact=$(jq -c '.faces' out)
expect 0 "$boxtree" query cube.bxt pair cube.bxt --pose 1,0.25,0.25 --json
same "$(jq -c "any(.pairs[]; . == $contact)" out)" true
for kind in distance overlap; do
  expect 1 "$boxtree" query cube.bxt $kind
  grep -q 'FILE2 is required' err
done
# Numbers that no query can have: the kind, what was expected and what was found.
rejects() {
  local said=$1
  shift
  expect 1 "$boxtree" query cube.bxt "$@"
  grep -qF "boxtree: invalid_query: cube.bxt: $said" err || { cat err; exit 1; }
}
rejects 'ray: direction: expected finite and not zero, found origin [0.5,0,9], direction [0,0,0]' \
  ray --origin 0.5,0,9 --direction 0,0,0
rejects 'ray: t_max: expected t_min [0] or more, found origin [0,0,0], direction [0,0,1], t_max -1' \
  ray --origin 0,0,0 --direction 0,0,1 --t-max=-1
rejects 'ray: t_max: expected t_min [0] or more, found origin [0,0,0], direction [0,0,1], t_min 2, t_max 1' \
  ray --origin 0,0,0 --direction 0,0,1 --t-max 1 --t-min 2
rejects 'ray: t_min: expected 0 or more, found origin [0,0,0], direction [0,0,1], t_min -1' \
  ray --origin 0,0,0 --direction 0,0,1 --t-min=-1
rejects 'ray: origin: expected a finite point, at most 2^185 mesh extents away, found origin [0,0,1e+100], ' \
  ray --origin 0,0,1e100 --direction 0,0,1
rejects 'box: expected finite corners, min not above max on any axis, found min [1,0,0], max [0,1,1]' \
  box --min 1,0,0 --max 0,1,1
rejects 'box: within: expected 0 or more, found min [0,0,0], max [1,1,1], within -1' \
  box --min 0,0,0 --max 1,1,1 --within=-1
rejects 'sphere: radius: expected finite and 0 or more, found center [0,0,0], radius -1' \
  sphere --center 0,0,0 --radius=-1
rejects 'point: relative_error: expected 0 or more, found at [0,0,0], relative_error -1' \
  point --at 0,0,0 --relative-error=-1
rejects 'cast: radius: expected finite and 0 or more, found at [0,0,9], direction [0,0,-1], sphere -1' \
  cast --at 0,0,9 --direction 0,0,-1 --sphere=-1
rejects 'cast: direction: expected finite, found at [0,0,9], direction [0,0,inf], sphere 1' \
  cast --at 0,0,9 --direction 0,0,inf --sphere 1
rejects 'cast: half_extents: expected finite and 0 or more, found at [0,0,9], direction [0,0,-1], box [1,-1,1]' \
  cast --at 0,0,9 --direction 0,0,-1 --box 1,-1,1
rejects 'cast: rotation: expected four finite numbers, not all 0, found at [0,0,9], ' \
  cast --at 0,0,9 --direction 0,0,-1 --box 1,1,1 --rotation 0,0,0,0
rejects 'cast: end: expected a finite point, ' cast --at 0,0,9 --direction 0,0,-1 --capsule 0,0,inf,0
grep -q ', capsule \[0,0,inf,0\]$' err
rejects 'point: expected a finite point, ' point --at nan,0,0
grep -q ' found at \[nan,0,0\]$' err
rejects 'distance: max_distance: expected 0 or more, found max_distance -1' \
  distance cube.bxt --max-distance=-1
rejects 'overlap: within: expected 0 or more, found within -1' overlap cube.bxt --within=-1
# A pose that no query can have: whose it is, and what is wrong with it.
poses() {
  local said=$1
  shift
  expect 1 "$boxtree" query cube.bxt "$@"
  grep -qF "boxtree: invalid_pose: cube.bxt: $said" err || { cat err; exit 1; }
}
poses "pair: the second tree's pose is not invertible: it flattens what it places; expected finite numbers of an invertible "\
'map, not too far away, found [1,0,0,0,0,1,0,0,0,0,0,0]' pair cube.bxt --pose 1,0,0,0,0,1,0,0,0,0,0,0
poses "distance: the second tree's pose is not finite: row 2, column 4 is nan; " distance cube.bxt --pose 0,nan,0
poses "overlap: the second tree's pose leads too far away: " overlap cube.bxt --pose 0,0,1e300

# Same bytes from another folder and with other thread counts.
mkdir elsewhere
cp cube.obj elsewhere/
(cd elsewhere && "$boxtree" cook cube.obj -o cube.bxt --jobs 1 -q)
cmp cube.bxt elsewhere/cube.bxt

# The depfile serves make and ninja: what was read and is touched, or is gone, is a reason to cook again.
mkdir depends
sed '1i mtllib two\\ words.mtl own.mtl' cube.obj >depends/own.obj
touch "depends/own.mtl"
printf 'own.bxt: own.obj\n\t"%s" cook own.obj -o own.bxt --depfile own.d -q\n-include own.d\n' "$boxtree" >depends/Makefile
cat >depends/build.ninja <<NINJA
rule cook
  command = "$boxtree" cook own.obj -o \$out --depfile \$out.d -q
  depfile = \$out.d
build ninja.bxt: cook own.obj
rule cook_log
  command = "$boxtree" cook own.obj -o \$out --depfile \$out.d -q
  depfile = \$out.d
  deps = gcc
build log.bxt: cook_log own.obj
NINJA
for tool in make ninja; do
  touch depends/own.mtl
  expect 0 $tool -C depends
  grep -q ' cook ' out || grep -q '2/2' out
  expect 0 $tool -C depends
  grep -qE 'up to date|no work to do' out
  sleep 1.1 # make compares whole seconds on some file systems
  touch depends/own.mtl
  expect 0 $tool -C depends
  grep -q ' cook ' out || grep -q '2/2' out
  rm depends/own.mtl
  expect 0 $tool -C depends
  grep -q ' cook ' out || grep -q '2/2' out
  expect 0 $tool -C depends
  grep -qE 'up to date|no work to do' out
done
# Whatever make and ninja can read; what they cannot is an error, and nothing is written.
mkdir names
printf 'exec "%s" cook "$(cat name)" -o "$1" --depfile "$1.d" -q\n' "$boxtree" >names/cook.sh
printf 'make.bxt:\n\tsh cook.sh make.bxt\n-include make.bxt.d\n' >names/Makefile
printf 'rule cook\n  command = sh cook.sh $out\n  depfile = $out.d\nbuild ninja.bxt: cook\n' >names/build.ninja
for name in a:b :b 'a b' 'a#b' 'a$b' 'a\b' 'a,(b)~'; do
  rm -f names/*.bxt names/*.d
  cp cube.obj "names/$name.obj"
  echo "$name.obj" >names/name
  for tool in make ninja; do
    touch -d '2 hours ago' "names/$name.obj"
    expect 0 $tool -C names
    expect 0 $tool -C names
    grep -qE 'up to date|no work to do' out || { echo "$tool cooks again for nothing: $name"; exit 1; }
    touch -d '1 hour ago' names/$tool.bxt
    touch "names/$name.obj"
    expect 0 $tool -C names
    grep -q 'cook.sh' out || grep -q '1/1' out
  done
done
for name in 'a;b' 'a=b' 'a|b' $'a\tb' 'a\:b'; do
  cp cube.obj "names/$name.obj"
  expect 2 "$boxtree" cook "names/$name.obj" -o names/none.bxt --depfile names/none.d
  grep -qF 'write_failed: names/none.d: make cannot read the name "' err
  if [ -e names/none.bxt ] || [ -e names/none.d ]; then echo "written: $name"; exit 1; fi
done

# Errors name the file and the place, and leave the old file alone.
cp cube.bxt before.bxt
printf 'v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n' >bad.obj
expect 3 "$boxtree" cook bad.obj -o cube.bxt
grep -q 'bad.obj' err
cmp cube.bxt before.bxt
expect 2 "$boxtree" cook missing.obj -o cube.bxt
expect 2 "$boxtree" cook cube.obj -o no/such/folder/out.bxt
same "$(cat err)" 'boxtree: write_failed: no/such/folder/out.bxt: the folder no/such/folder is not there; make it first, as by mkdir -p'
expect 1 "$boxtree" cook cube.obj
expect 1 "$boxtree" query cube.bxt ray --origin 0,0 --direction 0,0,1
expect 1 "$boxtree" query cube.bxt ray --origin 0,0,0 --direction 0,0,0
# A file that is not there has one name and one message, whatever it was to be.
printf '{"kind":"ray","origin":[0,0,9],"direction":[0,0,-1]}\n' >one.jsonl
missing() {
  expect 2 "$boxtree" "$@"
  grep -qxF "boxtree: file_not_found: missing: no such file; check the name, which is relative to the current folder, $PWD" err ||
    { echo "$*"; cat err; exit 1; }
}
for command in 'cook -o none.bxt' info verify; do
  expect 2 "$boxtree" $command ''
  same "$(cat err)" 'boxtree: file_not_found: expected the name of a file, found an empty one'
done
missing cook missing -o none.bxt
missing cook missing cube.obj -o none.bxt
missing cook cube.obj --costs missing -o none.bxt
missing cook --profile missing -o none.bxt
# Found by a review: a report was measured before it was known that it cannot be written.
expect 2 "$boxtree" report cube.obj -o none/report.html
grep -q '^boxtree: write_failed: none/report.html: the folder none is not there' err
# But what a profile names is told by its line, and by the folder from which names count.
mkdir -p profiles
printf '[scene]\nsource = "missing"\n' >profiles/source.toml
printf '[[mesh]]\nname = "m"\nfile = "missing"\n[[instance]]\nmesh = "m"\n' >profiles/mesh.toml
expect 2 "$boxtree" cook --profile profiles/source.toml -o none.bxt
same "$(cat err)" 'boxtree: file_not_found: profiles/source.toml:2: source: profiles/missing: no such file; names in profiles/source.toml are relative to its folder'
expect 2 "$boxtree" cook --profile profiles/mesh.toml -o none.bxt
same "$(cat err)" 'boxtree: file_not_found: profiles/mesh.toml:3: file: profiles/missing: no such file; names in profiles/mesh.toml are relative to its folder'
missing info missing
missing verify missing
missing verify cube.bxt --mesh missing
missing export missing -o none.obj
missing bench missing --quick
missing query missing ray --origin 0,0,9 --direction 0,0,-1
missing query cube.bxt pair missing
missing query cube.bxt --batch missing
missing report missing --quick --no-times
missing report cube.obj --include missing --quick --no-times
missing report cube.obj --peers missing --quick
test ! -e none.bxt
expect 3 "$boxtree" info cube.obj
head -c 200 cube.bxt >short.bxt
expect 3 "$boxtree" verify short.bxt
cp cube.bxt damaged.bxt
printf '\377' | dd of=damaged.bxt bs=1 seek=700 conv=notrunc status=none
expect 3 "$boxtree" verify damaged.bxt
# What verify finds is an error like any other, "boxtree: NAME: PLACE: ...", on standard error.
cp cube.bxt found.bxt
printf '\377' | dd of=found.bxt bs=1 seek=150 conv=notrunc status=none
expect 3 "$boxtree" verify found.bxt cube.bxt
same "$(head -1 err)" 'boxtree: checksum_mismatch: found.bxt: section 0 (trees): checksum differs (finding 1 of 2)'
same "$(grep -vc '^boxtree: [a-z_]*: found.bxt: ' err)" 0
same "$(cat out)" 'cube.bxt: valid: 1 tree, every triangle inside every box above it'
# Found by a newcomer: what a newer program wrote was damage for verify, and info did not say in which file.
/usr/bin/python3 - cube.bxt newer.bxt <<'PYTHON'
import struct, sys, xxhash
data = bytearray(open(sys.argv[1], "rb").read())
count = struct.unpack_from("<I", data, 12)[0]
end = 32 + 16 * count
size = struct.unpack_from("<Q", data, 32)[0] & (1 << 40) - 1
trees = end + -end % (8 if size < 4096 else 64)
data[trees] = 9  # the codec
struct.pack_into("<Q", data, 32 + 8, xxhash.xxh3_64_intdigest(bytes(data[trees:trees + size])))
struct.pack_into("<Q", data, 24, xxhash.xxh3_64_intdigest(bytes(data[:24] + data[32:end])))
open(sys.argv[2], "wb").write(data)
PYTHON
for command in "info newer.bxt cube.bxt" "verify newer.bxt cube.bxt" "verify newer.bxt -q"; do
  # shellcheck disable=SC2086 # several words
  expect 5 "$boxtree" $command
  grep -q '^boxtree: codec_unsupported: newer.bxt: tree 0: codec 9' err
done
got=0
"$boxtree" verify - <found.bxt 2>err || got=$?
same "$got" 3
same "$(head -1 err)" 'boxtree: checksum_mismatch: standard input: section 0 (trees): checksum differs (finding 1 of 2)'
# Found by a review: the first section that is damaged hid the others. Several findings are numbered.
cp cube.bxt several.bxt
"$boxtree" info cube.bxt --json | jq -r '.sections[] | select(.bytes > 0) | .offset' >offsets
while read -r offset; do printf '\377' | dd of=several.bxt bs=1 seek="$offset" conv=notrunc status=none; done <offsets
expect 3 "$boxtree" verify several.bxt
same "$(grep -c ': checksum differs (finding [0-9]* of [0-9]*)$' err)" "$(wc -l <offsets)"
same "$(sed 's/.*(finding \([0-9]*\) of .*/\1/' err | xargs)" "$(seq "$(wc -l <err)" | xargs)"
expect 3 "$boxtree" verify several.bxt --json
same "$(jq -c '[.findings[].number] == [range(1; 1 + (.findings | length))]' out)" true
# Found by a newcomer: what cannot be opened at all came without a remedy.
head -c 300 cube.bxt >short.bxt
expect 3 "$boxtree" info short.bxt
grep -q '^boxtree: truncated: short.bxt: the file lacks [0-9]* bytes; copy the file here again, or cook it again$' err
got=0
"$boxtree" info - <short.bxt 2>err || got=$?
same "$got" 3
grep -q 'standard input: .*; copy the file here again, or cook it again$' err
# So is what is wrong with a command line: its name is usage, its place the command.
for words in 'cook cube.obj -o cube.obj' 'cook cube.obj --format ply -o x' 'cook cube.obj -o x --depfile -' \
  'verify cube.bxt found.bxt --mesh cube.obj' 'export cube.bxt -o x.obj --levels 3-' 'export cube.bxt -o cube.bxt' \
  'report cube.obj -o cube.obj' 'cook cube.obj --jobs x -o y' 'query cube.bxt'; do
  # shellcheck disable=SC2086 # a list of words
  expect 1 "$boxtree" $words
  grep -q "^boxtree: usage: ${words%% *}: " err || { echo "$words"; cat err; exit 1; }
done
got=0
"$boxtree" info cube.bxt >/dev/full 2>err || got=$?
same "$got" 2
same "$(cat err)" 'boxtree: write_failed: standard output: No space left on device'
expect 0 "$boxtree" --help
expect 0 "$boxtree" --version
mv out version
# All that the bytes of a file may depend on, for keys of caches.
same "$(head -2 version | sed 's/sources [0-9a-f]\{64\}$/sources DIGEST/; s/[0-9][0-9]*/N/g')" 'boxtree N.N.N, sources DIGEST
assimp N.N.N, liblzma N.N.N, zstd N.N.N'
# The same that keys hold.
"$boxtree" key cube.obj --explain >explained
grep -qF "$(sed -n '1s/.*, //p' version) " explained
# Found by an audit: assimp's version does not tell that of draco, which decodes positions.
for library in libassimp libdraco; do
  loaded=$(ldd "$boxtree" | sed -n "s/^[[:space:]]*\($library[^ ]*\) => .*/\1/p")
  [ -z "$loaded" ] || sed -n 3p version | tr , '\n' | grep -Eq "^ ?$loaded [0-9a-f]{16,64}\$" || { cat version; exit 1; }
done
expect 0 "$boxtree" -V
same "$(cat out)" "$(cat version)"

# Misspelt names: what was meant, where help is, nothing on standard output.
misspelt() {
  local said=$1
  shift
  expect 1 "$boxtree" "$@"
  same "$(cat err)" "$said"
  same "$(wc -c <out)" 0
}
misspelt "boxtree: usage: 'quary' is no command; did you mean 'query'?
See 'boxtree --help'." quary
misspelt "boxtree: usage: 'xyzzy' is no command; expected cook, info, verify, query, bench, report, export, key, pack, split, tile, merge, completion or help
See 'boxtree --help'." xyzzy cube.bxt
misspelt "boxtree: usage: a command is required
See 'boxtree --help'."
misspelt "boxtree: usage: query: 'rya' is no kind of query; did you mean 'ray'?
See 'boxtree query --help'." query cube.bxt rya
kinds='ray, cast, collide, box, sphere, frustum, point, pair, distance, overlap or contacts'
misspelt "boxtree: usage: query: 'twist' is no kind of query; expected $kinds
See 'boxtree query --help'." query cube.bxt twist --at 0,0,0
misspelt "boxtree: usage: query: 'shapecast' is no kind of query; expected $kinds; did you mean 'cast'?
See 'boxtree query --help'." query cube.bxt shapecast --at 0,0,0
misspelt "boxtree: usage: query: 'raycast' is no kind of query; expected $kinds; did you mean 'ray'?
See 'boxtree query --help'." query cube.bxt raycast --origin 0,0,9
# A file in the place of a command.
misspelt "boxtree: usage: query: 'nearest' is no kind of query; did you mean 'point'?
See 'boxtree query --help'." query cube.bxt nearest
misspelt "boxtree: usage: 'validate' is no command; did you mean 'verify'?
See 'boxtree --help'." validate cube.bxt
misspelt "boxtree: usage: query ray: '--from' is no option; did you mean '--origin'?
See 'boxtree query ray --help'." query cube.bxt ray --from 0,0,9 --to 0,0,0
misspelt "boxtree: usage: query sphere: '--position' is no option; did you mean '--center'?
See 'boxtree query sphere --help'." query cube.bxt sphere --position 0,0,0 --radius 1
misspelt "boxtree: usage: 'sub/cube.obj' is no command; did you mean 'boxtree cook sub/cube.obj -o cube.bxt'?
See 'boxtree --help'." sub/cube.obj
misspelt "boxtree: usage: 'cube.STL' is no command; did you mean 'boxtree cook cube.STL -o cube.bxt'?
See 'boxtree --help'." cube.STL -o x.bxt
misspelt "boxtree: usage: 'cube.bxt' is no command; did you mean 'boxtree info cube.bxt'?
See 'boxtree --help'." cube.bxt
misspelt "boxtree: usage: query ray: '--orgin' is no option; did you mean '--origin'?
See 'boxtree query ray --help'." query cube.bxt ray --orgin 1,2,3
misspelt "boxtree: usage: cook: '--outptu' is no option; did you mean '--output'?
See 'boxtree cook --help'." cook cube.obj --outptu out.bxt
misspelt "boxtree: usage: cook: '--out' is no option; did you mean '--output'?
See 'boxtree cook --help'." cook cube.obj --out out.bxt
cp cube.obj ./-x.obj
misspelt "boxtree: usage: cook: '-x.obj' is no option; a file of that name is ./-x.obj
See 'boxtree cook --help'." cook -x.obj -o out.bxt
rm ./-x.obj
# Found by a newcomer: it was told to mean itself.
misspelt "boxtree: usage: cook: '--version' is an option of boxtree alone; use 'boxtree --version'
See 'boxtree cook --help'." cook --version
misspelt "boxtree: usage: cook: '--versio' is no option
See 'boxtree cook --help'." cook --versio
misspelt "boxtree: usage: report: '--grid-bits' is no option of report, but of cook or key
See 'boxtree report --help'." report cube.obj --grid-bits 16
misspelt "boxtree: usage: cook: '--frobnicate' is no option
See 'boxtree cook --help'." cook cube.obj --frobnicate
misspelt "boxtree: usage: query ray: --origin: expected X,Y,Z, found \"1,2\"
See 'boxtree query ray --help'." query cube.bxt ray --origin 1,2
misspelt "boxtree: usage: 'quary' is no command; did you mean 'query'?" help quary
# Options that follow a misspelt command or kind are not what is wrong.
misspelt "boxtree: usage: 'cok' is no command; did you mean 'cook'?
See 'boxtree --help'." cok cube.obj -o cube.bxt
misspelt "boxtree: usage: query: 'rya' is no kind of query; did you mean 'ray'?
See 'boxtree query --help'." query cube.bxt rya --origin 0,0,9
misspelt "boxtree: usage: query: 'rya' is no kind of query; did you mean 'ray'?
See 'boxtree query --help'." query rya cube.bxt --origin 0,0,9
misspelt "boxtree: usage: query: '--origin' is an option of ray, which comes before it
See 'boxtree query --help'." query cube.bxt --origin 0,0,9
misspelt "boxtree: usage: query: '--first' is an option of pair or contacts, which comes before it
See 'boxtree query --help'." query cube.bxt --first
misspelt "boxtree: usage: cook: '-o' is an option that comes after cook
See 'boxtree cook --help'." -o cube.bxt cook cube.obj
misspelt "boxtree: usage: 'ray' is no command but a kind of query; see 'boxtree help query ray'
See 'boxtree --help'." ray cube.bxt --origin 0,0,9
misspelt "boxtree: usage: query point: '--json' is an option that comes after query
See 'boxtree query point --help'." --json query cube.bxt point --at 0,0,0
misspelt "boxtree: usage: 'ray' is no command but a kind of query; see 'boxtree help query ray'" help ray
misspelt "boxtree: usage: 'relative-error' is no command but an option; see 'boxtree help query point' or 'boxtree help query distance'" help relative-error

# Values name what was expected and what was found.
misvalued() {
  local said=$1
  shift
  expect 1 "$boxtree" "$@"
  same "$(head -1 err)" "boxtree: $said"
}
for value in abc 0 -1 inf nan 1x; do
  misvalued "usage: cook: --tolerance: expected a length above 0, found \"$value\"" cook cube.obj -o x.bxt --tolerance="$value"
done
misvalued 'usage: cook: --max-slowdown: expected a factor above 0, found "0"' cook cube.obj -o x.bxt --max-slowdown 0
misvalued 'usage: cook: --max-bytes-per-triangle: expected a number of bytes above 0, found "few"' \
  cook cube.obj -o x.bxt --max-bytes-per-triangle few
for value in 7 31 8.5 many; do
  misvalued "usage: cook: --grid-bits: expected a whole number from 8 to 30, found \"$value\"" cook cube.obj -o x.bxt --grid-bits $value
done
misvalued 'usage: cook: --shrink-share: expected a share from 0.01 to 1, found "2"' cook cube.obj -o x.bxt --shrink-share 2
misvalued 'usage: cook: --jobs: expected a whole number from 1 to 1024, found "0"' cook cube.obj -o x.bxt --jobs 0
misvalued "usage: cook: --for: expected memory, speed or balance, found \"sped\"; did you mean 'speed'?" cook cube.obj -o x.bxt --for sped
misvalued 'usage: query point: --at: expected X,Y,Z, found no value' query cube.bxt point --at
misvalued 'usage: cook: --jobs: expected N, found no value' cook cube.obj -o x.bxt --jobs
# Found by a newcomer: that of a variable that is not set left the option out, so that a profile did not count, and a cook
# without a mesh replaced a good file by one without a tree.
cp cube.bxt kept.bxt
for option in --profile --depfile --cache --costs --user-data --face-ids --write-reordered; do
  expect 1 "$boxtree" cook cube.obj -o kept.bxt $option ''
  grep -qE "^boxtree: usage: cook: $option: expected [A-Z|]+, found an empty value$" err || { echo "$option"; cat err; exit 1; }
done
misvalued 'usage: cook: --profile: expected FILE, found an empty value' cook --profile '' -o kept.bxt
misvalued 'usage: cook: --output: expected FILE, found an empty value' cook cube.obj -o ''
misvalued 'usage: query point: --tree: expected TREE, found an empty value' query cube.bxt point --at 0,0,0 --tree ''
cmp kept.bxt cube.bxt
misvalued 'usage: query point: --at: expected once, found 3 times' query cube.bxt point --at 0,0,0 --at 1,1,1 --at 0,0,0
misvalued 'usage: query cast: --capsule: expected X,Y,Z,R, found "0,0,1"' query cube.bxt cast --capsule 0,0,1
misvalued 'usage: query ray: --origin: expected X,Y,Z, found "0"; write it with commas, without spaces' \
  query cube.bxt ray --origin 0 0 1 --direction 0,0,-1
misvalued 'usage: query point: --at: expected X,Y,Z, found "1 2 3"; write it with commas, without spaces' query cube.bxt point --at "1 2 3"
misvalued 'usage: query frustum: --matrix: expected 16 numbers between commas, found "1"; write it with commas, without spaces' \
  query cube.bxt frustum --matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
misvalued 'usage: query pair: --pose: expected X,Y,Z or 12 numbers, found "1"; write it with commas, without spaces' \
  query cube.bxt pair cube.bxt --pose 1 0 0
misvalued 'usage: query point: --at: expected X,Y,Z, found "there"' query cube.bxt point --at there
misvalued 'usage: query point: --at: expected X,Y,Z, found "1, 2, 3"; write it without spaces' query cube.bxt point --at "1, 2, 3"
misvalued 'usage: query point: --at: expected X,Y,Z, found "1,"; write it without spaces' query cube.bxt point --at 1, 2, 3
misvalued 'usage: query point: --at: expected X,Y,Z, found "0,1e400,0"; 1e400 is beyond the range of double' \
  query cube.bxt point --at 0,1e400,0
misvalued 'usage: query cast: --capsule: expected X,Y,Z,R, found "0,0,1,-1e999"; -1e999 is beyond the range of double' \
  query cube.bxt cast --capsule 0,0,1,-1e999
misvalued 'usage: cook: --exact: expected no value, found "maybe"' cook cube.obj -o x.bxt --exact=maybe
misvalued 'usage: query cast: --box: expected HX,HY,HZ, found "1"; write it with commas, without spaces' query cube.bxt cast --box 1
misvalued 'usage: query cast: --rotation: expected X,Y,Z,W, found "0,0,0,1,2"' query cube.bxt cast --rotation 0,0,0,1,2
misvalued 'usage: query ray: --t-max: expected a number, found "far"' query cube.bxt ray --origin 0,0,9 --direction 0,0,1 --t-max far
# Found by an oracle: options took numbers that vectors and batches do not, and rounded them twice.
for number in 0x10 +1 1e400 1e-400 '1 ' ''; do
  misvalued "usage: query ray: --t-max: expected a number, found \"$number\"" query cube.bxt ray --origin 0,0,9 --direction 0,0,-1 --t-max "$number"
done
expect 0 "$boxtree" query cube.bxt ray --origin 0,0,9 --direction 0,0,-1 --t-max inf
# Found by a newcomer: whole numbers with a leading zero were octal, 08 was none, and 010 was 8.
expect 0 "$boxtree" cook cube.obj -o ten.bxt --grid-bits 10 -q
expect 0 "$boxtree" cook cube.obj -o zeros.bxt --grid-bits 010 -q
cmp ten.bxt zeros.bxt
expect 0 "$boxtree" cook cube.obj -o zeros.bxt --grid-bits 08 --jobs 01 -q
misvalued 'usage: cook: --grid-bits: expected a whole number from 8 to 30, found "0b1010"' cook cube.obj -o x.bxt --grid-bits 0b1010
# What a ray leaves behind, by a newcomer's wish: it begins at --t-min.
expect 0 "$boxtree" query cube.bxt ray --origin 0.5,0.25,9 --direction 0,0,-1
first=$(sed -n 's/^t: //p' out)
expect 0 "$boxtree" query cube.bxt ray --origin 0.5,0.25,9 --direction 0,0,-1 --t-min "$(jq -n "$first + 0.5")"
jq -en "$(sed -n 's/^t: //p' out) == $first + 1"
printf '{"kind":"ray","origin":[0.5,0.25,9],"direction":[0,0,-1],"t_min":%s}\n' "$(jq -n "$first + 0.5")" >t_min.jsonl
expect 0 "$boxtree" query cube.bxt --batch t_min.jsonl
jq -e ".t == $first + 1" out
misvalued 'invalid_query: cube.bxt: collide: merge: expected 0 or more, found at [0,0,0], sphere 1, merge -1' query cube.bxt collide --sphere 1 --at 0,0,0 --merge -1
for value in 1.5 -1 x; do
  misvalued "usage: query point: --budget: expected a whole number of 0 or more, found \"$value\"" query cube.bxt point --at 0,0,0 --budget=$value
done
expect 0 "$boxtree" query cube.bxt point --at 0.5,0.5,3 --max-distance inf --budget 18446744073709551615

# help says what --help says, in lines that a terminal holds.
help_of() {
  mv out help
  expect 0 "$boxtree" "$@" --help
  cmp out help
  same "$(awk 'length > 79' help)" ""
}
expect 0 "$boxtree" help
help_of
grep -q '^  query ' help
for command in cook info verify query bench report export pack split completion help; do
  expect 0 "$boxtree" help $command
  help_of $command
  grep -q "^Usage: boxtree $command " help
done
for kind in ray cast collide point box sphere frustum pair distance overlap contacts; do
  expect 0 "$boxtree" help query $kind
  help_of query cube.bxt $kind
  grep -q "^Usage: boxtree query FILE $kind " help
done

expect 1 "$boxtree" help cook query
same "$(cat err)" "boxtree: usage: help: 'query' was not expected: boxtree cook has no commands of its own"
# All inputs are looked for before the first is measured; a mesh may be a point.
expect 2 "$boxtree" report cube.obj missing.obj -o missing.html
grep -q '^boxtree: file_not_found: missing.obj: no such file; ' err
[ ! -e missing.html ]
printf 'v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n' >point.obj
expect 0 "$boxtree" cook point.obj -o point.bxt
expect 0 "$boxtree" bench point.bxt --quick --runs 1
# A folder is none of the things that an output replaces.
mkdir folder.bxt
expect 2 "$boxtree" cook cube.obj -o folder.bxt
same "$(cat err)" 'boxtree: write_failed: folder.bxt: is a folder; expected the name of a file'
expect 1 "$boxtree" tile cube.obj -o tiles.bxt
same "$(head -1 err)" 'boxtree: usage: tile: -o names the manifest, for cook --manifest: expected tiles.jsonl'
expect 1 "$boxtree" tile cube.obj -o tiles.obj
same "$(cat err)" "boxtree: usage: tile: tiles.obj: expected another ending than .obj, which is that of a mesh, as tiles.jsonl"
# Faces that name a vertex twice have no edges, so nothing is closed.
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 2\nf 1 1 3\n' >points.obj
expect 0 "$boxtree" cook points.obj -o points.bxt
grep -qx 'points: 2 triangles, no edges' out
expect 0 "$boxtree" info points.bxt
grep -qx '  surface: no edges' out
expect 0 "$boxtree" info points.bxt --json
same "$(jq -c '.trees[0].surface | [.closed, .open_edges]' out)" '[false,0]'
# Material of a single face: one byte is no bytes.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n' >one.obj
expect 0 "$boxtree" cook one.obj -o one.bxt --materials
grep -q '  materials: 1 byte, ' out

# -- ends options: what stands behind it is a file, and neither an option nor a kind of query.
cp cube.obj ./-cube.obj
expect 0 "$boxtree" cook -o dashed.bxt --quiet -- -cube.obj
expect 0 "$boxtree" verify -- dashed.bxt
refused_words() {
  local message=$1
  shift
  expect 1 "$boxtree" "$@"
  same "$(head -1 err)" "boxtree: usage: $message"
}
refused_words "cook: -o, --output FILE is required; options come before --, which ends them" cook -- cube.obj -o d.bxt
refused_words "query: 'point' was not expected behind --, where no option and no kind of query stands" \
  query -- cube.bxt point --at 1,2,3
refused_words "query: 'point' was not expected behind --, where no option and no kind of query stands" \
  query cube.bxt -- point --at 1,2,3
refused_words "query point: '--at' was not expected behind --, where no option stands" query cube.bxt point -- --at 1,2,3
refused_words 'a command is required' -- cook
refused_words 'verify: FILE is required' verify --
# The value of a short option is not joined to it by =.
refused_words 'cook: --output: expected -o d.bxt or --output=d.bxt, found -o=d.bxt' cook cube.obj -o=d.bxt
[ ! -e =d.bxt ]
# Where a script has no name, the next option is none.
for next in --exact -q -j1 --; do
  refused_words "cook: --output: expected FILE, found the option $next; a file of that name is ./$next" \
    cook cube.obj -o $next
  refused_words "cook: --depfile: expected FILE, found the option $next; a file of that name is ./$next" \
    cook cube.obj -o d.bxt --depfile $next
  [ ! -e ./$next ]
done
refused_words "cook: --output: expected FILE, found the option --exact; a file of that name is ./--exact" \
  cook cube.obj --output=--exact
refused_words "report: --csv: expected FILE, found the option -q; a file of that name is ./-q" report cube.obj --csv -q
refused_words "query point: --mesh: expected FILE, found the option --tree; a file of that name is ./--tree" \
  query cube.bxt --mesh --tree 0 point --at 0,0,0
refused_words "query cast: --hull: expected MESH, found the option --at; a file of that name is ./--at" \
  query cube.bxt cast --hull --at 0,0,0 --direction 0,0,1
refused_words "help: --man-pages: expected FOLDER, found the option --man; a file of that name is ./--man" \
  help --man-pages --man
expect 0 "$boxtree" cook cube.obj -o ./--exact --quiet
[ -e ./--exact ]
# Nor has a long option one dash: -output would be -o utput.
refused_words "cook: '-output' is no option; did you mean '--output'?" cook cube.obj -output d.bxt
refused_words "cook: '-output=d.bxt' is no option; did you mean '--output'?" cook cube.obj -output=d.bxt
refused_words "cook: '-jobs' is no option; did you mean '--jobs'?" cook cube.obj -o d.bxt -jobs 1
refused_words "cook: '-json' is no option; did you mean '--json'?" cook cube.obj -o d.bxt -json
refused_words "report: '-output' is no option; did you mean '--output'?" report cube.obj -output d.html
refused_words "export: '-output' is no option; did you mean '--output'?" export cube.bxt -output d.glb
# Found by a newcomer: -out was -o ut.
refused_words "cook: '-out' is no option; did you mean '--output'?" cook cube.obj -out d.bxt
[ ! -e utput ] && [ ! -e ut ]
expect 0 "$boxtree" cook cube.obj -outfit -q
expect 0 "$boxtree" cook cube.obj -o utput -j1 -q
rm utfit utput
# A file that was meant to be the output.
refused_words 'cook: -o, --output FILE is required; did you mean -o d.bxt?' cook cube.obj d.bxt
refused_words 'export: -o, --output FILE is required; did you mean -o d.glb?' export cube.bxt d.glb
refused_words 'report: d.html is no mesh; did you mean -o d.html?' report cube.obj d.html
refused_words 'cook: --profile excludes --tolerance: the profile says it, by a key' cook cube.obj --profile p.toml --tolerance 1 -o d.bxt
refused_words 'report: with --quiet and no output nothing is told; expected -o FILE.html' report cube.obj -q
refused_words 'report: d.csv is no mesh; did you mean --csv d.csv?' report cube.obj d.csv --quick
refused_words 'report: d.json is no mesh; did you mean --json-out d.json?' report cube.obj d.json
refused_words 'cook: -o, --output FILE is required' cook cube.obj cube.obj

# Help says where the options are that it does not show, if there are any, and that command runs.
for command in cook report 'query pair'; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" help $command
  same "$(tail -1 out)" "More options: boxtree $command --help-all"
  cp out short
  # shellcheck disable=SC2086
  expect 0 "$boxtree" $command --help-all
  same "$(grep -c 'More options' out)" 0
  [ "$(grep -c '^  -' out)" -gt "$(grep -c '^  -' short)" ]
done
expect 0 "$boxtree" help query ray
same "$(grep -c 'More options' out)" 0

# A kind without a file has its help; it is not taken for a file, and the file comes before it.
expect 0 "$boxtree" query ray --help
grep -q '^Usage: boxtree query FILE ray --origin X,Y,Z --direction X,Y,Z \[OPTION...\]$' out
expect 0 "$boxtree" query --help
grep -q '^Usage: boxtree query FILE \[OPTION...\] KIND ...$' out
# Found by a newcomer: neither did the usage line say that a shape is needed, nor a query without a kind which kinds there are.
for kind in 'cast --at X,Y,Z --direction X,Y,Z' 'collide --at X,Y,Z'; do
  expect 0 "$boxtree" query "${kind%% *}" --help
  sed '/^$/q' out | tr -s ' \n' ' ' |
    grep -qF "Usage: boxtree query FILE $kind (--sphere R | --capsule X,Y,Z,R | --box HX,HY,HZ | --hull MESH) [OPTION...]"
done
expect 1 "$boxtree" query cube.bxt
same "$(cat err)" "boxtree: usage: query: a kind of query, ray, cast, collide, box, sphere, frustum, point, pair, distance, overlap or contacts, or --batch is required
See 'boxtree query --help'."
cp cube.bxt ray
expect 0 "$boxtree" query ./ray ray --origin 0.25,0.5,5 --direction 0,0,-1
misspelt "boxtree: usage: query ray: FILE is required
See 'boxtree query ray --help'." query ray --origin 0,0,9 --direction 0,0,-1
misspelt "boxtree: usage: query pair: FILE comes before pair, as in boxtree query FILE pair
See 'boxtree query pair --help'." query pair cube.bxt cube.bxt
for options in '' '--origin 0,0,9 --direction 0,0,-1'; do
  # shellcheck disable=SC2086
  misspelt "boxtree: usage: query ray: FILE comes before ray, as in boxtree query FILE ray
See 'boxtree query ray --help'." query ray cube.bxt $options
done
expect 0 "$boxtree" --help-all # of every command, rare ones too
grep -q -- '--depfile' out
expect 0 "$boxtree" --help
grep -q -- '--help-all  *Print every option of every command$' out
for command in cook 'query ray'; do # of a command, its own
  # shellcheck disable=SC2086
  expect 0 "$boxtree" $command --help
  grep -q -- '--help-all  *Print every option$' out
done
expect 1 "$boxtree" help --man query ray
grep -q 'in that of boxtree query' err
expect 1 "$boxtree" completion csh

# Several files: a line each, or one document; what is wrong with one keeps none from being looked at.
cp cube.bxt second.bxt
expect 0 "$boxtree" verify cube.bxt second.bxt
same "$(grep -c 'every triangle inside every box above it' out)" 2
expect 0 "$boxtree" verify -q cube.bxt second.bxt
same "$(wc -c <out)" 0
expect 3 "$boxtree" verify short.bxt cube.bxt damaged.bxt --json
same "$(jq -c '[.schema, [.files[] | [.file, .ok]]]' out)" '[1,[["short.bxt",false],["cube.bxt",true],["damaged.bxt",false]]]'
# Each finding is told with its file, as on standard error.
same "$(jq '[.files[] | .file as $file | .findings[].detail | startswith($file + ": ")] | length > 1 and all' out)" true
expect 1 "$boxtree" verify cube.bxt second.bxt --mesh cube.obj
expect 2 "$boxtree" info cube.bxt missing.bxt second.bxt --json
same "$(jq -c '[.schema, [.files[] | [.file, .trees[0].triangles]]]' out)" '[1,[["cube.bxt",12],["second.bxt",12]]]'
grep -q 'missing.bxt' err
expect 0 "$boxtree" info cube.bxt second.bxt
same "$(grep -c ':$' out)" 2
# Every document says which schema it follows.
# Of two files `files` is said even if only one can be read.
expect 2 "$boxtree" info cube.bxt missing.bxt --json
same "$(jq -r '.files | length' out)" 1
expect 2 "$boxtree" verify cube.bxt missing.bxt --json
same "$(jq -r '.files | length' out)" 2
expect 0 "$boxtree" info cube.bxt --json
same "$(jq -c '[keys_unsorted[0], .schema]' out)" '["schema",1]'
expect 0 "$boxtree" verify cube.bxt --json
same "$(jq -c '[.schema, .ok]' out)" '[1,true]'
same "$(find . -name '*.cooking' | wc -l)" 0

# No output has the name of a mesh, whose place it could take; a page of another ending than HTML is a warning.
cp cube.obj source.obj
for command in 'cook cube.obj -o source.obj' 'cook cube.obj -o new.GLB' 'report cube.obj --quick --no-times -o source.obj' \
  'report cube.obj --quick --no-times --csv source.obj'; do
  # shellcheck disable=SC2086
  expect 1 "$boxtree" $command
  grep -qE '^boxtree: usage: (cook|report): (source.obj|new.GLB): expected another ending than .*, as (source|new)\.(bxt|html|csv)$' err
done
cmp cube.obj source.obj
[ ! -e new.GLB ]
expect 0 "$boxtree" cook cube.obj -o cube.collision -q
expect 0 "$boxtree" report cube.obj --quick --no-times --quiet -o page.pdf
same "$(cat err)" 'boxtree: warning: page.pdf: the page is HTML, whatever its ending: expected .html'
expect 0 "$boxtree" report cube.obj --quick --no-times --quiet -o page.html
same "$(wc -c <err)" 0
# Found by a newcomer: what boxtree has not written is not lost by its outputs. What it has, and what is empty, is.
echo 'my own words' >notes.txt
refuses() {
  expect 1 "$boxtree" "$@"
  tr -s ' \n' ' ' <err | grep -qE "^boxtree: usage: $1: notes.txt: expected $kind there, or none, found another file; it would be lost"
  same "$(cat notes.txt)" 'my own words'
}
kind="a report's page" refuses report cube.obj --quick --no-times -o notes.txt
kind="a report's page" refuses report --paper cube.obj --no-times -o notes.txt
kind='CSV of a report' refuses report cube.obj --quick --no-times --csv notes.txt
kind='CSV of a report' refuses report cube.obj --quick --no-times --csv-approximate notes.txt
kind='JSON of a report' refuses report cube.obj --quick --no-times --json-out notes.txt
kind='a depfile of a cook' refuses cook cube.obj -o depends.bxt --depfile notes.txt
expect 1 "$boxtree" report cube.obj --quick --no-times -o cube.bxt
[ ! -e depends.bxt ]
for number in 1 2; do
  : >empty.html
  expect 0 "$boxtree" report cube.obj --quick --no-times -o empty.html --csv told.csv --csv-approximate near.csv \
    --json-out told.json -q
  expect 0 "$boxtree" report --paper cube.obj --no-times -o thesis.html --json-out thesis.json -q
  expect 0 "$boxtree" cook cube.obj -o "depends$number.bxt" --depfile depends.d -q
done
rm told.csv told.json near.csv thesis.html thesis.json empty.html
# What has to have a name is no stream.
expect 1 "$boxtree" cook cube.obj -o x.bxt --profile - </dev/null
grep -q '^boxtree: usage: cook: --profile needs the name of a file' err
expect 1 "$boxtree" cook cube.obj -o x.bxt --costs - </dev/null

# Found by a newcomer: the third weight was -0.0.
for option in '' --json; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" query cube.bxt ray --origin=0.5,0,5 --direction=0,0,-1 $option
  same "$(tr -d ' \n' <out | grep -o 'barycentric[^a-z]*]' | tr -d '":')" 'barycentric[0.5,0.5,0.0]'
done

# External geometry: recognised, refused without its mesh or with another one.
expect 0 "$boxtree" cook cube.obj -o external.bxt --external
expect 0 "$boxtree" verify external.bxt
grep -q 'not looked at' out
expect 1 "$boxtree" cook cube.obj -o x.bxt --external --no-face-ids
grep -q '^boxtree: usage: cook: --external excludes --no-face-ids: .*--write-reordered' err
expect 0 "$boxtree" verify external.bxt --mesh cube.obj
grep -q 'every triangle inside' out
expect 1 "$boxtree" query external.bxt point --at 0,0,0
same "$(cat err)" 'boxtree: external_mesh_needed: external.bxt: tree 0: no mesh was given: name the one that it was cooked of with --mesh MESH'
expect 1 "$boxtree" query cube.bxt pair external.bxt
same "$(cat err)" 'boxtree: external_mesh_needed: external.bxt: tree 0: no mesh was given: name the one that it was cooked of with --mesh2 MESH'
expect 0 "$boxtree" query --help
grep -q -- '^  --mesh ' out
expect 0 "$boxtree" cook cube.obj -o external_scene.bxt --external --scene
expect 1 "$boxtree" query external_scene.bxt point --at 0,0,0
grep -q '^boxtree: external_mesh_needed: external_scene.bxt: tree 0: no mesh was given: .* --tree TREE and --mesh MESH$' err
expect 0 "$boxtree" query external.bxt point --at 0.5,0.5,3 --mesh cube.obj --json
same "$(jq -c '[.distance,.point]' out)" '[2,[0.5,0.5,1]]'
sed 's/^v 1 1 1/v 1 1 2/' cube.obj >other.obj
for command in 'query external.bxt point --at 0,0,0' 'export external.bxt -o no.obj' 'verify external.bxt'; do
  expect 3 "$boxtree" $command --mesh other.obj
  same "$(cat err)" 'boxtree: external_mesh_mismatch: external.bxt: tree 0: expected 6 faces of f32 positions, given 7 of f32: '\
'other.obj is not what the tree was cooked of; name that mesh, or the one that --write-reordered wrote with the tree'
done
printf 'v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n' >pentagon.obj
expect 5 "$boxtree" cook pentagon.obj -o pentagon.bxt --external -q
same "$(cat err)" "boxtree: mesh_unsupported: pentagon.obj: geometry cannot stay external: face 0 is split or follows a split or skipped face, so the \
application's faces are not the tree's; --write-reordered FILE writes a mesh whose faces they are"
expect 0 "$boxtree" cook pentagon.obj -o pentagon.bxt --external -q --write-reordered parted.obj
expect 0 "$boxtree" verify pentagon.bxt --mesh parted.obj
expect 0 "$boxtree" query cube.bxt pair external.bxt --mesh2 cube.obj --json
same "$(jq -c '.hit' out)" true
# Found by an oracle: a line's mesh was not looked at where an earlier one had named the right one.
pair='{"kind":"distance","file":"external.bxt","pose":[0,0,20]'
printf '%s\n' "$pair,\"mesh\":\"cube.obj\"}" "$pair,\"mesh\":\"none.obj\"}" "$pair,\"mesh\":\"other.obj\"}" "$pair}" >meshes.jsonl
expect 2 "$boxtree" query cube.bxt --batch meshes.jsonl
same "$(jq -c '.error // (.upper | floor)' out | tr '\n' ' ')" '19 "file_not_found" "external_mesh_mismatch" "external_mesh_needed" '

# Batches: JSON lines, or one document; a bad line gets an error in its place.
cat >queries.jsonl <<'BATCH'
{"kind":"ray","origin":[0.25,0.5,5],"direction":[0,0,-1]}
{"kind":"box","min":[0.9,0.4,0.4],"max":[1.5,0.6,0.6]}

{"kind":"sphere","center":[0.5,0.5,1.5],"radius":0.5}
{"kind":"point","at":[0.5,0.5,3]}
{"kind":"pair","file":"cube.bxt","pose":"1,0.25,0.25","first":true}
{"kind":"distance","file":"cube.bxt","pose":"3,0,0","relative_error":0.1}
{"kind":"point","at":[0.5,0.5,3],"absolute_error":0.5,"budget":100}
{"kind":"overlap","file":"cube.bxt","pose":"1,0.25,0.25","within":0}
{"kind":"box","min":[2,2,2],"max":[3,3,3],"within":0.5}
{"kind":"cast","sphere":0.5,"at":[0.25,0.5,5],"direction":[0,0,-1],"t_max":4,"any":true}
{"kind":"cast","box":[1,1,1],"rotation":[0,0,0,2],"at":[0.25,0.5,5],"direction":[0,0,-1],"all":true}
BATCH
expect 0 "$boxtree" query cube.bxt --batch queries.jsonl
same "$(wc -l <out)" 11
same "$(jq -cs '[.[0].t,.[1].faces,.[2].count,.[3].distance,.[4].count]' out)" '[4,[5],1,2,1]'
same "$(jq -cs '.[5:7] | map(.lower <= 2 and .upper >= 2)' out)" '[true,true]'
same "$(jq -cs '.[7:9] | map(.overlap)' out)" '["overlapping","disjoint"]'
same "$(jq -cs '.[9:] | [.[0].hit, .[0].face, .[1].count]' out)" '[true,1,12]'
expect 0 "$boxtree" query cube.bxt --batch queries.jsonl --json
same "$(jq -c '.answers | length' out)" 11
expect 0 sh -c "echo '{\"at\":[0.5,0.5,3]}' | '$boxtree' query cube.bxt point --batch -"
same "$(jq -c '.distance' out)" 2
for bad in 'nonsense' '[1]' '{"kind":"cone"}' '{"kind":"point"}' '{"kind":"point","at":[1,2]}' \
  '{"kind":"distance"}' '{"kind":"point","at":[0,0,0],"budget":-1}' \
  '{"kind":"distance","file":"cube.bxt","relative_error":-1}' \
  '{"kind":"overlap","file":"cube.bxt","within":-1}' '{"kind":"box","min":[0,0,0],"max":[1,1,1],"within":"x"}' \
  '{"kind":"point","at":[0,0,0],"hat":1}' '{"kind":"ray","origin":[0,0,0],"direction":[0,0,0]}'; do
  printf '{"kind":"point","at":[0.5,0.5,3]}\n%s\n' "$bad" >bad.jsonl
  expect 1 "$boxtree" query cube.bxt --batch bad.jsonl
  same "$(jq -cs '[.[0].distance,.[1].error]' out)" '[2,"invalid_query"]'
  grep -q 'line 2' out
done
same "$(jq -sr '.[1].detail' out)" "line 2: ray: direction: expected finite and not zero, found origin [0,0,0], direction [0,0,0]"
# What is missing or wrong is named, by kind and key.
names() {
  echo "$2" >bad.jsonl
  expect 1 "$boxtree" query cube.bxt --batch bad.jsonl
  same "$(jq -r .detail out)" "line 1: $1"
}
names 'distance: "file": expected the second .bxt file, here or on the command line, found no such key' \
  '{"kind":"distance"}'
names 'point: "at": expected [X,Y,Z], found no such key' '{"kind":"point"}'
names 'point: "at": expected [X,Y,Z], found [1,2]' '{"kind":"point","at":[1,2]}'
names 'cast: expected one shape, sphere, capsule, box or hull, found none' '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1]}'
names 'cast: expected one shape, sphere, capsule, box or hull, found sphere and box' \
  '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"sphere":1,"box":[1,1,1]}'
names 'cast: expected rotation with box or hull, found it with sphere' \
  '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"sphere":1,"rotation":[0,0,0,1]}'
names 'cast: expected any or all, found both' \
  '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"sphere":1,"any":true,"all":true}'
names 'cast: "capsule": expected [X,Y,Z,R], found [0,0,1]' \
  '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"capsule":[0,0,1]}'
names 'cast: "sphere": expected a number, found "1"' '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"sphere":"1"}'
names "cast: expected the keys at, direction, sphere, capsule, box, hull, rotation, t_max, any, all, back_faces, move or kind, found \"spere\"; "\
"did you mean 'sphere'?" '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"spere":1}'
names 'frustum: "matrix": expected an array of 16 numbers, found [1]' '{"kind":"frustum","matrix":[1]}'
names 'contacts: expected the keys first, points, move or kind, found "hat"' '{"kind":"contacts","hat":1}'
# Found by an audit: names of files were cut at a NUL.
names 'cast: "hull": expected the file of a mesh, found "a\u0000.obj"' '{"kind":"cast","at":[0,0,9],"direction":[0,0,-1],"hull":"a\u0000.obj"}'
names '"kind": expected a text, found 3' '{"kind":3}'
kinds='ray, cast, collide, box, sphere, frustum, point, pair, distance, overlap or contacts'
# A misspelt key, not the one that is missing because of it.
names "box: expected the keys min, max, within, budget, move or kind, found \"mni\"; did you mean 'min'?" '{"kind":"box","mni":[0,0,0],"max":[1,1,1]}'
names "\"kind\": expected $kinds, found no such key" '{"at":[1,2,3]}'
names "\"kind\": expected $kinds, found \"rya\"; did you mean 'ray'?" '{"kind":"rya"}'
names 'point: expected the keys at, max_distance, relative_error, absolute_error, budget, move or kind, found "max_distence"; '\
"did you mean 'max_distance'?" '{"kind":"point","at":[0,0,0],"max_distence":1}'
# Words are joined as they are in the line.
names 'point: expected the keys at, max-distance, relative-error, absolute-error, budget, move or kind, found "max-distence"; '\
"did you mean 'max-distance'?" '{"kind":"point","at":[0,0,0],"max-distence":1}'
names 'point: "max-distance": expected a number, found "x"' '{"kind":"point","at":[0,0,0],"max-distance":"x"}'
names 'expected a JSON object, found no JSON at byte 31' '{"kind":"point","at":[1,0,0]} x'
names 'expected a JSON object, found [1]' '[1]'
names 'expected a JSON object of finite numbers, found one beyond what a double holds' '{"kind":"point","at":[1e999,0,0]}'
names "ray: expected the keys origin, direction, t_min, t_max, any, all, back_faces, move or kind, found \"--origin\"; did you mean 'origin'?" '{"kind":"ray","--origin":[0,0,9],"direction":[0,0,-1]}'
names '"t_max": expected once, found twice: - and _ are the same' \
  '{"kind":"ray","origin":[0,0,9],"direction":[0,0,-1],"t-max":1,"t_max":2}'
names '"origin": expected once, found twice' '{"kind":"ray","origin":[0,0,9],"origin":[0,0,8],"direction":[0,0,-1]}'
names '"kind": expected once, found twice' '{"kind":"ray","kind":"point","at":[0,0,8]}'
names 'ray: "tree" is of the second tree of a line of the kind pair, distance or overlap; FILE, --tree and --mesh of the command '\
'line say which tree a batch queries' '{"kind":"ray","origin":[0,0,9],"direction":[0,0,-1],"tree":"cube"}'
names 'distance: "tree": expected a name as a text, or a number, found [0]' '{"kind":"distance","file":"cube.bxt","tree":[0]}'
names 'cube.bxt: there is no tree 7; expected 0' '{"kind":"distance","file":"cube.bxt","tree":7}'
# What nests deeply overflows no stack.
names '"kind": expected a JSON object of numbers, texts and arrays of them, found an array or an object in another' \
  "{\"kind\":$(printf '[%.0s' {1..200000})$(printf ']%.0s' {1..200000})}"
names '"move": is for instances of a scene, and this is a tree' '{"kind":"point","at":[0,0,0],"move":"cube=1,0,0"}'
names 'point: "move": expected INSTANCE=POSE as a text ("Crate=1,2,3"), or an array of such, found [1]' '{"kind":"point","at":[0,0,0],"move":[1]}'
for nested in '{"Crate":[1,2,3]}' '[["Crate=1,2,3"]]' '[{"Crate":[1,2,3]}]'; do
  names 'point: "move": expected INSTANCE=POSE as a text ("Crate=1,2,3"), or an array of such, found '"$nested" \
    '{"kind":"point","at":[0,0,0],"move":'"$nested}"
done
# Keys are the names of options, with - or _.
printf '%s\n' '{"kind":"ray","origin":[0.25,0.5,5],"direction":[0,0,-1],"t-max":3}' '' \
  '{"kind":"ray","origin":[0.25,0.5,5],"direction":[0,0,-1],"t_max":4}' '{}' >keys.jsonl
expect 1 "$boxtree" query cube.bxt --batch keys.jsonl
same "$(jq -cs 'map([.line, .hit, .error])' out)" '[[1,false,null],[3,true,null],[4,null,"invalid_query"]]'
same "$(head -1 out)" '{"line":1,"hit":false}'
same "$(cat err)" "boxtree: invalid_query: keys.jsonl: 1 of 3 queries have no answer; the first: line 4: \"kind\": expected $kinds, found no such key"
expect 1 sh -c "'$boxtree' query cube.bxt --batch - <keys.jsonl"
grep -q '^boxtree: invalid_query: standard input: 1 of 3 queries have no answer; ' err
expect 1 "$boxtree" query cube.bxt --batch keys.jsonl --json
same "$(jq -c '.answers | map(.line)' out)" '[1,3,4]'
# A line that is too long is one without an answer, and those after it have theirs.
{ head -c 1100000 /dev/zero | tr '\0' x; printf '\n%s\n' '{"kind":"ray","origin":[0.25,0.5,5],"direction":[0,0,-1]}'; } >long.jsonl
expect 1 "$boxtree" query cube.bxt --batch long.jsonl
same "$(jq -cs 'map([.line, .hit, .error])' out)" '[[1,null,"invalid_query"],[2,true,null]]'
same "$(cat err)" "boxtree: invalid_query: long.jsonl: 1 of 2 queries have no answer; the first: line 1: it has more than 1048576 bytes"
for pose in '[1,2]' '"1,2"' '[1,2,"3"]' 3; do
  names "pair: \"pose\": expected X,Y,Z or 12 numbers, as an array or as text, found $pose" \
    "{\"kind\":\"pair\",\"file\":\"cube.bxt\",\"pose\":$pose}"
done
names 'pair: "pose": expected X,Y,Z or 12 numbers, as an array or as text, found string of 102 bytes' \
  "{\"kind\":\"pair\",\"file\":\"cube.bxt\",\"pose\":\"$(printf 'x%.0s' {1..100})\"}"
# A program that queries through a pipe gets each answer before its next query, and ends its batch by closing the pipe.
coproc batch { exec "$boxtree" query cube.bxt point --batch -; }
for z in 3 4; do
  echo "{\"at\":[0.5,0.5,$z]}" >&"${batch[1]}"
  read -r -t 20 -u "${batch[0]}" answer || { echo "no answer while the pipe is open"; exit 1; }
  same "$(jq -c '[.line, .distance]' <<<"$answer")" "[$((z - 2)),$((z - 1))]"
done
pid=$batch_PID
eval "exec ${batch[1]}>&-"
wait "$pid"
# The second file is that of the line or, with its pose, that of the command line; poses are text or numbers.
cat >poses.jsonl <<'BATCH'
{}
{"pose":"4,0,0"}
{"pose":[5,0,0]}
{"pose":[1,0,0,6, 0,1,0,0, 0,0,1,0]}
{"file":"cube.bxt"}
{"file":"cube.bxt","pose":[3,0,0]}
BATCH
expect 0 "$boxtree" query cube.bxt distance grid.bxt --pose 7,0,0 --batch poses.jsonl
same "$(jq -cs 'map(.upper * 1000 | round)' out)" '[6000,3000,4000,5000,0,2000]'
expect 0 "$boxtree" cook cube.obj uneven.obj -o two.bxt -q
printf '%s\n' '{"pose":[-3,0,0]}' '{"pose":[-3,0,0],"tree":"cube"}' >poses.jsonl
expect 0 "$boxtree" query cube.bxt distance two.bxt --tree2 uneven --batch poses.jsonl
same "$(jq -cs 'map(.upper * 1000 | round)' out)" '[1900,2000]'
# What a line does not say is taken from the options of its kind.
cat >rays.jsonl <<'BATCH'
{"origin":[0.25,0.5,5]}
{"origin":[0.25,0.5,5],"t_max":9}
{"origin":[0.25,0.5,5],"direction":[0,0,-2],"t_max":9}
{}
{"kind":"ray","origin":[0.25,0.5,-5],"direction":[0,0,1],"t_max":5}
{"kind":"point","at":[0.5,0.5,3]}
BATCH
expect 1 "$boxtree" query cube.bxt ray --direction 0,0,-1 --t-max 3 --batch rays.jsonl
same "$(jq -cs 'map([.hit, .t, .error])' out)" \
  '[[false,null,null],[true,4,null],[true,2,null],[null,null,"invalid_query"],[true,5,null],[null,null,null]]'
same "$(jq -sr '.[3].detail' out)" 'line 4: ray: "origin": expected [X,Y,Z], found no such key'
# A line with a shape takes none of the command line.
printf '%s\n' '{}' '{"sphere":1}' '{"box":[1,1,1]}' '{"rotation":[0,0,0,1]}' >casts.jsonl
expect 0 "$boxtree" query cube.bxt cast --box 1,1,2 --rotation 0.5,0,0,0.5 --at 0.25,0.5,5 --direction 0,0,-1 --batch casts.jsonl
same "$(jq -cs 'map(.t * 1e9 | round / 1e9)' out)" '[3,3,3,2]'
expect 1 "$boxtree" query cube.bxt cast --at 0.25,0.5,5 --direction 0,0,-1 --batch casts.jsonl
same "$(jq -cs 'map(.hit)' out)" '[null,true,true,null]'
printf '%s\n' '{}' '{"kind":"point","at":[0.5,0.5,3],"relative_error":0}' '{"budget":0}' >points.jsonl
expect 0 "$boxtree" query cube.bxt point --at 0.5,0.5,4 --absolute-error 0 --batch points.jsonl
same "$(jq -cs 'map([(.upper | if . then . * 1000 | round else . end), .nodes > 0])' out)" \
  '[[3000,true],[2000,true],[null,false]]'
printf '%s\n' '{"file":"cube.bxt"}' '{"file":"cube.bxt","first":false}' '{"file":"cube.bxt","pose":[9,0,0]}' >pairs.jsonl
expect 0 "$boxtree" query cube.bxt pair --first --pose 1,0.25,0.25 --batch pairs.jsonl
same "$(jq -cs 'map(.count | if . > 1 then 2 else . end)' out)" '[1,2,0]'
expect 1 "$boxtree" query cube.bxt distance - --batch - <cube.bxt
grep -q 'the file or the batch, not both' err
expect 1 "$boxtree" query cube.bxt
expect 1 "$boxtree" query cube.bxt ray --origin 0,0,0
grep -q -- '--direction X,Y,Z is required' err
expect 2 "$boxtree" query cube.bxt --batch missing.jsonl
# A batch that cannot be read to its end is no answer.
expect 2 "$boxtree" query cube.bxt --batch .
expect 2 sh -c "'$boxtree' query cube.bxt point --batch - <."
expect 1 "$boxtree" query cube.bxt point --batch /dev/zero
for line in 'info cube.bxt' --version --help --help-all 'cook --help' 'query ray --help-all' help; do
  expect 2 sh -c "'$boxtree' $line >/dev/full"
  same "$(cat err)" 'boxtree: write_failed: standard output: No space left on device'
done
grep -q 'standard output: No space left on device' err

# Own constants: what the calibration prints decides; what makes no sense is refused by name.
expect 0 "$boxtree" bench --calibrate cube.obj --runs 1 --json
cp out costs.json
expect 0 "$boxtree" cook cube.obj -o own.bxt --costs costs.json --json
jq -e '.trees[0].candidates | all(.cost.ray > 0)' out >/dev/null
cp out before.json
jq '.costs |= map(.ray |= map_values(. * 8))' costs.json >slower.json
expect 0 "$boxtree" cook cube.obj -o own.bxt --costs slower.json --json
jq -e --slurpfile before before.json '[.trees[0].candidates, $before[0].trees[0].candidates] | transpose |
  all(.[0].codec == .[1].codec and (.[0].cost.ray / .[1].cost.ray - 8 | fabs) < 1e-9)' out >/dev/null
jq '.speed_ratio = 1.45 | .processor_share = 1' costs.json >disturbed.json
expect 0 "$boxtree" cook cube.obj -o own.bxt --costs disturbed.json -q
same "$(cat err)" "boxtree: warning: --costs: the processor took up to 45 % longer for the same work at some times than at others\
 while queries were timed, so constants may be wrong, and what is chosen by them: measure again when the machine, and its host, do nothing else"
jq '.speed_ratio = 1 | .processor_share = 1' costs.json >calm.json
expect 0 "$boxtree" cook cube.obj -o own.bxt --costs calm.json -q
same "$(cat err)" ''
jq '.costs |= .[1:]' costs.json >short.json
expect 3 "$boxtree" cook cube.obj -o refused.bxt --costs short.json
grep -q 'document_invalid: short.json: costs: .*: expected one row, found 0' err
expect 2 "$boxtree" cook cube.obj -o refused.bxt --costs missing.json
[ ! -e refused.bxt ]

# Empty slabs: never cut off, or soon.
for share in 1 0.05; do
  expect 0 "$boxtree" cook cube.obj -o own.bxt --codec packed-f16 --shrink-share $share
  expect 0 "$boxtree" verify own.bxt
done
for share in 0 1.5 nan; do expect 1 "$boxtree" cook cube.obj -o own.bxt --shrink-share=$share; done

# Several inputs: one tree each, found by number and by name; bad faces dropped by number.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 4\nf 1 2 3\n' >flat.obj
expect 3 "$boxtree" cook cube.obj flat.obj -o both.bxt
expect 0 "$boxtree" cook cube.obj flat.obj -o both.bxt --skip-bad --json
same "$(jq -c '[.trees[].name]' out)" '["cube","flat"]'
same "$(jq -c '[.trees[1].import.skipped[].face]' out)" '[0]'
same "$(jq -c '[.trees[].candidates[].gates] | unique' out)" \
  '[{"missed":0,"escapes":0,"certificate":true}]'
expect 0 "$boxtree" verify both.bxt
for tree in 1 flat; do
  expect 0 "$boxtree" query both.bxt point --at 0.2,0.2,1 --tree "$tree" --json
  same "$(jq -c '[.distance,.face]' out)" '[1,1]'
done
misvalued 'tree_index: both.bxt: there is no tree 2; expected 0 or 1' query both.bxt point --at 0,0,0 --tree 2
misvalued 'tree_index: cube.bxt: there is no tree 1; expected 0' query cube.bxt point --at 0,0,0 --tree 1
# Which tree answers is told where nobody said it, once.
printf '{"kind":"point","at":[0.2,0.2,1]}\n{"kind":"point","at":[0.2,0.2,2]}\n' >points.jsonl
for query in 'point --at 0.2,0.2,1' '--batch points.jsonl'; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" query both.bxt $query
  same "$(cat err)" 'boxtree: warning: both.bxt: has 2 trees, and this is about tree 0, "cube"; --tree names another, or this one'
  # shellcheck disable=SC2086
  expect 0 "$boxtree" query both.bxt --tree 0 $query
  same "$(cat err)" ''
done
expect 0 "$boxtree" query cube.bxt pair both.bxt
same "$(cat err)" 'boxtree: warning: both.bxt: has 2 trees, and this is about tree 0, "cube"; --tree2 names another, or this one'
expect 0 "$boxtree" query cube.bxt pair both.bxt --tree2 cube
same "$(cat err)" ''
misvalued 'tree_index: both.bxt: no tree is called "nobody"; expected cube or flat' query both.bxt point --at 0,0,0 --tree nobody
misvalued 'tree_index: both.bxt: no tree is called "nobody"; expected cube or flat' query cube.bxt pair both.bxt --tree2 nobody

# Blobs: smaller on disk, the same answers, refused when truncated.
for method in lzma zstd; do
  expect 0 "$boxtree" cook cube.obj -o blob.bxt --codec "blob-$method"
  expect 0 "$boxtree" verify blob.bxt
  expect 5 "$boxtree" bench blob.bxt
  grep -q '^boxtree: feature_unsupported: blob.bxt: it is a blob, and bench times files that are mapped; cook it' err
  expect 0 "$boxtree" info blob.bxt --json
  same "$(jq -r '.trees[0].codec' out)" plain-f32
  same "$(jq -c '.blob.file_bytes < .blob.resident_bytes' out)" true
  expect 0 "$boxtree" info blob.bxt
  same "$(sed -n 2p out)" "compressed whole, to $(stat -c %s blob.bxt) bytes: it is decompressed before the first answer"
  expect 0 "$boxtree" query blob.bxt point --at 0.5,0.5,3 --json
  same "$(jq -c '[.distance,.point]' out)" '[2,[0.5,0.5,1]]'
  head -c 300 blob.bxt >short.bxt
  expect 3 "$boxtree" verify short.bxt
done

# Benchmarks: times beside the counts of their answers.
expect 0 "$boxtree" bench cube.bxt --quick --runs 1 --json
same "$(jq -c '[.files[0] | .ray_ns,.cast_sphere_ns,.box_ns,.point_ns,.pair_first_us,.pair_all_us,.open_us] | all(. > 0)' out)" true
same "$(jq -c '.files[0] | .ray_hits == 20000 and .cast_sphere_hits == 20000 and .pair_pairs >= .pair_hits' out)" true
# One is one.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >lone.obj
expect 0 "$boxtree" cook lone.obj -o lone.bxt -q
expect 0 "$boxtree" bench lone.bxt --quick --runs 1
grep -q '^lone\.bxt (lone, [a-z0-9-]*, 1 triangle)$' out
if grep -E ' 1 [a-z ]+s(,|;|$)' out; then exit 1; fi
expect 0 "$boxtree" bench lone.bxt --pages --quick
grep -q '^lone\.bxt (lone, [a-z0-9-]*, 1 triangle): 1 page of 4 KiB$' out
if grep -E ' 1 [a-z ]+s(,|:|$)' out; then exit 1; fi
expect 0 "$boxtree" bench cube.bxt --quick --runs 1 --json
# The same figures in words: all but times are those of the document.
counts=$(jq -c '.files[0] | [.ray_hits, .cast_sphere_hits, .box_faces, .pair_hits, .pair_pairs]' out)
page_faults=$(jq '.files[0].open_page_faults' out)
bench_says() {
  grep -Eq -- "$1" out || { echo "bench does not say: $1"; cat out; exit 1; }
}
expect 0 "$boxtree" bench cube.bxt --quick --runs 1
bench_says '^cube\.bxt \(cube, [a-z0-9-]+, 12 triangles\)$'
bench_says '^  measured means, wide codecs walked by [A-Za-z0-9, -]+; spheres with a radius of 1 % of the diagonal are cast along the rays;$'
bench_says 'boxes are cubes with an edge of 5 % of the diagonal'
same "$(awk '$1 ~ /^(ray|cast|box|first|all)$/ { printf "%s%s", separator, $4; separator = "," }' out)" "$(tr -d '[]' <<<"$counts")"
same "$(awk '$1 ~ /^(ray|cast|box|point|first|all|open)$/ && $2 > 0 { printf "%s %s ", $1, $3 }' out)" \
  'ray ns cast ns box ns point ns first us all us open us '
bench_says "^  ray +[0-9]+ ns  [0-9]+ hits, in batches [0-9]+ ns$"
bench_says "^  box +[0-9]+ ns  [0-9]+ faces, in batches [0-9]+ ns$"
bench_says "^  point +[0-9]+ ns  [0-9.e+]+ summed distance, in batches [0-9]+ ns$"
bench_says "^  near +[0-9]+ ns  in batches [0-9]+ ns$"
bench_says "^  ball +[0-9]+ ns  in batches [0-9]+ ns$"
bench_says "^  first +[0-9.]+ us  [0-9]+ contacts$"
bench_says "^  all +[0-9.]+ us  [0-9]+ pairs$"
bench_says "^  open +[0-9.]+ us  to the first answer, of which opening and binding take [0-9.]+ us; [0-9]+ page faults?$"
[ "$page_faults" -gt 0 ]
expect 0 "$boxtree" bench cube.bxt --pages --quick --json
pages=$(jq -r '.files[0] | "\(.pages.file)/\(.pages.open)/\(.pages.ray.median)/\(.first_rays.prefetched | length)"' out)
expect 0 "$boxtree" bench cube.bxt --pages --quick
bench_says '^cube\.bxt \(cube, [a-z0-9-]+, 12 triangles\): [0-9]+ pages? of 4 KiB$'
bench_says '^  box +[0-9]+ at the median, +[0-9]+ at worst, of 100 queries$'
bench_says '^  pages of the first 100 rays on one open file, after Tree::prefetch\(levels\)$'
bench_says '^  levels +0, nodes +0: +[0-9]+ read ahead, +[0-9]+ by the rays$'
same "$(sed -n 's/^.*: \([0-9]*\) pages* of.*/\1/p' out)/$(awk '$1 == "open" { print $2 }' out)/$(awk '$1 == "ray" { print $2 }' out)/$(grep -c '^  levels ' out)" \
  "$pages"
expect 0 "$boxtree" bench cube.bxt --approximate --quick --runs 1
bench_says '^  point +median, ns +nodes +largest error$'
bench_says '^  distance +median, ns +nodes +largest error$'
bench_says '^    error 0\.1 +[0-9]+ +[0-9.]+ +[0-9.e-]+$'
bench_says '^    budget [0-9]+ +[0-9]+ +[0-9.]+ +([0-9.e-]+|-)$'
expect 0 "$boxtree" bench --calibrate cube.obj --runs 1
grep -qx 'boxtree: warning: constants of so few meshes hold for their like alone: give 3 or more, of different sizes' err
bench_says '^ns of a query, of a node expanded and of a leaf read, for rays, boxes \(cubes with an edge of 5 % of the diagonal\), points and pairs '
bench_says '^wide8 +exact +f64 *( +[0-9.]+){12}$'
bench_says '^modelled and measured times differ by at most [0-9.]+ times$'
expect 1 "$boxtree" bench external.bxt --quick --runs 1
misvalued 'usage: bench: - (standard input) is no file, and bench times the opening of files, too' bench - --quick
misvalued 'usage: report: - (standard input) is no file; expected names of meshes' report - -o page.html
expect 0 "$boxtree" bench cube.bxt --approximate --quick --runs 1 --json
jq -e '.files[0].approximate | [.point, .distance] | all(
  (.by_error | length > 3 and .[0].relative_error == 0 and all(.median_ns > 0 and .false_bounds == 0
    and .measured_error <= .relative_error + 1e-9)) and
  (.by_budget | length > 3 and all(.nodes <= .node_budget and .false_bounds == 0)))' out >/dev/null

# Found by a newcomer: what is not read and may be geometry was lost in silence. It is a warning, and in the JSON.
printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'cstype bezier' 'deg 1' 'f 1 2 3' 'deg 2' >unread.obj
expect 0 "$boxtree" cook unread.obj -o unread.bxt -q --json
same "$(cat err)" "boxtree: warning: unread.obj: not read, and may be geometry: cstype (line 4), deg (2, the first in line 5); faces are read from 'f' alone: convert curves and surfaces to polygons"
same "boxtree: warning: $(jq -r '.warnings[]' out)" "$(cat err)"
same "$(jq -c '.trees[0].import.unread' out)" '[{"what":"cstype","count":1,"line":4},{"what":"deg","count":2,"line":5}]'
printf '%s\n' OFF '3 1 0' '0 0 0' '1 0 0' '0 1 0' '3 0 1 2' '3 2 1 0' >unread.off
expect 0 "$boxtree" cook unread.off -o unread.bxt -q
same "$(cat err)" 'boxtree: warning: unread.off: not read, and may be geometry: lines after the last element (line 7); the header counts elements: if these are some, correct its numbers'
# So was that f32 makes a point of a mesh.
printf '%s\n' 'v 0 0 0' 'v 1e-50 0 0' 'v 0 1e-50 0' 'f 1 2 3' >tiny.obj
expect 0 "$boxtree" cook tiny.obj -o tiny.bxt -q --json
same "$(cat err)" 'boxtree: warning: tiny.obj: f32 has few digits for a mesh so small and moved a vertex by up to 1e-50; cook --f64 keeps all digits, and with --tolerance LENGTH or the tolerance of a profile in few bytes'
same "$(jq '.trees[0].import.moved_by_f32' out)" 1e-50
expect 5 "$boxtree" cook tiny.obj -o tiny.bxt -q --tolerance 1e-51
# And that it took the area of half of the faces, though it moved no vertex far beside the mesh.
printf '%s\n' 'v 0 0 0' 'v 1000 0 0' 'v 0 1000 0' 'v 1 0 0' 'v 1.00000001 0 0' 'v 1 1e-8 0' 'f 1 2 3' 'f 4 5 6' >flat.obj
expect 0 "$boxtree" cook flat.obj -o flat.bxt -q
same "$(cat err)" 'boxtree: warning: flat.obj: 1 of 2 faces have an area in f64 and none in f32; cook --f64 keeps all digits'
expect 0 "$boxtree" cook flat.obj -o flat.bxt -q --f64
same "$(cat err)" ''
sed -i s/1.00000001/1/ flat.obj # one that has none anywhere
expect 0 "$boxtree" cook flat.obj -o flat.bxt -q
same "$(cat err)" ''

# What f32 takes far from the origin is told, and kept on request: whole, or on a grid over the mesh.
printf 'v %s\n' '459123.4321 5412345.6789 0' '459123.5321 5412345.6789 0' '459123.4321 5412345.7789 0' >far.obj
printf 'f 1 2 3\n' >>far.obj
expect 0 "$boxtree" cook far.obj -o far.bxt -q --json
same "$(cat err)" 'boxtree: warning: far.obj: f32 has few digits for a mesh so far from the origin and moved a vertex by up to 0.222; cook --f64 keeps all digits, and with --tolerance LENGTH or the tolerance of a profile in few bytes'
jq -e '.trees[0].import.moved_by_f32 | . > 0.2 and . < 0.3' out >/dev/null
expect 5 "$boxtree" cook far.obj -o far.bxt -q --tolerance 0.001
same "$(cat err)" 'boxtree: mesh_unsupported: far.obj: f32 moves a vertex by up to 0.222, farther than the tolerance of 0.001; --f64 keeps all digits'
expect 5 "$boxtree" cook far.obj cube.obj -o far.bxt -q --tolerance 0.001
# Found by an oracle: what is too little to be told was farther than a tolerance, too.
printf 'v 0 0 0\nv 999.9999 0 0\nv 0 1 0\nf 1 2 3\n' >long.obj
printf '[scene]\nsource = "long.obj"\ntolerance = 1e-6\n' >long.toml
expect 0 "$boxtree" cook long.obj -o long.bxt -q
same "$(cat err)" ''
for options in 'long.obj --tolerance 1e-6' 'long.obj --scene --tolerance 1e-6' '--profile long.toml'; do
  expect 5 "$boxtree" cook $options -o long.bxt -q
  grep -q '^boxtree: mesh_unsupported: .* f32 moves a vertex .*by up to 2.21e-05, farther than .*--f64 keeps all digits$' err
  expect 0 "$boxtree" cook $options -o long.bxt -q --f64
done
expect 5 "$boxtree" report long.obj -o long.html -q --quick --tolerance 1e-6
# What f32 took counts: in the file, and of a profile's tolerance.
expect 0 "$boxtree" cook far.obj -o far.bxt -q --tolerance 0.3 --json
jq -e '.trees[0].candidates | all(.error.max_vertex_error > 0.2 and .error.max_vertex_error <= 0.3)' out >/dev/null
expect 0 "$boxtree" cook far.obj -o far.bxt -q --exact
expect 0 "$boxtree" info far.bxt --json
jq -e '.trees[0] | .geometry != "grid" and .max_vertex_error > 0.2 and .max_vertex_error < 0.3' out >/dev/null
printf '[scene]\nsource = "far.obj"\ntolerance = 0.001\n' >far.toml
expect 5 "$boxtree" cook --profile far.toml -o far.bxt -q
same "$(cat err)" 'boxtree: mesh_unsupported: far.toml:3: tolerance: at most 0.001 off in the world, 0.001 in the mesh at scale 1; f32 moves a vertex of mesh "far" by up to 0.222, farther than that; cook --f64 keeps all digits'
expect 0 "$boxtree" cook --profile far.toml -o far.bxt -q --f64
same "$(cat err)" ''
expect 0 "$boxtree" info far.bxt --json
jq -e '.trees[0].max_vertex_error <= 0.001' out >/dev/null
printf '[scene]\nsource = "far.obj"\nexact = true\n' >far.toml
expect 0 "$boxtree" cook --profile far.toml -o far.bxt --why
grep -q 'exact, f32, which moved a vertex by up to 0.222' out
for options in --f64 '--f64 --tolerance 0.001'; do
  expect 0 "$boxtree" cook far.obj -o far.bxt -q $options
  same "$(cat err)" ''
  expect 0 "$boxtree" query far.bxt point --at 459123.4321,5412345.6789,7 --json
  jq -e '.distance - 7 | fabs < 1e-6' out >/dev/null
done
expect 0 "$boxtree" query far.bxt ray --origin 459123.48,5412345.72,7 --direction 0,0,-1 --json
same "$(jq .hit out)" true
# The page of a report says how far f32 moved the mesh, and its tolerance counts that.
expect 0 "$boxtree" report far.obj -o far.html --quick --no-times --tolerance 0.3
same "$(grep -c 'moved a vertex by up to 0.222' err)" 1
for said in out far.html; do
  grep -q 'Reading the mesh as f32 moved a vertex by up to [0-9.]* of the diagonal (0.23 units of the mesh)' $said
done
grep -q 'surface within the tolerance of 0.3' out
expect 5 "$boxtree" report far.obj -o far.html --quick --no-times --tolerance 0.001
same "$(cat err)" 'boxtree: mesh_unsupported: far.obj: f32 moves a vertex by up to 0.222, farther than the tolerance of 0.001; --f64 keeps all digits'
expect 0 "$boxtree" report far.obj -o far.html --quick --no-times --tolerance 0.001 --f64 -q
same "$(cat err)" ''
grep -q 'Positions are f64' far.html

# Bad faces are left out of a report on request, of all that it is of, and its commands leave them out, too.
{ cat cube.obj; printf 'v nan 0 0\nf 1 2 -1\n'; } >cube_and_bad.obj
expect 3 "$boxtree" report cube_and_bad.obj --quick --no-times
grep -q '(report --skip-bad drops such faces)$' err
expect 0 "$boxtree" report cube_and_bad.obj -o bad.html --quick --no-times --skip-bad --json -q
same "$(cat err)" 'boxtree: warning: cube_and_bad.obj: 1 bad face left out by --skip-bad'
same "$(jq -c '.meshes[0] | [.triangles, .skipped]' out)" '[12,1]'
grep -q 'Without 1 bad face of the source' bad.html
grep -o '<code>.*</code>' bad.html | sed 's/<[^>]*>/ /g' | tr -s ' ' | grep -o 'boxtree cook cube_and_bad.obj .*' >commands
[ -s commands ]
same "$(grep -vc -- ' --skip-bad' commands)" 0
read -ra words < <(head -1 commands)
expect 0 "$boxtree" "${words[@]:1}" -q

# The same of a mesh whose node places it there, as an export does.
expect 0 "$boxtree" cook far.obj -o far.bxt -q --f64
expect 0 "$boxtree" export far.bxt --triangles -o placed.glb
for options in '' --exact; do
  expect 0 "$boxtree" cook placed.glb -o placed.bxt -q $options
  same "$(cat err)" 'boxtree: warning: placed.glb: f32 has few digits for a mesh so far from the origin and moved a vertex by up to 0.222; cook --f64 or a scene (--scene) keeps the places of its nodes, and with --tolerance LENGTH or the tolerance of a profile in few bytes'
  expect 0 "$boxtree" info placed.bxt --json
  jq -e '.trees[0].max_vertex_error > 0.2 and .trees[0].max_vertex_error < 0.3' out >/dev/null
done
for command in 'cook -o placed.bxt' 'report -o placed.html --quick --no-times'; do
  expect 5 "$boxtree" $command placed.glb -q --tolerance 0.001
  same "$(cat err)" 'boxtree: mesh_unsupported: placed.glb: f32 moves a vertex by up to 0.222, farther than the tolerance of 0.001; --f64 or a scene (--scene) keeps the places of its nodes'
done
for options in --f64 '--f64 --tolerance 0.001' '--scene --tolerance 0.001'; do
  expect 0 "$boxtree" cook placed.glb -o placed.bxt -q $options
  same "$(cat err)" ''
  expect 0 "$boxtree" query placed.bxt point --at 459123.4321,5412345.6789,7 --json
  jq -e '.distance - 7 | fabs < 1e-6' out >/dev/null
done

# Digits of text STL are kept, too. A binary one has none, and of Collada its reader keeps none.
{
  printf 'solid far\nfacet normal 0 0 1\nouter loop\nvertex 459123.4321 5412345.6789 0\nvertex 459123.5321 5412345.6789 0\n'
  printf 'vertex 459123.4321 5412345.7789 0\nendloop\nendfacet\nendsolid far\n'
} >far.stl
expect 5 "$boxtree" cook far.stl -o stl.bxt -q --tolerance 0.001
same "$(cat err)" 'boxtree: mesh_unsupported: far.stl: f32 moves a vertex by up to 0.222, farther than the tolerance of 0.001; --f64 keeps all digits'
expect 0 "$boxtree" cook far.stl -o stl.bxt -q
grep -q '^boxtree: warning: far.stl: f32 has few digits .* moved a vertex by up to 0.222; cook --f64 keeps all digits, and with' err
expect 0 "$boxtree" cook far.stl -o stl.bxt -q --f64
same "$(cat err)" ''
expect 0 "$boxtree" query stl.bxt point --at 459123.4321,5412345.6789,7 --json
jq -e '.distance - 7 | fabs < 1e-6' out >/dev/null
{ printf '\0%.0s' {1..80}; printf '\1\0\0\0'; printf '\0%.0s' {1..12}; printf '\0\0\200\77\0\0\0\0\0\0\0\0'
  printf '\0\0\0\0\0\0\200\77\0\0\0\0'; printf '\0%.0s' {1..14}; } >binary.stl
expect 0 "$boxtree" cook binary.stl -o stl.bxt -q --f64
same "$(cat err)" 'boxtree: warning: binary.stl: its coordinates were read as f32, and --f64 keeps no more'
expect 0 "$boxtree" cook binary.stl -o stl.bxt -q
same "$(cat err)" ''

# f64 from the digits of the file to the answer: layers 1e-9 apart, a million units out.
printf 'v 1000000 0 0\nv 1000001 0 0\nv 1000000 1 0\nv 1000000 0 -1e-9\nv 1000001 0 -1e-9\nv 1000000 1 -1e-9\nf 1 2 3\nf 4 5 6\n' >layers.obj
for codec in packed-f64 plain-f16; do
  expect 0 "$boxtree" cook layers.obj -o layers.bxt --f64 --codec "$codec"
  expect 0 "$boxtree" verify layers.bxt
  expect 0 "$boxtree" query layers.bxt ray --origin 1000000.25,0.25,-1 --direction 0,0,1 --json
  same "$(jq -c '[.face,(.t - 0.999999999 | fabs < 1e-15)]' out)" '[1,true]'
done

# The paper's tables: text, a page and figures that agree with each other.
expect 0 "$boxtree" report --paper cube.obj layers.obj --no-times -o paper.html --json-out paper.json
grep -q 'Table A.2' out
grep -q 'A.6 and A.7' out
same "$(grep '^wrote' out)" "wrote paper.html, $(stat -c %s paper.html) bytes
wrote paper.json, $(stat -c %s paper.json) bytes"
grep -q '<td class="word">cube</td>' paper.html
same "$(jq -c '[.meshes[] | .original_nodes == .merged_nodes + .faces] | unique' paper.json)" '[true]'
same "$(jq -c '[.meshes[].codecs | length] | unique' paper.json)" '[8]'
same "$(jq -c '[.stairs[] | .missed_outward] | unique' paper.json)" '[0]'
expect 0 "$boxtree" report --paper cube.obj --no-times
same "$(tail -1 out)" "no page was written; -o FILE.html writes one"
expect 2 "$boxtree" report --paper missing.obj
expect 1 "$boxtree" report --paper cube.obj --csv paper.csv

# Which encoding to use: a page, JSON and CSV of the same points; counted figures repeat to the byte.
printf '[{"id":"S1","what":"hashes","figure":0,"limit":0,"pass":true}]' >stiff.json
expect 0 "$boxtree" report cube.obj layers.obj --no-times --quick --include stiff.json \
  -o report.html --json-out report.json --csv report.csv
if grep -q '; also:' out; then exit 1; fi
grep -Eq '^ *Balanced(, for most uses \(surface within a millionth of the diagonal\)|,? and .*): wide' out
expect 0 "$boxtree" report cube.obj layers.obj --no-times --quick --include stiff.json --json
same "$(jq -S 'del(.load)' out | cmp - <(jq -S 'del(.load)' report.json) && echo same)" same
same "$(jq -c .schema report.json)" 1
if grep warning err; then exit 1; fi
same "$(jq -c '[.meshes[].points | length] | unique' report.json)" '[18]'
same "$(jq -c '[.meshes[].points[] | .gates.pass and .times == null] | unique' report.json)" '[true]'
same "$(jq -c '[.meshes[].points[].bytes | .total == .nodes + .vertices + .corners + .face_ids + .rest] | unique' report.json)" '[true]'
same "$(jq -c '[.meshes[] | .processor_share, .speed_ratio] | unique' report.json)" '[null]'
same "$(wc -l <report.csv)" 37
same "$(grep -c '<h2>stiff</h2>' report.html)" 1
jq 'del(.load)' report.json >first.json
expect 0 "$boxtree" report cube.obj layers.obj --no-times --quick --include stiff.json --json-out report.json
same "$(jq 'del(.load)' report.json | cmp - first.json && echo same)" same
expect 0 "$boxtree" report cube.obj --quick --json-out report.json
same "$(tail -1 out)" "wrote report.json, $(stat -c %s report.json) bytes"
same "$(jq -c '[.meshes[] | .processor_share > 0 and .processor_share <= 1 and .speed_ratio >= 1]' report.json)" '[true]'
same "$(jq -c '[.meshes[].points[].times | .ray.median_ns <= .ray.p99_ns] | unique' report.json)" '[true]'
expect 2 "$boxtree" report missing.obj
expect 2 "$boxtree" report cube.obj --include missing.json
expect 2 "$boxtree" report cube.obj --quick --peers missing
expect 2 "$boxtree" report cube.obj --quick --peers /bin/false
expect 3 "$boxtree" report cube.obj --quick --peers /bin/true
grep -q 'document_invalid: /bin/true: printed no JSON with an array "rows"' err
row='{"mesh":"cube","library":"peer","variant":"","metric":"ray_ns","value":1,"unit":"ns"}'
for second in '{"value":1}' '[]' 2 "${row/1/\"1\"}" "${row/\"ns\"/3}"; do
  printf '#!/bin/sh\necho %s\n' "'{\"rows\":[$row,$second]}'" >peer.sh
  chmod +x peer.sh
  expect 3 "$boxtree" report cube.obj --quick --peers ./peer.sh
  grep -qF 'peer.sh: rows[1] is no row as boxtree_peers prints it: ' err
done
printf '#!/bin/sh\necho %s\n' "'{\"rows\":[$row]}'" >peer.sh
expect 0 "$boxtree" report cube.obj --quick --peers ./peer.sh
expect 3 "$boxtree" report cube.obj --include cube.obj
grep -q 'document_invalid: cube.obj: expected rows .* boxtree_stiff and boxtree_robustness .*, found no JSON' err
expect 0 "$boxtree" report --help
tr -s ' \n' ' ' <out | grep -q 'results of boxtree_stiff or boxtree_robustness'
# What was written is told, but not among a document.
expect 0 "$boxtree" report cube.obj --quick --no-times -o told.html --csv told.csv --json-out told.json \
  --csv-approximate told-approximate.csv
for file in told.html told.csv told.json told-approximate.csv; do
  grep -q "^wrote $file, $(stat -c %s $file) bytes$" out
done
expect 0 "$boxtree" report cube.obj --quick --no-times -o told.html -q
same "$(wc -c <out)" 0
for document in --json '--csv -'; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" report cube.obj --quick --no-times -o told.html $document
  same "$(grep -c '^wrote' out)" 0
done
expect 1 "$boxtree" report
expect 2 "$boxtree" report cube.obj --quick --no-times -o no/such/folder/report.html

# Files for viewers: what comes back is the geometry that was cooked (verify compares its hash).
expect 0 "$boxtree" export cube.bxt -o shown.obj --json
same "$(jq -c '[.trees[0] | .name,.faces,.triangles,.levels[0],.leaves]' out)" \
  '["cube",6,12,{"level":0,"boxes":1},null]'
same "$(jq -r .bytes out)" "$(stat -c %s shown.obj)"
same "$(grep -c '^l ' shown.obj)" 12
expect 0 "$boxtree" verify external.bxt --mesh shown.obj
expect 0 "$boxtree" export both.bxt -o shown.glb --triangles
same "$(head -c 4 shown.glb)" glTF
grep -q '^cube: 12 triangles$' out
grep -q '^flat: 1 triangle$' out
expect 0 "$boxtree" cook shown.glb -o again.bxt --flatten --json
same "$(jq -r '.trees[0].triangles' out)" 13
for tree in 1 flat; do
  expect 0 "$boxtree" export both.bxt -o flat-shown.obj --tree "$tree" --triangles
  same "$(grep -c '^f ' flat-shown.obj)" 1
done
expect 0 "$boxtree" export cube.bxt -o boxes.obj --boxes --levels 0 --solid
same "$(grep -c '^f ' boxes.obj)" 6
expect 0 "$boxtree" export cube.bxt -o boxes.obj --leaves --json
same "$(jq -c '[.trees[0] | .triangles,.levels,.leaves > 0]' out)" '[12,[],true]'
expect 1 "$boxtree" export external.bxt -o external.obj
same "$(cat err)" 'boxtree: external_mesh_needed: external.bxt: tree 0: no mesh was given: name the one that it was cooked of with --mesh MESH'
expect 0 "$boxtree" export external.bxt -o external.obj --boxes
expect 0 "$boxtree" export external.bxt -o external.obj --mesh cube.obj --triangles
expect 0 "$boxtree" verify external.bxt --mesh external.obj
expect 3 "$boxtree" export external.bxt -o external.obj --mesh other.obj
cp shown.obj before.obj
for levels in 90 0-1,90 3-1 1- x 0,; do
  expect 1 "$boxtree" export cube.bxt -o shown.obj --levels "$levels"
done
expect 1 "$boxtree" export cube.bxt -o shown.obj --levels 90
grep -q '^boxtree: invalid_query: cube.bxt: no boxes on level 90: the deepest is [0-9]*$' err
expect 1 "$boxtree" export cube.bxt -o shown.stl
same "$(head -1 err)" 'boxtree: usage: export: --output: shown.stl: expected a name in .obj or .glb'
expect 1 "$boxtree" export cube.bxt
expect 1 "$boxtree" export both.bxt -o shown.obj --tree 2
expect 1 "$boxtree" export both.bxt -o shown.obj --tree nobody
grep -q '^boxtree: tree_index: both.bxt: no tree is called "nobody"' err
# Boxes alone have no triangles to count.
expect 0 "$boxtree" export cube.bxt -o boxes.obj --boxes --levels 0
same "$(tail -1 out)" 'cube: level 0: 1 box'
expect 2 "$boxtree" export missing.bxt -o shown.obj
expect 2 "$boxtree" export cube.bxt -o no/such/folder/shown.obj
expect 3 "$boxtree" export cube.obj -o shown.obj
cmp shown.obj before.obj
# What `info` prints accounts for every byte, and says why there are no face ids.
awk 'BEGIN { for (i = 0; i < 200; i++) { x = i * 37 % 200; printf "v %d 0 0\nv %d 1 0\nv %d 0 1\nf -3 -2 -1\n", x, x, x } }' >apart.obj
for ids in stored none 'source order'; do
  options=()
  [ "$ids" = none ] && options=(--no-face-ids)
  [ "$ids" = 'source order' ] && options=(--write-reordered ordered_apart.obj)
  expect 0 "$boxtree" cook apart.obj -o ids.bxt --quiet "${options[@]}"
  expect 0 "$boxtree" info ids.bxt --json
  same "$(jq -r '.trees[0].face_ids' out)" "$ids"
  expect 0 "$boxtree" info ids.bxt
  same "$(sed -n 's/^bytes: //p' out | grep -o '[0-9]*' | awk '{ sum += $1 } END { print sum }')" "$(stat -c %s ids.bxt)"
  case $ids in
    stored) grep -q "^  face ids: stored, those of the source's faces$" out ;;
    none) grep -q "^  face ids: none, queries number faces in the tree's order$" out ;;
    *) grep -q "^  face ids: none needed, the tree's faces are in the source's order$" out ;;
  esac
done
# One of a thing has no plural.
printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' >one.obj
printf 'f 1 2 3\n' >>one.obj
expect 0 "$boxtree" cook one.obj -o one.bxt --grid-bits 8
grep -q '^one: 1 triangle, ' out
expect 0 "$boxtree" info one.bxt
grep -q '^one: 1 triangle, ' out
expect 0 "$boxtree" cook one.obj -o one.bxt --scene
grep -q '^scene: 1 instance (0 moving) of 1 tree, 1 triangle placed, ' out
sed 's/^v 1 0 0/v nan 0 0/' one.obj >bad_one.obj
expect 3 "$boxtree" cook bad_one.obj -o bad_one.bxt --skip-bad
grep -q 'its only face is bad' err
# A small mesh beside a large one has few steps of their grid, and is told so.
sed 's/^v .*/& /; s/\(v .*\)1 /\11000 /' cube.obj >large.obj
expect 0 "$boxtree" cook cube.obj large.obj -o sizes.bxt --grid-bits 20
grep -q '^  one grid for all, step 2^-10: some 2^10 steps over cube, 2^19 over the largest; cooked apart it has a finer one, --exact keeps every bit$' out
expect 0 "$boxtree" cook cube.obj other/cube.obj -o sizes.bxt --grid-bits 20
same "$(grep -c 'one grid for all' out)" 0
grep -q '^  grid: step 2^-19$' out
# Two measures at once are refused.
expect 1 "$boxtree" bench cube.bxt --pages --approximate
grep -q '^boxtree: usage: bench: --' err
# What an export is made from is never its output, whatever the name it goes by.
cp cube.bxt link-target.bxt
ln -s link-target.bxt link.obj
cp cube.obj own.obj
expect 1 "$boxtree" export link-target.bxt -o link.obj
expect 1 "$boxtree" export external.bxt --mesh own.obj -o ./own.obj
cmp link-target.bxt cube.bxt
cmp own.obj cube.obj
# Nor is what is cooked or reported on: by no name, and no other output either.
ln own.obj hard.obj
ln -s own.obj soft.obj
printf '' >empty.toml
for output in own.obj ./own.obj hard.obj soft.obj; do
  expect 1 "$boxtree" cook own.obj -o "$output" -q
  expect 1 "$boxtree" cook own.obj -o not-own.bxt --depfile "$output" -q
  expect 1 "$boxtree" report own.obj --quick -o "$output"
done
expect 1 "$boxtree" cook own.obj -o not-own.bxt --depfile ./not-own.bxt -q
same "$(cat err)" 'boxtree: usage: cook: --depfile ./not-own.bxt: is the same file as the output not-own.bxt; it would be written over: name another output'
expect 1 "$boxtree" cook own.obj -o not-own.bxt --write-reordered ./own.obj -q
same "$(cat err)" 'boxtree: usage: cook: --write-reordered ./own.obj: is the same file as the input own.obj; it would be written over: name another output'
expect 1 "$boxtree" cook own.obj --profile empty.toml -o empty.toml -q
expect 1 "$boxtree" cook own.obj -o '' -q
same "$(stat -c %s empty.toml)" 0
cmp own.obj cube.obj
if [ -e not-own.bxt ]; then echo "not-own.bxt was written"; exit 1; fi
same "$(find . -name '*.cooking' | wc -l)" 0

# Names are whatever bytes they are: shown so that no terminal obeys them, and never the end of it.
odd=$(printf 'odd\033[31m\377\302\233name')
cp cube.obj "$odd.obj"
expect 0 "$boxtree" cook "$odd.obj" -o "$odd.bxt"
grep -qF 'odd\x1b[31m\xff\xc2\x9bname' out
expect 0 "$boxtree" info "$odd.bxt"
grep -qF 'odd\x1b[31m�\xc2\x9bname: 12 triangles' out
expect 0 "$boxtree" info "$odd.bxt" --json
expect 0 "$boxtree" verify "$odd.bxt"
expect 0 "$boxtree" query "$odd.bxt" ray --origin 0.2,0.3,5 --direction 0,0,-1
expect 2 "$boxtree" info "missing$odd.bxt"
grep -qF 'missingodd\x1b[31m\xff\xc2\x9bname.bxt' err
if grep -l "$(printf '\033')" out err; then echo "an escape sequence was printed"; exit 1; fi
cp cube.obj 'Würfel 方.obj'
expect 0 "$boxtree" cook 'Würfel 方.obj' -o plain.bxt
grep -qF 'Würfel 方' out

# Devices never end; a limit of file sizes is an error like any other.
for option in --profile --costs; do
  expect 2 timeout 20 "$boxtree" cook cube.obj -o endless.bxt "$option" /dev/zero
  grep -q '/dev/zero: more than the [0-9]* bytes that such a file may have' err
done
printf '[[mesh]]\nname = "*"\nhidden_faces = "/dev/zero"\n' >endless.toml
expect 3 timeout 60 "$boxtree" cook cube.obj -o endless.bxt --profile endless.toml
grep -q '/dev/zero: more than the [0-9]* bytes' err
got=0
said=$(ulimit -f 0; "$boxtree" cook cube.obj -o no-room.bxt 2>&1 >/dev/null) || got=$?
same "$got" 2
case $said in *write_failed*'File too large'*) ;; *) echo "unclear: $said"; exit 1 ;; esac
got=0
(ulimit -f 0; exec "$boxtree" cook missing.obj -o no-room.bxt >/dev/null 2>nowhere) || got=$?
same "$got" 2 # standard error takes nothing either
if [ -e no-room.bxt ]; then echo "no-room.bxt was written"; exit 1; fi
# Where no thread can be started, one does the work, and more than the machine has are not said to be missing. Limits of
# processes do not hold for root, and another user may read standard input alone.
awk 'BEGIN { for (y = 0; y <= 150; ++y) for (x = 0; x <= 150; ++x) print "v", x, y, x * y % 7
  for (y = 0; y < 150; ++y) for (x = 1; x <= 150; ++x) { a = 151 * y + x; print "f", a, a + 1, a + 152 "\nf", a, a + 152, a + 151 } }' >many.obj
one_process=(prlimit --nproc=1)
[ "$(id -u)" -ne 0 ] || one_process=(setpriv --reuid=54321 --clear-groups "${one_process[@]}")
if "${one_process[@]}" "$boxtree" --version >/dev/null 2>&1; then
  for jobs in "" "--jobs 64"; do
    # shellcheck disable=SC2086
    expect 0 "${one_process[@]}" "$boxtree" cook - --format obj -o - -q $jobs <many.obj
    same "$(wc -c <err)" 0
    mv out stdin.bxt
    # shellcheck disable=SC2086
    expect 0 "${one_process[@]}" "$boxtree" verify - $jobs <stdin.bxt
    same "$(wc -c <err)" 0
  done
fi
# Too little memory has one status, wherever it runs out: from what the program cannot be loaded with to what is enough.
# Not under sanitizers, which reserve terabytes of address space.
if (ulimit -v 4000000; exec "$boxtree" --version) >/dev/null 2>&1; then
  expect 0 "$boxtree" cook many.obj -o many.bxt --exact --for speed -q
  for command in "cook many.obj -o own.bxt -q -j 1" "verify many.bxt -q -j 1" "query many.bxt point --at 0,0,0"; do
    refused=0
    # Between what loads the program and what a query needs there is less than a megabyte.
    for kilobytes in $(seq 12000 200 40000) $(seq 41000 1000 400000); do
      got=0
      # shellcheck disable=SC2086
      (ulimit -v "$kilobytes"; exec "$boxtree" $command) >out 2>err || got=$?
      case $got in
        0) break ;;
        4)
          refused=$((refused + 1))
          # The command, or a file that was too large.
          grep -qE '^boxtree: (out_of_memory: (cook|verify|query|own|many)[^ ]*: |internal: cannot go on)' err || { cat err; exit 1; }
          ;;
        127) ;; # not even loaded
        134) same "$refused" 0 ;; # nor were the libraries: those that assimp needs have start-up code of their own
        *) echo "expected exit 0, 4 or 127, got $got with $kilobytes KB: $command"; cat err; exit 1 ;;
      esac
    done
    same "$got" 0
    [ "$refused" -gt 0 ] || { echo "memory never ran out: $command"; exit 1; }
  done
fi
# More inputs than a file can hold are told before any is read.
seq 65536 | sed 's/.*/cube.obj/' >many
expect 5 timeout 20 "$boxtree" cook @many -o many.bxt
grep -q 'mesh_too_large: 65536 inputs, each a tree: a file holds 65535 at most; cook files of their own, and pack these' err
# assimp reads a number below zero as a large one.
printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n' >negative.ply
expect 3 "$boxtree" cook negative.ply -o negative.bxt
grep -q 'corner 2 names vertex -2, but there are 3 vertices' err

# Materials of single trees are kept on request; answers name them.
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl grass\nf 1 2 3\nusemtl stone\nf 1 3 4\n' >field.obj
expect 0 "$boxtree" cook field.obj -o field.bxt
expect 0 "$boxtree" query field.bxt ray --origin 0.2,0.8,5 --direction 0,0,-1 --json
same "$(jq -c '[.face, has("material")]' out)" '[1,false]'
expect 0 "$boxtree" cook field.obj -o field.bxt --materials
expect 0 "$boxtree" verify field.bxt
expect 0 "$boxtree" query field.bxt ray --origin 0.2,0.8,5 --direction 0,0,-1 --json
same "$(jq -c '[.face, .material]' out)" '[1,"stone"]'
expect 0 "$boxtree" query field.bxt sphere --center 0.8,0.2,0 --radius 0.1 --json
same "$(jq -c '.faces' out)" '[{"face":0,"material":"grass"}]'
expect 0 "$boxtree" info field.bxt
grep -qx 'materials \["grass", *"stone"\]' out
grep -q '  materials: of each face, 1.00 bytes per triangle' out

expect 0 "$boxtree" cook field.obj -o field.bxt --materials
grep -qx '  materials: 2 bytes, of each face; runs of the source.s faces would take 16 bytes' out
expect 0 "$boxtree" cook cube.obj -o cube.bxt --materials -q
same "$(cat err)" 'boxtree: warning: cube.obj: --materials finds no material: usemtl of OBJ files, glTF, FBX and others have some'

# User data of faces: a property of a PLY file, groups of an OBJ file, whose names are told with their numbers.
{
  printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng floor\nf 1 2 3\n'
  for ((i = 0; i < 13; ++i)); do printf 'g part%s\nf 1 3 4\n' $i; done
} >groups.obj
expect 0 "$boxtree" cook groups.obj -o groups.bxt --user-data groups
grep -qx '  groups: 0 floor, 1 part0, 2 part1, .*, 11 part10, and 2 more, which --json names' out
expect 0 "$boxtree" cook groups.obj -o groups.bxt --user-data groups --json
same "$(jq -c '.trees[0].import.groups | [length, .[0], .[13]]' out)" '[14,"floor","part12"]'
# What is no mesh by its name is none, whatever its first bytes are.
cp groups.obj groups
expect 3 "$boxtree" cook groups -o groups.bxt
grep -q 'groups: expected a mesh by its ending: .*; found none$' err
# Nothing takes the place of another kind of file.
cp groups.obj shown.obj
expect 1 "$boxtree" export groups.bxt -o shown.obj
same "$(cat err)" 'boxtree: usage: export: shown.obj: expected what an export has written there, or none, found another file; it would be lost: remove it, or name another'
cmp groups.obj shown.obj
for _ in once again; do expect 0 "$boxtree" export groups.bxt -o shown2.obj; expect 0 "$boxtree" export groups.bxt -o shown.glb; done
printf '[scene]\n' >kept.toml
expect 1 "$boxtree" cook groups.obj -o kept.toml
grep -q 'kept.toml: expected a cooked file there, or none, found another file' err
same "$(cat kept.toml)" '[scene]'
expect 1 "$boxtree" cook groups.obj -o groups.bxt --depfile shown.obj
grep -q 'shown.obj: expected another ending than .obj, which is that of a mesh, as shown.d' err
{
  printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n'
  printf 'property list uchar int vertex_indices\nproperty int zone\nproperty float heat\nend_header\n'
  printf '0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 300 0\n3 0 2 3 -1 0\n'
} >zones.ply
expect 0 "$boxtree" cook zones.ply -o zones.bxt --user-data zone
grep -qx '  user data: 8 bytes, of each face; runs of the source.s faces would take 16 bytes' out
expect 0 "$boxtree" verify zones.bxt
expect 0 "$boxtree" query zones.bxt ray --origin 0.2,0.8,5 --direction 0,0,-1 --json
same "$(jq -c '[.face, .user_data]' out)" '[1,4294967295]'
expect 0 "$boxtree" query zones.bxt sphere --center 0.8,0.2,0 --radius 0.1 --json
same "$(jq -c '.faces' out)" '[{"face":0,"user_data":300}]'
expect 0 "$boxtree" info zones.bxt
grep -q '  user data: of each face, 4.00 bytes per triangle' out
expect 5 "$boxtree" cook zones.ply -o zones.bxt --user-data zones
grep -q "zones.ply: user data of faces 'zones': faces have no such property; integers of theirs are: zone; did you mean 'zone'?" err
expect 5 "$boxtree" cook zones.ply -o zones.bxt --user-data heat
grep -q 'expected an integer, found a floating-point number' err
printf 'solid\nendsolid\n' >zones.stl
expect 5 "$boxtree" cook zones.stl -o zones.bxt --user-data zone
grep -q 'zones.stl: .*expected a PLY file, whose faces have properties, an OBJ file, which has groups, or a glTF file, which has primitives and extras' err
expect 0 "$boxtree" cook cube.obj -o cube.bxt --user-data groups -q
same "$(cat err)" "boxtree: warning: cube.obj: no line 'g' begins a group: the user data of every face is 0"
printf '[scene]\nsource = "zones.ply"\nuser_data = "zone"\n' >zones.toml
expect 0 "$boxtree" cook --profile zones.toml -o zones.bxt --why
grep -q "face_user_data .* 'zone' of the source; of each face; runs of the source's faces would take 16 bytes  <- zones.toml:3: user_data = \"zone\"" out
expect 0 "$boxtree" query zones.bxt ray --origin 0.8,0.2,5 --direction 0,0,-1 --json
same "$(jq -c '[.instance, .face, .user_data]' out)" '[0,0,300]'
expect 1 "$boxtree" cook --profile zones.toml -o zones.bxt --user-data zone

# Of a glTF file the number of each primitive, or an integer in the extras of what it is made of.
{
  printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"materials":[{"extras":{"zone":-1}}],"meshes":[{"name":"ground",'
  printf '"extras":{"zone":300},"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},"indices":1,"material":0}]}],"accessors":['
  printf '{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],"bufferViews":['
  printf '{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],"buffers":[{"byteLength":39,"uri":"data:application/octet-stream;base64,'
  { printf '\0%.0s' {1..14}; printf '\200\77'; printf '\0%.0s' {1..14}; printf '\200\77'; printf '\0%.0s' {1..4}; printf '\0\2\1'; } | base64 -w 0
  printf '"}]}'
} >ground.gltf
expect 0 "$boxtree" cook ground.gltf -o ground.bxt --user-data primitives
grep -qx '  primitives: 0 ground-0, 1 ground-1' out
expect 0 "$boxtree" query ground.bxt sphere --center 0.2,0.2,0 --radius 0.1 --json
same "$(jq -c '.faces | sort_by(.face)' out)" '[{"face":0,"user_data":0},{"face":1,"user_data":1}]'
expect 0 "$boxtree" cook ground.gltf -o ground.bxt --user-data zone
expect 0 "$boxtree" query ground.bxt sphere --center 0.2,0.2,0 --radius 0.1 --json
same "$(jq -c '.faces | sort_by(.face)' out)" '[{"face":0,"user_data":300},{"face":1,"user_data":4294967295}]'
expect 5 "$boxtree" cook ground.gltf -o ground.bxt --user-data zones
grep -q "ground.gltf: user data of faces 'zones': no primitive has it in its extras, nor has its material or mesh; integers of theirs are: zone, and 'primitives' numbers them; did you mean 'zone'?" err
expect 5 "$boxtree" cook groups.obj -o groups.bxt --user-data group
grep -q "an OBJ file has 'groups' alone; did you mean 'groups'?" err

# Help: common options, all options. Output to a file or a pipe shows no progress.
expect 0 "$boxtree" cook --help
grep -q -- '--codec' out
if grep -q -- '--depfile' out; then echo "--help shows rare options"; exit 1; fi
expect 0 "$boxtree" cook --help-all
grep -q -- '--depfile' out
for line in 'cook --help' 'cook --help-all' 'export --help' 'query --help' 'query pair --help' 'query pair --help-all' --help --help-all help; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" $line
  if grep -Pzq '\n\n\n' out; then echo "$line: two empty lines"; cat out; exit 1; fi
done
expect 0 "$boxtree" cook cube.obj -o cube.bxt
same "$(wc -c <err)" 0
echo "command line: all as expected"
