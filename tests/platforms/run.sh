#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the runtime and its C interface for each platform, makes fixed queries there (digests.c) and
# compares the digests of the answers with those that are pinned (digests-COUNT.txt), also of the files of
# tests/golden (digests-golden.txt); damaged copies end in an answer or an error. Prints PASS, FAIL or
# SKIP, the name and the digest of all; exit 1 when one fails. What is missing is installed.
#   tests/platforms/run.sh [--count N] [--long] [NAME...]     default: all
#   --count N    queries of each kind and file [15000: 10^5 in all]; those of a number that is not pinned are
#                compared with what the first platform answered
#   --long       windows-suites: the tests of queries, scenes, codecs, damaged files and robustness, too
#   NAME         c: this machine's, through the shared library; amalgamation: one file, without CMake, as docs/GUIDE.md says;
#                scalar: without vectors; sse4, avx512: walks by other vectors; avx512-leaves: what every
#                build does where the processor has AVX-512; both emulated by Bochs where it has not, half an hour for
#                1000 queries; O0, clang, libcxx: other compilers and libraries;
#                windows: x86-64 under Wine, the interface in C; windows-cli: the command line there, compared with
#                this machine's; windows-suites: tests of files there; arm64, armhf, riscv64, i386: under qemu or as
#                they are, without vectors; arm64-neon: with NEON, by Debian's Highway for arm64;
#                wasm: under Node; farm: no queries, but cooks by a cache on a server, by Bazel and by Slurm (tests/farm)
# Environment: BOXTREE_BUILD, where boxtree is built, whose command line cooks [build]
# shellcheck disable=SC2317 # platforms are called by name
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$(cd "$here/../.." && pwd)
build=${BOXTREE_BUILD:-$source/build}
work=$build/platforms
known="c amalgamation scalar sse4 avx512 avx512-leaves O0 clang libcxx windows windows-cli windows-suites arm64 arm64-neon armhf riscv64 i386 wasm farm"
count=15000
long=
while [ $# -gt 0 ]; do
  case $1 in
    --count) count=${2:?--count: expected a number}; shift 2 ;;
    --long) long=1; shift ;;
    -h | --help)
      sed -n '/^# Builds/,/^# Environment/s/^# \{0,1\}//p' "$0"
      exit 0
      ;;
    *) break ;;
  esac
done
for name in "$@"; do
  case " $known " in
    *" $name "*) ;;
    *) echo "tests/platforms/run.sh: no platform '$name'; expected some of: $known" >&2; exit 2 ;;
  esac
done
wanted=${*:-$known}
mkdir -p "$work"
rm -f "$work"/digests-*.txt
# shellcheck source=samples/packages.sh
. "$source/samples/packages.sh"
failed=0
if [ ! -x "$build/boxtree" ] || [ ! -e "$build/runtime/libboxtree.so" ]; then
  # shellcheck disable=SC2086 # lists of words
  install_missing $BUILD_PACKAGES
  [ -f "$build/CMakeCache.txt" ] || cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build "$build" --target boxtree_cli boxtree_c
fi

# The files, the same on every platform: their bytes are pinned by tests/same_bytes.
files=()
cook() {
  local name=$1
  shift
  "$build/boxtree" cook "$@" -o "$work/$name.bxt" -q
  files+=("$name.bxt")
}
cook level "$source/samples/meshes/level.obj" "$source/samples/meshes/crate.obj" --active-edges 5
cook torus "$here/torus.obj" --exact --codec wide8
cook torus-grid "$here/torus.obj" --grid-bits 16 --codec wide4
cook torus-arrays "$here/torus.obj" --exact --for speed --codec wide8
cook torus-f64 "$here/torus.obj" --f64 --exact --for speed --codec wide4
cook torus-f64-clusters "$here/torus.obj" --f64 --exact --for memory --codec wide8
cook crate "$source/samples/meshes/crate.obj" --active-edges 30 --materials
cook courtyard "$source/samples/level/level.gltf"

# The golden files of what the C interface reads.
goldens=()
for codec in wide4 wide8 wide8-edges wide8-grid wide8-materials wide8-user-data; do
  python3 -c 'import sys; sys.stdout.buffer.write(bytes.fromhex(sys.stdin.read()))' \
    <"$source/tests/golden/v1.0-$codec.hex" >"$work/v1.0-$codec.bxt"
  goldens+=("v1.0-$codec.bxt")
done

