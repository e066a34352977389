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
export TMPDIR=$work/tmp # where scratch files are to be seen

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
"$boxtree" cook crate.obj -o - --strip -q >piped.bxt 2>err
cmp crate.bxt piped.bxt
same "$(wc -c <err)" 0
"$boxtree" cook crate.obj -o - --strip 2>/dev/full >piped.bxt
cmp crate.bxt piped.bxt
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
grep -q '^-: valid: 1 tree' out
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
"$boxtree" report crate.obj -o - --quick --no-times --quiet >page.html
head -1 page.html | grep -q DOCTYPE
tail -1 page.html | grep -q '</html>'
"$boxtree" report crate.obj --csv - --quick --no-times >out
head -1 out | grep -q ','
same "$(ls tmp)" ""

# A cook that is ended leaves nothing, whether by a signal or because nobody reads on.
awk 'BEGIN { for (y = 0; y <= 400; ++y) for (x = 0; x <= 400; ++x) print "v", x, y, x * y % 7
  for (y = 0; y < 400; ++y) for (x = 1; x <= 400; ++x) { a = 401 * y + x; print "f", a, a + 1, a + 402 "\nf", a, a + 402, a + 401 } }' >many.obj
for signal in HUP INT TERM; do # background jobs of scripts ignore INT
  env --default-signal=$signal "$boxtree" cook - --format obj -o - --try-all -q <many.obj >piped.bxt &
  while [ -z "$(ls tmp)" ]; do kill -0 $!; sleep 0.01; done
  kill -s $signal $!
  got=0
  wait $! || got=$?
  same "$(kill -l "$got")" $signal
  same "$(ls tmp)" ""
done
env --ignore-signal=TERM "$boxtree" cook - --format obj -o ignored.bxt -q <many.obj & # as by nohup
while [ -z "$(ls tmp)" ]; do kill -0 $!; sleep 0.01; done
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
expect 1 "$boxtree" cook - - --format obj -o out.bxt
expect 1 "$boxtree" cook crate.obj -o - --json
expect 1 "$boxtree" cook crate.obj -o - --depfile d
expect 1 "$boxtree" export crate.bxt -o x.glb --format glb
expect 1 "$boxtree" report crate.obj -o - --json --quick --no-times
expect 1 "$boxtree" query - --batch - <crate.bxt
grep -q 'the file or the batch, not both' err
expect 0 "$boxtree" cook - --format obj -o out.bxt <crate.obj
grep -q '^  crate.mtl is not there' out
rm out.bxt
printf 'f 1 2 3\n' | expect 3 "$boxtree" cook - --format obj -o out.bxt
grep -q 'stdin.obj' err
if grep -q tmp/ err; then echo "a scratch name is shown: $(cat err)"; exit 1; fi
printf 'x' | expect 3 "$boxtree" info -
grep -q 'bad_magic: standard input: the first 1 bytes are not a .bxt magic' err
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
expect 0 "$boxtree" cook 1.obj 0.obj -o numbers.bxt -q
for tree in 0:4 1:0.5; do
  expect 0 "$boxtree" query numbers.bxt --tree "${tree%:*}" point --at 9,0,0 --json
  same "$(jq -r '.point[0]' out)" "${tree#*:}"
done
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

# A material library that is not there is said, and nothing else changes.
sed 's/crate.mtl/gone.mtl/' crate.obj >no_library.obj
expect 0 "$boxtree" cook no_library.obj -o no_library.bxt
grep -q 'gone.mtl is not there' out
expect 1 "$boxtree" cook crate.obj -o out.bxt --depfile -

# A cook of one mesh prints six lines of 100 columns at most, whatever there is to say.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.3 0.7 0\np 1\nl 1 2\nf 1 2 3\nf 1 1 2\nf 1 2 3' >notes.obj
expect 0 "$boxtree" cook notes.obj -o notes.bxt --grid-bits 10
[ "$(wc -l <out)" -le 6 ] || { cat out; exit 1; }
same "$(awk 'length > 100' out)" ""
grep -q 'skipped 1 points and 1 lines; kept 1 faces without area; the last line has no end' out
grep -qE '^  slowdown [0-9.]+ \(time over that of wide8 with arrays, mean over the kinds of queries\); [0-9]+ tried$' out
expect 0 "$boxtree" cook --help
head -3 out | grep -q '24 bits'
echo "standard streams: all as expected"
