#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares what the command line for Windows prints under Wine, and writes, with this machine's, byte for byte.
#   windows_command_line.sh BOXTREE BOXTREE.EXE SOURCE FOLDER     FOLDER has the files of run.sh
# Prints each command that differs; at last the number of those that were compared. Exit 1 if one differs.
set -uo pipefail
linux=$(realpath "$1") windows=$(realpath "$2") source=$(realpath "$3")
cd "$4" || exit
export LC_ALL=C.UTF-8  # by which Wine reads names of files
compared=0
failed=0
on_windows() { wine "$windows" "$@" 2>../windows.complaint; }
differs() {
  echo "differs: $*"
  failed=1
}

# same ARGUMENT...: the same standard output, and the same exit status. Standard input is what it is.
same() {
  local expected=0 found=0
  "$linux" "$@" <"${input:-/dev/null}" >../linux.out 2>../linux.complaint || expected=$?
  on_windows "$@" <"${input:-/dev/null}" >../windows.out || found=$?
  compared=$((compared + 1))
  [ $expected = $found ] || differs "exit status $found, expected $expected: $*" "$(head -1 ../windows.complaint)"
  cmp -s ../linux.out ../windows.out || differs "$*"
}
# refused STATUS TEXT ARGUMENT...: ends with that status, and says so.
refused() {
  local status=$1 text=$2 found=0
  shift 2
  on_windows "$@" </dev/null >../windows.out || found=$?
  compared=$((compared + 1))
  [ $found = "$status" ] || differs "exit status $found, expected $status: $*"
  grep -qF "$text" ../windows.complaint || differs "$* does not say '$text': $(head -1 ../windows.complaint)"
}

for file in *.bxt; do
  same info "$file" --json
  same verify "$file" --json
done
same info level.bxt
for tree in level torus torus-grid torus-arrays torus-f64 crate; do
  same query $tree.bxt ray --origin 0.3,0.2,9 --direction 0,0.01,-1 --json
  same query $tree.bxt cast --sphere 0.05 --at 0.3,0.2,9 --direction 0,0,-1 --json
  same query $tree.bxt collide --sphere 0.6 --at 0.1,0.2,0.5 --json
  same query $tree.bxt box --min -0.4,-0.4,-0.4 --max 0.5,0.5,1 --json
  same query $tree.bxt sphere --center 0,0,0.5 --radius 0.6 --json
  same query $tree.bxt frustum --matrix 5,0,0,0,0,5,0,0,0,0,1,0,0,0,0,1 --json
  same query $tree.bxt point --at 1,2,3 --json
  same query $tree.bxt pair crate.bxt --pose 0.5,0,0.4 --json
  same query $tree.bxt distance crate.bxt --pose 9,1,2 --json
  same query $tree.bxt overlap crate.bxt --pose 5,0,0 --within 0.1 --json
