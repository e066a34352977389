#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Scenes on the command line: cooked from a node graph or a profile, queried in world coordinates.
set -euo pipefail
# shellcheck source=tests/cli/expect.sh
. "$(dirname "$0")/expect.sh"
boxtree=$1
level=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A file with several placed meshes is a scene by itself; --flatten makes one tree of it.
expect 0 "$boxtree" cook "$level/level.gltf" -o level.bxt --exact --json --depfile level.d
same "$(jq -c '[.scene.instances, .scene.moving, (.trees | length)]' out)" '[53,0,8]'
same "$(jq '[.why[] | select(.kept) | .bytes] | add' out)" "$(stat -c %s level.bxt)"
same "$(jq -c '[.why[] | select(.reason == "") | .part]' out)" '[]'
same "$(jq '.scene.file_bytes' out)" "$(stat -c %s level.bxt)"
grep -q 'level.gltf' level.d
expect 0 "$boxtree" verify level.bxt
grep -qE "^level.bxt: valid: [0-9]+ trees? and a scene, every triangle inside every box above it$" out
expect 0 "$boxtree" cook "$level/level.gltf" -o flat.bxt --flatten --exact --json
same "$(jq -c '[has("scene"), (.trees | length), .trees[0].triangles]' out)" '[false,1,9648]'
expect 0 "$boxtree" info level.bxt --json
same "$(jq -c '[.scene.instance_count, .scene.placed_triangles, (.scene.instances | length)]' out)" '[53,9648,53]'
same "$(jq -c '.scene.materials' out)" '["stone","grass","brick","wood","iron","glass"]'
expect 0 "$boxtree" info level.bxt
grep -q '^scene: 53 instances (0 moving), 9648 triangles placed' out
expect 0 "$boxtree" cook "$level/level.gltf" -o again.bxt --exact --jobs 1 --why
grep -q 'what a reader opens the file by' out
grep -A1 '^left out' out | grep -qx '  nothing'
cmp level.bxt again.bxt
# Each tree on a line, or with all its candidates.
same "$(grep -c '^  barrel ' out)" 1
same "$(grep -c 'not tried' out)" 0
expect 0 "$boxtree" cook "$level/level.gltf" -o again.bxt --exact --candidates
same "$(grep -c 'not tried, geometry grid' out)" 0
same "$(grep -cE ' wide8 +arrays ' out)" 8

# A step or bits that are stated are those of every mesh, however small beside the scene, so that their borders fit.
printf 'v %s\n' '-500 0 0' '0.3333252 0 0' '0.3333252 1 0' '-500 1 0' >big.obj
printf 'v %s\n' '0.3333252 0 0' '1.1 0 0' '1.1 1 0' '0.3333252 1 0' >small.obj
for mesh in big small; do echo 'f 1 2 3 4' >>$mesh.obj; done
for stated in '--grid-step 2^-10' '--grid-bits 12'; do
  # shellcheck disable=SC2086 # an option and its value
  expect 0 "$boxtree" cook --scene big.obj small.obj -o border.bxt $stated
  expect 0 "$boxtree" info border.bxt --json
  same "$(jq '[.trees[].grid_step] | unique | length' out)" 1
  for i in $(seq 0 40); do
    printf '{"kind":"ray","origin":[%s,0.5,1],"direction":[0,0,-1]}\n' "$(awk "BEGIN { print 0.3333252 + ($i - 20) / 20000 }")"
  done >border.jsonl
  expect 0 "$boxtree" query border.bxt --batch border.jsonl
  same "$(grep -c '"hit":true' out)" 41
done

# Layers by name: what another one has is not there.
printf '[scene]\n[[mesh]]\nname = "big"\nfile = "big.obj"\n[[mesh]]\nname = "small"\nfile = "small.obj"\n' >layers.toml
printf '[[instance]]\nname = "left"\nmesh = "big"\n[[instance]]\nname = "right"\nmesh = "small"\n' >>layers.toml
printf '[[object]]\nname = "ground"\nmatch = ["left"]\n[[object]]\nname = "props"\nmatch = ["right"]\n' >>layers.toml
expect 0 "$boxtree" cook --profile layers.toml -o layers.bxt -q
printf 'v -0.1 0.5 -1\nv 0.1 0.5 -1\nv 0 0.5 1\nf 1 2 3\n' >needle.obj
expect 0 "$boxtree" cook needle.obj -o needle.bxt -q
for query in 'ray --origin 0,0.5,9 --direction 0,0,-1' 'cast --sphere 0.1 --at 0,0.5,9 --direction 0,0,-1' 'collide --sphere 0.1 --at 0,0.5,0' \
  'box --min=-0.1,0.4,-1 --max=0.1,0.6,1' 'sphere --center 0,0.5,0 --radius 0.1' 'pair needle.bxt' \
  'frustum --matrix 10,0,0,0,0,1,0,-0.5,0,0,1,0.5,0,0,0,1'; do
  # shellcheck disable=SC2086 # a kind and its options
  for layers in '' '--layer ground' '--layer ground --layer props'; do
    expect 0 "$boxtree" query layers.bxt $layers $query --json
    jq -e '.hit == true or .count > 0' out >/dev/null
  done
  expect 0 "$boxtree" query layers.bxt --layer props $query --json
  jq -e '.hit == false or .count == 0' out >/dev/null