# conclude NAME PROGRAM [RUNNER...]: runs the queries and compares their digest.
conclude() {
  local name=$1 program=$2 digest
  shift 2
  if ! (cd "$work" && "$@" "$program" "$count" "${files[@]}") 2>"$work/$name.err" | tr -d '\r' >"$work/$name.txt"; then
    tail -5 "$work/$name.err"
    fail "$name" "does not run to its end"
    return
  fi
  digest=$(awk '$1 == "all" {print $2}' "$work/$name.txt")
  local pinned=$here/digests-$count.txt
  if [ ! -f "$pinned" ]; then
    pinned=$work/digests-$count.txt
    [ -f "$pinned" ] || cp "$work/$name.txt" "$pinned"
  fi
  if ! diff "$pinned" "$work/$name.txt" >"$work/$name.diff"; then
    grep '^>' "$work/$name.diff" | head -5
    fail "$name" "other answers than pinned: $digest"
    return
  fi
  if ! (cd "$work" && "$@" "$program" 100 "${goldens[@]}") 2>"$work/$name.err" | tr -d '\r' | diff "$here/digests-golden.txt" - >"$work/$name.diff"; then
    grep '^>' "$work/$name.diff" | head -5
    fail "$name" "other answers of tests/golden"
    return
  fi
  if ! (cd "$work" && "$@" "$program" --damaged $((30 + count / 100)) "${files[@]}" "${goldens[@]}") >"$work/$name.damaged.txt" 2>&1; then
    tail -5 "$work/$name.damaged.txt"
    fail "$name" "does not survive damaged files"
    return
  fi
  echo "PASS $name $digest"
}
fail() {
  echo "FAIL $1 $2"
  failed=1
}
skip() { echo "SKIP $1 $2"; }

# built NAME OPTION...: the libraries of a platform, in $work/NAME; several sources at a time, which takes half as long.
built() {
  local name=$1
  shift
  if cmake -S "$source" -B "$work/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBOXTREE_BUILD_COOKER=OFF \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 -DBOXTREE_PRECOMPILE_HEADERS=OFF "$@" >"$work/$name.log" 2>&1 &&
    cmake --build "$work/$name" --target boxtree_c boxtree_c_static >>"$work/$name.log" 2>&1; then
    return 0
  fi
  grep -E 'error|Error' "$work/$name.log" | head -5
  fail "$name" "does not build, see $work/$name.log"
  return 1
}
# static NAME COMPILER [FLAG...]: what is linked with libboxtree.a; flags come last on the command line.
static() {
  local name=$1 compiler=$2
  shift 2
  "$compiler" -std=c99 -O2 -I"$source/runtime/include" "$here/digests.c" -o "$work/$name/digests" \
    "$work/$name/runtime/libboxtree.a" "$@" >>"$work/$name.log" 2>&1 && return 0
  tail -5 "$work/$name.log"
  fail "$name" "the program does not compile"
  return 1
}
# For another system.
cross() {
  local name=$1 system=$2 processor=$3 compiler=$4
  shift 4
  built "$name" -DCMAKE_SYSTEM_NAME="$system" -DCMAKE_SYSTEM_PROCESSOR="$processor" -DCMAKE_CXX_COMPILER="$compiler" "$@"
}
# emulated NAME PROCESSOR TRIPLE PACKAGES RUNNER [OPTION...]
emulated() {
  local name=$1 processor=$2 triple=$3 packages=$4 runner=$5
  shift 5
  # shellcheck disable=SC2086 # a list of words
  install_missing $packages
  cross "$name" Linux "$processor" "$triple-g++" "$@" || return 0
  local flags=()
  [ "$name" != i386 ] || flags=(-msse2 -mfpmath=sse)
  static "$name" "$triple-gcc" "${flags[@]}" -static -lstdc++ -lm || return 0
  # shellcheck disable=SC2086 # nothing where the processor runs it
  conclude "$name" "$work/$name/digests" $runner
}

