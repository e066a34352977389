#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Packs: what goes in comes out, byte for byte, and every command reads what is inside.
#   pack_test.sh BOXTREE GOLDEN_DIR LEVEL
set -euo pipefail
# shellcheck source=tests/cli/expect.sh
. "$(dirname "$0")/expect.sh"
boxtree=$1 golden=$2 level=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A fan of N triangles with two materials and a number for each face.
make_mesh() {
  awk -v n="$1" 'BEGIN {
    print "v 0 0 0"
    for (i = 0; i <= n; ++i) printf "v %.6f %.6f 1\n", cos(i), sin(i)
    for (i = 2; i <= n + 1; ++i) {
      if (i % 4 == 0) print "usemtl stone\ng walls"
      if (i % 4 == 2) print "usemtl wood\ng floors"
      printf "f 1 %d %d\n", i, i + 1
    }
  }' >"$2"
}
mkdir -p a b
make_mesh 9 rock.obj
make_mesh 30 tree.obj
"$boxtree" cook rock.obj -o a/rock.bxt --materials --user-data groups --active-edges 5 -q
"$boxtree" cook tree.obj -o a/tree.bxt --grid-bits 12 --strip -q
"$boxtree" cook "$level" -o a/level.bxt -q --scene
"$boxtree" cook tree.obj -o b/rock.bxt -q
"$boxtree" cook tree.obj -o blob.bxt --codec blob-zstd -q

# All come back as they were, in whatever order they were named, also from a list.
expect 0 "$boxtree" pack a/rock.bxt a/tree.bxt a/level.bxt -o all.bxt
grep -q '^all.bxt: [0-9]* trees of 3 files, [0-9]* bytes$' out
printf 'a/level.bxt\na/tree.bxt\na/rock.bxt\n' >list
expect 0 "$boxtree" pack @list -o other.bxt --json
cmp all.bxt other.bxt
same "$(jq -c '[.output, .members, .bytes]' out)" "[\"other.bxt\",3,$(wc -c <all.bxt)]"
expect 0 "$boxtree" pack @list -o - >all.piped
cmp all.bxt out
{ printf '\357\273\277'; cat list; } >marked.list # as editors for Windows write it
expect 0 "$boxtree" pack @marked.list -o marked.bxt -q
cmp all.bxt marked.bxt
# As of a shard without a job.
: >empty.list
expect 1 "$boxtree" pack @empty.list -o none.bxt
grep -qxF 'boxtree: usage: pack: FILE is required; the list @empty.list has no line' err
expect 0 "$boxtree" pack @empty.list @list -o other.bxt -q
cmp all.bxt other.bxt
expect 0 "$boxtree" verify all.bxt
expect 0 "$boxtree" split all.bxt -o taken --json
same "$(jq -c '[.files[] | .output, .member]' out)" '["taken/level.bxt","level","taken/rock.bxt","rock","taken/tree.bxt","tree"]'
for file in rock tree level; do cmp a/$file.bxt taken/$file.bxt; done
expect 0 "$boxtree" split all.bxt --tree tree -o one
same "$(ls one)" tree.bxt
expect 0 "$boxtree" split - --tree level/crate -o one <all.bxt
cmp a/level.bxt one/level.bxt
# Or by what it is called itself.
expect 0 "$boxtree" split all.bxt --tree level --tree rock -o two
same "$(cd two && echo *)" 'level.bxt rock.bxt'
cmp a/level.bxt two/level.bxt

# info tells of each tree what it tells of its file.
expect 0 "$boxtree" info all.bxt --json
cp out info.json
same "$(jq .members info.json)" 3
same "$(jq .trees info.json | jq length)" "$(($("$boxtree" info a/level.bxt --json | jq '.trees | length') + 2))"
same "$(jq -c '.trees[] | select(.name == "rock") | del(.name, .member, .cook_record, .material_names)' info.json)" \
  "$("$boxtree" info a/rock.bxt --json | jq -c '.trees[0] | del(.name)')"
same "$(jq -r '.trees[] | select(.name == "rock") | .cook_record' info.json)" "$("$boxtree" info a/rock.bxt --json | jq -r .cook_record)"
same "$(jq -c '.trees[] | select(.name == "rock") | .material_names' info.json)" '["wood","stone"]'
same "$(jq -c '.trees[] | select(.name == "tree") | .cook_record, .member.name' info.json)" "$(printf 'null\n"tree"')"
same "$(jq -c '[.trees[] | select(.member.has_scene) | .member.name] | unique' info.json)" '["level"]'
expect 0 "$boxtree" info all.bxt
grep -q '^pack: [0-9]* trees of 3 files$' out

# Answers are those of the files, materials and user data too.
for at in 0.3,0.1 -0.2,0.5 0,-0.9; do
  "$boxtree" query a/rock.bxt ray --origin "$at,9" --direction 0,0,-1 --json >alone
  "$boxtree" query all.bxt --tree rock ray --origin "$at,9" --direction 0,0,-1 --json >packed
  cmp alone packed
