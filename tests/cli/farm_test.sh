#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cooks by their keys: manifests, shards, journals and caches give the bytes of single cooks, whatever fails or is killed.
set -euo pipefail
# shellcheck source=tests/cli/expect.sh
. "$(dirname "$0")/expect.sh"
boxtree=$1 level=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A grid of N x N quads, bent by N.
make_mesh() {
  awk -v n="$1" 'BEGIN {
    for (y = 0; y <= n; ++y) for (x = 0; x <= n; ++x) printf "v %d %d %.6f\n", x, y, sin(x * y / n)
    for (y = 0; y < n; ++y) for (x = 1; x <= n; ++x) {
      a = y * (n + 1) + x
      printf "f %d %d %d\nf %d %d %d\n", a, a + 1, a + n + 2, a, a + n + 2, a + n + 1
    }
  }' >"$2"
}
mkdir in single # a manifest makes the folders of its outputs
jobs=24
for i in $(seq 1 $jobs); do
  make_mesh $((i + 3)) "in/m$i.obj"
  echo "{\"inputs\":[\"in/m$i.obj\"],\"output\":\"cooked/m$i.bxt\"}"
  "$boxtree" cook "in/m$i.obj" -o "single/m$i.bxt" --quiet
done >jobs.jsonl
(cd single && sha256sum ./*.bxt) >single.sums
same_as_single() { (cd "${1:-cooked}" && sha256sum -c --quiet ../single.sums); }
count_of() { jq -s "map(select($1)) | length" out.jsonl; }
cook_all() { expect "${status:-0}" "$boxtree" cook --manifest jobs.jsonl --json "$@"; cp out out.jsonl; }

# `key`: the same for the same job, whatever the folder; a line has key, output and inputs.
expect 0 "$boxtree" key in/m1.obj -o x.bxt
same "$(cut -f2- out)" "$(printf 'x.bxt\tin/m1.obj')"
key=$(cut -f1 out)
cp in/m1.obj .
expect 0 "$boxtree" key m1.obj --trusted --for balance
same "$(cut -f1 out)" "$key"
expect 0 "$boxtree" key m1.obj --exact
[ "$(cut -f1 out)" != "$key" ]
expect 0 "$boxtree" key m1.obj --explain
same "$(sha256sum <out | cut -d' ' -f1)" "$key"
expect 0 "$boxtree" key - --format obj <m1.obj
expect 0 "$boxtree" key in/m1.obj --inputs
same "$(cat out)" in/m1.obj
expect 0 "$boxtree" key --manifest jobs.jsonl
same "$(wc -l <out)" $jobs
cp out keys
expect 0 "$boxtree" key --manifest jobs.jsonl --json
same "$(jq -r '.jobs[] | .key + "\t" + .output + "\t" + .inputs[0].file' out)" "$(cat keys)"
same "$(jq -r '.jobs[0].inputs[0].sha256' out)" "$(sha256sum in/m1.obj | cut -d' ' -f1)"
expect 1 "$boxtree" key
expect 2 "$boxtree" key absent.obj
expect 1 "$boxtree" key in/m1.obj --manifest jobs.jsonl

# Options of a run, which no key has, change no byte.
for option in "--jobs 1" --quiet --json --why --candidates; do
  # shellcheck disable=SC2086 # words
  expect 0 "$boxtree" cook in/m9.obj -o run.bxt $option
  cmp run.bxt single/m9.bxt
done
expect 0 "$boxtree" cook - --format obj -o run.bxt <in/m9.obj

# A manifest: the bytes of single cooks, and a second run cooks nothing.
cook_all
same "$(count_of '.cached or .there')" 0
same_as_single
same "$(jq -r '.key + "\t" + .output' out.jsonl | sort)" "$(cut -f1,2 keys | sort)"
same "$(jq -s '[.[].bytes] | add' out.jsonl)" "$(cat cooked/*.bxt | wc -c)"
same "$(jq -s 'map(.schema) | unique | .[]' out.jsonl)" 1
cook_all
same "$(count_of .there)" $jobs
# What is away, damaged or made of another input is cooked, and nothing else.
rm cooked/m3.bxt
printf x >>cooked/m4.bxt
cp cooked/m5.bxt cooked/m6.bxt
echo '# edited' >>in/m7.obj
cook_all
same "$(jq -r 'select(.there | not) | .output' out.jsonl | sort | xargs)" "cooked/m3.bxt cooked/m4.bxt cooked/m6.bxt cooked/m7.bxt"
sed -i '$d' in/m7.obj
cook_all
same_as_single
# What the journal remembers of files, once they have rested: no file is read again, and each change is seen, also by
# other bytes of the same size with the time of the old ones.
sleep 2.1
cook_all
same "$(count_of .there)" $jobs
same "$(grep -c '"file"' jobs.jsonl.done | awk -v n=$((2 * jobs)) '{ print ($1 >= n) }')" 1
cp jobs.jsonl.done rested.done
cook_all
same "$(count_of .there)" $jobs
cmp jobs.jsonl.done rested.done
cp -p in/m7.obj kept.obj
sed -i 's/^v 0 0 .*/v 0 0 0.500000/' in/m7.obj
same "$(wc -c <in/m7.obj)" "$(wc -c <kept.obj)"
touch -r kept.obj in/m7.obj
cp -p cooked/m3.bxt kept.bxt
printf x | dd of=cooked/m3.bxt bs=1 seek=200 conv=notrunc status=none
touch -r kept.bxt cooked/m3.bxt
cook_all
same "$(jq -r 'select(.there | not) | .output' out.jsonl | sort | xargs)" "cooked/m3.bxt cooked/m7.bxt"
cp -p kept.obj in/m7.obj
cook_all
same_as_single
cook_all --reread
same "$(count_of .there)" $jobs
expect 1 "$boxtree" cook in/m1.obj -o x.bxt --reread

# Killed at any moment and started again, it goes on: no output is missing, wrong or half, and nothing else is left.
for i in $(seq 1 8); do
  rm -rf cooked jobs.jsonl.done
  mkdir cooked
  "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 2 --cache "killed$((i % 3))" &
  sleep "0.0$((i * 2 % 10))$i"
  kill -9 $! 2>/dev/null || true
  wait $! 2>/dev/null || true
  cook_all --cache "killed$((i % 3))"
  same_as_single
  same "$(find cooked -type f | wc -l)" $jobs
done

# Shards: each job once, whatever their number; a job that is added moves no other.
for shards in 2 5; do
  rm -rf cooked
  mkdir cooked
  : >all.jsonl
  for i in $(seq 0 $((shards - 1))); do
    cook_all --shard "$i/$shards"
    cat out.jsonl >>all.jsonl
    # By the name of the output, as anyone can tell it.
    jq -r '.output' out.jsonl | python3 -c "
import hashlib, sys
sys.exit(any(int(hashlib.sha256(name.strip().encode()).hexdigest()[:16], 16) % $shards != $i for name in sys.stdin))"
    jq -r '"'"$i"' " + .output' out.jsonl >>shards.$shards
    "$boxtree" key --manifest jobs.jsonl --shard "$i/$shards" | cut -f2 | sort >outputs
    jq -r .output out.jsonl | sort | cmp - outputs
  done
  same "$(wc -l <all.jsonl)" $jobs
  same_as_single
done
cp jobs.jsonl before.jsonl
make_mesh 99 in/new.obj
echo '{"inputs":["in/new.obj"],"output":"cooked/new.bxt"}' >>jobs.jsonl
for i in 0 1 2 3 4; do
  cook_all --shard "$i/5" --journal "again.$i"
  jq -r 'select(.output != "cooked/new.bxt") | "'"$i"' " + .output' out.jsonl
done | sort >moved
sort shards.5 | cmp - moved
mv before.jsonl jobs.jsonl
# Nothing is read of the jobs of others: inputs that are not there, or hang, are no matter.
mkfifo in/pipe.obj
for i in $(seq 1 8); do echo "{\"inputs\":[\"in/pipe.obj\"],\"output\":\"pipe$i.bxt\"}"; done >pipes.jsonl
head -1 jobs.jsonl >>pipes.jsonl
ours=$(python3 -c "import hashlib; print(int(hashlib.sha256(b'cooked/m1.bxt').hexdigest()[:16], 16) % 64)")
others=$(python3 -c "
import hashlib
print(sum(int(hashlib.sha256(b'pipe%d.bxt' % i).hexdigest()[:16], 16) % 64 == $ours for i in range(1, 9)))")
same "$others" 0
timeout 20 "$boxtree" cook --manifest pipes.jsonl --shard "$ours/64" --json >out
same "$(jq -r .output out)" cooked/m1.bxt

# One bad mesh fails its own line, a missing one may pass, and the others are cooked.
rm -rf cooked
mkdir cooked
echo 'v 0 0 0' >in/bad.obj
sed 's|in/m3.obj|in/bad.obj|' jobs.jsonl >bad.jsonl
expect 3 "$boxtree" cook --manifest bad.jsonl --json
cp out out.jsonl
same "$(wc -l <out)" $jobs
same "$(jq -c 'select(.error) | [.line, .error.name, .error.status, .error.may_pass]' out)" '[3,"no_faces",3,false]'
grep -q '^boxtree: no_faces: bad.jsonl:3: in/bad.obj' err
sed 's|in/m4.obj|in/absent.obj|' bad.jsonl >absent.jsonl
expect 2 "$boxtree" cook --manifest absent.jsonl --json --journal absent.done
same "$(jq -c 'select(.error) | [.line, .key == null, .error.may_pass]' out | sort | xargs)" '[3,false,false] [4,true,true]'
# A manifest in a pipe has no place beside it.
expect 2 "$boxtree" cook --manifest <(printf '')
grep -q '^boxtree: write_failed: /dev/fd/.*; --journal FILE names another place for it$' err
# Found by a newcomer: the journal was written behind a mesh, or behind the manifest.
cp in/m1.obj kept.obj
expect 1 "$boxtree" cook --manifest absent.jsonl --journal kept.obj
cmp in/m1.obj kept.obj
same "$(cat err)" 'boxtree: usage: cook: --journal kept.obj: expected a journal of cooks there, or none, found another file; it would be lost: remove it, or name another'
echo '{"output":"first.bxt","inputs":["in/m1.obj"]}' >first.jsonl
cp first.jsonl kept.jsonl
expect 1 "$boxtree" cook --manifest first.jsonl --journal first.jsonl
cmp first.jsonl kept.jsonl
# A reason that stays: no other run writes it either.
echo "{\"inputs\":[\"in/m1.obj\"],\"output\":\"cooked/$(printf 'x%.0s' $(seq 300)).bxt\"}" >long.jsonl
expect 3 "$boxtree" cook --manifest long.jsonl --json
same "$(jq -c '[.error.name, .error.status, .error.may_pass]' out)" '["write_failed",2,false]'
# Found by a newcomer: the word behind an unknown option was told to be a mesh, which excludes --manifest.
expect 1 "$boxtree" key --manifest bad.jsonl --fail-fast
same "$(head -1 err)" "boxtree: usage: key: '--fail-fast' is no option of key, but of cook"
expect 1 "$boxtree" cook --manifest bad.jsonl --cahce x
same "$(head -1 err)" "boxtree: usage: cook: '--cahce' is no option; did you mean '--cache'?"
# Found by a newcomer: names of something else are retried for ever.
mkdir -p folder
echo notes >notes.txt
printf '{"inputs":["in/m1.obj"],"output":"%s"}\n' notes.txt folder notes.txt/m.bxt /dev/null >names.jsonl
echo '{"inputs":["in"],"output":"cooked/folder.bxt"}' >>names.jsonl
expect 3 "$boxtree" cook --manifest names.jsonl --json
same "$(jq -c '[.line, .error.status, .error.may_pass]' out | sort | xargs)" \
  '[1,2,false] [2,2,false] [3,2,false] [4,2,false] [5,2,false]'
same "$(cat notes.txt)" notes
# Its shard alone tells it.
for i in 0 1 2; do "$boxtree" cook --manifest absent.jsonl --json --shard "$i/3" 2>/dev/null || true; done | jq -c 'select(.line == 4) | .line' >told
same "$(wc -l <told)" 1
(echo '{"inputs":["in/bad.obj"],"output":"cooked/first.bxt"}'; cat jobs.jsonl) >fast.jsonl
expect 3 "$boxtree" cook --manifest fast.jsonl --json --fail-fast --jobs 1
same "$(wc -l <out)" 1
expect 3 "$boxtree" cook --manifest fast.jsonl --json --keep-going --journal keep.done
same "$(wc -l <out)" $((jobs + 1))
expect 1 "$boxtree" cook --manifest fast.jsonl --keep-going --fail-fast

# A manifest that is none, or contradicts itself, cooks nothing.
refused() { # MESSAGE LINE...
  rm -f never.bxt
  (head -1 jobs.jsonl | sed 's|cooked/m1.bxt|never.bxt|'; printf '%s\n' "${@:2}") >wrong.jsonl
  expect 3 "$boxtree" cook --manifest wrong.jsonl
  grep -qF "$1" err || { echo "expected '$1', found"; cat err; exit 1; }
  [ ! -e never.bxt ]
}
refused 'wrong.jsonl:2: expected one JSON object' '{"inputs":["in/m2.obj"],"outp'
refused 'wrong.jsonl:3: output: ./never.bxt is that of line 1, too' '' '{"inputs":["in/m2.obj"],"output":"./never.bxt"}'
refused 'wrong.jsonl:2: inputs: never.bxt is the output of line 1' '{"inputs":["never.bxt"],"output":"b.bxt"}'
refused "wrong.jsonl:2: options: cook: '--exat' is no option; did you mean '--exact'?" \
  '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["--exat"]}'
refused 'wrong.jsonl:2: options: cook: --grid-bits: ' '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["--grid-bits","99"]}'
refused 'wrong.jsonl:2: options: ' '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["--exact","--tolerance","1"]}'
refused 'wrong.jsonl:2: options: ' '{"profile":"p.toml","output":"b.bxt","options":["--exact"]}'
refused 'wrong.jsonl:2: options: ' '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["--json"]}'
refused 'wrong.jsonl:2: options: ' '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["other.obj"]}'
refused 'wrong.jsonl:2: options: ' '{"inputs":["in/m2.obj"],"output":"b.bxt","options":["--depfile","d"]}'
refused 'expected another ending than .obj' '{"inputs":["in/m2.obj"],"output":"b.obj"}'
expect 2 "$boxtree" cook --manifest absent-manifest.jsonl
for shard in 3/3 -1/3 1 x/y 1/0 0/99999999999; do expect 1 "$boxtree" cook --manifest jobs.jsonl --shard "$shard"; done
for memory in 0 -1 x 1X ''; do expect 1 "$boxtree" cook --manifest jobs.jsonl --memory "$memory"; done
expect 1 "$boxtree" cook in/m1.obj -o x.bxt --shard 0/2
expect 1 "$boxtree" cook --manifest jobs.jsonl --exact
expect 1 "$boxtree" cook --manifest jobs.jsonl -o x.bxt

# A budget for one mesh at a time, or none, is no error; lines of options and of profiles; standard input.
rm -rf cooked jobs.jsonl.done
mkdir cooked
cook_all --memory 1K
same_as_single
printf '[scene]\nsource = "in/m2.obj"\n' >scene.toml
{
  echo '{"inputs":["in/m1.obj","in/m2.obj"],"output":"two.bxt","options":["--exact","--for","speed"]}'
  echo '{"profile":"scene.toml","output":"scene.bxt"}'
} >mixed.jsonl
expect 0 "$boxtree" cook --manifest - --quiet <mixed.jsonl
[ ! -s out ] || { cat out; exit 1; }
expect 0 "$boxtree" cook in/m1.obj in/m2.obj -o two_single.bxt --exact --for speed
cmp two.bxt two_single.bxt
expect 0 "$boxtree" cook --profile scene.toml -o scene_single.bxt
cmp scene.bxt scene_single.bxt
echo 'no cooked file' >cooked/m1.bxt # would be lost
status=3 cook_all --journal other.done
same "$(cat cooked/m1.bxt)" 'no cooked file'
same "$(jq -r 'select(.error) | .line' out.jsonl)" 1

# The cache: single cooks and manifests have each other's outputs; damage is a miss, and is replaced.
rm -rf cooked jobs.jsonl.done
mkdir cooked
expect 0 "$boxtree" cook in/m8.obj -o m8.bxt --cache cache --json
same "$(jq .cached out)" false
cook_all --cache cache
same "$(jq -r 'select(.cached) | .output' out.jsonl)" cooked/m8.bxt
same_as_single
rm -rf cooked jobs.jsonl.done
mkdir cooked
cook_all --cache cache
same "$(count_of .cached)" $jobs
same_as_single
expect 0 "$boxtree" cook in/m8.obj -o again.bxt --cache cache
grep -q 'from the cache' out
cmp again.bxt single/m8.bxt
rm again.bxt
digest=$(sha256sum single/m8.bxt | cut -d' ' -f1)
damaged=cache/cas/${digest:0:2}/$digest
for damage in 'truncate -s -1' 'truncate -s 0' 'rm' 'sed -i s/./x/40'; do
  $damage "$damaged"
  expect 0 "$boxtree" cook in/m8.obj -o again.bxt --cache cache --json
  same "$(jq .cached out)" false
  cmp again.bxt single/m8.bxt
  rm again.bxt
  expect 0 "$boxtree" cook in/m8.obj -o again.bxt --cache cache --json
  same "$(jq .cached out)" true
  cmp again.bxt single/m8.bxt
  rm again.bxt
done
# Two runs at once, with journals of their own.
rm -rf cooked two cache
mkdir cooked two
sed 's|cooked/|two/|' jobs.jsonl >two.jsonl
"$boxtree" cook --manifest two.jsonl --cache cache --quiet &
cook_all --cache cache --journal one.done
wait $!
same_as_single
same_as_single two
# One journal is one run's at a time.
(exec 9>>jobs.jsonl.done; flock 9; status=2 cook_all; grep -q 'another process' err)
# An audit: what the cache has is what a cook makes, or the run says so, with a status of its own.
expect 0 "$boxtree" cook in/m8.obj -o audited.bxt --cache cache --audit 1 --json
same "$(jq .cached out)" false
lie() { # KEY FILE: an entry as anyone may make one, of another file
  python3 - "$@" <<'END'
import hashlib, json, pathlib, sys
key, file = sys.argv[1:]
body = pathlib.Path(file).read_bytes()
digest = hashlib.sha256(body).hexdigest()
text = json.dumps({"key": key, "output": digest, "bytes": len(body), "report": "[]"})
for place, data in (f"cas/{digest[:2]}/{digest}", body), \
                   (f"ac/{key[:2]}/{key}", f"boxtree cache 1 {hashlib.sha256(text.encode()).hexdigest()}\n{text}".encode()):
    path = pathlib.Path("cache", place)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
END
}
key=$("$boxtree" key in/m8.obj | cut -f1)
lie "$key" single/m9.bxt
rm audited.bxt
expect 7 "$boxtree" cook in/m8.obj -o audited.bxt --cache cache --audit 1
grep -q '^boxtree: difference: audited.bxt: audit: under the key' err
cmp audited.bxt single/m8.bxt
lie "$key" single/m9.bxt
sed 's|in/m1.obj|in/absent.obj|' jobs.jsonl >audit.jsonl # says first what no later run finds
expect 7 "$boxtree" cook --manifest audit.jsonl --cache cache --audit 1 --json --journal audit.done
same "$(jq -c 'select(.error) | [.output, .error.status, .error.may_pass]' out | sort | xargs)" \
  '[cooked/m1.bxt,2,true] [cooked/m8.bxt,7,false]'
grep -q '^boxtree: difference: audit.jsonl:8: cooked/m8.bxt: audit: ' err
cmp cooked/m8.bxt single/m8.bxt
expect 0 "$boxtree" cook in/m8.obj -o audited.bxt --cache cache --audit 1
# A size: it is kept to.
cook_all --cache small --cache-size 20K --journal small.done
rm -rf cooked small small.done
mkdir cooked
cook_all --cache small --cache-size 20K --journal small.done
same_as_single
same "$(find small -type f ! -name size -printf '%s\n' | awk '{ s += $1 } END { print (s <= 20480) }')" 1
# A folder that takes nothing.
echo file >nofolder
expect 2 "$boxtree" cook in/m8.obj -o x.bxt --cache nofolder
expect 1 "$boxtree" cook in/m8.obj -o - --cache cache
expect 1 "$boxtree" cook in/m8.obj -o x.bxt --cache cache --write-reordered r.obj
expect 1 "$boxtree" cook in/m8.obj -o x.bxt --cache cache --why
expect 1 "$boxtree" cook in/m8.obj -o x.bxt --audit 0.5
expect 1 "$boxtree" cook in/m8.obj -o x.bxt --cache cache --audit 2
# Warnings come again.
printf 'mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >lost.obj
for cached in false true; do
  expect 0 "$boxtree" cook lost.obj -o lost.bxt --cache cache --json
  grep -q 'warning: .*lost.mtl' err
  same "$(jq -c '[.cached, (.warnings | length)]' out)" "[$cached,1]"
done

# Found by an audit: warnings of the cache itself were on standard error alone.
for cache in http://127.0.0.1:1/x broken; do
  rm -rf broken/ac broken/cas lost.done
  mkdir -p broken/ac broken/cas
  for i in 0 1 2 3 4 5 6 7 8 9 a b c d e f; do
    for j in 0 1 2 3 4 5 6 7 8 9 a b c d e f; do echo file >"broken/cas/$i$j"; done
  done
  expect 0 "$boxtree" cook lost.obj -o lost.bxt --cache "$cache" --json
  same "$(jq -r '.warnings[]' out)" "$(sed -n 's/^boxtree: warning: //p' err)"
  same "$(jq -r '.warnings[]' out | grep -c '^--cache: ')" 1
  grep -q 'lost.mtl' out
  echo '{"inputs":["lost.obj"],"output":"lost.bxt"}' >lost.jsonl
  expect 0 "$boxtree" cook --manifest lost.jsonl --cache "$cache" --json --journal lost.done
  same "$(jq -r '.warnings[]' out | sed 's/^lost.obj/lost.jsonl:1: lost.obj/')" "$(sed -n 's/^boxtree: warning: //p' err)"
  same "$(jq -r '.warnings[]' out | grep -c '^--cache: ')" 1
done

# Formats that assimp reads are first tried in another process, while other threads cook.
for i in $(seq 1 12); do
  cp "$level" "in/level$i.gltf"
  echo "{\"inputs\":[\"in/level$i.gltf\"],\"output\":\"level$i.bxt\"}"
  echo "{\"inputs\":[\"in/m$i.obj\"],\"output\":\"beside$i.bxt\"}"
done >levels.jsonl
expect 0 "$boxtree" cook --manifest levels.jsonl --jobs 8 --quiet
expect 0 "$boxtree" cook in/level7.gltf -o level_single.bxt --quiet
cmp level7.bxt level_single.bxt

# Found by an audit: names of what a mesh refers to were looked for in it each time. They are remembered, and each change of what
# decides them is seen.
mkdir named
printf 'mtllib first.mtl later.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >named/a.obj
echo 'newmtl first' >named/first.mtl
python3 - <<'END'
import json, struct
def write(name, buffer):
    accessor = {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}
    json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [accessor],
               "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": buffer, "byteLength": 36}]}, open(name, "w"))
