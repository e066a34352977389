#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Uses that check_portability.py has to find, and those that it must not.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/cooker/system" "$work/runtime/tree"
# expect FAULTS [FOLDER]
expect() {
  local faults=$1 subject=$work/${2:-cooker/system}/subject.cpp
  cat >"$subject"
  local found
  found=$(python3 "$here/check_portability.py" "$work" | grep -c "subject.cpp" || true)
  [ "$found" = "$faults" ] || { echo "expected $faults faults, found $found in:"; cat "$subject"; exit 1; }
  rm "$subject"
}
expect 1 <<'X'
int file = ::memfd_create("x", 0);
X
expect 1 <<'X'
bool has(auto& a, auto& b) { return !std::ranges::search(a, b).empty() && std::ranges::find(a, 1) != a.end(); }
X
expect 1 runtime/tree <<'X'
void clear(auto& a) { std::ranges::fill(a, 0); }
X
expect 0 <<'X'
void clear(auto& a) { std::ranges::fill(a, 0); }
X
expect 1 <<'X'
#ifdef _WIN32
#include <unistd.h>
#endif
X
expect 2 <<'X'
#ifdef __linux__
int file = ::memfd_create("x", 0);
#else
int other = ::memfd_create("x", 0);
#endif
const char* self = "/proc/self/maps";
X
expect 1 <<'X'
#ifdef _WIN32
#include <windows.h>
#else
#include <windows.h>
#include <sys/mman.h>
#endif
X
expect 0 <<'X'
// memfd_create, as a comment says
#ifndef _WIN32
#include <sys/mman.h>
#endif
#if defined(__GNUC__)
int x = __builtin_ctz(4);
#endif
X
echo "uses without their condition are found"
