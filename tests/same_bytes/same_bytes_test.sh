#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One build's bytes against the pinned ones, in circumstances that must not matter.
#   same_bytes_test.sh [--threads-only] BOXTREE_SAME_BYTES BOXTREE PINNED MESH...
#   --threads-only   for builds that are slow: vary the number of threads and nothing else
set -euo pipefail
threads_only=no
if [ "$1" = --threads-only ]; then
  threads_only=yes
  shift
fi
program=$1 boxtree=$2 pinned=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A locale with a decimal comma: one of the machine's, or made from its sources.
comma_locale() {
  local found
  found=$(locale -a | grep -iE '^de_DE\.utf-?8$' | head -1 || true)
  if [ -z "$found" ] && localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" 2>/dev/null; then
    export LOCPATH=$work
    found=de_DE.UTF-8
  fi
  comma=$found
}
comma_locale

# same NAME COMMAND...: what the command prints is what is pinned.
same() {
  local name=$1
  shift
  if ! "$@" >"$work/printed" 2>"$work/errors"; then
    echo "$name: failed"
    cat "$work/errors"
    exit 1
  fi
  if ! diff "$pinned" "$work/printed" >"$work/differences"; then
    echo "$name: other bytes than pinned"
    grep '^[<>]' "$work/differences" | head -20
    exit 1
  fi
  echo "$name: same bytes"
}

same "all threads" "$program"
same "one thread" "$program" --jobs 1
[ "$threads_only" = no ] || exit 0
# Several circumstances at a time, since each run takes seconds.
mkdir -p "$work/other folder"
ln -s "$(dirname "$program")" "$work/link"
same "heap filled with 5a, no fused or wide instructions in libm" \
  env MALLOC_PERTURB_=90 GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX "$program"
linked=(env -C "$work/other folder" MALLOC_PERTURB_=165)
if [ -n "$comma" ]; then
  same "heap filled with a5, through a link, in another folder, decimal comma" \
    "${linked[@]}" LC_ALL="$comma" "$work/link/$(basename "$program")" --comma-locale
else
  same "heap filled with a5, through a link, in another folder" \
    "${linked[@]}" LC_ALL=C "$work/link/$(basename "$program")"
  echo "decimal comma: not tried, there is neither de_DE.UTF-8 nor what makes it"
fi

# cooked NAME COMMAND...: files cooked from files, too, whatever the way to them and out.
cooked() {
  local name=$1 mesh
  shift
  for mesh in "${meshes[@]}"; do
    rm -f out.bxt
    "$@" cook "$mesh" -o out.bxt --quiet
    cmp out.bxt "$work/$(basename "$mesh").bxt" || { echo "$name: $mesh cooked otherwise"; exit 1; }
  done
  echo "$name: same files"
}
for mesh in "$@"; do "$boxtree" cook "$mesh" -o "$work/$(basename "$mesh").bxt" --quiet; done
cd "$work/other folder"
meshes=("$@")
cooked "heap filled with 5a" env MALLOC_PERTURB_=90 "$boxtree"
cooked "heap filled with a5" env MALLOC_PERTURB_=165 "$boxtree"
[ -z "$comma" ] || cooked "decimal comma" env LC_ALL="$comma" "$boxtree"
mkdir deep
cp "$@" deep
ln -s deep shallow
meshes=()
for mesh in "$@"; do meshes+=("shallow/$(basename "$mesh")"); done
cooked "through a link, by a relative path" "$boxtree"
echo "same bytes everywhere that was tried"
