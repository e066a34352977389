#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cooks with a cache on a server, nginx with WebDAV where it is installed: what another checkout has cooked is not cooked again, and a
# server that is damaged, full, lying, or away costs time and never a byte.
#   tests/farm/http_test.sh BOXTREE
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=tests/cli/expect.sh
. "$source/tests/cli/expect.sh"
boxtree=$(realpath "$1")
work=$(mktemp -d)
cleanup() {
  local status=$?
  [ ! -f "$work/nginx.pid" ] || kill "$(cat "$work/nginx.pid")"
  [ -z "${faulty_input:-}" ] || exec {faulty_input}>&-
  [ $status = 0 ] || tail -n 20 "$work"/{err,nginx.log} >&2 || true
  rm -rf "$work"
}
trap cleanup EXIT
cd "$work"
modules=/usr/lib/nginx/modules/ngx_http_dav_ext_module.so
PATH=$PATH:/usr/sbin

# A server whose faults are named in the URL; nginx, too, if it is there.
mkfifo input
python3 "$source/tests/farm/faulty_server.py" <input >port &
exec {faulty_input}>input
until [ -s port ]; do sleep 0.05; done
faulty=http://127.0.0.1:$(cat port)
start_nginx() {
  mkdir -p served/{all,small,fixed} tmp
  cat >nginx.conf <<END
load_module $modules;
pid $work/nginx.pid; error_log $work/nginx.log;
$([ "$(id -u)" -ne 0 ] || echo "user root;")
events {}
http {
  access_log off; client_body_temp_path $work/tmp;
  server {
    listen 127.0.0.1:$nginx_port; root $work/served;
    location / { dav_methods PUT; create_full_put_path on; client_max_body_size 0; }
    location /small { dav_methods PUT; create_full_put_path on; client_max_body_size 1k; }
    location /fixed { }
  }
}
END
  nginx -c "$work/nginx.conf"
}
server=faulty_server.py url=$faulty/good
if [ -e "$modules" ] && command -v nginx >/dev/null; then
  nginx_port=$((20000 + RANDOM % 10000))
  until start_nginx 2>/dev/null || [ $nginx_port = 30100 ]; do nginx_port=$((nginx_port + 1)); done
  server=nginx url=http://127.0.0.1:$nginx_port/all
fi

