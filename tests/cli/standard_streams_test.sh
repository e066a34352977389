#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# "-" for standard input and output, --quiet and --jobs, names of trees, whether a mesh is closed.
set -euo pipefail
# shellcheck source=tests/cli/expect.sh
. "$(dirname "$0")/expect.sh"
boxtree=$1 meshes=$2/samples/meshes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir tmp
export TMPDIR=$work/tmp # where scratch files would be seen
none=$work/none # a folder that is not there

# A pipe from mesh to answer gives what named files give, and the bytes are the same.
cp "$meshes/crate.obj" "$meshes/crate.mtl" .
expect 0 "$boxtree" cook crate.obj -o crate.bxt --strip
mv out said
"$boxtree" cook crate.obj -o - --strip >piped.bxt 2>err
cmp crate.bxt piped.bxt
# What is said of a file that is standard output is on standard error, unless it is not wanted.
told() { sed -E 's/(wrote )?(crate.bxt|named.glb|standard output)/NAME/; s/in [0-9.]+ s;/in S;/' "$1"; }
same "$(told err)" "$(told said)"
grep -q '^wrote standard output, [0-9]* bytes, in ' err
# Found by a newcomer: the name of a pipe in /proc was told, where none can be created.
status=0
said=$("$boxtree" cook crate.obj -o /dev/stdout 2>&1 | cat) || status=$?
same "$status,$said" '2,boxtree: write_failed: /dev/stdout: exists and is not a regular file'
"$boxtree" cook crate.obj -o - --strip -q >piped.bxt 2>err
cmp crate.bxt piped.bxt
same "$(wc -c <err)" 0
"$boxtree" cook crate.obj -o - --strip 2>/dev/full >piped.bxt
cmp crate.bxt piped.bxt
# Found by a newcomer: a stream that is closed left its number to the next file, so that messages were written into cooked
# files and their caches, and what was to go to standard output was lost without an error.
for job in 1 2 3 4 5 6 7 8; do
  printf '{"output":"closed-%s.bxt","inputs":["crate.obj"],"options":["--strip"]}\n' "$job" >>closed.jsonl
  printf '{"output":"missing-%s.bxt","inputs":["nowhere.obj"]}\n' "$job" >>closed.jsonl
done
status=0
"$boxtree" cook --manifest closed.jsonl --cache closed-cache --journal closed.done --json <&- >&- 2>&- || status=$?
same "$status" 2
for job in 1 2 3 4 5 6 7 8; do cmp crate.bxt "closed-$job.bxt"; done
if grep -v '^{' closed.done; then echo "messages in a journal" >&2; exit 1; fi
for command in "cook crate.obj -o -" "export crate.bxt -o -" "info crate.bxt"; do
  status=0
  # shellcheck disable=SC2086 # a list of words
  "$boxtree" $command >&- 2>err || status=$?
  same "$status,$(sed 's/cannot be written: //' err)" '2,boxtree: write_failed: standard output: Bad file descriptor'
done
status=0
"$boxtree" info - <&- 2>err || status=$?
same "$status,$(cat err)" '2,boxtree: file_unreadable: standard input: Bad file descriptor'
for query in "ray --origin 0,0,9 --direction 0,0,-1" "point --at 3,0,0"; do
  # shellcheck disable=SC2086 # a list of words
  "$boxtree" cook - --format obj -o - <crate.obj | "$boxtree" query - $query --json >piped
  # shellcheck disable=SC2086
  "$boxtree" query crate.bxt $query --json >named
  cmp piped named
done
"$boxtree" info - --json <crate.bxt >piped
"$boxtree" info crate.bxt --json >named
cmp piped named
"$boxtree" verify - <crate.bxt >out
grep -q '^standard input: valid: 1 tree' out
"$boxtree" cook crate.obj -o crate.blob --codec blob-zstd -q
"$boxtree" verify - <crate.blob >out
"$boxtree" query - pair - --pose 0.5,0,0 --json <crate.bxt >out # read once, used twice
same "$(jq -r .hit out)" true
for format in obj glb; do
  "$boxtree" export crate.bxt -o "named.$format" -q >out
  same "$(wc -c <out)" 0
  "$boxtree" export - -o - --format "$format" <crate.bxt >piped
  cmp piped "named.$format"