done
same "$("$boxtree" query all.bxt --tree tree point --at 3,1,0 --json)" "$("$boxtree" query a/tree.bxt point --at 3,1,0 --json)"
# A scene is queried in the pack, by any of its trees.
ray=(ray --origin 0.5,0.5,9 --direction 0,0,-1)
part=$(jq -r '[.trees[] | select(.member.has_scene) | .name][0]' info.json)
"$boxtree" query a/level.bxt "${ray[@]}" --json >alone
"$boxtree" query all.bxt --scene "$part" "${ray[@]}" --json >packed
cmp alone packed
grep -q '"instance"' packed
"$boxtree" query all.bxt --scene "${part%%/*}" "${ray[@]}" --json | cmp alone -
"$boxtree" query a/level.bxt --scene 0 "${ray[@]}" --json | cmp alone -
echo '{"kind":"ray","origin":[0.5,0.5,9],"direction":[0,0,-1]}' >batch
same "$("$boxtree" query all.bxt --scene "$part" --batch batch | jq .answers)" "$("$boxtree" query a/level.bxt --batch batch | jq .answers)"
expect 1 "$boxtree" query all.bxt --scene rock "${ray[@]}"
same "$(cat err)" 'boxtree: no_scene: all.bxt: --scene rock: this tree was cooked without --scene; --tree rock queries it'
expect 1 "$boxtree" query all.bxt --scene levl "${ray[@]}"
same "$(cat err)" "boxtree: tree_index: all.bxt: no scene, and no tree of one, is called \"levl\"; did you mean 'level'?"
"$boxtree" pack a/level.bxt a/rock.bxt --names path -o paths.bxt -q
expect 1 "$boxtree" query paths.bxt --scene level "${ray[@]}"
grep -q "did you mean 'a/level'?" err
expect 1 "$boxtree" query a/rock.bxt --scene level "${ray[@]}"
grep -q 'is called "level"; the file holds no scene$' err
expect 1 "$boxtree" query all.bxt --scene rock --tree rock "${ray[@]}"
same "$(head -1 err)" 'boxtree: usage: query ray: --tree excludes --scene'
expect 1 "$boxtree" query all.bxt --tree rok ray --origin 0,0,9 --direction 0,0,-1
grep -q "did you mean 'rock'" err
expect 1 "$boxtree" query all.bxt --tree level ray --origin 0,0,9 --direction 0,0,-1
grep -q '"level": that is a file or a scene of several, such as "level/' err
expect 0 "$boxtree" export all.bxt --tree rock -o rock.glb

# Names: two of one name are refused, with the remedy; paths keep them apart.
expect 1 "$boxtree" pack a/tree.bxt b/rock.bxt -o names.bxt
grep -q 'usage: pack: two files are named "tree", of a/tree.bxt and b/rock.bxt; name them after the paths of their files: --names path' err
[ ! -e names.bxt ]
expect 0 "$boxtree" pack a/rock.bxt ./b/rock.bxt -o names.bxt --names path
same "$("$boxtree" info names.bxt --json | jq -r '.trees[].name' | xargs)" 'a/rock b/rock'
# Found by a newcomer: the last part of a path alone was not told the rest.
expect 1 "$boxtree" query names.bxt --tree rock ray --origin 0,0,9 --direction 0,0,-1
grep -q "did you mean 'a/rock'?" err
expect 0 "$boxtree" split names.bxt -o by_path
cmp by_path/b/rock.bxt b/rock.bxt
expect 1 "$boxtree" pack a/rock.bxt a/rock.bxt -o twice.bxt
grep -q 'a/rock.bxt: it is given twice' err

# Packs go into packs as what is in them.
"$boxtree" pack a/rock.bxt -o first.bxt -q
"$boxtree" pack a/tree.bxt a/level.bxt -o second.bxt -q
expect 0 "$boxtree" pack second.bxt first.bxt -o merged.bxt
cmp merged.bxt all.bxt

# What is no input, and what is no output.
expect 2 "$boxtree" pack a/rock.bxt missing.bxt -o new.bxt
expect 3 "$boxtree" pack rock.obj -o new.bxt
expect 5 "$boxtree" pack blob.bxt -o new.bxt
grep -q 'blob.bxt: expected a file that can be mapped, found a compressed one' err
head -c -8 a/rock.bxt >short.bxt
expect 3 "$boxtree" pack short.bxt -o new.bxt
grep -q 'short.bxt' err
{ head -c 700 a/rock.bxt; printf '\125'; tail -c +702 a/rock.bxt; } >damaged.bxt
expect 3 "$boxtree" pack damaged.bxt -o new.bxt
grep -q 'checksum_mismatch: damaged.bxt: ' err
{ head -c 8 a/rock.bxt; printf '\2'; tail -c +10 a/rock.bxt; } >newer.bxt
expect 5 "$boxtree" pack newer.bxt -o new.bxt
[ ! -e new.bxt ]
expect 1 "$boxtree" pack a/rock.bxt a/tree.bxt -o a/rock.bxt
grep -q 'is the same file as the input a/rock.bxt' err
expect 1 "$boxtree" pack a/rock.bxt -o rock.obj
expect 1 "$boxtree" pack a/rock.bxt -o list
expect 1 "$boxtree" pack -o new.bxt
expect 1 "$boxtree" split a/rock.bxt -o taken
grep -q 'a/rock.bxt: expected a pack, found 1 tree that was cooked as one file' err
expect 1 "$boxtree" split all.bxt --tree rok -o nowhere
[ ! -e nowhere ]
cp all.bxt taken/rock.bxt
expect 1 "$boxtree" split taken/rock.bxt --tree rock -o taken
grep -q 'is the same file as the input' err
printf 'text' >taken/tree.bxt
expect 1 "$boxtree" split all.bxt -o taken
same "$(cat taken/tree.bxt)" text

