#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the runtime as a shared library of the C++ interface, without optimisation to save time, and installs it: what it
# exports is what the public headers declare, its soname changes with every version that is not compatible,
# programs link it by CMake and by pkg-config, and cpack makes Debian packages of it.
#   shared_test.sh SOURCE COMPILER BOXTREE
set -euo pipefail
source=$1 compiler=$2 boxtree=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "shared: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"

version=$(sed -n 's/^project(boxtree VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
soversion=${version%.*}
quiet cmake -S "$source" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DBUILD_SHARED_LIBS=ON -DBOXTREE_SIMD=OFF -DBOXTREE_BUILD_COOKER=OFF \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DBOXTREE_PRECOMPILE_HEADERS=OFF \
  -DCMAKE_INSTALL_PREFIX="$work/prefix" -DCMAKE_INSTALL_LIBDIR=lib
quiet cmake --build "$work/build" -j2
quiet cmake --install "$work/build"
lib=$work/prefix/lib
[ -f "$lib/libboxtree_cpp.so.$version" ] || fail "no libboxtree_cpp.so.$version"
[ "$(readlink "$lib/libboxtree_cpp.so.$soversion")" = "libboxtree_cpp.so.$version" ] || fail "no link of the soname"
[ "$(readlink "$lib/libboxtree_cpp.so")" = "libboxtree_cpp.so.$soversion" ] || fail "no link to link by"
compgen -G "$lib/libboxtree_*.a" && fail "archives beside the shared library"

readelf -d "$lib/libboxtree_cpp.so" >"$work/dynamic"
grep -q "soname: \[libboxtree_cpp.so.$soversion\]" "$work/dynamic" || fail "wrong soname: $(cat "$work/dynamic")"
if grep -E 'RPATH|RUNPATH' "$work/dynamic"; then fail "has a path to search"; fi

# Exported is what the public headers declare: their functions, and members of their
# classes and structs, which mark functions one by one.
nm -DC --defined-only --format=posix "$lib/libboxtree_cpp.so" | grep -v ' A ' >"$work/exported"
[ -s "$work/exported" ] || fail "nothing is exported"
sed -E 's/@@.*//; s/\(.*//' "$work/exported" | sort -u >"$work/names"
sed 's|//.*||' "$work"/prefix/include/boxtree/*.h >"$work/headers"
while read -r name _; do
  [[ $name == boxtree::* ]] || fail "exports $name, which is not boxtree's"
  name=${name#boxtree::}
  if [[ $name == *::* ]]; then
    grep -qE "^(class BOXTREE_API|struct) ${name%%::*} \{" "$work/headers" || fail "exports $name, whose class is not public"
  fi
  grep -qE "(^|[^A-Za-z_])${name##*::} ?\(" "$work/headers" || fail "exports $name, which no public header declares"
done <"$work/names"
# And every function is marked that a public header declares, but templates and inline ones, and exported.
awk '!after_template && /^[A-Za-z[][^#;=]* [&*]?[a-z_]+\(/ && !/^inline / && !/BOXTREE_API/ {print} {after_template = /^template/}' \
  "$work/headers" >"$work/unmarked"
[ ! -s "$work/unmarked" ] || fail "not marked with BOXTREE_API: $(cat "$work/unmarked")"
marked=$(sed -nE 's/.*BOXTREE_API [^(]*[ &]([a-z_]+)\(.*/\1/p' "$work/headers" | sort -u)
[ "$(wc -w <<<"$marked")" -gt 15 ] || fail "no functions to look for: $marked"
for name in $marked; do grep -qxE "boxtree::([A-Za-z]+::)?$name" "$work/names" || fail "$name is not exported"; done

# Programs, by CMake and by pkg-config.
"$boxtree" cook "$source/samples/meshes/level.obj" -o "$work/level.bxt" --codec packed-f32 -q
"$boxtree" cook "$source/samples/meshes/level.obj" -o "$work/blob.bxt" --codec blob-zstd -q
mkdir "$work/user"
cat >"$work/user/CMakeLists.txt" <<CMAKE
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(boxtree $soversion CONFIG REQUIRED COMPONENTS runtime paper blob)
foreach(tool PkgConfig::boxtree_highway PkgConfig::boxtree_zstd boxtree::cli)
  if(TARGET \${tool})
    message(FATAL_ERROR "\${tool} is there for nothing")
  endif()
endforeach()
add_executable(user $source/tests/size/programs/whole.cpp)
target_link_libraries(user PRIVATE boxtree::runtime boxtree::paper boxtree::blob)
CMAKE
quiet cmake -S "$work/user" -B "$work/user/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$work/prefix"
quiet cmake --build "$work/user/build"
export PKG_CONFIG_PATH=$lib/pkgconfig
read -ra flags <<<"$(pkg-config --cflags --libs boxtree boxtree-paper boxtree-blob)"
quiet "$compiler" -std=c++20 -O0 "$source/tests/size/programs/whole.cpp" -o "$work/plain" "${flags[@]}"
for program in "$work/user/build/user" "$work/plain"; do
  readelf -d "$program" >"$work/dynamic"
  grep -q "NEEDED.*\[libboxtree_cpp.so.$soversion\]" "$work/dynamic" || fail "$program does not link libboxtree_cpp.so"
  for file in level blob; do
    LD_LIBRARY_PATH=$lib quiet "$program" "$work/$file.bxt"
  done
done

# The command line is not there, and CMake is told why.
sed -i 's/COMPONENTS runtime/COMPONENTS cli/' "$work/user/CMakeLists.txt"
if cmake -S "$work/user" -B "$work/user/build" >"$work/log" 2>&1; then fail "a command line was found"; fi
grep -q 'cli: the command line is not installed here' "$work/log" || fail "unclear: $(cat "$work/log")"

# Debian packages.
(cd "$work/build" && quiet cpack)
architecture=$(dpkg --print-architecture)
packages=$(cd "$work/build" && printf '%s\n' *.deb | sort | paste -sd ' ')
runtime=libboxtree-cpp${soversion}_${version}_$architecture.deb
of_c=libboxtree1_${version}_$architecture.deb
development=libboxtree-dev_${version}_$architecture.deb
[ "$packages" = "$runtime $development $of_c" ] || fail "packages: $packages"
field() { dpkg-deb --field "$work/build/$1" "$2"; }
for name in "libboxtree-cpp$soversion" libboxtree1; do
  [[ $(field "$development" Depends) == *"$name (= $version)"* ]] ||
    fail "$development depends on: $(field "$development" Depends)"
done
[[ $(field "$runtime" Depends) == *libzstd1* ]] || fail "$runtime depends on: $(field "$runtime" Depends)"
for package in "$runtime" "$of_c" "$development"; do
  [ "$(field "$package" Maintainer)" = "boxtree developers <boxtree@example.org>" ] || fail "$package: maintainer"
  quiet dpkg-deb --extract "$work/build/$package" "$work/root"
  name=${package%%_*}
  [ -f "$work/root/usr/share/doc/$name/copyright" ] || fail "$package has no copyright file"
done
[ "$(field "$runtime" Section) $(field "$of_c" Section) $(field "$development" Section)" = "libs libs libdevel" ] ||
  fail "wrong sections"
control() { dpkg-deb --ctrl-tarfile "$work/build/$1" | tar -xO "./$2" >"$work/$2"; }
control "$runtime" shlibs
grep -q "^libboxtree_cpp $soversion libboxtree-cpp$soversion" "$work/shlibs" || fail "shlibs: $(cat "$work/shlibs")"
control "$of_c" shlibs
grep -q "^libboxtree 1 libboxtree1" "$work/shlibs" || fail "shlibs: $(cat "$work/shlibs")"
for package in "$runtime" "$of_c"; do
  control "$package" triggers
  grep -q ldconfig "$work/triggers" || fail "the linker is not told of the library of $package"
done
echo "shared: as expected"
