#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What projects meet that use boxtree by CMake: boxtree_add_cooked_assets in all its forms, find_package
# with its components, versions and silence, boxtree below another project, and pkg-config. Builds little:
# most is seen when CMake configures.
#   cmake_test.sh BUILD SOURCE
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "cmake: $*"; exit 1; }
# shellcheck source=tests/consumer/quiet.sh
. "$source/tests/consumer/quiet.sh"
cache() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
compiler=$(cache CMAKE_CXX_COMPILER)
version=$(cache CMAKE_PROJECT_VERSION)
shared=$(cache BUILD_SHARED_LIBS)
quiet cmake --install "$build" --prefix "$work/prefix"
config=$(find "$work/prefix" -name boxtreeConfig.cmake)
lib=${config%/cmake/boxtree/*}
# Where Debian has libraries; CMake looks there if a compiler tells it to, and a project without languages has none.
architecture=()
[[ $lib == */lib/* ]] && architecture=(-DCMAKE_LIBRARY_ARCHITECTURE="${lib##*/}")
cp -r "$source/samples/meshes" "$work/meshes"

# project NAME LANGUAGES: a project of the lines of standard input.
project() {
  mkdir -p "$work/$1"
  { printf 'cmake_minimum_required(VERSION 3.25)\nproject(%s VERSION 7.8.9 LANGUAGES %s)\n' "$1" "$2"; cat; } \
    >"$work/$1/CMakeLists.txt"
}
configure() {
  local name=$1
  shift
  cmake -S "$work/$name" -B "$work/$name/build" -G Ninja --no-warn-unused-cli -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCMAKE_CXX_COMPILER="$compiler" "${architecture[@]}" "$@" >"$work/log" 2>&1
}
configured() { configure "$@" || { cat "$work/log"; fail "$1 is not configured"; }; }
# refused WHY OPTION...: CMake must refuse a project without languages, the lines of standard input, and say
# WHY, whatever the places where it breaks lines.
refused() {
  local why=$1
  shift
  rm -rf "$work/refused"
  project refused NONE
  if configure refused "$@"; then fail "not refused: $why"; fi
  tr -s ' \n' '  ' <"$work/log" | grep -qF -- "$why" || { cat "$work/log"; fail "unclear, without: $why"; }
}

# --- boxtree_add_cooked_assets ---

# Several calls for a target, options by generator expressions, relative folders, an INTERFACE library,
# a file that two targets in two folders share.
project assets CXX <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_executable(game game.cpp)
boxtree_add_cooked_assets(TARGET game MESHES ../meshes/level.obj ../meshes/crate.obj)
boxtree_add_cooked_assets(TARGET game MESHES ../meshes/crate.obj OUTPUT_DIR small DEFINITION SMALL_DIR
                          OPTIONS --codec $<IF:$<CONFIG:Release>,${CODEC},none> $<$<CONFIG:Debug>:--none>)
boxtree_add_cooked_assets(TARGET game MESHES ../meshes/crate.obj)
add_subdirectory(library)
add_executable(viewer game.cpp)
target_link_libraries(viewer PRIVATE library)
CMAKE
mkdir "$work/assets/library"
cat >"$work/assets/library/CMakeLists.txt" <<'CMAKE'
add_library(library INTERFACE)
boxtree_add_cooked_assets(TARGET library MESHES ../../meshes/level.obj OUTPUT_DIR ${PROJECT_BINARY_DIR})
boxtree_add_cooked_assets(TARGET library MESHES ../../meshes/level.obj OUTPUT_DIR own/deep DEFINITION SMALL_DIR)
CMAKE
cat >"$work/assets/game.cpp" <<'CODE'
#include <cstdio>
int main() { std::puts(BOXTREE_ASSET_DIR "\n" SMALL_DIR); }
CODE
codec_of() { "$work/prefix/bin/boxtree" info "$1" --json | jq -r '.trees[0].codec'; }
out=$work/assets/build
configured assets -DCODEC=packed-f32
quiet cmake --build "$out" --target viewer
for file in "$out/level.bxt" "$out/library/own/deep/level.bxt"; do
  [ -f "$file" ] || fail "viewer: $file was not cooked before it was built"