# Damage of a pack is found, and told of the file that it is in.
size=$(wc -c <all.bxt)
{ head -c $((size - 200)) all.bxt; printf '\125'; tail -c 199 all.bxt; } >broken.bxt
expect 3 "$boxtree" verify broken.bxt
grep -q 'checksum_mismatch' err
expect 3 "$boxtree" split broken.bxt --tree tree -o broken
expect 0 "$boxtree" split broken.bxt --tree rock -o broken
# Found by an audit: what was sound behind a damaged file, or beside one without a header, stayed in the pack.
damaged_at() { # BYTE: of all.bxt, in ./broken.bxt
  { head -c "$1" all.bxt; printf '\125'; tail -c +$(($1 + 2)) all.bxt; } >broken.bxt
}
begin=$(python3 - <<'PYTHON'
pack, rock = open("all.bxt", "rb").read(), open("a/rock.bxt", "rb").read()
print(pack.index(rock))
PYTHON
)
for at in $((begin + 1)) $((begin + 700)); do # its first bytes, its sections
  damaged_at "$at"
  rm -rf broken
  expect 3 "$boxtree" split broken.bxt -o broken
  same "$(ls broken | xargs)" 'level.bxt tree.bxt'
  for file in level tree; do cmp a/$file.bxt broken/$file.bxt; done
  same "$(grep -c '^boxtree: .*: broken.bxt: member rock: ' err)" "$(wc -l <err)"
  grep -q '^broken: 2 files, ' out
  expect 3 "$boxtree" split broken.bxt -o broken --json
  same "$(jq -c '[.files[].member]' out)" '["level","tree"]'
done
# Both others: the status is that of the first, and each is told.
{ head -c $((begin + 8)) broken.bxt; printf '\2'; tail -c +$((begin + 10)) broken.bxt; } >twice.bxt
{ head -c $((size - 200)) twice.bxt; printf '\125'; tail -c 199 twice.bxt; } >broken.bxt
rm -rf broken
expect 5 "$boxtree" split broken.bxt -o broken
same "$(ls broken)" level.bxt
same "$(cut -d: -f2,4 err | xargs)" 'version_unsupported: member rock checksum_mismatch: member tree'

# The second reader agrees.
/usr/bin/python3 "$golden/read_bxt.py" all.bxt >theirs
keys='[.trees[] | {name,codec,faces,duplicates,triangles,nodes,depth}]'
same "$(jq -cS "$keys" theirs)" "$(jq -cS "$keys" info.json)"

# More trees than a file without members has, from a list: each is found, and taken out as it was.
mkdir many
cat >rename.py <<'PYTHON'
import struct, sys, xxhash
data = bytearray(open(sys.argv[1], "rb").read())
count = struct.unpack_from("<I", data, 12)[0]
end = 32 + 16 * count
for row in range(count):
    size, kind = struct.unpack_from("<Q", data, 32 + 16 * row)[0] & (1 << 40) - 1, data[32 + 16 * row + 5] >> 1 & 127
    end += -end % (8 if size < 4096 else 64)
    if kind == 7:
        place = row, end, size
    end += size
row, at, size = place
for number in range(int(sys.argv[2])):
    name = b"%0*d" % (size, number)
    data[at:at + size] = name
    struct.pack_into("<Q", data, 32 + 16 * row + 8, xxhash.xxh3_64_intdigest(name))
    struct.pack_into("<Q", data, 24, xxhash.xxh3_64_intdigest(bytes(data[:24] + data[32:32 + 16 * count])))
    open("many/%s.bxt" % name.decode(), "wb").write(data)
PYTHON
cp rock.obj sixsix.obj
"$boxtree" cook sixsix.obj -o sixsix.bxt -q
/usr/bin/python3 rename.py sixsix.bxt 5000
ls many/* >list
expect 0 timeout 120 "$boxtree" pack @list -o many.bxt
grep -q '^many.bxt: 5000 trees of 5000 files' out
expect 0 timeout 60 "$boxtree" verify many.bxt
expect 0 timeout 20 "$boxtree" split many.bxt --tree 004711 -o one
cmp one/004711.bxt many/004711.bxt
echo "packs hold what was put in"