done
"$boxtree" export crate.bxt -o named.glb >said
"$boxtree" export crate.bxt -o - >piped 2>err # glb unless told otherwise
cmp piped named.glb
same "$(told err)" "$(told said)"
"$boxtree" export crate.bxt -o - -q >piped 2>err
same "$(wc -c <err)" 0
TMPDIR=$none "$boxtree" report crate.obj -o - --quick --quiet >page.html
TMPDIR=$none "$boxtree" report --paper crate.obj -o paper.html --quick --quiet
head -1 page.html | grep -q DOCTYPE
tail -1 page.html | grep -q '</html>'
"$boxtree" report crate.obj --csv - --quick --no-times >out
head -1 out | grep -q ','
same "$(ls tmp)" ""

# Neither standard stream needs a folder for temporary files: what is said of a cook is true, it reads no environment.
for codec in auto blob-zstd; do
  "$boxtree" cook crate.obj -o crate.blob --codec $codec -q --strip
  TMPDIR=$none "$boxtree" cook crate.obj -o - --codec $codec --strip -q >piped.bxt
  cmp crate.blob piped.bxt
done
TMPDIR=$none "$boxtree" cook - --format obj -o - --strip -q <crate.obj >piped.bxt
TMPDIR=$none "$boxtree" export crate.bxt -o - -q >piped
cmp piped named.glb
# Other formats and scenes, too, with the same hash of the source in the cook record as from a file.
"$boxtree" export crate.bxt -o stdin.glb --triangles -q
mkdir files
for format in obj ply off stl glb; do
  case $format in
  obj) cp crate.obj stdin.obj ;; # without its library
  ply) printf 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >stdin.ply ;;
  off) printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >stdin.off ;;
  stl) printf 'solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n' >stdin.stl ;;
  esac
  mv stdin.$format files
  for options in "" "--trusted --exact" "--scene"; do
    # shellcheck disable=SC2086 # a list of words
    "$boxtree" cook files/stdin.$format -o named.bxt -q $options
    # shellcheck disable=SC2086
    TMPDIR=$none "$boxtree" cook - --format $format -o piped.bxt -q $options <files/stdin.$format
    cmp named.bxt piped.bxt
  done
done
for format in stl OBJ; do # of meshes beside it, each is read by its name
  "$boxtree" cook files/stdin.off - --format $format -o two.bxt -q <files/stdin.${format,,}
  "$boxtree" verify two.bxt -q
done

# A cook that is ended leaves nothing, whether by a signal, any signal, or because nobody reads on.
awk 'BEGIN { for (y = 0; y <= 400; ++y) for (x = 0; x <= 400; ++x) print "v", x, y, x * y % 7
  for (y = 0; y < 400; ++y) for (x = 1; x <= 400; ++x) { a = 401 * y + x; print "f", a, a + 1, a + 402 "\nf", a, a + 402, a + 401 } }' >many.obj
mkfifo mesh # once all of it is taken, the cook has begun
for signal in HUP INT TERM KILL; do # background jobs of scripts ignore INT
  env --default-signal=$([ $signal = KILL ] || echo $signal) "$boxtree" cook - --format obj -o - --try-all -q <mesh >piped.bxt &
  cat many.obj >mesh
  kill -s $signal $!
  got=0
  wait $! 2>/dev/null || got=$?
  same "$(kill -l "$got")" $signal
  same "$(ls tmp)" ""
  same "$(wc -c <piped.bxt)" 0
done
env --ignore-signal=TERM "$boxtree" cook - --format obj -o ignored.bxt -q <mesh & # as by nohup
cat many.obj >mesh
kill -s TERM $!
wait $!
expect 0 "$boxtree" verify ignored.bxt -q
(set +o pipefail; "$boxtree" cook many.obj -o - -q | head -c 1 >piped.bxt)
same "$(ls tmp)" ""

# What cannot be is refused, by its name.
expect 1 "$boxtree" cook - -o out.bxt
grep -q -- '--format' err
expect 1 "$boxtree" cook crate.obj --format obj -o out.bxt
expect 1 "$boxtree" cook - --format ../obj -o out.bxt
# An ending that nobody reads is refused, although assimp would find a reader by the first bytes.
expect 1 "$boxtree" cook - --format xyz -o out.bxt <crate.obj
grep -q 'expected the ending of a mesh file, as obj, found "xyz"' err
expect 1 "$boxtree" cook - --format objj -o out.bxt <crate.obj
grep -q "did you mean 'obj'?" err
expect 1 "$boxtree" cook crate.obj --format ply -o out.bxt
grep -q 'a file is read by the ending of its name' err
# What is beside a file is beside nothing on standard input.
mkdir -p beside
printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"three.bin"}]}' >beside/three.gltf
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0' >beside/three.bin
expect 0 "$boxtree" cook beside/three.gltf -o out.bxt
rm out.bxt
for option in -q --trusted; do
  (cd beside && expect 3 "$boxtree" cook - --format gltf -o ../out.bxt $option <three.gltf)
  grep -q 'import_failed: standard input: it refers to three.bin, which .*: name it, or .* \.glb$' beside/err