done
same query courtyard.bxt ray --origin 0,10,-3.3 --direction 0,-1,0 --json
# Pairs come in the order of the walk, which is another one with vectors.
in_order() { python3 -c 'import json, sys
print(sorted(json.dumps(pair) for pair in json.load(sys.stdin)["pairs"]))'; }
contacts=(query courtyard.bxt contacts --move Crate=0.8,2.1,-6.8 --json)
"$linux" "${contacts[@]}" | in_order >../linux.out
on_windows "${contacts[@]}" | in_order >../windows.out
compared=$((compared + 1))
cmp -s ../linux.out ../windows.out || differs "${contacts[*]}"
same query courtyard.bxt --tree crate point --at 0,2,0 --json
printf '%s\n' '{"kind":"ray","origin":[0.3,0.2,9],"direction":[0,0,-1]}' '{"kind":"point","at":[1,2,3]}' >queries.jsonl
same query level.bxt --batch queries.jsonl --json
input=queries.jsonl same query level.bxt --batch - --json

# Standard input and standard output are bytes.
input=level.bxt same info - --json
input=level.bxt same verify - --json
input=$source/samples/meshes/crate.obj same cook - --format obj -o -
same cook "$source/samples/meshes/level.obj" -o -

# Files that it cooks have the same bytes, also where there was one, and its old bytes stay where it fails.
for options in "--exact --codec wide8" "--grid-bits 16 --codec wide4" "--f64 --exact" "--exact --for speed --materials"; do
  # shellcheck disable=SC2086 # a list of words
  {
    "$linux" cook "$source/samples/meshes/crate.obj" $options -o expected.cooked -q
    on_windows cook "$source/samples/meshes/crate.obj" $options -o found.cooked -q
  }
  compared=$((compared + 1))
  cmp expected.cooked found.cooked || differs "cook $options"
done
# A disk that is full in the middle of it.
(
  trap '' XFSZ
  ulimit -f 8
  on_windows cook "$source/tests/platforms/torus.obj" --f64 --exact --codec wide4 -o found.cooked -q
)
status=$?
compared=$((compared + 1))
[ $status = 2 ] || differs "exit status $status, expected 2, of a full disk: $(head -1 ../windows.complaint)"
cmp expected.cooked found.cooked || differs "a full disk leaves another file than the old one"
litter=$(find . -name '.*.cooking')
[ -z "$litter" ] || differs "left behind: $litter"
rm -f expected.cooked found.cooked queries.jsonl

# bench. Times and instruction sets differ; what was found does not.
counts() { python3 -c 'import json, sys
for file in json.load(sys.stdin)["files"]:
    print({k: v for k, v in file.items() if not k.endswith(("_ns", "_us", "faults", "_set"))})'; }
measured() {
  "$linux" bench "$1" --quick --runs 1 --json | counts >../linux.out
  on_windows bench "$1" --quick --runs 1 --json | counts >../windows.out
  compared=$((compared + 1))
  cmp -s ../linux.out ../windows.out || differs bench "$1"
}
measured torus.bxt

# written FILE ARGUMENT...: both write it, with the same bytes and the same exit status.
written() {
  local file=$1 expected=0 found=0
  shift
  rm -f "$file"
  "$linux" "$@" -o "$file" -q 2>../linux.complaint || expected=$?
  mv "$file" ../expected.file
  on_windows "$@" -o "$file" -q || found=$?
  compared=$((compared + 1))
  [ $expected = $found ] || differs "exit status $found, expected $expected: $*" "$(head -1 ../windows.complaint)"
  cmp ../expected.file "$file" || differs "$* -o $file" "$(head -1 ../windows.complaint)"
}
# Files, folders, lists, batches, meshes, profiles and packs in that folder, whose names are not ASCII.
named() {
  local folder=$1 file
  local tree="$folder/größe.bxt" other="$folder/日本.bxt" third="$folder/🌳 tree.bxt"
  mkdir -p "$folder"
  cp level.bxt "$tree"
  cp torus.bxt "$other"
  cp crate.bxt "$third"
  for file in "$tree" "$other" "$third"; do
    same info "$file" --json
    same verify "$file" --json
    same query "$file" ray --origin 0.3,0.2,9 --direction 0,0.01,-1 --json
    same query "$file" pair "$third" --pose 0.5,0,0.4 --json
  done
  measured "$other"
  printf '{"kind":"pair","file":"%s"}\n' "$third" >"$folder/fragen é.jsonl"
  same query "$tree" --batch "$folder/fragen é.jsonl" --json

  sed 's/mtllib .*/mtllib farben é 木.mtl/' "$source/samples/meshes/crate.obj" >"$folder/kiste é.obj"
  cp "$source/samples/meshes/crate.mtl" "$folder/farben é 木.mtl"
  written "$folder/kiste é.bxt" cook "$folder/kiste é.obj" --materials
  printf '[scene]\nsource = "kiste é.obj"\n' >"$folder/profil é.toml"
  written "$folder/profil é.bxt" cook --profile "$folder/profil é.toml"

  printf '%s\n' "$tree" "$third" >"$folder/liste é"
  written "$folder/alle é.bxt" pack "$other" "@$folder/liste é" --names path
  written "$folder/alle é.bxt" pack "$tree" "$other" "$third"
  mkdir ../expected.split
  "$linux" split "$folder/alle é.bxt" -o ../expected.split -q
  on_windows split "$folder/alle é.bxt" -o "$folder/taken é" -q
  compared=$((compared + 1))
  diff -r ../expected.split "$folder/taken é" || differs "split into $folder" "$(head -1 ../windows.complaint)"

  # What is not to be written over.
  same pack "$tree" "$other" -o "$tree"
  cmp level.bxt "$tree" || differs "pack over its input"
  echo notes >"$folder/notizen é"
  same pack "$tree" "$other" -o "$folder/notizen é"
  [ "$(cat "$folder/notizen é")" = notes ] || differs "pack over another file"
  refused 2 "$folder/nichts é.bxt: no such file" info "$folder/nichts é.bxt"
  rm -r "${folder%%/*}" ../expected.split
}
named "größe 木 🌳"
long=folder
for _ in $(seq 12); do long+="/a folder with a name of some length"; done  # beyond MAX_PATH, which is 260
named "$long"

# What it has not.
"$linux" cook "$source/samples/meshes/crate.obj" --codec blob-zstd -o ../blob.bxt -q
refused 5 "built without zstd" info ../blob.bxt
refused 5 "built without zstd" cook "$source/samples/meshes/crate.obj" --codec blob-zstd -o ../other.bxt
refused 5 "built without assimp" cook "$source/samples/level/level.gltf" -o ../other.bxt
refused 5 "on Linux" report "$source/samples/meshes/crate.obj" --quick
refused 5 "on Linux" bench torus.bxt --pages
refused 2 "no such file" info nothing.bxt

echo "$compared commands"
exit $failed