write("named/b.gltf", "one.bin")
write("named/other.gltf", "two.bin")
for name, last in ("named/one.bin", 0.5), ("named/two.bin", 1.0), ("named/third.bin", 0.25):
    open(name, "wb").write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, last))
END
for mesh in a.obj b.gltf; do echo "{\"inputs\":[\"named/$mesh\"],\"output\":\"named/$mesh.bxt\"}"; done >named.jsonl
sleep 2.1
cook_named() { # OUTPUT...: those that are cooked, and not there already; the others have the bytes of single cooks
  expect 0 "$boxtree" cook --manifest named.jsonl --json
  same "$(jq -r 'select(.there | not) | .output' out | sort | xargs)" "$*"
  for mesh in a.obj b.gltf; do
    "$boxtree" cook "named/$mesh" -o single.bxt --quiet 2>/dev/null
    cmp single.bxt "named/$mesh.bxt"
  done
}
cook_named named/a.obj.bxt named/b.gltf.bxt
same "$(grep -c '"reads"' named.jsonl.done)" 2
sleep 2.1
cook_named
cook_named
same "$(grep -c '"reads"' named.jsonl.done)" 2
echo 'newmtl later' >named/later.mtl # was missing
cook_named named/a.obj.bxt
rm named/first.mtl
cook_named named/a.obj.bxt
touch -r named/one.bin time
cat named/third.bin >named/one.bin
touch -r time named/one.bin
cook_named named/b.gltf.bxt
cp named/other.gltf named/b.gltf # refers to another
cook_named named/b.gltf.bxt
cook_named