done
expect 1 "$boxtree" cook - - --format obj -o out.bxt
expect 1 "$boxtree" cook crate.obj -o - --json
expect 1 "$boxtree" cook crate.obj -o - --depfile d
expect 1 "$boxtree" export crate.bxt -o x.glb --format glb
expect 1 "$boxtree" report crate.obj -o - --json --quick --no-times
expect 1 "$boxtree" query - --batch - <crate.bxt
grep -q 'the file or the batch, not both' err
expect 0 "$boxtree" cook - --format obj -o out.bxt <crate.obj
same "$(cat err)" 'boxtree: warning: standard input: crate.mtl is not there: no file of that name can be read. Faces and the names of their materials are complete without it'
rm out.bxt
printf 'f 1 2 3\n' | expect 3 "$boxtree" cook - --format obj -o out.bxt
grep -q 'mesh_index_out_of_range: standard input: face 0: ' err
if grep -q 'stdin.obj' err; then echo "a file that is not there is named: $(cat err)"; exit 1; fi
expect 3 "$boxtree" cook - --format obj -o out.bxt </dev/null
grep -q 'import_failed: standard input: the file is empty' err
expect 3 "$boxtree" cook - --format fbx -o out.bxt <crate.obj
grep -q 'import_failed: standard input: ' err
printf 'x' | expect 3 "$boxtree" info -
grep -q 'bad_magic: standard input: the first 1 bytes are not a .bxt magic; a mesh has to be cooked first' err
head -c 8 crate.bxt | expect 3 "$boxtree" info -
grep -q 'truncated: standard input: the file has 8 bytes, a header alone has 32' err
expect 2 script -qec "'$boxtree' info -" /dev/null </dev/null
test ! -e out.bxt
cp crate.bxt ./- # a file of that name
expect 0 "$boxtree" verify ./-
same "$(ls tmp)" ""

# As many threads as are allowed make the same bytes.
expect 0 "$boxtree" cook crate.obj -o one.bxt -j 1 -q --strip
same "$(wc -c <out)" 0
cmp one.bxt crate.bxt
expect 0 "$boxtree" verify one.bxt -j 1 -q
same "$(wc -c <out)" 0

# A tree that is called by a number is found by its name; others by their numbers.
cp crate.obj 1.obj
cp "$meshes/level.obj" 0.obj
expect 0 "$boxtree" cook 1.obj 0.obj -o numbers.bxt -q --json
same "$(cat err)" 'boxtree: warning: tree 0: --tree 0 takes the tree of that name, number 1; --tree 1 takes tree number 0, and "tree": 0 does in a line of a batch; 1 other number is a name, too'
same "boxtree: warning: $(jq -r '.warnings[]' out)" "$(cat err)"
for tree in 0:4 1:0.5; do
  expect 0 "$boxtree" query numbers.bxt --tree "${tree%:*}" point --at 9,0,0 --json
  same "$(jq -r '.point[0]' out)" "${tree#*:}"
done
# Found by a newcomer: a number in JSON was taken for the name, and "--tree NUMBER any" was not true.
printf '{"kind":"distance","file":"numbers.bxt","tree":%s,"pose":[40,0,0]}\n' 0 1 '"0"' '"1"' >numbers.jsonl
expect 0 "$boxtree" query crate.bxt --batch numbers.jsonl
same "$(jq -s 'map(.lower) | .[0] == .[3] and .[1] == .[2] and .[0] > .[1]' out)" true
mkdir -p again && cp crate.obj crate.mtl again/ && cp crate.obj 2.obj
expect 0 "$boxtree" cook crate.obj again/crate.obj 0.obj -o shared.bxt -q
same "$(cat err)" 'boxtree: warning: tree 0: --tree 0 takes the tree of that name, number 2; --tree crate takes tree number 0, and "tree": 0 does in a line of a batch
boxtree: warning: tree crate: 2 trees of the file have this name; --tree crate and find_tree() take the first, --tree NUMBER those whose number is no name of another'
expect 0 "$boxtree" cook crate.obj 0.obj 2.obj -o own.bxt -q
same "$(head -1 err)" 'boxtree: warning: tree 0: --tree 0 takes the tree of that name, number 1; --tree crate takes tree number 0, and "tree": 0 does in a line of a batch'
same "$(wc -l <err)" 1
expect 0 "$boxtree" query numbers.bxt point --at 9,0,0 --json # the first
same "$(jq -r '.point[0]' out)" 0.5
expect 0 "$boxtree" cook crate.obj 0.obj -o names.bxt -q
expect 0 "$boxtree" query names.bxt --tree 1 point --at 9,0,0 --json
same "$(jq -r '.point[0]' out)" 4
expect 1 "$boxtree" query names.bxt --tree crat point --at 9,0,0
grep -q "no tree is called \"crat\"; did you mean 'crate'?" err