# A grid of N x N quads, bent by N, as high as HEIGHT.
make_mesh() { # N HEIGHT FILE
  awk -v n="$1" -v height="$2" 'BEGIN {
    for (y = 0; y <= n; ++y) for (x = 0; x <= n; ++x) printf "v %d %d %.6f\n", x, y, height * sin(x * y / n)
    for (y = 0; y < n; ++y) for (x = 1; x <= n; ++x) {
      a = y * (n + 1) + x
      printf "f %d %d %d\nf %d %d %d\n", a, a + 1, a + n + 2, a, a + n + 2, a + n + 1
    }
  }' >"$3"
}
jobs=12
mkdir -p one/in one/cooked
make_meshes() { # HEIGHT: and the sums of what they become
  for i in $(seq 1 $jobs); do make_mesh $((i + 30)) "$1" "one/in/m$i.obj"; done
  rm -f one/jobs.jsonl.done
  (cd one && "$boxtree" cook --manifest jobs.jsonl --quiet && sha256sum cooked/*.bxt) >sums
}
for i in $(seq 1 $jobs); do echo "{\"inputs\":[\"in/m$i.obj\"],\"output\":\"cooked/m$i.bxt\"}"; done >one/jobs.jsonl
make_meshes 1
# run URL [OPTION...]: all of checkout one anew, with the right bytes; its lines are in one/out, warnings in one/err.
run() {
  rm -rf one/cooked one/jobs.jsonl.done
  mkdir one/cooked
  (cd one && expect 0 "$boxtree" cook --manifest jobs.jsonl --json --cache "$@" && sha256sum --check --quiet ../sums)
}
count_of() { jq -s "map(select($1)) | length" one/out; }
warnings() { grep -c 'warning: --cache: ' one/err || true; }
says() { grep -q -- "$1" "${2:-one/err}" || { echo "expected '$1', found"; cat "${2:-one/err}"; exit 1; }; }
unread='nothing more is looked for .*there in this run'
unsent='nothing more is .*sent there in this run'

run "$url"
same "$(count_of .cached)" 0
same "$(warnings)" 0
# Another checkout, at another path, by single cooks and by a manifest.
mkdir -p two/else/cooked
cp -r one/in one/jobs.jsonl two/else
cd two/else
expect 0 "$boxtree" cook in/m1.obj -o cooked/m1.bxt --cache "$url/" --json
same "$(jq .cached out)" true
expect 0 "$boxtree" cook --manifest jobs.jsonl --json --cache "$url"
same "$(jq -s 'map(select(.cached)) | length' out)" $jobs
sha256sum --check --quiet ../../sums
cd ../..
# Two shards at once on a server that has nothing.
rm -rf one/cooked
mkdir one/cooked
(cd one && "$boxtree" cook --manifest jobs.jsonl --quiet --cache "${url}2" --shard 0/2) &
(cd one && "$boxtree" cook --manifest jobs.jsonl --quiet --cache "${url}2" --shard 1/2)
wait $!
(cd one && sha256sum --check --quiet ../sums)
run "${url}2"
same "$(count_of .cached)" $jobs

# An entry as anyone may make one, by its specification, of another valid file: nothing but an audit can tell.
key=$("$boxtree" key one/in/m1.obj | cut -f1)
"$boxtree" cook one/in/m2.obj -o lie.bxt --quiet
cat >lie.py <<'END'
import hashlib, sys, urllib.request
url, key, file = sys.argv[1:]
body, report = open(file, "rb").read(), b"[]"
digest = hashlib.sha256(body).hexdigest()
seal = hashlib.sha256("\n".join(["boxtree cache 1", key, digest, str(len(body)), report.decode()]).encode()).hexdigest()
def number(n):
    return bytes([n]) if n < 128 else bytes([n & 127 | 128]) + number(n >> 7)
def text(field, value):
    return number(field << 3 | 2) + number(len(value)) + value
digest_message = text(1, digest.encode()) + number(2 << 3) + number(len(body))
entry = text(2, text(1, (seal + ".bxt").encode()) + text(2, digest_message)) + text(7, report)
for place, data in ("cas/" + digest, body), ("ac/" + key, entry):
    urllib.request.urlopen(urllib.request.Request(f"{url}/{place}", data, method="PUT"))
END
no_proxy='*' python3 lie.py "$url" "$key" lie.bxt
expect 0 "$boxtree" cook one/in/m1.obj -o lied.bxt --cache "$url" --json
same "$(jq .cached out)" true
cmp lied.bxt lie.bxt
expect 7 "$boxtree" cook one/in/m1.obj -o audited.bxt --cache "$url" --audit 1
says '^boxtree: difference: audited.bxt: audit: under the key' err
cmp audited.bxt one/cooked/m1.bxt
expect 0 "$boxtree" cook one/in/m1.obj -o audited.bxt --cache "$url" --audit 1 --json
same "$(jq .cached out)" false
run "$url"
same "$(count_of .cached)" $jobs

# Faults of every answer: no byte is wrong, and three failures in a row end it.
run "$faulty/good"
for fault in html redirect 500 403 closes garbage ac-endless; do
  run "$faulty/$fault"
  same "$(count_of .cached)" 0
  if [ "$(warnings)" -lt 2 ] || [ "$(warnings)" -gt 3 ]; then echo "$fault: $(warnings) warnings"; cat one/err; exit 1; fi
  says "3 failures in a row, the last: .*; $unread"
done
run "$faulty/good"
same "$(count_of .cached)" $jobs
# Entries are right, and outputs are not: they are put again.
for fault in cas-short cas-half cas-wrong cas-other cas-long cas-html cas-closes; do
  run "$faulty/$fault" --jobs 1
  same "$(count_of .cached)" 0
  [ "$(warnings)" -ge 1 ]
done
run "$faulty/good"
same "$(count_of .cached)" $jobs
# A server that is full is read, and not written to for long.
for fault in 507 early413; do
  run "$faulty/$fault"
  same "$(count_of .cached)" $jobs
done
make_meshes 2
for fault in 507 early413; do
  run "$faulty/$fault"
  same "$(count_of .cached)" 0
  says "$unsent"
done
run "$faulty/good"
same "$(count_of .cached)" 0

# nginx whose files are damaged, which takes nothing so large or nothing at all, and which ends while it is needed.
if [ "$server" = nginx ]; then
  run "$url"
  outputs=(served/all/cas/*) entries=(served/all/ac/*)
  : >"${outputs[0]}"
  truncate -s -1 "${outputs[1]}"
  printf x >>"${outputs[2]}"
  rm "${outputs[3]}"
  echo '<html>' >"${entries[0]}"
  truncate -s -1 "${entries[1]}"
  cp "${entries[3]}" "${entries[2]}"
  for i in 1 2 3 4; do run "$url" --jobs 1; done # what is left alone in one run is put right by the next
  same "$(count_of .cached)" $jobs
  for place in small fixed; do
    run "http://127.0.0.1:$nginx_port/$place"
    says "$unsent"
  done
  (sleep 0.05; kill "$(cat nginx.pid)") &
  run "http://127.0.0.1:$nginx_port/new" --jobs 1
  wait $!
  until [ ! -e nginx.pid ]; do sleep 0.05; done
  run "http://127.0.0.1:$nginx_port/new"
  says "$unread\|$unsent"
  [ "$(warnings)" -le 3 ]
fi

# What is no URL, and what a server does by itself; no message has a password.
for place in ftp://host http:// 'http://a b' http://host/?x; do expect 1 "$boxtree" cook one/in/m1.obj -o x.bxt --cache "$place"; done
expect 1 "$boxtree" cook one/in/m1.obj -o x.bxt --cache "$url" --cache-size 1G
says '--cache-size is of a folder' err
expect 0 "$boxtree" cook one/in/m1.obj -o x.bxt --cache "http://me:secret@${faulty#http://}/500"
says 'found 500' err
if grep secret err; then exit 1; fi
# libcurl is loaded where it is needed, and nowhere else.
if ldd "$boxtree" | grep curl; then exit 1; fi
mkdir lib
: >lib/libcurl.so.4
LD_LIBRARY_PATH=$work/lib expect 0 "$boxtree" cook one/in/m1.obj -o x.bxt --cache cache
LD_LIBRARY_PATH=$work/lib expect 5 "$boxtree" cook one/in/m1.obj -o x.bxt --cache "$url"
says 'HTTP needs libcurl' err
echo "http: another checkout cooks nothing again, and no fault of a server changes a byte; the server was $server"
