#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds and runs every test. The last line counts them.
#   tests/run.sh [--all | PART...]   [release]
#   release         every test of one build
#   builds          the runtime in other builds: shared, without optimisation, with parts left out; the command line
#                   without the libraries that may be left out
#   asan-ubsan      all but those labelled "figures", with sanitizers and the assertions of libraries
#   scalar          every test without vectors
#   tsan            what runs on several threads, with ThreadSanitizer
#   compare-builds  the bytes that other compilers and arm64 write
#   platforms       the answers of other compilers, systems and processors
#   --all           all of them: some hours on two cores
set -euo pipefail
cd "$(dirname "$0")/.."
all="release builds asan-ubsan scalar tsan compare-builds platforms"
parts=${*:-release}
[ "$parts" = --all ] && parts=$all
for part in $parts; do
  case " $all " in
    *" $part "*) ;;
    *) echo "tests/run.sh: no part '$part'; expected --all or some of: $all" >&2; exit 2 ;;
  esac
done
# shellcheck source=samples/packages.sh
. samples/packages.sh
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $SAMPLE_PACKAGES $TEST_PACKAGES $PEER_PACKAGES

passed=0 failed=0 skipped=0

# run_preset NAME [BUILD]: configures and builds one preset, that of the tests or BUILD, runs its tests and adds them up.
run_preset() {
  local junit=$PWD/build/junit-$1.xml build=${2:-$1} status=0
  cmake --preset "$build" -DBOXTREE_BUILD_TESTS=ON >/dev/null
  cmake --build --preset "$build"
  ctest --preset "$1" --output-on-failure --output-junit "$junit" || status=$?
  local tests failures skips
  tests=$(sed -n 's/.*<testsuite.* tests="\([0-9]*\)".*/\1/p;s/^[[:space:]]*tests="\([0-9]*\)".*/\1/p' "$junit" | head -1)
  failures=$(grep -c 'status="fail"' "$junit" || true)
  skips=$(grep -cE 'status="(notrun|disabled)"' "$junit" || true)
  failed=$((failed + failures))
  skipped=$((skipped + skips))
  passed=$((passed + tests - failures - skips))
  # A test run that broke down without naming a failed test is a failure all the same.
  if [ "$status" -ne 0 ] && [ "$failures" -eq 0 ]; then failed=$((failed + 1)); fi
}

# count_lines FILE STATUS: PASS, FAIL and SKIP at the begin of lines are tests.
count_lines() {
  local failures
  failures=$(grep -c '^FAIL' "$1" || true)
  failed=$((failed + failures))
  skipped=$((skipped + $(grep -c '^SKIP' "$1" || true)))
  passed=$((passed + $(grep -c '^PASS' "$1" || true)))
  if [ "$2" -ne 0 ] && [ "$failures" -eq 0 ]; then failed=$((failed + 1)); fi
}

# compare_builds: each build that writes files is a test.
compare_builds() {
  local said=build/compare_builds.txt status=0
  # shellcheck disable=SC2086 # a list of words
  install_missing $COMPARE_PACKAGES
  tests/same_bytes/compare_builds.sh | tee "$said" || status=$?
  count_lines "$said" "$status"
}

# platforms: each platform that answers queries is a test.
platforms() {
  local said=build/platforms.txt status=0
  tests/platforms/run.sh | tee "$said" || status=$?
  count_lines "$said" "$status"
}

mkdir -p build
for part in $parts; do
  case $part in
    builds) run_preset builds release ;;
    compare-builds) compare_builds ;;
    platforms) platforms ;;
    asan-ubsan)
      # shellcheck disable=SC2086 # a list of words
      install_missing $FUZZ_PACKAGES
      run_preset "$part"
      ;;
    *) run_preset "$part" ;;
  esac
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
