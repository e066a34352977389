#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the C interface and uses it as C projects do, by CMake and by pkg-config, as a shared and as a static library: without
# C++, Eigen or Highway being looked for, and with no symbol of C++ in programs that link the shared one.
#   c_test.sh BUILD SOURCE
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "c: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"
command -v gcc >/dev/null || { echo "c: there is no gcc, nothing is tested"; exit 0; }
quiet cmake --install "$build" --prefix "$work/prefix"
quiet "$work/prefix/bin/boxtree" cook "$source/samples/meshes/level.obj" -o "$work/level.bxt"
lib=$(dirname "$(find "$work/prefix" -name libboxtree.so)")
expected="ground at height 0.5, face 2"
# answers PROGRAM [DIRECTORY_OF_LIBRARY]
answers() {
  local said
  said=$(LD_LIBRARY_PATH=${2:-} "$1" "$work/level.bxt") || fail "$1 failed"
  [ "$said" = "$expected" ] || fail "$1 says: $said"
}
# needs PROGRAM: what of shared libraries it names. of_cpp PROGRAM: its symbols of C++.
needs() { readelf -d "$1" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p'; }
of_cpp() { nm -u "$1" | grep -E ' (_Z|__cxa_(throw|begin|guard|allocate)|__gxx)' || true; }

# --- The library ---
abi=$(sed -n 's/^#define BXT_ABI_VERSION \(0x[0-9a-f]*\)u$/\1/p' "$work/prefix/include/boxtree_c.h")
major=$((abi >> 16)) minor=$((abi & 0xffff))
[ "$(readlink "$lib/libboxtree.so")" = "libboxtree.so.$major" ] || fail "no link to link by"
[ "$(readlink "$lib/libboxtree.so.$major")" = "libboxtree.so.$major.$minor" ] || fail "no link of the soname"
readelf -d "$lib/libboxtree.so" >"$work/dynamic"
grep -q "soname: \[libboxtree.so.$major\]" "$work/dynamic" || fail "wrong soname: $(cat "$work/dynamic")"
if grep -E 'RPATH|RUNPATH|TEXTREL' "$work/dynamic"; then fail "has a path to search, or is relocated"; fi
# It exports what the header declares, as one version, and nothing else.
nm -D --defined-only --format=posix "$lib/libboxtree.so" | awk '$2 != "A" { print $1 }' | sort >"$work/exported"
sed -n 's/^BXT_API [^(]*[ *]\(bxt_[a-z0-9_]*\)(.*/\1/p' "$work/prefix/include/boxtree_c.h" |
  sed "s/\$/@@BXT_$major/" | sort >"$work/declared"
[ "$(wc -l <"$work/declared")" -gt 100 ] || fail "no functions to look for"
diff "$work/exported" "$work/declared" || fail "exports (left) what is not declared (right)"

# --- CMake ---
mkdir "$work/user"
cp "$source/samples/c/first_ray.c" "$work/user"
cat >"$work/user/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C)
find_package(boxtree 0.1 CONFIG REQUIRED COMPONENTS c)
get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
if(NOT languages STREQUAL "C" OR TARGET boxtree::runtime OR TARGET Eigen3::Eigen)
  message(FATAL_ERROR "languages '${languages}', or targets for C++")
endif()
foreach(library IN ITEMS c c_static)
  add_executable(with_${library} first_ray.c)
  set_target_properties(with_${library} PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
  target_link_libraries(with_${library} PRIVATE boxtree::${library})
endforeach()
CMAKE
# What the component does not need must not be looked for.
quiet cmake -S "$work/user" -B "$work/user/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_C_COMPILER=gcc -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON
quiet cmake --build "$work/user/build"
answers "$work/user/build/with_c"
answers "$work/user/build/with_c_static"

# --- pkg-config ---
# A folder that was moved is found, too.
mv "$work/prefix" "$work/moved"
lib=${lib/prefix/moved}
export PKG_CONFIG_PATH=$lib/pkgconfig
compile=(gcc -std=c99 -pedantic-errors -Wall "$source/samples/c/first_ray.c")
read -ra flags <<<"$(pkg-config --cflags --libs boxtree_c)"
[ "${flags[*]/#-[IL]*/}" = "  -lboxtree" ] || fail "boxtree_c.pc has flags: ${flags[*]}"
quiet "${compile[@]}" -o "$work/shared" "${flags[@]}"
answers "$work/shared" "$lib"
read -ra flags <<<"$(pkg-config --cflags --libs --static boxtree_c | sed 's/-lboxtree/-l:libboxtree.a/')"
quiet "${compile[@]}" -o "$work/static" "${flags[@]}"
answers "$work/static"

# --- The guide ---
# In an empty folder, what docs/GUIDE.md says, as printed.
mkdir "$work/empty"
sed -n '/^## Use it from C$/,/^## Use it without/p' "$source/docs/GUIDE.md" >"$work/section.md"
section() { python3 "$source/tests/docs/blocks.py" "$work/section.md" "$1"; }
section c >"$work/empty/ground.c"
cp "$source/samples/meshes/level.obj" "$work/empty"
section sh >"$work/commands.sh"
[ "$(wc -l <"$work/commands.sh")" -eq 3 ] || fail "the guide has other commands: $(cat "$work/commands.sh")"
(cd "$work/empty" && PATH=$work/moved/bin:$PATH LD_LIBRARY_PATH=$lib bash -eu "$work/commands.sh") >"$work/said" 2>&1 ||
  fail "the guide's commands fail: $(cat "$work/said")"
tail -1 "$work/said" | diff - <(section text) || fail "the guide's program prints something else (left)"
section cmake >"$work/empty/CMakeLists.txt"
quiet cmake -S "$work/empty" -B "$work/empty/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_C_COMPILER=gcc
quiet cmake --build "$work/empty/build"
(cd "$work/empty" && ./build/ground) | diff - <(section text) || fail "the guide's CMake project prints something else (left)"

for program in "$work/user/build/with_c" "$work/shared"; do
  needs "$program" | grep -qx "libboxtree.so.$major" || fail "$program does not need libboxtree.so.$major"
  if needs "$program" | grep -E 'stdc|hwy|libc\+\+'; then fail "$program needs C++"; fi
  [ -z "$(of_cpp "$program")" ] || fail "$program has symbols of C++: $(of_cpp "$program")"
done
for program in "$work/user/build/with_c_static" "$work/static"; do
  if needs "$program" | grep boxtree; then fail "$program is not linked statically"; fi
done
echo "c: as expected"
