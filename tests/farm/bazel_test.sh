#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The rules of bazel/, as GUIDE uses them, with a remote cache by nginx: what is cooked equals what the command line cooks, a
# second checkout takes all of it from the cache, what changed alone is cooked again, and an input that is not declared fails.
#   tests/farm/bazel_test.sh BOXTREE
# shellcheck disable=SC2016 # dollars of nginx and Bazel
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
boxtree=$(realpath "$1")
work=$(mktemp -d)
port=$((20000 + RANDOM % 20000))
bazel() { command bazel --output_user_root="$work/bazel" "$@"; }
cleanup() {
  local status=$?
  for checkout in "$work"/checkout*; do
    [ ! -d "$checkout" ] || (cd "$checkout" && bazel shutdown >/dev/null 2>&1) || true
  done
  if [ -f "$work/nginx.pid" ]; then
    kill "$(cat "$work/nginx.pid")"
    # nginx removes it when it ends, which must not be while the folder is walked below.
    for _ in $(seq 100); do [ -e "$work/nginx.pid" ] || break; sleep 0.1; done
  fi
  [ $status = 0 ] || tail -n 20 "$work"/{build,nginx}.log >&2
  chmod -R u+w "$work"
  rm -rf "$work"
}
trap cleanup EXIT
fail() {
  echo "bazel_test.sh: $*" >&2
  exit 1
}

mkdir -p "$work/cache" "$work/tmp" "$work/bin"
cat >"$work/nginx.conf" <<END
load_module /usr/lib/nginx/modules/ngx_http_dav_ext_module.so;
pid $work/nginx.pid; error_log $work/nginx.log; user root;
events {}
http {
  access_log $work/access.log; client_max_body_size 0; client_body_temp_path $work/tmp;
  server { listen 127.0.0.1:$port; location / { root $work/cache; dav_methods PUT; create_full_put_path on; } }
}
END
nginx -c "$work/nginx.conf"

# The program is a link, so that a test can put another in its place.
cp "$boxtree" "$work/bin/boxtree"
checkout() {
  mkdir -p "$1/props"
  cp "$source"/samples/meshes/{crate.obj,crate.mtl,level.obj} "$1/props/"
  cp "$source"/samples/level/{level.gltf,scene.toml} "$1/"
  # A glTF file whose buffer is a file of its own.
  python3 - "$source/samples/level/level.gltf" "$1/outside.gltf" "$1/outside.bin" <<'END'
import base64, json, sys
document = json.load(open(sys.argv[1]))
data = b"".join(base64.b64decode(b["uri"].split(",", 1)[1]) for b in document["buffers"])
assert len(document["buffers"]) == 1
document["buffers"][0]["uri"] = "outside.bin"
json.dump(document, open(sys.argv[2], "w"))
open(sys.argv[3], "wb").write(data)
END
  cp "$source"/samples/meshes/crate.{obj,mtl} "$1/"
  python3 - "$source" "$1" "$work/bin/boxtree" <<'END'
import pathlib, sys
source, checkout, program = map(pathlib.Path, sys.argv[1:])
sys.path.insert(0, str(source / "tests/docs"))
from blocks import blocks_of
workspace, build = [text for language, text, _ in blocks_of(source / "docs/GUIDE.md") if language == "starlark"]
workspace = workspace.replace("/usr/local/share/boxtree/bazel", str(source / "bazel"))
workspace = workspace.replace('boxtree_tool(name = "boxtree")', f'boxtree_tool(name = "boxtree", path = "{program}")')
(checkout / "WORKSPACE").write_text(workspace)
(checkout / "BUILD").write_text(build + """
boxtree_mesh(
    name = "outside",
    srcs = ["outside.gltf"],
    data = ["outside.bin"],
)
""")
END
  cat >"$1/props/BUILD" <<'END'
load("@boxtree_rules//:defs.bzl", "boxtree_mesh")

boxtree_mesh(
    name = "both",
    srcs = [
        "crate.obj",
        "level.obj",
    ],
    data = ["crate.mtl"],
    out = "props.bxt",
)
END
}
# build CHECKOUT [TARGET...]: in $work/build.log.
build() {
  local checkout=$1
  shift
  (cd "$checkout" && bazel build --spawn_strategy=sandboxed --noshow_progress --remote_cache="http://127.0.0.1:$port" "${@:-//...}") \
    >"$work/build.log" 2>&1
}
# processes OF: how many of the last build were of this kind: remote cache hit, linux-sandbox or another sandbox, internal.
processes() {
  sed -n 's/^INFO: [0-9]* processes*: \(.*\)\.$/\1/p' "$work/build.log" | tr ',' '\n' | awk -v kind="$1" '$0 ~ kind {n += $1} END {print n + 0}'
}
expect() { # WHAT CACHED COOKED
  [ "$(processes 'remote cache hit')" = "$2" ] || fail "$1: expected $2 of the cache, found $(processes 'remote cache hit')"
  [ "$(processes sandbox)" = "$3" ] || fail "$1: expected $3 cooked, found $(processes sandbox)"
}

checkout "$work/checkout1"
build "$work/checkout1"
expect "the first build" 0 4
(
  cd "$work/checkout1"
  "$boxtree" cook --profile scene.toml -o scene.bxt -q
  "$boxtree" cook crate.obj -o crate.bxt --grid-bits 20 -q
  "$boxtree" cook props/crate.obj props/level.obj -o props.bxt -q
  cmp scene.bxt bazel-bin/level.bxt
  cmp crate.bxt bazel-bin/crate.bxt
  cmp props.bxt bazel-bin/props/props.bxt
  "$boxtree" verify bazel-bin/outside.bxt >/dev/null
)

build "$work/checkout1"
expect "nothing changed" 0 0

checkout "$work/checkout2/at/another/path"
second=$work/checkout2/at/another/path
build "$second"
expect "a second checkout" 4 0
cmp "$second/bazel-bin/level.bxt" "$work/checkout1/bazel-bin/level.bxt"

echo '# touched' >>"$second/props/crate.obj"
build "$second"
expect "a mesh that changed" 0 1
sed -i 's/--grid-bits=20/--grid-bits=21/' "$second/BUILD"
build "$second"
expect "options that changed" 0 1
printf '\0' >>"$second/outside.bin"
build "$second"
expect "a buffer that changed" 0 1

echo '# touched' >>"$second/props/crate.mtl"
build "$second"
expect "a material library that changed" 0 1

# Another program: here the same one with a byte more.
printf '\0' >>"$work/bin/boxtree"
build "$second"
expect "a program that changed" 0 4

sed -i '/data = \["outside.bin"\]/d' "$second/BUILD"
if build "$second" //:outside; then fail "cooks with a buffer that is not declared"; fi
grep -q 'outside.bin' "$work/build.log" || fail "does not say which input was not declared"
# Found by an audit: without its material library a mesh was cooked to other bytes, with a warning.
sed -i '/data = \["crate.mtl"\]/d' "$second/props/BUILD"
if build "$second" //props:both; then fail "cooks with a material library that is not declared"; fi
grep -q 'crate.mtl' "$work/build.log" || fail "does not say which library was not declared"
(cd "$second" && bazel shutdown)
echo "bazel: 4 cooked, 4 of the cache in a second checkout, what changed alone cooked again"
