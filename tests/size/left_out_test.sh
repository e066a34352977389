#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runtimes without all that a program does not need, each a build of its own: their sizes, that each query
# compiles without the others, and what is said of what was left out. The small one reads wide4 and answers
# rays, holds no other walk and no decompressor, and says so of a file that it cannot read.
#   left_out_test.sh SOURCE BOXTREE WHOLE EMPTY    the last two: programs/ of the build under test
set -euo pipefail
source=$1 boxtree=$2 whole=$3 empty=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "left out: $*"; exit 1; }
# shellcheck source=tests/size/measure.sh
. "$(dirname "$0")/measure.sh"
less=$(bytes "$empty")

# build NAME OPTION...: a program on a runtime of its own.
build() {
  local name=$1
  shift
  cmake -S "$source/tests/size/programs" -B "$work/$name" -G Ninja -DBOXTREE_BUILD_COOKER=OFF "$@" \
    >"$work/log" 2>&1 && cmake --build "$work/$name" -j2 >>"$work/log" 2>&1
}
# built NAME OPTION...: likewise; the test fails if it cannot be.
built() { build "$@" || { tail -30 "$work/log"; fail "$1 does not build"; }; }

ray_only=(-DPROGRAM=ray -DBOXTREE_CODECS=wide4 -DBOXTREE_QUERIES=ray -DBOXTREE_BLOB=OFF)
built small -DCMAKE_BUILD_TYPE=MinSizeRel -DBOXTREE_SIMD=OFF "${ray_only[@]}"
built small-fast -DCMAKE_BUILD_TYPE=Release "${ray_only[@]}"
built whole-small -DCMAKE_BUILD_TYPE=MinSizeRel -DPROGRAM=whole
smaller 'every query but casts and contacts of shapes, every library, MinSizeRel' "$work/whole-small/program" $((400 * 1024))
smaller 'rays of wide4' "$work/small-fast/program" $((120 * 1024))
smaller 'rays of wide4, MinSizeRel without vectors' "$work/small/program" $((60 * 1024))

# What all queries share needs none of them: each compiles without the others, all sources as one to save time.
for query in 'ray;cast' 'ray;cast;collide' 'ray;cast;hull' box frustum point sphere pair 'point;distance' within; do
  rm -rf "$work/alone"
  cmake -S "$source" -B "$work/alone" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DBOXTREE_BUILD_COOKER=OFF -DBOXTREE_BUILD_TESTS=OFF -DBOXTREE_PRECOMPILE_HEADERS=OFF \
    -DBOXTREE_CODECS=wide4 "-DBOXTREE_QUERIES=$query" -DBOXTREE_BLOB=OFF -DBOXTREE_SIMD=OFF >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "$query alone is not configured"; }
  sed -nE 's@^ *"file": ("[^"]*/(format|runtime)/[^"]*").*@#include \1@p' "$work/alone/compile_commands.json" |
    sort -u >"$work/alone.cpp"
  [ "$(wc -l <"$work/alone.cpp")" -gt 30 ] || fail "$query: no sources to compile"
  # One source of the runtime knows where all headers are.
  read -ra command < <(sed -nE 's@^ *"command": "(.*) -o .*/runtime/[^"]*",@\1@p' "$work/alone/compile_commands.json" | tail -1)
  "${command[@]}" -fsyntax-only "$work/alone.cpp" >"$work/log" 2>&1 || { head -30 "$work/log"; fail "$query alone does not compile"; }
done

# What was left out is in none of the small programs, and the same list finds it in the whole one.
left_out='PairWalk|DistanceWalk|walk_wide_pairs|triangles_intersect|triangle_distance|PointQuery|BoxQuery|SphereQuery|PackedCodec|PlainCodec|Wide8Node|lzma_|ZSTD_|decompress'
for name in small small-fast; do
  nm -C "$work/$name/program" >"$work/symbols"
  grep -E 'closest_hit' "$work/symbols" >/dev/null || fail "$name: no symbols to look at"
  if grep -E "$left_out" "$work/symbols"; then fail "$name: links what it does not need"; fi
  ldd "$work/$name/program" >"$work/libraries"
  if grep -E 'lzma|zstd' "$work/libraries"; then fail "$name: needs a decompressor"; fi
done
nm -C "$whole" >"$work/symbols"
IFS='|' read -ra names <<<"$left_out"
for name in "${names[@]}"; do
  grep -q "$name" "$work/symbols" || fail "the whole runtime has no symbol $name: the list is stale"
done

cook_square wide4 --codec wide4
cook_square grid --codec wide4 --grid-bits 20
cook_square packed-f16 --codec packed-f16
for name in small small-fast; do
  for file in wide4 grid; do
    said=$("$work/$name/program" "$work/$file.bxt") || fail "$name: $file: $said"
    [ "$said" = 't 9, face 1' ] || fail "$name: $file: wrong answer '$said'"
  done
  said=$("$work/$name/program" "$work/packed-f16.bxt") && fail "$name: answered of another codec"
  case $said in
    *'packed-f16 was left out of this build, which has wide4'*) ;;
    *) fail "$name: unclear: '$said'" ;;
  esac
done

# Scenes need no wide codec.
built scene -DCMAKE_BUILD_TYPE=MinSizeRel -DBOXTREE_SIMD=OFF -DPROGRAM=scene \
  -DBOXTREE_CODECS=plain-f32 -DBOXTREE_BLOB=OFF
printf '[scene]\nsource = "square.obj"\ncodec = "plain-f32"\nexact = true\n' >"$work/scene.toml"
"$boxtree" cook --profile "$work/scene.toml" -o "$work/scene.bxt" -q
said=$("$work/scene/program" "$work/scene.bxt") || fail "scene of plain-f32: $said"
[ "$said" = 't 9, face 1, 3 faces, distance 1' ] || fail "scene of plain-f32: wrong answer '$said'"

# A query that was left out is an error of the compiler that says so; a codec or query that there is
# not, and a cooker on less than a whole runtime, are errors of the configuration.
sed -i 's/^PROGRAM:[A-Z]*=.*/PROGRAM:UNINITIALIZED=missing/' "$work/small/CMakeCache.txt"
if build small; then fail "pair.h compiles where pair queries were left out"; fi
grep -q 'BOXTREE_QUERIES left pair queries out' "$work/log" || fail "unclear: $(cat "$work/log")"
if build unknown -DPROGRAM=ray -DBOXTREE_CODECS=wide5; then fail "a codec wide5 was built"; fi
grep -q "unknown 'wide5'" "$work/log" || fail "unclear: $(cat "$work/log")"
if build cooker -DPROGRAM=ray -DBOXTREE_QUERIES=ray -DBOXTREE_BUILD_COOKER=ON; then
  fail "a cooker on less than a whole runtime was built"
fi
grep -q 'cooker needs the whole runtime' "$work/log" || fail "unclear: $(cat "$work/log")"
echo "left out: as expected"