# make and ninja with a cache, by the rules of docs/FARM.md: what is away is taken from it, with the depfile of a cook, and what an
# input refers to still cooks anew. GNU parallel, where it is installed.
mkdir built
printf 'mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >built/a.obj
echo 'newmtl a' >built/m.mtl
cd built
printf 'a.bxt: a.obj\n\t"%s" cook $< -o $@ --depfile $@.d --jobs 1 --json --cache ../built.cache\n-include a.bxt.d\n' "$boxtree" >Makefile
# shellcheck disable=SC2016 # variables of ninja
printf 'rule cook\n  command = "%s" cook $in -o $out --depfile $out.d --jobs 1 --json --cache ../built.cache\n  depfile = $out.d\n  deps = gcc\nbuild a.bxt: cook a.obj\n' \
  "$boxtree" >build.ninja
cached_by() { expect 0 "$@"; sed -n 's/.*"cached": *\([a-z]*\).*/\1/p' out; }
same "$(cached_by make)" false
cp a.bxt.d cooked.d
for engine in make "ninja -v"; do
  rm -f a.bxt a.bxt.d
  # shellcheck disable=SC2086 # words
  same "$(cached_by $engine)" true
  [ ! -e a.bxt.d ] || cmp a.bxt.d cooked.d
  # shellcheck disable=SC2086
  same "$(cached_by $engine)" ""
  sleep 0.02
  echo "# for $engine" >>m.mtl
  # shellcheck disable=SC2086
  same "$(cached_by $engine)" false
done
cd ..
if parallel --version >version 2>/dev/null && grep -q '^GNU parallel' version; then
  mkdir side
  expect 0 parallel --will-cite "$boxtree" cook "{}" -o "side/{/.}.bxt" --jobs 1 --quiet --cache side.cache ::: in/m[0-9].obj in/m1[0-9].obj in/m2[0-4].obj
  same_as_single side
fi

# Response files: one word a line.
printf 'in/m1.obj\n\n-o\ntwo words.bxt\n' >words
expect 0 "$boxtree" cook @words --quiet
cmp 'two words.bxt' single/m1.bxt
expect 2 "$boxtree" cook @absent
cp in/m1.obj @m.obj
expect 0 "$boxtree" cook ./@m.obj -o at.bxt --quiet
echo "farm: keys, manifests, shards, journals and caches"