platform_c() {
  gcc -std=c99 -pedantic-errors -Wall -Wextra -Werror -O2 -I"$source/runtime/include" "$here/digests.c" -o "$work/digests_c" \
    -L"$build/runtime" -lboxtree -Wl,-rpath,"$build/runtime" -lm || { fail c "the program does not compile"; return 0; }
  conclude c "$work/digests_c"
}
platform_scalar() {
  built scalar -DBOXTREE_SIMD=OFF || return 0
  static scalar gcc -lstdc++ -lm || return 0
  conclude scalar "$work/scalar/digests"
}
platform_sse4() {
  by_vectors sse4 sse4 || return 0
  conclude sse4 "$work/sse4/digests"
}
platform_avx512() {
  by_vectors avx512 "sse4;avx2;avx512" || return 0
  with_avx512 avx512
}
# What is built everywhere, on such a processor: walks by AVX2, leaves of clusters by AVX-512.
platform_avx512-leaves() {
  by_vectors avx512-leaves "sse4;avx2" || return 0
  with_avx512 avx512-leaves
}
# with_avx512 NAME: on this processor or on one that is emulated.
with_avx512() {
  if grep -q avx512_vbmi2 /proc/cpuinfo; then
    conclude "$1" "$work/$1/digests"
  else
    BOXTREE_BOCHS=$work/bochs conclude "$1" "$work/$1/digests" "$here/in_bochs.sh"
  fi
}
# by_vectors NAME SETS: what is linked with walks by these vectors.
by_vectors() {
  built "$1" -DBOXTREE_INSTRUCTION_SETS="$2" && static "$1" gcc -lhwy -lstdc++ -lm
}
platform_O0() {
  built O0 -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 || return 0
  static O0 gcc -lhwy -lstdc++ -lm || return 0
  conclude O0 "$work/O0/digests"
}
platform_clang() {
  install_missing clang
  built clang -DCMAKE_CXX_COMPILER=clang++ || return 0
  static clang clang -lhwy -lstdc++ -lm || return 0
  conclude clang "$work/clang/digests"
}
platform_libcxx() {
  install_missing clang libc++-dev libc++abi-dev
  # Highway of Debian is compiled for libstdc++, so this is without.
  built libcxx -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-stdlib=libc++ -DBOXTREE_HIGHWAY=OFF || return 0
  static libcxx clang -lc++ -lc++abi -lm || return 0
  conclude libcxx "$work/libcxx/digests"
}
# built_for_windows NAME TARGET...: in $work/windows, whichever platform comes first. Tests are of GoogleTest's source.
built_for_windows() {
  local name=$1 log=$work/windows.log
  shift
  install_missing g++-mingw-w64-x86-64-posix wine wine64 googletest
  export WINEDEBUG=-all WINEPREFIX="$work/wine"
  if cmake -S "$source" -B "$work/windows" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Windows \
    -DCMAKE_SYSTEM_PROCESSOR=x86_64 -DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc-posix \
    -DCMAKE_CXX_COMPILER=x86_64-w64-mingw32-g++-posix -DCMAKE_RC_COMPILER=x86_64-w64-mingw32-windres \
    -DBOXTREE_BUILD_COOKER=ON -DBOXTREE_BUILD_SAMPLES=OFF >"$log" 2>&1 &&
    cmake --build "$work/windows" --target "$@" >>"$log" 2>&1; then
    # One server for all programs: that of Debian's Wine ends with each of them, and resets the connection of
    # the next one if that comes just then. It fails where one runs already.
    mkdir -p "$WINEPREFIX"
    wineserver -p60 </dev/null >/dev/null 2>&1 || true
    return 0
  fi
  grep -E 'error|Error' "$log" | head -5
  fail "$name" "does not build, see $log"
  return 1
}
platform_windows() {
  built_for_windows windows boxtree_c boxtree_c_static || return 0
  # The library exports what the header declares, and nothing else.
  x86_64-w64-mingw32-nm "$work/windows/runtime/libboxtree.dll.a" 2>/dev/null | sed -n 's/^[0-9a-f]* I __imp_//p' | sort >"$work/windows/exported"
  sed -n 's/^BXT_API [^(]*[ *]\(bxt_[a-z0-9_]*\)(.*/\1/p' "$source/runtime/include/boxtree_c.h" | sort >"$work/windows/declared"
  diff "$work/windows/exported" "$work/windows/declared" >"$work/windows/exports.diff" ||
    { head -5 "$work/windows/exports.diff"; fail windows "boxtree.dll exports (left) what is not declared (right)"; return 0; }
  cp "$work/windows/runtime/boxtree.dll" "$work/windows/"
  x86_64-w64-mingw32-gcc-posix -std=c99 -O2 -I"$source/runtime/include" "$here/digests.c" -o "$work/windows/digests.exe" \
    "$work/windows/runtime/libboxtree.dll.a" || { fail windows "the program does not compile"; return 0; }
  rm -rf "$work/windows/files"
  mkdir "$work/windows/files"
  if ! (
    cd "$work/windows" &&
      x86_64-w64-mingw32-gcc-posix -std=c99 -O2 -I"$source/runtime/include" "$here/windows_files.c" \
        runtime/libboxtree.dll.a -o files/windows_files.exe && cp boxtree.dll files && cd files && wine windows_files.exe "$work/crate.bxt"
  ) >"$work/windows.files.log" 2>&1; then
    grep -v ':err:\|^wine' "$work/windows.files.log" | tail -5
    fail windows "files are opened in another way, see $work/windows.files.log"
    return 0
  fi
  conclude windows "$work/windows/digests.exe" wine
}
platform_windows-cli() {
  built_for_windows windows-cli boxtree_cli || return 0
  local folder=$work/windows/compared
  rm -rf "$folder"
  mkdir "$folder"
  (cd "$work" && cp "${files[@]}" "$folder")
  if "$here/windows_command_line.sh" "$build/boxtree" "$work/windows/boxtree.exe" "$source" "$folder" >"$work/windows-cli.txt"; then
    echo "PASS windows-cli $(tail -1 "$work/windows-cli.txt")"
  else
    head -5 "$work/windows-cli.txt"
    fail windows-cli "does not do what this machine's does, see $work/windows-cli.txt"
  fi
}
# A line for each program that fails; at last the number of their tests.
platform_windows-suites() {
  local suites="suites" list program name passed=0 failing=()
  [ -z "$long" ] || suites="suites long_suites"
  for list in $suites; do built_for_windows windows-suites "boxtree_$list" || return 0; done
  while read -r program; do
    name=$(basename "$program" .exe)
    if WINEPATH="$work/windows/runtime" timeout 3600 wine "$program" --gtest_brief=1 </dev/null 2>"$work/windows.$name.err" |
      tr -d '\r' >"$work/windows.$name.txt"; then
      passed=$((passed + $(grep -oE '^\[  PASSED  \] [0-9]+' "$work/windows.$name.txt" | grep -oE '[0-9]+$')))
    else
      failing+=("$name")
      { grep -E '^\[  FAILED  \]|Failure' "$work/windows.$name.txt" || tail -3 "$work/windows.$name.err"; } | head -5
    fi
  done < <(for list in $suites; do cat "$work/windows/$list.txt"; done)
  if [ ${#failing[@]} = 0 ]; then
    echo "PASS windows-suites $passed tests"
  else
    fail windows-suites "${failing[*]}: see $work/windows.NAME.txt"
  fi
}
platform_arm64() { emulated arm64 aarch64 aarch64-linux-gnu "g++-aarch64-linux-gnu qemu-user-static" qemu-aarch64-static; }
# Highway is a library, so it is that of Debian's arm64.
platform_arm64-neon() {
  local root=$work/arm64-packages libraries=usr/lib/aarch64-linux-gnu
  install_missing g++-aarch64-linux-gnu qemu-user-static pkg-config
  fetched arm64 "$root" libhwy1 libhwy-dev || { fail arm64-neon "no packages of arm64, see $root.log"; return 0; }
  PKG_CONFIG_LIBDIR=$root/$libraries/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root \
    cross arm64-neon Linux aarch64 aarch64-linux-gnu-g++ -DBOXTREE_HIGHWAY=ON || return 0
  static arm64-neon aarch64-linux-gnu-gcc -L"$root/$libraries" -lhwy -Wl,-rpath,"$root/$libraries" -lstdc++ -lm || return 0
  conclude arm64-neon "$work/arm64-neon/digests" qemu-aarch64-static -L /usr/aarch64-linux-gnu
}
# fetched ARCHITECTURE FOLDER PACKAGE...: unpacks what Debian has for another architecture; nothing is installed.
fetched() {
  local architecture=$1 folder=$2 new=$2.new
  shift 2
  [ ! -d "$folder" ] || return 0
  rm -rf "$new"
  mkdir -p "$new/lists/partial" "$new/cache/archives/partial" "$new/unpacked"
  local apt=(apt-get -q -o "APT::Architecture=$architecture" -o "APT::Architectures=$architecture" -o "Dir::State::Lists=$new/lists"
    -o "Dir::Cache=$new/cache" -o Dir::State::status=/dev/null -o APT::Sandbox::User=root)
  (
    cd "$new" && "${apt[@]}" update && "${apt[@]}" download "$@" &&
      for package in *.deb; do dpkg -x "$package" unpacked || exit; done && mv unpacked "$folder"
  ) >"$folder.log" 2>&1 && rm -rf "$new"
}
platform_armhf() { emulated armhf armv7l arm-linux-gnueabihf "g++-arm-linux-gnueabihf qemu-user-static" qemu-arm-static; }
platform_riscv64() { emulated riscv64 riscv64 riscv64-linux-gnu "g++-riscv64-linux-gnu qemu-user-static" qemu-riscv64-static; }
# As they are, or under QEMU where the kernel runs no programs of 32 bits.
platform_i386() {
  local runner=
  install_missing g++-i686-linux-gnu
  echo 'int main() {}' | i686-linux-gnu-g++ -static -x c++ - -o "$work/i386.probe"
  "$work/i386.probe" 2>"$work/i386.probe.err" || runner=qemu-i386-static
  emulated i386 i686 i686-linux-gnu "g++-i686-linux-gnu ${runner:+qemu-user-static}" "$runner"
}
platform_farm() {
  install_missing bazel-bootstrap nginx-light libnginx-mod-http-dav-ext slurm-wlm munge
  local engine
  for engine in http bazel slurm; do
    if "$source/tests/farm/${engine}_test.sh" "$build/boxtree" >"$work/$engine.log" 2>&1; then
      echo "PASS farm $(tail -n 1 "$work/$engine.log")"
    else
      tail -n 5 "$work/$engine.log"
      fail farm "$engine, see $work/$engine.log"
    fi
  done
}
# The two files of the amalgamation, in $work/NAME.
amalgamated() { python3 "$source/runtime/c/amalgamate.py" "$source" "$work/$1"; }
# As docs/GUIDE.md says, in an empty folder: with no flag of the project, but with contraction of products and sums where the
# compiler likes it.
platform_amalgamation() {
  local folder=$work/amalgamation commands
  rm -rf "$folder"
  mkdir "$folder"
  # guide SECTION LANGUAGE: the blocks of a section.
  guide() { python3 "$source/tests/docs/blocks.py" <(sed -n "/^## $1\$/,/^## /p" "$source/docs/GUIDE.md") "$2"; }
  guide "Use it from C" c >"$folder/ground.c"
  ln -s "$source"/{CMakeLists.txt,cmake,format,runtime} "$folder"
  commands=$(guide "Use it without a build system" sh)
  [ "$(wc -l <<<"$commands")" -eq 3 ] || { fail amalgamation "the guide has other commands: $commands"; return 0; }
  "$build/boxtree" cook "$source/samples/meshes/level.obj" -o "$folder/level.bxt" -q
  (
    c++() { command c++ -march=native "$@"; }
    cd "$folder" &&
    eval "${commands//$'\n'/ && }" &&
    gcc -std=c99 -O2 -Itwo_files "$here/digests.c" boxtree_amalgamated.o -o digests -lstdc++ -lm &&
    command c++ -std=c++20 -O2 -DBXT_ONLY_RAYS -c two_files/boxtree_amalgamated.cpp -o rays.o &&
    gcc -std=c99 -O2 -Itwo_files "$source/samples/c/first_ray.c" rays.o -o first_ray -lstdc++ -lm
  ) >"$work/amalgamation.log" 2>&1 || { tail -5 "$work/amalgamation.log"; fail amalgamation "does not compile"; return 0; }
  (cd "$folder" && ./ground) | tail -1 | diff - <(guide "Use it from C" text) ||
    { fail amalgamation "the guide's program prints something else (left)"; return 0; }
  # Found by an audit: -ffast-math was refused, its parts were not.
  local part
  for part in -funsafe-math-optimizations -ffinite-math-only -freciprocal-math; do
    g++ -std=c++20 "$part" -Wfatal-errors -fsyntax-only "$folder/two_files/boxtree_amalgamated.cpp" 2>"$work/amalgamation.log" &&
      { fail amalgamation "compiles with $part"; return 0; }
    grep -q 'decides by exact arithmetic' "$work/amalgamation.log" || { fail amalgamation "another error of $part"; return 0; }
  done
  [ "$("$folder/first_ray" "$folder/level.bxt")" = "ground at height 0.5, face 2" ] ||
    { fail amalgamation "finds another ground with BXT_ONLY_RAYS"; return 0; }
  conclude amalgamation "$folder/digests"
}
# Node runs what emcc writes; files are those of this machine.
platform_wasm() {
  install_missing emscripten
  amalgamated wasm
  (
    cd "$work/wasm" || exit
    export NODE_PATH=/usr/share/nodejs  # where the optimiser looks for what Debian has
    em++ -std=c++20 -O2 -c boxtree_amalgamated.cpp &&
    emcc -std=c99 -O2 -I. -c "$here/digests.c" &&
    em++ -O2 boxtree_amalgamated.o digests.o -o digests.js -sNODERAWFS=1 -sTOTAL_STACK=2MB -sALLOW_MEMORY_GROWTH=1 -sEXIT_RUNTIME=1
  ) >"$work/wasm.log" 2>&1 || { tail -5 "$work/wasm.log"; fail wasm "does not compile"; return 0; }
  conclude wasm "$work/wasm/digests.js" node --no-experimental-fetch
}

for name in $wanted; do "platform_$name"; done
exit "$failed"
