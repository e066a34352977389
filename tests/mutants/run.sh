#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Seeds small faults into runtime and format and sees which of them the tests notice: hours of work,
# so no part of tests/run.sh. Goes on where it stopped; what it did lies in build/mutants.
#   tests/mutants/run.sh [COUNT [SEED]]   [200 1]
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=samples/packages.sh
. samples/packages.sh
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $SAMPLE_PACKAGES $TEST_PACKAGES $MUTANT_PACKAGES
count=${1:-200} seed=${2:-1}
work=$PWD/build/mutants/$count-$seed
targets="primitive_test format_test file_test golden_test tree_test proof_test scene_test queries_test encode_test
  boxtree_exact wide_walks_test robustness_test mutation_test"

if [ ! -e "$work/list.json" ]; then
  mkdir -p "$work/src"
  git ls-files -z | xargs -0 cp --parents -t "$work/src"
  # One instruction set: the others are the same source.
  cmake -S "$work/src" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DBOXTREE_INSTRUCTION_SETS=avx2 >/dev/null
  /usr/bin/python3 tests/mutants/mutate.py "$work/src" "$work/build/compile_commands.json" "$count" "$seed" "$work/list.json"
  cmake -S "$work/src" -B "$work/build" \
    -DCMAKE_CXX_FLAGS="-w -include $work/src/tests/mutants/mutant.h" >/dev/null
fi
# shellcheck disable=SC2086 # a list of words
tests/mutants/build_mutants.py "$work/list.json" "$work/src" "$work/build" $targets
tests/mutants/run_mutants.py "$work/list.json" "$work/build" "$work/log.jsonl"