done
expect 0 "$boxtree" query layers.bxt --layer props point --at 0,0.5,0 --json
same "$(jq -c '[.name, (.distance * 1e7 | round)]' out)" '["right",3333252]'
expect 1 "$boxtree" query layers.bxt --layer prop point --at 0,0.5,0
same "$(cat err)" "boxtree: invalid_query: layers.bxt: --layer: no layer is called \"prop\"; did you mean 'props'?"
expect 1 "$boxtree" query layers.bxt --layer sea point --at 0,0.5,0
same "$(cat err)" 'boxtree: invalid_query: layers.bxt: --layer: no layer is called "sea"; expected ground or props'
expect 1 "$boxtree" query layers.bxt --layer props contacts --move right=0,0,0
grep -q '^boxtree: invalid_query: layers.bxt: contacts: --layer is for the other kinds' err
expect 1 "$boxtree" query layers.bxt --tree big --layer props point --at 0,0.5,0
grep -q '^boxtree: usage: query: --layer is for instances of a scene$' err

# One mesh is no scene, unless it is made one; its bytes are accounted for likewise.
expect 0 "$boxtree" cook "$level/../meshes/crate.obj" -o crate.bxt --why
grep -q 'what a reader opens the file by' out
grep -qE "^  sum +$(stat -c %s crate.bxt)\$" out
same "$(grep -c ' instances ' out)" 0
expect 0 "$boxtree" cook "$level/../meshes/crate.obj" -o crate.bxt --why --scene
grep -q 'what a reader opens the file by' out
grep -qE '^  instances ' out

# Answers in the world, with instance and material; those of the flattened tree are the same.
expect 0 "$boxtree" query level.bxt ray --origin 0,10,-3.3 --direction 0,-1,0 --json
same "$(jq -c '[.hit, .name, .material]' out)" '[true,"Step 2","stone"]'
t=$(jq .t out)
expect 0 "$boxtree" query flat.bxt ray --origin 0,10,-3.3 --direction 0,-1,0 --json
jq -e --argjson t "$t" '(.t - $t) | fabs < 1e-6' out >/dev/null
expect 0 "$boxtree" query level.bxt box --min=-1,0,-5 --max 1,1,-3 --json
count=$(jq .count out)
expect 0 "$boxtree" query flat.bxt box --min=-1,0,-5 --max 1,1,-3 --json
same "$(jq .count out)" "$count"
expect 0 "$boxtree" query level.bxt sphere --center 0,1,-4 --radius 0.5 --json
jq -e '.count > 0 and ([.faces[].name] | unique | all(startswith("Step")))' out >/dev/null
expect 0 "$boxtree" query level.bxt point --at 3,2,1 --json
same "$(jq -c '[.distance, .name]' out)" '[2,"Floor"]'

