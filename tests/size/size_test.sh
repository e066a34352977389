#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sizes of the runtime in linked and stripped programs of few lines, code and data, less those of an
# empty program: whole and small. The small one reads wide4 and answers rays, holds no other walk
# and no decompressor, and says so of a file that it cannot read.
#   size_test.sh SOURCE BOXTREE WHOLE RUNTIME EMPTY SHAPES    the last four: programs/ of the build under test
set -euo pipefail
source=$1 boxtree=$2 whole=$3 runtime=$4 empty=$5 shapes=$6
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "size: $*"; exit 1; }

# bytes PROGRAM: code and data of it once stripped.
bytes() { strip -o "$work/stripped" "$1" && size "$work/stripped" | awk 'NR == 2 {print $4}'; }
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
# smaller NAME PROGRAM LIMIT: reports a size and holds it to a limit, both in bytes.
smaller() {
  local got=$(($(bytes "$2") - less))
  echo "$1: $got bytes of code and data"
  [ "$got" -lt "$3" ] || fail "$1: more than the $3 bytes that are allowed"
}

ray_only=(-DPROGRAM=ray -DBOXTREE_CODECS=wide4 -DBOXTREE_QUERIES=ray -DBOXTREE_BLOB=OFF)
built small -DCMAKE_BUILD_TYPE=MinSizeRel -DBOXTREE_SIMD=OFF "${ray_only[@]}"
built small-fast -DCMAKE_BUILD_TYPE=Release "${ray_only[@]}"
built whole-small -DCMAKE_BUILD_TYPE=MinSizeRel -DPROGRAM=whole
smaller 'every query but casts and contacts of shapes' "$runtime" $((450 * 1024))
smaller 'every query' "$shapes" $((547 * 1024))
echo "the same with boxtree::paper and boxtree::blob: $(($(bytes "$whole") - less)) bytes"
smaller 'every query but those and every library, MinSizeRel' "$work/whole-small/program" $((400 * 1024))
smaller 'rays of wide4' "$work/small-fast/program" $((120 * 1024))
smaller 'rays of wide4, MinSizeRel without vectors' "$work/small/program" $((60 * 1024))

# What all queries share needs none of them: each is built without the others.
for query in 'ray;cast' 'ray;cast;collide' 'ray;cast;hull' box frustum point sphere pair distance within; do
  cmake -S "$source" -B "$work/alone" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DBOXTREE_BUILD_COOKER=OFF -DBOXTREE_BUILD_TESTS=OFF \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DBOXTREE_PRECOMPILE_HEADERS=OFF \
    -DBOXTREE_CODECS=wide4 "-DBOXTREE_QUERIES=$query" -DBOXTREE_BLOB=OFF -DBOXTREE_SIMD=OFF >"$work/log" 2>&1 &&
    cmake --build "$work/alone" -j2 >>"$work/log" 2>&1 || { tail -30 "$work/log"; fail "$query alone does not build"; }
done

# What was left out is in none of the small programs, and the same list finds it in the whole one. The
# runtime has no codec of the paper and no decompressor of its own.
left_out='PairWalk|DistanceWalk|walk_wide_pairs|triangles_intersect|triangle_distance|PointQuery|BoxQuery|SphereQuery|PackedCodec|PlainCodec|Wide8Node|lzma_|ZSTD_|decompress'
for name in small small-fast; do
  nm -C "$work/$name/program" >"$work/symbols"
  grep -E 'closest_hit' "$work/symbols" >/dev/null || fail "$name: no symbols to look at"
  if grep -E "$left_out" "$work/symbols"; then fail "$name: links what it does not need"; fi
  ldd "$work/$name/program" >"$work/libraries"
  if grep -E 'lzma|zstd' "$work/libraries"; then fail "$name: needs a decompressor"; fi
done
nm -C "$runtime" >"$work/symbols"
if grep -E 'PackedCodec|PlainCodec|lzma_|ZSTD_' "$work/symbols"; then fail "the runtime has a codec of the paper"; fi
nm -C "$whole" >"$work/symbols"
IFS='|' read -ra names <<<"$left_out"
for name in "${names[@]}"; do
  grep -q "$name" "$work/symbols" || fail "the whole runtime has no symbol $name: the list is stale"
done

# Answers: a sheet at z = 1 whose second triangle (face 1) lies under the ray.
cat >"$work/square.obj" <<'OBJ'
v -10 -10 1
v 10 -10 1
v 10 8 1
v -10 12 1
f 1 2 3
f 1 3 4
OBJ
for k in $(seq 0 40); do
  printf 'v %d 30 0\nv %d 30 0\nv %d 31 0\nf -3 -2 -1\n' "$k" $((k + 1)) "$k"
done >>"$work/square.obj"
for codec in wide4 packed-f16; do
  "$boxtree" cook "$work/square.obj" -o "$work/$codec.bxt" --codec "$codec" -q
done
"$boxtree" cook "$work/square.obj" -o "$work/grid.bxt" --codec wide4 --grid-bits 20 -q
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
"$boxtree" cook "$work/square.obj" -o "$work/blob.bxt" --codec blob-zstd -q
"$whole" "$work/blob.bxt" >/dev/null || fail "the whole runtime does not answer"
"$runtime" "$work/wide4.bxt" >/dev/null || fail "the runtime does not answer"
said=$("$runtime" "$work/packed-f16.bxt") && fail "the runtime answered of a codec of the paper"
case $said in
  *'packed-f16 is a codec of boxtree::paper: link it and call use_paper_codecs()'*) ;;
  *) fail "unclear: '$said'" ;;
esac

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
echo "size: as expected"