done
[ ! -e "$out/small/crate.bxt" ] || fail "viewer: cooked what it does not use"
[ "$("$out/viewer")" = "$(printf '%s\n%s/library/own/deep' "$out" "$out")" ] || fail "viewer: $("$out/viewer")"
quiet cmake --build "$out"
[ "$("$out/game")" = "$(printf '%s\n%s/small' "$out" "$out")" ] || fail "game: $("$out/game")"
[ "$(codec_of "$out/small/crate.bxt")" = packed-f32 ] || fail "options of the call were lost"
[ "$(codec_of "$out/crate.bxt")" != packed-f32 ] || fail "options of another call were used"
for generator in Ninja "Unix Makefiles"; do # another option cooks again, and just that
  rm -rf "$out"
  configured assets -G "$generator" -DCODEC=packed-f32
  quiet cmake --build "$out"
  sleep 1.1 # Make compares whole seconds on some file systems
  configured assets -G "$generator" -DCODEC=plain-f16
  quiet cmake --build "$out"
  [ "$(codec_of "$out/small/crate.bxt")" = plain-f16 ] || fail "$generator: another option did not recook"
  grep -q 'Cooking small/crate.bxt$' "$work/log" || fail "$generator: what is cooked is not told with its folder"
  [ "$(grep -c Cooking "$work/log")" = 1 ] || fail "$generator: another option recooked all"
done

# A cache: another build folder cooks nothing, by the variable or by CACHE, and depfiles are those of cooks.
project cached CXX <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(plain)
boxtree_add_cooked_assets(TARGET plain MESHES ../meshes/level.obj)
add_custom_target(named)
boxtree_add_cooked_assets(TARGET named MESHES ../meshes/level.obj OUTPUT_DIR named CACHE own)
add_custom_target(none)
boxtree_add_cooked_assets(TARGET none MESHES ../meshes/crate.obj OUTPUT_DIR none CACHE OFF)
CMAKE
out=$work/cached/build
entries() { find "$1/ac" -type f 2>/dev/null | wc -l; }
for round in 1 2; do
  rm -rf "$out/level.bxt" "$out/none"
  configured cached -DBOXTREE_CACHE="$work/shared cache"
  quiet cmake --build "$out" --target plain named none
  [ "$(entries "$work/shared cache")" = 1 ] || fail "BOXTREE_CACHE: $(entries "$work/shared cache") entries in round $round"
  [ "$(entries "$out/own")" = 1 ] || fail "CACHE is not the folder below the build"
  cmp "$out/level.bxt" "$out/named/level.bxt"
  cmp "$out/level.bxt.d" <(sed 's|/named/|/|' "$out/named/level.bxt.d") || fail "the depfile of a hit is another"
done
ninja -C "$out" -t commands level.bxt | grep -q -- '--cache' || fail "no cache in the command"
if ninja -C "$out" -t commands none/crate.bxt | grep -q -- '--cache'; then fail "CACHE OFF is not none"; fi
configured cached -DBOXTREE_CACHE=http://host:8080/x
ninja -C "$out" -t commands level.bxt | grep -q -- '--cache http://host:8080/x ' || fail "a URL is taken for a folder"