# Instances that are moved for a query; contacts of what moves with the rest.
expect 0 "$boxtree" query level.bxt contacts --move 'Crate=0.8,2.25,-7' --json
same "$(cat err; jq -c '[.hit, .count]' out)" '[false,0]'
expect 0 "$boxtree" query level.bxt contacts --json
same "$(cat err)" 'boxtree: warning: level.bxt: no instance moves, so that contacts has none to look at: use --move INSTANCE=POSE, or a profile with motion = "moving"'
same "$(jq -c '[.hit, .count]' out)" '[false,0]'
expect 0 "$boxtree" query level.bxt contacts --move 'Crate=0.8,2.1,-6.8' --json
jq -e '.hit and ([.pairs[][0].name] | unique == ["Crate"]) and ([.pairs[][1].name] | unique == ["Landing"])' out >/dev/null
expect 0 "$boxtree" query level.bxt contacts --move 'Crate=0.8,2.1,-6.8'
same "$(grep -c '^  \[{.*"name":"Crate".*},{.*"name":"Landing".*}\]$' out)" "$(sed -n 's/^count: //p' out)"
expect 0 "$boxtree" query level.bxt sphere --center 0,1,-4 --radius 0.5
same "$(grep -c '^  {.*"name":"Step ' out)" "$(sed -n 's/^count: //p' out)"
expect 0 "$boxtree" query level.bxt ray --origin 0.5,9,-4.5 --direction 0,-1,0 --move 'Crate=0.5,6,-4.5' --json
same "$(jq -c '.name' out)" '"Crate"'
jq -e '(.t - 2.6) | fabs < 1e-6' out >/dev/null
# A pose replaces the whole pose: three numbers have no rotation and no scale, twelve have them.
expect 0 "$boxtree" info level.bxt --json
barrel=$(jq -c '.scene.instances[] | select(.name == "Barrel 8") | .pose' out)
jq -e '.[1] == [0, .[1][1], 0, 0] and .[1][1] > 1.1' <<<"$barrel" >/dev/null # it is scaled
ray="--direction 0,-1,0 --origin $(jq -r '"\(.[0][3]),9,\(.[2][3])"' <<<"$barrel")"
# shellcheck disable=SC2086 # a list of words
expect 0 "$boxtree" query level.bxt ray $ray --json
cp out stays
rows=$(jq -r 'flatten | map(tostring) | join(",")' <<<"$barrel")
place=$(jq -r '"\(.[0][3]),\(.[1][3]),\(.[2][3])"' <<<"$barrel")
# shellcheck disable=SC2086
expect 0 "$boxtree" query level.bxt ray $ray --move "Barrel 8=$rows" --json
same "$(jq -c '[.name, .t]' out)" "$(jq -c '[.name, .t]' stays)"
# shellcheck disable=SC2086
expect 0 "$boxtree" query level.bxt ray $ray --move "Barrel 8=$place" --json
jq -e --argjson barrel "$barrel" --slurpfile stays stays \
  '(9 - .t) * $barrel[1][1] - (9 - $stays[0].t) | fabs < 1e-6' out >/dev/null
expect 0 "$boxtree" query --help
tr -s ' \n' ' ' <out | grep -q 'X,Y,Z is one without rotation and scale; 12 numbers, .*, keep them'
expect 1 "$boxtree" query level.bxt contacts --move 'Crate=up'
grep -q 'expected INSTANCE=X,Y,Z' err
expect 1 "$boxtree" query level.bxt contacts --move 'Crate=1,0,0,0,0,0,0,0,0,0,1,0'
grep -q 'invalid_pose: level.bxt: --move Crate: the pose is not invertible: it flattens what it places; expected ' err
expect 1 "$boxtree" query level.bxt pair level.bxt --tree2 crate --pose inf,0,0
grep -q "invalid_pose: level.bxt: pair: the second tree's pose is not finite: row 1, column 4 is inf; " err
expect 1 "$boxtree" query level.bxt contacts --move 'Nobody=0,0,0'
grep -q 'Nobody' err
expect 1 "$boxtree" query flat.bxt contacts
grep -q '^boxtree: no_scene: flat.bxt: ' err
expect 2 "$boxtree" query flat.bxt pair gone.bxt
grep -q '^boxtree: file_not_found: gone.bxt: ' err
expect 1 "$boxtree" query level.bxt overlap flat.bxt --within 0.1
grep -q -- '--tree' err

expect 1 "$boxtree" query level.bxt sphere --center 0,0,0 --radius=-1
grep -q 'invalid_query: level.bxt: sphere: radius: expected finite and 0 or more, found center \[0,0,0\], radius -1$' err

