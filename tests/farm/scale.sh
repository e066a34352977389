#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What a manifest of many small meshes costs: processor time against as many single cooks, jobs a second with nothing to do, from a
# cache and from a server, and memory. docs/MEASUREMENTS.md has the figures.
#   tests/farm/scale.sh BOXTREE GENERATE [MESHES [SINGLES]]     10000 meshes, of which 1000 are also cooked one by one
#   GENERATE   the program boxtree_generate
# Environment: SCALE_MESHES, a folder that keeps the meshes for another run [none]
# Checks what does not depend on a time: bytes, counts, and that memory does not grow with the number of jobs.
set -euo pipefail
boxtree=$(realpath "$1") generate=$(realpath "$2") meshes=${3:-10000} singles=${4:-1000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() {
  echo "scale.sh: $*" >&2
  exit 1
}
cat >measure.py <<'END'
"""measure.py TITLE JOBS COMMAND...: runs it; a line of what it took, and its processor time and peak in ./last."""
import os, subprocess, sys, time
title, jobs, *command = sys.argv[1:]
start = time.time()
process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
_, status, used = os.wait4(process.pid, 0)
seconds, cpu, peak = time.time() - start, used.ru_utime + used.ru_stime, used.ru_maxrss >> 10
if status:
    sys.exit(f"scale.sh: {title}: exit {os.waitstatus_to_exitcode(status)}")
jobs = int(jobs)
print(f"{title:44} {jobs:6} jobs {cpu:9.2f} s processor {1e3 * cpu / jobs:8.3f} ms a job {jobs / cpu:8.0f} jobs a second {seconds:8.1f} s {peak:5} MB", flush=True)
open("last", "w").write(f"{cpu} {peak}")
END
measure() { python3 measure.py "$@"; }
peak() { cut -d' ' -f2 last; }

in=${SCALE_MESHES:-$work/meshes}
mkdir -p out single "$in"
ln -s "$in" in
for ((i = 0; i < meshes; ++i)); do
  kind=terrain
  [ $((i % 2)) = 0 ] || kind=city
  [ -e "in/m$i.ply" ] || "$generate" $kind $((1000 + i * 7919 % 9001)) "in/m$i.ply" --seed "$i"
  echo "{\"inputs\": [\"in/m$i.ply\"], \"output\": \"out/m$i.bxt\"}"
done >jobs.jsonl
[ "$singles" -le "$meshes" ] || singles=$meshes
step=$((meshes / singles))
awk -v step=$step -v n="$singles" '(NR - 1) % step == 0 && ++k <= n' jobs.jsonl | sed 's|"out/|"single/|' >part.jsonl
sed -E 's|.*"(in/m[0-9]+.ply)".*"(single/m[0-9]+.bxt)".*|"'"$boxtree"'" cook \1 -o \2 --jobs 1 --quiet|' part.jsonl >singles.sh
echo "$meshes meshes"
measure "single cooks" "$singles" bash -e singles.sh
sums() { (cd "$1" && find . -name '*.bxt' -print0 | sort -z | xargs -0 sha256sum); }
sums single >single.sums
rm single/*
measure "the same as a manifest" "$singles" "$boxtree" cook --manifest part.jsonl --quiet --jobs 1
sums single | cmp - single.sums
small=$(peak)
measure "all" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1
large=$(peak)
sums out >out.sums
# Of what grows with the number of jobs there are names and keys alone: less than 2 KB a job.
[ "$large" -le $((small + 16 + meshes * 2 / 1024)) ] || fail "memory grows from $small to $large MB"
sleep 2.1
measure "nothing to do, first: reads all" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1
measure "nothing to do" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1
measure "nothing to do, --reread" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --reread
measure "keys alone" "$meshes" "$boxtree" key --manifest jobs.jsonl
measure "shard 0 of 100, nothing to do" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --shard 0/100
measure "the same again" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --shard 0/100
anew() { rm -f out/* jobs.jsonl.done; }
anew
measure "into a cache" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --cache cache --cache-size 100G
anew
measure "from a cache" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --cache cache --cache-size 100G
sums out | cmp - out.sums
modules=/usr/lib/nginx/modules/ngx_http_dav_ext_module.so
PATH=$PATH:/usr/sbin
if [ -e $modules ] && command -v nginx >/dev/null; then
  port=$((20000 + RANDOM % 10000))
  mkdir served tmp
  cat >nginx.conf <<END
load_module $modules;
pid $work/nginx.pid; error_log $work/nginx.log;
$([ "$(id -u)" -ne 0 ] || echo "user root;")
events {}
http {
  access_log off; client_body_temp_path $work/tmp;
  server { listen 127.0.0.1:$port; location / { root $work/served; dav_methods PUT; create_full_put_path on; client_max_body_size 0; } }
}
END
  nginx -c "$work/nginx.conf"
  trap 'kill "$(cat "$work/nginx.pid")"; rm -rf "$work"' EXIT
  anew
  measure "into a cache on a server" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --cache "http://127.0.0.1:$port"
  anew
  measure "from a cache on a server" "$meshes" "$boxtree" cook --manifest jobs.jsonl --quiet --jobs 1 --cache "http://127.0.0.1:$port"
  sums out | cmp - out.sums
  echo "entries have $(cat served/ac/* | wc -c) bytes, outputs $(cat served/cas/* | wc -c)"
fi