# A profile that says itself what to cook, as in GUIDE.md: once, and again if a mesh of it changes. Found by a newcomer: a cooked
# file beside it is not taken for the output.
mkdir "$work/listed"
cp "$work/meshes"/* "$work/listed"
printf '#include <cstdio>\nint main() { std::puts(BOXTREE_ASSET_DIR "/scene.bxt"); }\n' >"$work/listed/game.cpp"
printf '[[mesh]]\nname = "crate"\nfile = "crate.obj"\n[[instance]]\nmesh = "crate"\n' >"$work/listed/scene.toml"
: >"$work/listed/scene.bxt"
{
  printf '%s\n' 'find_package(boxtree CONFIG REQUIRED)' 'add_executable(game game.cpp)'
  python3 "$source/tests/docs/blocks.py" "$source/docs/GUIDE.md" cmake |
    grep -x 'boxtree_add_cooked_assets(TARGET game PROFILES scene.toml)'
} | project listed CXX
for generator in Ninja "Unix Makefiles"; do
  out=$work/listed/build
  rm -rf "$out"
  configured listed -G "$generator"
  quiet cmake --build "$out"
  [ "$("$work/prefix/bin/boxtree" info "$out/scene.bxt" --json | jq .scene.instance_count)" = 1 ] || fail "no scene"
  [ "$("$out/game")" = "$out/scene.bxt" ] || fail "$generator: the program does not know the scene"
  quiet cmake --build "$out"
  if grep -q Cooking "$work/log"; then fail "$generator: a scene was cooked twice"; fi
  sleep 1.1
  touch "$work/listed/crate.obj"
  quiet cmake --build "$out"
  grep -q 'Cooking scene.bxt' "$work/log" || fail "$generator: a mesh of a profile did not recook its scene"
done

# The tiles of GUIDE.md: a file for each, all on one grid; a mesh that comes later is cooked, too, and it alone.
mkdir -p "$work/world/tiles"
cp "$work/assets/game.cpp" "$work/world"
printf 'v %s\n' '0 0 0' '1.3 0 0' '0 1.7 0.3' >"$work/world/tiles/left.obj"
printf 'v %s\n' '1.3 0 0' '90.1 0 0' '88.9 1.2 2' >"$work/world/tiles/right.obj"
for tile in left right; do printf 'f 1 2 3\n' >>"$work/world/tiles/$tile.obj"; done
{
  printf '%s\n' 'find_package(boxtree CONFIG REQUIRED)' 'add_executable(game game.cpp)' \
    'target_compile_definitions(game PRIVATE BOXTREE_ASSET_DIR="" SMALL_DIR="")'
  python3 "$source/tests/docs/blocks.py" "$source/docs/GUIDE.md" cmake |
    sed -n '/^file(GLOB tiles /,/^boxtree_add_cooked_assets(/p'
} | project world CXX
configured world
out=$work/world/build
quiet cmake --build "$out"
cp "$work/world/tiles/left.obj" "$work/world/tiles/up.obj"
quiet cmake --build "$out"
[ "$(grep -c Cooking "$work/log")" = 1 ] || fail "a new tile recooked all"
steps=$("$work/prefix/bin/boxtree" info "$out"/tiles/{left,right,up}.bxt --json | jq -c '[.files[].trees[].grid_step]')
[ "$steps" = '[0.0009765625,0.0009765625,0.0009765625]' ] || fail "tiles on other grids: $steps"

# What is refused when CMake configures, with what to do about it.
refused 'level.obj is cooked into' <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj OPTIONS --exact)
CMAKE
tr -s ' \n' '  ' <"$work/log" | grep -q "with '--exact', too, give one of them another OUTPUT_DIR" || fail "no remedy"
cp "$work/meshes/level.obj" "$work/level.obj"
refused 'would both be cooked into' <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj ../level.obj)
CMAKE
refused 'would both be cooked into' <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(first)
add_custom_target(second)
boxtree_add_cooked_assets(TARGET first MESHES ../meshes/level.obj)
boxtree_add_cooked_assets(TARGET second MESHES ../level.obj)
CMAKE
refused 'add DEFINITION and another name for it, or use one OUTPUT_DIR' <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_library(assets INTERFACE)
boxtree_add_cooked_assets(TARGET assets MESHES ../meshes/level.obj)
boxtree_add_cooked_assets(TARGET assets MESHES ../meshes/crate.obj OUTPUT_DIR other)
CMAKE
refused "there is no target nothing; call add_executable or add_library" <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
boxtree_add_cooked_assets(TARGET nothing MESHES ../meshes/level.obj)
CMAKE
# refused_call WHY ARGUMENT...: of boxtree_add_cooked_assets, for the target all_assets unless one is named.
refused_call() {
  local why=$1
  shift
  refused "boxtree_add_cooked_assets: $why" <<CMAKE
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets($*)
CMAKE
  tr -s ' \n' '  ' <"$work/log" | grep -qF 'TARGET target [MESHES mesh...]' || fail "not told how to call it: $why"
}
refused_call "'OPTION' in MESHES is no keyword; did you mean OPTIONS?" \
  TARGET all_assets MESHES ../meshes/level.obj OPTION --exact
refused_call "'options' in MESHES is no keyword; did you mean OPTIONS?" \
  TARGET all_assets MESHES ../meshes/level.obj options --exact
refused_call "'output_dir' in OPTIONS is no keyword; did you mean OUTPUT_DIR?" \
  TARGET all_assets MESHES ../meshes/level.obj OPTIONS --exact output_dir other
refused_call "'OUTPUT_DIRECTORY' in MESHES is no keyword; did you mean OUTPUT_DIR?" \
  TARGET all_assets MESHES ../meshes/level.obj OUTPUT_DIRECTORY other
refused_call "OPTIONS has '--cache'; did you mean CACHE?" TARGET all_assets MESHES ../meshes/level.obj OPTIONS --cache own
refused_call "'OUTDIR' in OPTIONS is no keyword; did you mean OUTPUT_DIR?" \
  TARGET all_assets MESHES ../meshes/level.obj OPTIONS --exact OUTDIR other
refused_call "'DEPENDS' in MESHES is neither a keyword nor the name of a file" \
  TARGET all_assets MESHES ../meshes/level.obj DEPENDS other
refused_call "'MESH' is no keyword; did you mean MESHES? Expected" TARGET all_assets MESH ../meshes/level.obj
refused_call "'../meshes/level.obj' is no keyword and stands behind none that takes it. Expected" TARGET all_assets ../meshes/level.obj
refused_call "MESHES has '../meshes/level.obj;../meshes/crate.obj' in one piece" \
  TARGET all_assets MESHES '"../meshes/level.obj;../meshes/crate.obj"'
refused_call "CACHE of target all_assets has no value" TARGET all_assets MESHES ../meshes/level.obj CACHE
refused_call "DEFINITION is 'A B', which is no name of a macro" TARGET all_assets MESHES ../meshes/level.obj DEFINITION '"A B"'
refused_call "target boxtree::cli is imported, and this build makes nothing for it" TARGET boxtree::cli MESHES ../meshes/level.obj
refused_call "TARGET is missing" MESHES ../meshes/level.obj
# shellcheck disable=SC2016 # a variable of CMake
for meshes in MESHES 'MESHES ${NONE}' 'MESHES ""' ''; do
  refused_call 'MESHES or PROFILES of target all_assets is missing or an empty list' TARGET all_assets "$meshes" OPTIONS --exact
done
refused 'only OPTIONS may hold generator expressions' <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj OUTPUT_DIR $<CONFIG>)
CMAKE
refused "OPTIONS has '--grid-bits 12' in one piece" <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj OPTIONS "--grid-bits 12")
CMAKE
for option in '-o x.bxt' -ox.bxt --output=x.bxt '--depfile x.d' '--write-reordered x.obj'; do
  refused "OPTIONS has '${option%% *}', but the function names what it writes: NAME.bxt and NAME.bxt.d in OUTPUT_DIR" <<CMAKE
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj OPTIONS --exact $option)
CMAKE
done

# A mesh that is not there is a warning when CMake configures, unless a command makes it, before or after the call.
project meshes NONE <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets ALL)
add_custom_command(OUTPUT before.obj COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/../meshes/crate.obj before.obj)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj ${PROJECT_BINARY_DIR}/before.obj
                          ${PROJECT_BINARY_DIR}/after.obj OPTIONS --codec;wide8 --max-slowdown 100)
add_custom_command(OUTPUT after.obj COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/../meshes/crate.obj after.obj)
if(GONE)
  boxtree_add_cooked_assets(TARGET all_assets MESHES gone.obj OPTIONS -j 2)
endif()
CMAKE
configured meshes
if grep -q Warning "$work/log"; then cat "$work/log"; fail "a mesh that is there or made is warned of"; fi
quiet cmake --build "$work/meshes/build"
for name in level before after; do [ -f "$work/meshes/build/$name.bxt" ] || fail "$name was not cooked"; done
grep -q -- '--jobs 1 --codec wide8' "$work/meshes/build/build.ninja" || fail "cooks of a build take all processors"
configured meshes -DGONE=ON
tr -s ' \n' '  ' <"$work/log" | grep -qF "$work/meshes/gone.obj is not there, and no command" || fail "a mesh is missing without a word"
if grep -q -- '--jobs 1 -j 2' "$work/meshes/build/build.ninja"; then fail "--jobs is there twice"; fi

# A tool of the machine that builds.
project tool NONE <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets ALL)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj)
CMAKE
cat >"$work/tool.sh" <<SHELL
#!/bin/sh
echo "\$1" >>"$work/calls"
exec "$work/prefix/bin/boxtree" "\$@"
SHELL
chmod +x "$work/tool.sh"
configured tool -DBOXTREE_TOOL="$work/tool.sh" -DCMAKE_SYSTEM_NAME=Linux # which is cross compiling
quiet cmake --build "$work/tool/build"
touch "$work/tool.sh"
quiet cmake --build "$work/tool/build"
[ "$(cat "$work/calls")" = "$(printf 'cook\ncook')" ] || fail "BOXTREE_TOOL was not run twice: $(cat "$work/calls")"
nowhere='set(CMAKE_FIND_USE_CMAKE_SYSTEM_PATH OFF)
set(CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH OFF)'
refused 'or set BOXTREE_TOOL to the path of the program boxtree there' -DCMAKE_SYSTEM_NAME=Linux <<CMAKE
find_package(boxtree CONFIG REQUIRED)
$nowhere
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj)
CMAKE
for tool in '/nothing, and no file is there' 'boxtree, which is no absolute path' '/usr, which is a folder'; do
  refused "BOXTREE_TOOL is '${tool/,/\',}" -DBOXTREE_TOOL="${tool%%,*}" <<'CMAKE'
find_package(boxtree CONFIG REQUIRED)
add_custom_target(all_assets)
boxtree_add_cooked_assets(TARGET all_assets MESHES ../meshes/level.obj)
CMAKE
done
rm -rf "$work/tool/build"
PATH="$work/prefix/bin:$PATH" configured tool -DCMAKE_SYSTEM_NAME=Linux
grep -q "^BOXTREE_TOOL:FILEPATH=$work/prefix/bin/boxtree" "$work/tool/build/CMakeCache.txt" ||
  fail "no tool was found in PATH"

# --- find_package ---

# silent LINES: the project's lines print nothing, found or not. expect: boxtree_FOUND afterwards.
silent() {
  local expect=$1 lines=$2
  shift 2
  rm -rf "$work/silent" "$work/without"
  project silent NONE <<<"$lines
if(NOT \"\${boxtree_FOUND}\" STREQUAL \"$expect\")
  message(FATAL_ERROR \"boxtree_FOUND is '\${boxtree_FOUND}'\")
endif()"
  project without NONE <<<""
  configured without "$@"
  sed 's/without/silent/' "$work/log" >"$work/nothing"
  configured silent "$@"
  diff "$work/nothing" "$work/log" || fail "QUIET prints: $lines"
}
silent 1 'find_package(boxtree CONFIG QUIET COMPONENTS runtime paper blob c cli wide8 ray)'
silent 0 'find_package(boxtree CONFIG QUIET COMPONENTS wide5)'
silent 0 'find_package(boxtree CONFIG QUIET)' -DCMAKE_PREFIX_PATH=/nothing

# A project of an old version finds it; CMake says of one that states none, as lines of an example do not, what is missing.
for stated in 'cmake_minimum_required(VERSION 3.2)' ''; do
  rm -rf "$work/old"
  mkdir "$work/old"
  printf '%s\nproject(old LANGUAGES NONE)\nfind_package(boxtree CONFIG REQUIRED COMPONENTS runtime cli)\n%s\n' "$stated" \
    'add_library(meshes INTERFACE)
boxtree_add_cooked_assets(TARGET meshes MESHES ../meshes/level.obj ../meshes/crate.obj)' >"$work/old/CMakeLists.txt"
  if [ -n "$stated" ]; then configured old; elif configure old; then fail "this CMake needs no version"; fi
  if [ "$(grep -c 'CMake Error' "$work/log")" -ne "$([ -n "$stated" ] && echo 0 || echo 1)" ] ||
    grep -q boxtreeConfig "$work/log"; then
    cat "$work/log"
    fail "unclear without a version: '$stated'"
  fi
done

refused 'wide5: there is no such component: there are runtime, paper, blob, c, cli, codecs (plain-f32, plain-f16, ' <<<'find_package(boxtree CONFIG REQUIRED COMPONENTS ray wide5)'
# Versions 0.x are compatible within x.
minor=${version%.*}
for wanted in "$minor" "$version"; do
  project version NONE <<<"find_package(boxtree $wanted CONFIG REQUIRED)"
  configure version || fail "$wanted: not compatible with $version: $(cat "$work/log")"
done
for wanted in "${minor%.*}.$((${minor#*.} + 1))" 1.0 "$minor.$((${version##*.} + 1))"; do
  refused "compatible with requested version \"$wanted\"" <<<"find_package(boxtree $wanted CONFIG REQUIRED)"
done

# The build folder on the PATH, for its program, is searched before the usual places, and does not stand in
# for an installation.
project program_on_path NONE <<'CMAKE'
find_package(boxtree CONFIG REQUIRED COMPONENTS cli)
message("boxtree is in ${boxtree_DIR}")
CMAKE
PATH=$build:$PATH configured program_on_path -DCMAKE_PREFIX_PATH= -DCMAKE_INSTALL_PREFIX="$work/prefix"
grep -qxF "boxtree is in ${config%/*}" "$work/log" ||
  { cat "$work/log"; fail "with the build folder on the PATH, another boxtree is found"; }

# Components that are not wanted add no dependencies; one whose dependencies are missing is not found, and
# says so. Of a static build: the shared library brings its own.
mkdir "$work/pc"
if [ "$shared" != ON ]; then
  for name in libhwy eigen3; do
    pc=$(pkg-config --variable=pcfiledir "$name") && cp "$pc/$name.pc" "$work/pc/"
  done
  project alone NONE <<'CMAKE'
find_package(boxtree CONFIG REQUIRED COMPONENTS runtime paper cli)
if(TARGET PkgConfig::boxtree_zstd OR TARGET boxtree::blob)
  message(FATAL_ERROR "the component blob is found without being wanted")
endif()
CMAKE
  PKG_CONFIG_LIBDIR=$work/pc configured alone
  PKG_CONFIG_LIBDIR=$work/pc refused 'pkg-config does not find libzstd>=1.5' \
    <<<'find_package(boxtree CONFIG REQUIRED COMPONENTS blob)'
fi

# A runtime with less in it says what was left out, and where.
quiet cmake -S "$source" -B "$work/less" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DBOXTREE_BUILD_COOKER=OFF \
  -DBOXTREE_CODECS=wide4 -DBOXTREE_QUERIES=ray -DBOXTREE_BLOB=OFF
while read -r component why; do
  refused "$component: $why" -DCMAKE_PREFIX_PATH="$work/less/for_install" \
    <<<"find_package(boxtree CONFIG REQUIRED COMPONENTS $component)"
done <<'CASES'
pair BOXTREE_QUERIES left it out of this build, which has ray
wide8 BOXTREE_CODECS left it out of this build, which has wide4
paper BOXTREE_CODECS left all codecs of the paper out of this build
blob this build has BOXTREE_BLOB=OFF
c the C interface answers every query, and this build has ray
cli the command line is not installed here
CASES

# --- Below another project ---

# Its settings, variables, cache entries, targets and rules of installation stay as they are.
# shellcheck disable=SC2016 # variables of CMake
for way in 'add_subdirectory("${SOURCE}" boxtree)' \
  'include(FetchContent)
   FetchContent_Declare(boxtree SOURCE_DIR "${SOURCE}" BINARY_DIR "${CMAKE_BINARY_DIR}/boxtree")
   FetchContent_MakeAvailable(boxtree)'; do
  rm -rf "$work/parent"
  project parent CXX <<CMAKE
$(grep -q FetchContent <<<"$way" && echo 'include(FetchContent)')
set(CMAKE_INSTALL_PREFIX /elsewhere)
get_cmake_property(variables_before VARIABLES)
foreach(name IN LISTS variables_before)
  set(before_\${name} "\${\${name}}")
endforeach()
get_cmake_property(cache_before CACHE_VARIABLES)
macro(see_boxtree)
  $way
endmacro()
see_boxtree()
get_cmake_property(cache_after CACHE_VARIABLES)
foreach(name IN LISTS variables_before)
  if(NOT name MATCHES "^(ARG[CNV0-9]*|variables_before|CACHE_VARIABLES|.*_before|CMAKE_MATCH_.*)$" AND
     NOT "\${before_\${name}}" STREQUAL "\${\${name}}")
    message(SEND_ERROR "\${name} was '\${before_\${name}}' and is '\${\${name}}'")
  endif()
endforeach()
# New in the cache: options, where packages lie, and what modules of CMake put there by itself.
list(REMOVE_ITEM cache_after \${cache_before})
foreach(name IN LISTS cache_after)
  if(NOT name MATCHES "^(BOXTREE_|boxtree_|_?_?pkg_config_|pkgcfg_lib_boxtree_|PKG_CONFIG_|FETCHCONTENT_|_CMAKE_|_GNUInstallDirs_)|^([A-Za-z0-9]+|nlohmann_json)_DIR$|^FIND_PACKAGE_MESSAGE_DETAILS|^CMAKE_INSTALL_[A-Z]*DIR$|\
^prefix_result$")
    message(SEND_ERROR "new in the cache: \${name}")
  endif()
endforeach()
function(check_targets folder)
  get_property(targets DIRECTORY \${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    if(NOT target MATCHES "^boxtree_")
      message(SEND_ERROR "\${folder} has a target \${target}")
    endif()
  endforeach()
  get_property(below DIRECTORY \${folder} PROPERTY SUBDIRECTORIES)
  foreach(each IN LISTS below)
    check_targets(\${each})
  endforeach()
endfunction()
check_targets("\${SOURCE}")
get_property(includes DIRECTORY PROPERTY INCLUDE_DIRECTORIES)
get_property(tests DIRECTORY PROPERTY TESTS)
if(includes OR tests OR NOT "\${CMAKE_BUILD_TYPE}" STREQUAL "")
  message(SEND_ERROR "folders '\${includes}', tests '\${tests}', build type '\${CMAKE_BUILD_TYPE}'")
endif()
foreach(target boxtree::format boxtree::runtime boxtree::paper boxtree::blob boxtree::c boxtree::c_static boxtree::cli)
  if(NOT TARGET \${target})
    message(SEND_ERROR "there is no \${target}")
  endif()
endforeach()
add_executable(game game.cpp)
boxtree_add_cooked_assets(TARGET game MESHES ../meshes/level.obj OUTPUT_DIR assets)
target_link_libraries(game PRIVATE boxtree::runtime)
CMAKE
  echo 'int main() {}' >"$work/parent/game.cpp"
  configured parent -DCMAKE_BUILD_TYPE= -DSOURCE="$source"
  grep -q 'boxtree: CMAKE_BUILD_TYPE is empty, so nothing is optimised' "$work/log" || fail "slow code without a word"
  if grep -rl --include=cmake_install.cmake 'file(INSTALL' "$work/parent/build"; then fail "boxtree installs itself"; fi
  # Not by a dry run, which stops where it would look for new sources.
  ninja -C "$work/parent/build" -t commands game >"$work/log"
  grep -q 'cook .*level.obj -o .*assets/level.bxt' "$work/log" || fail "nothing would be cooked"
  [ -e "$work/parent/build/CPackConfig.cmake" ] && fail "boxtree configures packages"
done
# Unless it is wanted.
configured parent -DCMAKE_BUILD_TYPE= -DSOURCE="$source" -DBOXTREE_INSTALL=ON
grep -rq --include=cmake_install.cmake 'file(INSTALL' "$work/parent/build" || fail "BOXTREE_INSTALL=ON installs nothing"
quiet cmake -S "$source" -B "$work/less" -DBOXTREE_INSTALL=OFF
grep -rq --include=cmake_install.cmake 'file(INSTALL' "$work/less" && fail "BOXTREE_INSTALL=OFF installs"

# --- pkg-config ---

cat >"$work/plain.cpp" <<'CODE'
#include <boxtree/boxtree.h>
#include <boxtree/paper.h>
int main(int, char** argv) {
  boxtree::use_paper_codecs();
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return 1;
  const auto tree = boxtree::Tree::bind(*file);
  return tree.ok() && boxtree::closest_hit(*tree, {{0, 0, 10}, {0, 0, -1}}) ? 0 : 2;
}
CODE
"$work/prefix/bin/boxtree" cook "$work/meshes/level.obj" -o "$work/level.bxt" --codec plain-f32 -q
mv "$work/prefix" "$work/moved"
lib=${lib/prefix/moved}
export PKG_CONFIG_PATH=$lib/pkgconfig
[ "$(pkg-config --modversion boxtree)" = "$version" ] || fail "boxtree.pc has another version"
sanitize=$(cache BOXTREE_SANITIZE)
read -ra flags <<<"$(pkg-config --cflags --libs boxtree-paper) ${sanitize:+-fsanitize=$sanitize}"
quiet "$compiler" -std=c++20 "$work/plain.cpp" -o "$work/plain" "${flags[@]}"
LD_LIBRARY_PATH=$lib quiet "$work/plain" "$work/level.bxt"

# The GUIDE's Makefile finds the library below a prefix that make's environment does not name.
python3 "$source/tests/docs/blocks.py" "$source/docs/GUIDE.md" makefile |
  sed "s|\$(PREFIX)/lib/|$lib/|" >"$work/Makefile"
grep -q "PKG_CONFIG_PATH=$lib/pkgconfig" "$work/Makefile" || fail "the GUIDE has no Makefile with a prefix"
cat >"$work/game.cpp" <<'CODE'
#include <boxtree/boxtree.h>
int main(int, char** argv) { return boxtree::File::open(argv[1]).ok() ? 0 : 1; }
CODE
quiet env -u PKG_CONFIG_PATH make -C "$work" CXX="$compiler ${sanitize:+-fsanitize=$sanitize}" game
LD_LIBRARY_PATH=$lib quiet "$work/game" "$work/level.bxt"
echo "cmake: as expected"