# A body that is no part of the scene.
fall='cast --sphere 0.25 --at 0.1,0.2,9 --direction 0,0,-1'
# Shapes in the scene, and all that a ray passes.
expect 0 "$boxtree" query level.bxt cast --sphere 0.25 --at 0,10,-3.3 --direction 0,-1,0 --json
same "$(jq -c '[.hit, .name, .id, .material, .feature]' out)" '[true,"Step 3",3,"stone","edge"]'
jq -e '(.t - 9.26) | fabs < 1e-6' out >/dev/null
expect 0 "$boxtree" query level.bxt cast --capsule 0,1,0,0.3 --at 0.8,10,-6.8 --direction 0,-1,0 --json
same "$(jq -c '[.name, .feature]' out)" '["Landing","face"]'
expect 0 "$boxtree" query level.bxt cast --box 0.5,0.5,0.5 --at 0.8,10,-6.8 --direction 0,-1,0 --t-max 9.4 --all --json
jq -e '.count > 0 and .count == (.hits | length) and .hits[0].name == "Landing" and ([.hits[].t_lower] | . == sort)' out >/dev/null
expect 0 "$boxtree" query level.bxt collide --sphere 0.5 --at 0,0.3,-3.3 --json
jq -e '.count > 0 and .contacts[0].name == "Floor" and .contacts[0].depth == 0.2 and .contacts[0].material == "stone"' out >/dev/null
count=$(jq .count out)
expect 0 "$boxtree" query level.bxt collide --sphere 0.5 --at 0,0.3,-3.3 --merge 0.01 --json
jq -e --argjson all "$count" '.count > 0 and .count < $all' out >/dev/null
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n' >hull.obj
expect 0 "$boxtree" query level.bxt cast --hull hull.obj --at 0,10,-3.3 --direction 0,-1,0 --json
jq -e '.hit and .t_lower <= .t and (.instance | type) == "number"' out >/dev/null
expect 0 "$boxtree" query level.bxt collide --hull hull.obj --at 0,-0.25,-3.3 --json
jq -e '.count > 0 and ([.contacts[] | .depth >= 0 and (.instance | type) == "number"] | all)' out >/dev/null
expect 0 "$boxtree" query level.bxt ray --origin 0,10,-3.3 --direction 0,-1,0 --all --back-faces only --json
same "$(jq -c '[.hits[] | [.name, .face]]' out)" '[["Step 2",5]]'
# What a camera sees: the faces in x from -1 to 1, y from 0 to 1, z from -5 to -3, as in a box, and their instances.
expect 0 "$boxtree" query level.bxt frustum --matrix 1,0,0,0,0,2,0,-1,0,0,0.5,2.5,0,0,0,1 --json
seen=$(jq -c '[.faces[] | [.instance, .face]] | sort' out)
expect 0 "$boxtree" query level.bxt box --min=-1,0,-5 --max 1,1,-3 --json
same "$(jq -c '[.faces[] | [.instance, .face]] | sort' out)" "$seen"
expect 0 "$boxtree" query level.bxt frustum --matrix 1,0,0,0,0,2,0,-1,0,0,0.5,2.5,0,0,0,1 --instances --json
jq -e --argjson seen "$seen" '.count == (.instances | length) and ([.instances[].instance] as $all | $seen | all(.[0] as $i | $all | index($i) != null))' out >/dev/null
# Where what moves touches: as many pairs of faces as without points.
expect 0 "$boxtree" query level.bxt contacts --move 'Crate=0.8,2.1,-6.8' --json
pairs=$(jq -c '[.pairs[] | [.[0].face, .[1].instance, .[1].face]] | sort' out)
expect 0 "$boxtree" query level.bxt contacts --move 'Crate=0.8,2.1,-6.8' --points --json
same "$(jq -c '[.contacts[].faces | [.[0].face, .[1].instance, .[1].face]] | unique' out)" "$pairs"
jq -e '[.contacts[] | .faces[0].name == "Crate" and .depth >= 0 and (.point | length) == 3] | all' out >/dev/null
expect 0 "$boxtree" query level.bxt pair level.bxt --tree2 crate --pose 0.8,2.1,-6.8 --contacts --json
jq -e '.hit and ([.contacts[] | .faces[0].instance != null and .faces[1].instance == null] | all)' out >/dev/null
printf '%s\n' '{"kind":"cast","sphere":0.25,"at":[0,10,-3.3],"direction":[0,-1,0]}' >batch
expect 0 "$boxtree" query level.bxt --batch batch
same "$(jq -c '.name' out)" '"Step 3"'
# One of its trees alone, in its own coordinates.
expect 0 "$boxtree" query level.bxt --tree crate $fall --json
same "$(jq -c '[.hit, .normal, .feature]' out)" '[true,[0,0,1],"face"]'
expect 0 "$boxtree" query level.bxt --tree crate point --at 0,2,0 --json
jq -e '(.distance - 1.6) | fabs < 1e-6' out >/dev/null
expect 0 "$boxtree" query level.bxt pair level.bxt --tree2 crate --pose 0,0.3,0 --json
jq -e '.hit and ([.pairs[][0].name] | unique == ["Floor"])' out >/dev/null
# How far a tree is from the scene, and from which instance; the same as from that one alone.
expect 0 "$boxtree" query level.bxt distance level.bxt --tree2 crate --pose 3,2,1 --json
jq -e '.found and .converged and (.lower - 1.6 | fabs < 1e-6) and (.upper - 1.6 | fabs < 1e-6)' out >/dev/null
same "$(jq -c '[.faces[0].name, .faces[1].instance, (.points[0][1] | fabs < 1e-6)]' out)" '["Floor",null,true]'
for within in '1.59 false' '1.61 true'; do
  expect 0 "$boxtree" query level.bxt distance level.bxt --tree2 crate --pose 3,2,1 --max-distance ${within% *} --json
  same "$(jq -c .found out)" "${within#* }"
