#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The second reader (read_bxt.py, written from docs/FORMAT.md) agrees with ours on the golden files
# and on freshly cooked ones, and finds damage.
#   reader_test.sh BOXTREE GOLDEN_DIR MESH...
set -euo pipefail
boxtree=$1 golden=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
read_bxt() { /usr/bin/python3 "$golden/read_bxt.py" "$1"; }
fail() { echo "$*"; exit 1; }

for file in "$golden"/v*.hex; do read_bxt "$file" >"$work/said" || fail "$file"; done

# A sheet of quads and triangles that takes more than one cluster.
sheet=$work/sheet.obj
awk 'BEGIN {
  for (y = 0; y <= 8; ++y) for (x = 0; x <= 60; ++x) print "v", x / 7, y / 9, sin(x / 5) * cos(y / 3)
  for (y = 0; y < 8; ++y) for (x = 1; x <= 60; ++x) {
    a = 61 * y + x
    if (x == 5 && y % 2) print "f", a, a + 1, a + 62, a + 61
    else { print "f", a, a + 1, a + 62; print "f", a, a + 62, a + 61 }
  }
}' >"$sheet"
awk 'NF < 5' "$sheet" >"$work/triangles.obj"

codecs=$("$boxtree" cook --help | tr -s '\n ' ' ' | sed -n 's/.*(auto, \([^)]*\)).*/\1/p' | tr -d ',')
[ -n "$codecs" ] || fail "no list of codecs in the help of cook"
meshes=("$@" "$sheet" "$work/triangles.obj")
for codec in ${codecs//blob-*/}; do # blobs come last
  for geometry in "--exact --for speed" "--exact --for memory" --grid-bits=10 --grid-bits=28; do
    # shellcheck disable=SC2086 # several words
    "$boxtree" cook "${meshes[@]}" -o "$work/mesh.bxt" --codec "$codec" $geometry -q
    read_bxt "$work/mesh.bxt" >"$work/theirs" || fail "$codec, $geometry"
    "$boxtree" info "$work/mesh.bxt" --json >"$work/ours"
    keys='[.trees[] | {name,codec,faces,duplicates,triangles,nodes,depth}]'
    jq -cS "$keys" "$work/ours" >"$work/wanted"
    [ "$(jq length "$work/wanted")" -eq ${#meshes[@]} ] || fail "$codec, $geometry: not ${#meshes[@]} trees"
    jq -cS "$keys" "$work/theirs" | cmp - "$work/wanted" || fail "$codec, $geometry: the two readers differ"
  done
done

# Active edges are those of the source in every encoding.
: >"$work/first"
for encoding in "--codec wide8 --exact --for memory" "--codec plain-f32 --exact" "--codec wide4 --grid-bits 24"; do
  # shellcheck disable=SC2086 # several words
  "$boxtree" cook "${meshes[@]}" -o "$work/mesh.bxt" --active-edges 5 $encoding -q
  read_bxt "$work/mesh.bxt" >"$work/theirs" || fail "$encoding, active edges"
  jq -c '[.trees[] | [.face_ids, .active_edges] | transpose | sort]' "$work/theirs" >"$work/edges"
  [ -s "$work/first" ] || cp "$work/edges" "$work/first"
  cmp "$work/edges" "$work/first" || fail "$encoding: other active edges"
done

# Materials of faces are those of the source, by runs or by face.
awk '/^f/ { if (++faces % 100 == 1) print "usemtl m" faces % 7 } { print }' "$work/triangles.obj" >"$work/runs.obj"
awk '/^f/ { print "usemtl m" ++faces % 3 } { print }' "$work/triangles.obj" >"$work/turns.obj"
for mesh in runs turns; do
  for options in "--codec wide8 --exact" "--codec plain-f32" "--codec wide4 --no-face-ids" "--codec dedup --no-face-ids"; do
    # shellcheck disable=SC2086 # several words
    "$boxtree" cook "$work/$mesh.obj" -o "$work/mesh.bxt" --materials $options -q
    read_bxt "$work/mesh.bxt" >"$work/theirs" || fail "$mesh, $options, materials"
    jq -r '.trees[].materials[]' "$work/theirs" | sort | uniq -c >"$work/found"
    awk '/^usemtl/ { now = $2 } /^f/ { print now }' "$work/$mesh.obj" | sort | uniq -c >"$work/wanted"
    cmp "$work/found" "$work/wanted" || fail "$mesh, $options: other materials"
    if [ "${options##*--}" != no-face-ids ]; then
      jq -r '.trees[] | [.face_ids, .materials] | transpose | sort[] | .[1]' "$work/theirs" >"$work/found"
      awk '/^usemtl/ { now = $2 } /^f/ { print now }' "$work/$mesh.obj" >"$work/wanted"
      cmp "$work/found" "$work/wanted" || fail "$mesh, $options: materials of other faces"
    fi
  done
done

# User data of faces is that of the source, by runs or by face, in as few bytes as hold it.
for zones in 'int(f / 100) % 7' 'f % 3' 'f * 99 % 60000' 'f * 999999 % 4294967296' '-1 - f % 200'; do
  awk -v OFS=' ' '/^v / { vertices[n++] = $2 " " $3 " " $4 } /^f / { faces[m++] = $2 - 1 " " $3 - 1 " " $4 - 1 }
    END {
      print "ply\nformat ascii 1.0\nelement vertex", n "\nproperty float x\nproperty float y\nproperty float z"
      print "element face", m "\nproperty list uchar int vertex_indices\nproperty int zone\nend_header"
      for (i = 0; i < n; ++i) print vertices[i]
      for (f = 0; f < m; ++f) printf "3 %s %.0f\n", faces[f], '"$zones"'
    }' "$work/triangles.obj" >"$work/zones.ply"
  awk '/^3 / && NF == 5 { printf "%.0f\n", $5 < 0 ? $5 + 4294967296 : $5 }' "$work/zones.ply" >"$work/wanted"
  sort "$work/wanted" >"$work/all_wanted"
  for options in "--codec wide8 --exact" "--codec wide4 --no-face-ids" "--codec dedup"; do
    # shellcheck disable=SC2086 # several words
    "$boxtree" cook "$work/zones.ply" -o "$work/mesh.bxt" --user-data zone $options -q
    read_bxt "$work/mesh.bxt" >"$work/theirs" || fail "$zones, $options, user data"
    jq -r '.trees[].user_data[]' "$work/theirs" | sort >"$work/found"
    cmp "$work/found" "$work/all_wanted" || fail "$zones, $options: other user data"
    if [ "${options##*--}" != no-face-ids ]; then
      jq -r '.trees[] | [.face_ids, .user_data] | transpose | sort[] | .[1]' "$work/theirs" >"$work/found"
      cmp "$work/found" "$work/wanted" || fail "$zones, $options: user data of other faces"
    fi
  done
done

# Tiles that meet: one mesh in four places, one of them turned and mirrored, on a grid and not.
awk 'BEGIN {
  for (y = 0; y <= 4; ++y) for (x = 0; x <= 4; ++x) print "v", x - 2, y - 2, 0
  for (y = 0; y < 4; ++y) for (x = 1; x <= 4; ++x) {
    a = 5 * y + x
    if (x == y) print "f", a, a + 1, a + 6, a + 5
    else { print "f", a, a + 1, a + 6; print "f", a, a + 6, a + 5 }
  }
}' >"$work/tile.obj"
for precision in "exact = true" "tolerance = 0.001"; do
  {
    printf '[scene]\nactive_edges = 5\n%s\n[[mesh]]\nname = "tile"\nfile = "tile.obj"\n' "$precision"
    for at in "0, 0" "4, 0" "0, 4"; do printf '[[instance]]\nmesh = "tile"\ntranslation = [%s, 0]\n' "$at"; done
    printf '[[instance]]\nmesh = "tile"\ntranslation = [4, 4, 0]\naxis = [0, 0, 1]\ndegrees = 90\nscale = [-1, 1, 1]\n'
  } >"$work/tiles.toml"
  "$boxtree" cook --profile "$work/tiles.toml" -o "$work/tiles.bxt" -q
  "$boxtree" verify "$work/tiles.bxt" -q
  read_bxt "$work/tiles.bxt" >"$work/theirs" || fail "tiles, $precision"
  # Four edges at each of two sides.
  edges='[.instance_edges[] | map(.[1] | . % 2 + (. / 2 | floor) % 2 + (. / 4 | floor) % 2 + (. / 8 | floor)) | add]'
  [ "$(jq -c "$edges" "$work/theirs")" = "[8,8,8,8]" ] ||
    fail "tiles, $precision: $(jq -c .instance_edges "$work/theirs")"
done

# Packs: names, members and trees.
for mesh in "$@"; do
  name=$(basename "$mesh" .obj)
  "$boxtree" cook "$mesh" -o "$work/$name.bxt" -q
  files+=("$work/$name.bxt")
done
"$boxtree" cook "$@" -o "$work/several.bxt" -q
"$boxtree" pack "${files[@]}" "$work/several.bxt" -o "$work/pack.bxt" -q
read_bxt "$work/pack.bxt" >"$work/theirs" || fail "a pack"
"$boxtree" info "$work/pack.bxt" --json >"$work/ours"
[ "$(jq -cS "$keys" "$work/theirs")" = "$(jq -cS "$keys" "$work/ours")" ] || fail "a pack: the two readers differ"

# Each byte of a golden file matters to the second reader too.
/usr/bin/python3 - "$golden" <<'PYTHON'
import glob, struct, sys
sys.path.insert(0, sys.argv[1])
import read_bxt
paths = sorted(glob.glob(sys.argv[1] + "/v*.hex"))
for path in paths[:1] + [path for path in paths if "grid" in path or "wide" in path or "pack" in path]:
    data = bytes.fromhex(open(path).read())
    for i in range(len(data)):
        if 10 <= i < 12 or 32 <= i < 40:
            continue  # minor version and compatible features may be anything, but their checksum not
        damaged = data[:i] + bytes([data[i] ^ 1]) + data[i + 1:]
        try:
            read_bxt.read(damaged)
        except (read_bxt.Broken, struct.error):
            continue
        sys.exit(f"{path}: the second reader missed damage of byte {i}")
PYTHON
echo "two readers agree"