# Whether a mesh is closed, as it was imported and as it is stored.
expect 0 "$boxtree" cook crate.obj -o crate.bxt
grep -q '^crate: 12 triangles, closed$' out
expect 0 "$boxtree" info crate.bxt
grep -q '^  surface: closed$' out
sed '$d' crate.obj >open.obj
expect 0 "$boxtree" cook open.obj -o open.bxt
grep -qE '^open: [0-9]+ triangles, [34] open edges$' out
expect 0 "$boxtree" info open.bxt --json
same "$(jq -c '.trees[0].surface | [.closed, .non_manifold_edges, .inconsistent_edges]' out)" '[false,0,0]'
expect 0 "$boxtree" cook open.obj -o open.bxt --external
expect 0 "$boxtree" info open.bxt
grep -q '^  surface: not in the file$' out
expect 0 "$boxtree" cook open.obj -o open.bxt --grid-bits 12
expect 0 "$boxtree" info open.bxt
grep -qE '^  surface on the grid: [34] open edges$' out

# A material library that is not there is a warning, and nothing else changes. So is a file that seems to be cut short.
# --quiet and --json keep warnings.
sed 's/crate.mtl/gone.mtl/' crate.obj >no_library.obj
head -c -1 open.obj >cut.obj
for option in '' --quiet --json; do
  # shellcheck disable=SC2086
  expect 0 "$boxtree" cook no_library.obj -o no_library.bxt $option
  same "$(cat err)" 'boxtree: warning: no_library.obj: gone.mtl is not there: no file of that name can be read. Faces and the names of their materials are complete without it'
  # shellcheck disable=SC2086
  expect 0 "$boxtree" cook cut.obj cut.obj open.obj -o cut.bxt $option
  same "$(cat err)" 'boxtree: warning: cut.obj: the last line has no end, as if the file was cut short
boxtree: warning: tree cut: 2 trees of the file have this name; --tree cut and find_tree() take the first, --tree NUMBER any'
done
# Or an error, if the build wants it: an engine whose actions see declared files alone, say.
expect 2 "$boxtree" cook no_library.obj -o required.bxt --require-files
same "$(cat err)" 'boxtree: file_not_found: gone.mtl, which a mesh names and --require-files wants, is not there'
[ ! -e required.bxt ]
expect 0 "$boxtree" cook crate.obj -o required.bxt --require-files
# What is left of a face counts as no line.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2' >half.obj
expect 0 "$boxtree" cook half.obj -o half.bxt
same "$(cat err)" 'boxtree: warning: half.obj: the last line has no end and is half a face, which is left out, as if the file was cut short'
same "$(grep -c skipped out)" 0
expect 0 "$boxtree" report cut.obj --quick --no-times --quiet -o cut.html
same "$(cat err)" 'boxtree: warning: cut.obj: the last line has no end, as if the file was cut short'
expect 1 "$boxtree" cook crate.obj -o out.bxt --depfile -

# A cook of one mesh prints six lines of 100 columns at most, whatever there is to say.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.3 0.7 0\np 1\nl 1 2\nf 1 2 3\nf 1 1 2\nf 1 2 3' >notes.obj
expect 0 "$boxtree" cook notes.obj -o notes.bxt --grid-bits 10
[ "$(wc -l <out)" -le 6 ] || { cat out; exit 1; }
same "$(awk 'length > 100' out)" ""
grep -q 'skipped 1 point and 1 line; kept 1 face without area$' out
grep -qE '^  slowdown [0-9.]+ \(time over that of wide8 with arrays, mean over the kinds of queries\); [0-9]+ tried$' out
expect 0 "$boxtree" cook --help
head -3 out | grep -q '24 bits'
echo "standard streams: all as expected"