done
expect 0 "$boxtree" query layers.bxt --layer props distance level.bxt --tree2 crate --pose 0,2,0 --json
same "$(jq -r '.faces[0].name' out)" right
# Found by a newcomer: a scene as the second file was its first tree, in its own coordinates, without a word.
expect 0 "$boxtree" cook --scene "$level/../meshes/crate.obj" -o one.bxt -q
second='the second of two is a tree, and this is a scene; name a tree of the file with --tree2, in a line of a batch with "tree"'
for file in level one; do
  for kind in pair distance overlap; do
    expect 1 "$boxtree" query flat.bxt $kind $file.bxt
    same "$(cat err)" "boxtree: invalid_query: $file.bxt: $second"
  done
done
expect 1 "$boxtree" query level.bxt pair one.bxt
same "$(cat err)" "boxtree: invalid_query: one.bxt: $second"
printf '%s\n' '{"file":"one.bxt"}' '{"file":"one.bxt","tree":0}' '{"file":"level.bxt","tree":"crate"}' >batch
expect 1 "$boxtree" query flat.bxt distance --batch batch
same "$(jq -sc 'map([.error, .found])' out)" '[["invalid_query",null],[null,true],[null,true]]'
same "$(jq -sr '.[0].detail' out)" "line 1: one.bxt: $second"
expect 0 "$boxtree" query flat.bxt pair one.bxt --tree2 crate
printf '%s\n' '{"kind":"ray","origin":[0,10,-3.3],"direction":[0,-1,0]}' '{"kind":"contacts"}' >batch
expect 0 "$boxtree" query level.bxt --batch batch
same "$(jq -sc '[.[0].name, .[1].hit]' out)" '["Step 2",false]'
same "$(grep -c 'no instance moves' err)" 1
# A line of a profile without effect is a warning, which --quiet keeps.
printf '[[object]]\nname = "rocks"\nmatch = ["Rock*"]\n' >rocks.toml
expect 0 "$boxtree" cook --profile rocks.toml "$level/level.gltf" -o rocks.bxt --quiet
same "$(cat err)" 'boxtree: warning: rocks.toml:3: match = ["Rock*"]: no instance is of object "rocks"'
# A line moves instances for itself alone, beside those of the command line: as --move does, and from where they are in the file.
printf '%s\n' '{"kind":"contacts","move":"Crate=0.8,2.1,-6.8"}' '{"kind":"contacts"}' \
  '{"kind":"contacts","first":true,"move":["Crate=0.8,2.1,-6.8","Step 2=0,50,0"]}' \
  '{"kind":"contacts","move":"Crat=1,2,3"}' '{"kind":"contacts","move":"Crate"}' >batch
