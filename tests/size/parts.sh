#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Prints what each program takes, code and data once stripped, less what an empty one takes.
#   parts.sh EMPTY PROGRAM...
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/size/measure.sh
. "$(dirname "$0")/measure.sh"
less=$(bytes "$1")
shift
for program in "$@"; do
  name=$(basename "$program")
  printf '%-40s %7d bytes\n' "${name#boxtree_size_}" $(($(bytes "$program") - less))
done
