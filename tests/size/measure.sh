# SPDX-License-Identifier: MIT
# What the tests of sizes share: read by the scripts of this folder, which have a folder $work, a function fail, $less,
# the bytes of an empty program, and $boxtree.
# shellcheck shell=bash disable=SC2154

# bytes PROGRAM: code and data of it once stripped.
bytes() { strip -o "$work/stripped" "$1" && size "$work/stripped" | awk 'NR == 2 {print $4}'; }
# smaller NAME PROGRAM LIMIT: reports a size and holds it to a limit, both in bytes.
smaller() {
  local got=$(($(bytes "$2") - less))
  echo "$1: $got bytes of code and data"
  [ "$got" -lt "$3" ] || fail "$1: more than the $3 bytes that are allowed"
}
# cook_square NAME OPTION...: a sheet at z = 1 whose second triangle (face 1) lies under the ray of the programs.
cook_square() {
  local name=$1
  shift
  {
    printf 'v -10 -10 1\nv 10 -10 1\nv 10 8 1\nv -10 12 1\nf 1 2 3\nf 1 3 4\n'
    local k
    for k in $(seq 0 40); do
      printf 'v %d 30 0\nv %d 30 0\nv %d 31 0\nf -3 -2 -1\n' "$k" $((k + 1)) "$k"
    done
  } >"$work/square.obj"
  "$boxtree" cook "$work/square.obj" -o "$work/$name.bxt" "$@" -q
}