expect 1 "$boxtree" query level.bxt --batch batch
same "$(jq -sc 'map(.hit)' out)" '[true,false,true,null,null]'
same "$(jq -sr '.[3:][].detail' out)" "line 4: --move: no instance is named \"Crat\"; did you mean 'Crate'?
line 5: --move: expected INSTANCE=X,Y,Z or INSTANCE= and 12 numbers, found \"Crate\""
jq -c 'select(.line == 1) | del(.line)' out >moved
expect 0 "$boxtree" query level.bxt contacts --move Crate=0.8,2.1,-6.8 --json
same "$(jq -c 'del(.schema)' out)" "$(cat moved)"
expect 1 "$boxtree" query level.bxt --move Crate=0.8,2.1,-6.8 --batch batch
same "$(jq -sc 'map(.hit)' out)" '[true,true,true,null,null]'
# Found by a newcomer: of two instances of one name the first moved without a word.
cat >doubles.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
 "nodes": [{"name": "two", "mesh": 0}, {"name": "two", "mesh": 0, "translation": [5, 0, 0]},
           {"name": "0", "mesh": 0, "translation": [9, 0, 0]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri":
   "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
END
expect 0 "$boxtree" cook doubles.gltf -o doubles.bxt -q
expect 0 "$boxtree" query doubles.bxt contacts --move two=0,0,7 --move 0=0,0,8
same "$(cat err)" 'boxtree: warning: doubles.bxt: --move two: 2 instances have this name; the first moves, number 0. --move NUMBER=POSE moves the instance of that number
boxtree: warning: doubles.bxt: --move 0: the instance of that name moves, number 2, and not number 0'
printf '%s\n' '{"kind":"contacts","move":"two=0,0,7"}' '{"kind":"contacts","move":"two=0,0,8"}' >batch
expect 0 "$boxtree" query doubles.bxt --batch batch
same "$(grep -c 'have this name' err)" 1
expect 0 "$boxtree" query doubles.bxt contacts --move 1=0,0,7
same "$(cat err)" ''

# A file for viewers: every instance where it is, and what is cooked from it is the same place.
expect 0 "$boxtree" export level.bxt -o shown.glb --json
same "$(jq -c '[.scene.instances, .scene.placed_triangles, ([.trees[].instances] | add)]' out)" '[53,9648,53]'
expect 0 "$boxtree" cook shown.glb -o shown.bxt --exact --json
same "$(jq -c '[.scene.instances, (.trees | length)]' out)" '[53,8]'
expect 0 "$boxtree" export level.bxt -o shown.obj --triangles
grep -q '^scene: 53 instances, 9648 triangles placed$' out
grep -q '^step: 12 triangles, 10 instances$' out
same "$(grep -c '^o ' shown.obj)" 53
grep -q '^o Step 2$' shown.obj
grep -q '^g Step_2_triangles$' shown.obj
expect 0 "$boxtree" cook shown.obj -o shown-flat.bxt --exact --json
same "$(jq -c '.trees[0].triangles' out)" 9648
for file in level shown; do
  expect 0 "$boxtree" info $file.bxt --json
  jq -c '[.scene.instances | sort_by(.id)[] | [.name, .tree]]' out >$file.names
  expect 0 "$boxtree" query $file.bxt ray --origin 0,10,-3.3 --direction 0,-1,0 --json
  same "$(jq -c .name out)" '"Step 2"'
done
cmp level.names shown.names
for query in 'ray --origin 5,10,-3.3 --direction 0.1,-1,0' 'point --at 3,2,1' 'point --at=-7,1.5,4'; do
  for file in level shown flat shown-flat; do
    # shellcheck disable=SC2086
    expect 0 "$boxtree" query $file.bxt $query --json
    jq '.t // .distance' out
  done | jq -se 'max - min < 1e-6' >/dev/null
done
# Trees by themselves, as they are stored.
for trees in --trees '--tree crate'; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" export level.bxt -o trees.glb --triangles $trees --json
  same "$(jq -c '[.scene, ([.trees[].instances] | unique)]' out)" '[null,[null]]'
done
same "$(jq -c '[.trees[].name]' out)" '["crate"]'
# External geometry is found in the source, mesh by mesh.
printf '[scene]\nsource = "level.gltf"\nexternal = true\n' >external.toml
cp "$level/level.gltf" .
expect 0 "$boxtree" cook --profile external.toml -o external.bxt --quiet
expect 1 "$boxtree" export external.bxt -o external.obj
grep -q 'external_mesh_needed' err
expect 0 "$boxtree" export external.bxt -o boxes.glb --boxes
expect 0 "$boxtree" export external.bxt -o external.obj --triangles --mesh level.gltf
expect 0 "$boxtree" cook shown.obj -o whole.bxt --external --quiet
expect 0 "$boxtree" verify whole.bxt --mesh external.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >other.obj
expect 3 "$boxtree" export external.bxt -o external.obj --mesh other.obj
grep -q 'tree 0: expected 1152 faces' err

# The profile: what it names decides, what it says wrong is told by its line, and options that
# would contradict it are refused.
cp "$level/level.gltf" "$level/scene.toml" .
expect 0 "$boxtree" cook --profile scene.toml -o profiled.bxt --json --depfile profiled.d
same "$(jq -c '[.scene.instances, .scene.moving]' out)" '[53,1]'
same "$(jq '[.why[] | select(.kept) | .bytes] | add' out)" "$(stat -c %s profiled.bxt)"
jq -e '[.why[] | select(.kept | not) | .line // ""] | any(contains("scene.toml:")) ' out >/dev/null
jq -e '.trees | all(.left_out | any(.what == "face ids"))' out >/dev/null
grep -q 'scene.toml' profiled.d
grep -q 'level.gltf' profiled.d
expect 0 "$boxtree" verify profiled.bxt
# On grids and without face ids it is shown in the order requested.
for name in profiled.obj profiled.glb; do
  expect 0 "$boxtree" export profiled.bxt -o "$name"
  grep -q '^scene: 53 instances, 9648 triangles placed$' out
  expect 0 "$boxtree" cook "$name" -o again.bxt --exact --flatten --quiet
  for file in profiled again; do
    expect 0 "$boxtree" query $file.bxt ray --origin 5,10,-3.3 --direction 0.1,-1,0 --json
    jq .t out
  done | jq -se 'max - min < 1e-6' >/dev/null
done
expect 5 "$boxtree" query profiled.bxt point --at 0,0,0
grep -q 'part_left_out: .* left out by scene.toml:[0-9]*: queries' err # the line that did it
expect 0 "$boxtree" info profiled.bxt
grep -q 'left out: point queries, by scene.toml:[0-9]*: queries' out
# Found by a newcomer: what moves answers rays alone, and contacts said "hit: false" and nothing else.
printf '[scene]\nsource = "level.gltf"\n[[object]]\nname = "seen"\nmatch = ["Crate"]\nqueries = ["ray"]\n' >seen.toml
expect 0 "$boxtree" cook --profile seen.toml -o seen.bxt -q
no_pairs='boxtree: warning: seen.bxt: no instance that moves is in a layer that answers pairs, so that contacts has none to look at: its object of the profile needs "pair" among its queries'
expect 0 "$boxtree" query seen.bxt contacts --move Crate=0.8,2.1,-6.8
same "$(cat err)" "$no_pairs"
printf '%s\n' '{"kind":"contacts","move":"Crate=0.8,2.1,-6.8"}' '{"kind":"contacts","move":"Crate=0.8,2.1,-6.8"}' >batch
expect 0 "$boxtree" query seen.bxt --batch batch
same "$(cat err)" "$no_pairs"
expect 0 "$boxtree" query seen.bxt contacts --move Landing=0.8,2.1,-6.8
same "$(wc -c <err)" 0
# A tree that is queried by itself, or is the second one, lacks what the profile left out of its scene or its objects.
cat >parts.toml <<'TOML'
[scene]
source = "level.gltf"
queries = ["ray", "box"]
[[object]]
name = "gone"
match = ["Barrel 8"]
leave_out = true
[[object]]
name = "targets"
match = ["Crate"]
queries = ["ray"]
TOML
expect 0 "$boxtree" cook --profile parts.toml -o parts.bxt -q
says() {
  local status=$1 said=$2
  shift 2
  expect "$status" "$boxtree" query "$@"
  same "$(head -1 err)" "boxtree: $said"
}
by='were left out by parts.toml:3: queries = ["ray", "box"]'
says 5 "part_left_out: parts.bxt: the scene: point queries $by" parts.bxt --tree barrel point --at 0,0,0
says 5 "part_left_out: parts.bxt: the scene: pair queries $by" parts.bxt --tree barrel pair flat.bxt
says 5 "part_left_out: parts.bxt: the scene: pair queries $by" flat.bxt distance parts.bxt --tree2 barrel
says 5 'part_left_out: parts.bxt: tree "crate": box queries were left out for the objects that place it, targets: by "queries" of its profile' \
  parts.bxt --tree crate box --min 0,0,0 --max 1,1,1
expect 0 "$boxtree" query parts.bxt --tree crate ray --origin 0,0,4 --direction 0,0,-1
expect 0 "$boxtree" query parts.bxt --tree barrel box --min 0,0,0 --max 1,1,1
echo '{"kind":"point","at":[0,0,0]}' >batch
expect 5 "$boxtree" query parts.bxt --tree crate --batch batch
same "$(jq -r .error out)" part_left_out
# So does an instance that is moved.
ray='ray --origin 0,10,0 --direction 0,-1,0'
# shellcheck disable=SC2086
says 1 'instance_index: parts.bxt: --move: no instance is named "Barrel 8", and 1 or more instances of the source were '\
"left out of the file; did you mean 'Barrel 7'?" parts.bxt $ray --move 'Barrel 8=0,0,0'
# shellcheck disable=SC2086
says 1 'instance_index: level.bxt: --move: no instance is named "Crata"; did you mean '"'Crate'?" level.bxt $ray --move Crata=0,0,0
# shellcheck disable=SC2086
says 1 'instance_index: parts.bxt: --move 52: expected a number from 0 to 51' parts.bxt $ray --move 52=0,0,0
# The last instance of the source leaves no gap, so the file does not show that a profile left it out.
# Found by a newcomer: the transform of a profile was named without its line, with an option that profiles exclude.
printf '%s\n' '[[mesh]]' 'name = "m"' 'file = "big.obj"' '[[instance]]' 'mesh = "m"' 'translation = [1e100, 0, 0]' >far.toml
expect 1 "$boxtree" cook --profile far.toml -o far.bxt -q
grep -qx "boxtree: invalid_pose: far.toml:4: instance 0 '.*': its transform leads too far away: coordinates may be 2^185 mesh extents" err
printf '[scene]\nsource = "level.gltf"\n[[object]]\nname = "crate"\nmatch = ["Crate"]\nleave_out = true\n' >crateless.toml
expect 0 "$boxtree" cook --profile crateless.toml -o crateless.bxt --why
grep -q 'object crate .*crateless.toml:6: leave_out = true' out
# shellcheck disable=SC2086
says 1 'instance_index: crateless.bxt: --move: no instance is named "Crate"; info --json lists the 52 names' crateless.bxt $ray --move Crate=0,0,0
# Few names are listed, and a profile is named where it left something out.
expect 0 "$boxtree" cook --scene big.obj small.obj -o border.bxt
# shellcheck disable=SC2086
says 1 'instance_index: border.bxt: --move: no instance is named "Crate"; expected big or small' border.bxt $ray --move Crate=0,0,0
# shellcheck disable=SC2086
says 1 'instance_index: parts.bxt: --move: no instance is named "Zeppelin", and 1 or more instances of the source were '\
'left out of the file; info --json lists the 52 names; if the source has it, the profile left it out, by leave_out or queries = []: '\
'cook --why says which line' parts.bxt $ray --move Zeppelin=0,0,0
expect 0 "$boxtree" info parts.bxt --json
same "$(jq .scene.instances_left_out out)" 1
expect 0 "$boxtree" info parts.bxt
grep -q '^  left out: 1 or more instances of the source, whose ids are not there$' out
expect 0 "$boxtree" info level.bxt
[ "$(grep -c 'or more instances' out)" = 0 ]
sed '3s/.*/names = false/' parts.toml >unnamed.toml
expect 0 "$boxtree" cook --profile unnamed.toml -o unnamed.bxt -q
# shellcheck disable=SC2086
says 5 'part_left_out: unnamed.bxt: --move Crate: the scene: names were left out by unnamed.toml:3: names = false; '\
'give the number of the instance' unnamed.bxt $ray --move Crate=0,0,0
# shellcheck disable=SC2086
says 1 'tree_index: unnamed.bxt: no tree is called "crate": trees have no names in this file; expected a number from 0 to 7' \
  unnamed.bxt --tree crate $ray
# Names that are left out are counted once.
sed 's/^face_ids = false.*/names = false/' scene.toml >nameless.toml
expect 0 "$boxtree" cook --profile nameless.toml -o nameless.bxt --json
same "$(jq -c '[.why[] | select(.part == "names" and (.kept | not) and .owner == "file")]' out)" '[]'
same "$(jq '[.why[] | select(.part == "names" and (.kept | not) and (.owner | startswith("object"))) | .bytes] | add' out)" \
  "$("$boxtree" info level.bxt --json | jq '[.scene.instances[].name | utf8bytelength] | add')"
expect 1 "$boxtree" cook --profile scene.toml --codec wide8 -o x.bxt
sed 's/^tolerance = .*/tolerence = 1/' scene.toml >wrong.toml
expect 3 "$boxtree" cook --profile wrong.toml -o x.bxt
grep -Eq 'wrong.toml:[0-9]+: .*tolerance' err
expect 1 "$boxtree" cook -o x.bxt
[ ! -e x.bxt ]
: >empty.toml
expect 3 "$boxtree" cook --profile empty.toml -o x.bxt
same "$(cat err)" 'boxtree: profile_invalid: empty.toml: names nothing to cook; give MESH in the command, or "source" '\
'or [[instance]] in a profile'

# A node that is scaled to nothing has no pose to be queried in; flattened it is a flat surface.
# Found by a newcomer: it was a fault of the command line.
jq '(.nodes[] | select(.name == "Crate")).scale = [1, 0, 1]' level.gltf >squashed.gltf
expect 3 "$boxtree" cook squashed.gltf -o x.bxt
grep -q 'Crate.*--flatten' err
expect 0 "$boxtree" cook squashed.gltf -o squashed.bxt --flatten --quiet
expect 0 "$boxtree" verify squashed.bxt

# The same bytes from another folder and with one thread.
mkdir other
cp level.gltf scene.toml other/
expect 0 "$boxtree" cook --profile other/scene.toml -o other.bxt --jobs 1 --quiet
cmp profiled.bxt other.bxt
