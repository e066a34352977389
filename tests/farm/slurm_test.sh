#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Slurm on this one machine: an array job cooks the shards of a manifest, one of its tasks is killed in mid-cook and queued
# again, and what they wrote together equals what one run wrote.
#   tests/farm/slurm_test.sh BOXTREE
set -euo pipefail
boxtree=$(realpath "$1")
work=$(mktemp -d)
port=$((20000 + RANDOM % 20000))
export SLURM_CONF=$work/slurm.conf
cleanup() {
  local status=$?
  for daemon in slurmctld slurmd munged; do
    [ -f "$work/$daemon.pid" ] || continue
    local number
    number=$(cat "$work/$daemon.pid")
    kill "$number" || true
    timeout 20 tail --pid="$number" -f /dev/null || kill -KILL "$number" # it writes into the folder to the end
  done
  [ $status = 0 ] || tail -n 20 "$work"/slurmctld.log "$work"/slurmd.log "$work"/task.* >&2 || true
  rm -rf "$work"
}
trap cleanup EXIT
fail() {
  echo "slurm_test.sh: $*" >&2
  exit 1
}
# until_true SECONDS COMMAND...
until_true() {
  local left=$1
  shift
  until "$@"; do
    [ $((left -= 1)) -gt 0 ] || fail "waited too long: $*"
    sleep 1
  done
}

chmod 755 "$work" # munged wants its socket in a folder that others can enter
mkdir "$work/ctl" "$work/d"
cat >"$SLURM_CONF" <<END
ClusterName=farm
SlurmctldHost=localhost
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmUser=root
StateSaveLocation=$work/ctl
SlurmdSpoolDir=$work/d
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
NodeName=localhost CPUs=2 State=UNKNOWN
PartitionName=p Nodes=localhost Default=YES State=UP
END
/usr/sbin/mungekey --create --keyfile "$work/munge.key"
/usr/sbin/munged --force --socket="$work/munge.socket" --key-file="$work/munge.key" --log-file="$work/munged.log" \
  --pid-file="$work/munged.pid" --seed-file="$work/munge.seed" 2>/dev/null
slurmctld -f "$SLURM_CONF"
slurmd -f "$SLURM_CONF"
is_idle() { [ "$(sinfo --noheader --format=%T)" = idle ]; }
until_true 30 is_idle

# Meshes of several sizes, so that a shard takes some seconds: waves of K x K squares.
mkdir "$work/one" "$work/farm"
python3 - "$work" <<'END'
import json, math, pathlib, sys
work = pathlib.Path(sys.argv[1])
jobs = []
for number in range(24):
    k = 30 + 12 * number
    lines = [f"v {x} {y} {math.sin(x / 7 + number) + math.cos(y / 5):.6f}" for y in range(k) for x in range(k)]
    at = lambda x, y: y * k + x + 1
    lines += [f"f {at(x, y)} {at(x + 1, y)} {at(x + 1, y + 1)}\nf {at(x, y)} {at(x + 1, y + 1)} {at(x, y + 1)}"
              for y in range(k - 1) for x in range(k - 1)]
    (work / f"wave{number}.obj").write_text("\n".join(lines) + "\n")
    jobs.append({"inputs": [f"../wave{number}.obj"], "output": f"wave{number}.bxt", "options": ["--try-all"]})
for folder in ("one", "farm"):
    (work / folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs))
END
(cd "$work/one" && "$boxtree" cook --manifest jobs.jsonl -q >summary.jsonl)

# What GUIDE shows; each task notes how often it was started.
cat >"$work/farm/cook.sh" <<END
#!/bin/sh
#SBATCH --requeue
cd "$work/farm" || exit 2
echo "\${SLURM_RESTART_COUNT:-0}" >>"started.\$SLURM_ARRAY_TASK_ID"
exec "$boxtree" cook --manifest jobs.jsonl --shard "\$SLURM_ARRAY_TASK_ID/\$SLURM_ARRAY_TASK_COUNT" --jobs 1 -q
END
job=$(sbatch --parsable --array=0-3 --output="$work/task.%a" "$work/farm/cook.sh")

# Killed once it has written something and is still at work.
first=
is_in_mid_cook() {
  for task in 0 1 2 3; do
    [ -e "$work/farm/started.$task" ] && pgrep -f "^$boxtree cook --manifest jobs.jsonl --shard $task/4" >/dev/null && compgen -G "$work/farm/*.bxt" >/dev/null &&
      first=$task && return 0
  done
  return 1
}
until_true 60 is_in_mid_cook
scontrol requeue "${job}_$first"
is_pending() { squeue --noheader --array --format=%t --job="${job}_$first" | grep -q PD; }
until_true 30 is_pending
scontrol update "JobId=${job}_$first" StartTime=now
is_over() { [ -z "$(squeue --noheader --job="$job" 2>/dev/null)" ]; }
until_true 300 is_over

[ "$(tail -n 1 "$work/farm/started.$first")" = 1 ] || fail "task $first was not queued again"
cooked=0
for output in "$work"/one/*.bxt; do
  cmp "$output" "$work/farm/${output##*/}" || fail "${output##*/} differs"
  cooked=$((cooked + 1))
done
[ "$cooked" = 24 ] || fail "cooked $cooked of 24"
leftovers=$(find "$work/farm" -name '*.cooking')
[ -z "$leftovers" ] || fail "left behind: $leftovers"
echo "slurm: 24 jobs in 4 tasks, one killed and queued again, the same bytes as of one run"
