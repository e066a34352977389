#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fuzzes: builds the targets with clang, runs each of them from its corpus, keeps the inputs that it
# finds interesting for the next run, and adds up the executions in log.tsv.
#   tests/fuzz/run.sh [--executions N] [--plain] [TARGET...]    1 when something was found
#   tests/fuzz/run.sh --minimise    makes corpus/ anew of what all runs have found interesting
#   tests/fuzz/run.sh --totals      what log.tsv adds up to, as the table of docs/GUARANTEES.md
# N: of each target, 1 000 000 unless said otherwise. With address and undefined-behaviour
# sanitizers; --plain without, which is several times as fast. A finding is a crash, a report of a
# sanitizer, a finding() of the target, or an input that takes more than 100 ms. Its input stands in
# build-fuzz/findings; give it to build-asan-ubsan/tests/fuzz/fuzz_TARGET to see it again.
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=samples/packages.sh
. samples/packages.sh

executions=1000000 build=build-asan-ubsan sanitizers=address,undefined,fuzzer-no-link
kind_of_build=sanitizers action=run found=build-fuzz
targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --executions) executions=$2; shift ;;
    --plain) build=build-fuzz-plain sanitizers=fuzzer-no-link kind_of_build=plain ;;
    --minimise) action=minimise ;;
    --totals) action=totals ;;
    -*) echo "run.sh: unknown option $1" >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done

# Its corpus for each target, from what CMakeLists.txt says.
corpus_of() { awk -v name="$1" '$1 == name { print $2 }' "$build/tests/fuzz/targets.txt"; }

totals() {
  echo "| target | with sanitizers | without |"
  echo "|---|---|---|"
  awk -F'\t' '
    NR > 1 { sum[$3, $4] += $5; all[$4] += $5; seen[$3] = 1 }
    END {
      for (name in seen)
        printf "| `%s` | %d | %d |\n", name, sum[name, "sanitizers"], sum[name, "plain"]
      printf "| ~all | %d | %d |\n", all["sanitizers"], all["plain"]
    }' tests/fuzz/log.tsv | LC_ALL=C sort | sed 's/~//'
}

# run_target NAME: one line into log.tsv.
run_target() {
  local name=$1 work=$found/corpus/$1 said=$build/$1.log begin status=0 count findings
  mkdir -p "$work" "$found/findings"
  begin=$(date +%s)
  # Its own limit of 10 s is for what never ends; 100 ms are looked at in libfuzzer_main.cpp.
  ASAN_OPTIONS=allocator_may_return_null=1 LSAN_OPTIONS=suppressions=tests/leaks.txt \
    "$build/tests/fuzz/fuzz_$name" -runs="$executions" -max_len=4096 -len_control=0 -timeout=10 \
    -rss_limit_mb=2048 -print_final_stats=1 -seed="$begin" \
    -artifact_prefix="$found/findings/$name-" \
    "$work" "tests/fuzz/corpus/$(corpus_of "$name")" >"$said" 2>&1 || status=$?
  count=$(sed -n 's/^stat::number_of_executed_units: *//p' "$said")
  findings=$((status == 0 ? 0 : 1))
  printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$(date +%F)" "$(git rev-parse --short HEAD)" "$name" \
    "$kind_of_build" "${count:-0}" "$(($(date +%s) - begin))" "$findings" >>tests/fuzz/log.tsv
  if [ "$status" -eq 0 ]; then
    echo "$name: $count executions, nothing found"
  else
    echo "$name: found something after ${count:-0} executions, see $said"
    grep -E 'FINDING|ERROR|runtime error|SUMMARY|Test unit written' "$said" || tail -3 "$said"
  fi
  return "$status"
}

minimise() {
  local name kind fresh
  fresh=$(mktemp -d)
  for name in "${targets[@]}"; do
    kind=$(corpus_of "$name")
    mkdir -p "$fresh/$kind" "$found/corpus/$name"
    "$build/tests/fuzz/fuzz_$name" -merge=1 -max_len=2048 "$fresh/$kind" \
      "tests/fuzz/corpus/$kind" "$found/corpus/$name" >"$found/$name.log" 2>&1
  done
  for kind in "$fresh"/*; do
    rm -rf "tests/fuzz/corpus/$(basename "$kind")"
    mv "$kind" tests/fuzz/corpus/
  done
  rm -rf "$fresh"
  du -sb tests/fuzz/corpus
}

if [ "$action" = totals ]; then
  totals
  exit 0
fi
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $TEST_PACKAGES $FUZZ_PACKAGES
cmake --preset asan-ubsan -B "$build" -DBOXTREE_SANITIZE="$sanitizers" \
  -DBOXTREE_BUILD_TESTS=ON >/dev/null
cmake --build "$build" --target boxtree_fuzz_targets >"$build/build.log" ||
  { tail -30 "$build/build.log"; exit 1; }
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(cut -d' ' -f1 "$build/tests/fuzz/targets.txt")
[ -f tests/fuzz/log.tsv ] ||
  printf 'date\tcommit\ttarget\tbuild\texecutions\tseconds\tfindings\n' >tests/fuzz/log.tsv
if [ "$action" = minimise ]; then
  minimise
  exit 0
fi
status=0
for name in "${targets[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$(nproc)" ]; do wait -n || status=1; done
  run_target "$name" &
done
while [ -n "$(jobs -rp)" ]; do wait -n || status=1; done
exit "$status"
