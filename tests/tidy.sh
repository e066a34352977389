#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Holds the sources to .clang-format and .clang-tidy; exit 0 when both are clean. Some ten minutes
# on two cores, so that it stands beside tests/run.sh and not inside it.
#   tests/tidy.sh [FILE...]     default: every source of format, runtime and cooker
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=samples/packages.sh
. samples/packages.sh
# shellcheck disable=SC2086 # lists of words
install_missing $BUILD_PACKAGES $TEST_PACKAGES $PEER_PACKAGES clang-tidy clang-format

git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
cmake --preset release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
if [ $# -eq 0 ]; then mapfile -t files < <(git ls-files 'format/*.cpp' 'runtime/*.cpp' 'cooker/*.cpp'); else files=("$@"); fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 2 clang-tidy -p build --quiet
echo "clang-format and clang-tidy: clean"
