#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the project, builds samples/game against it and runs it; touching a mesh, or a file that
# it refers to, recooks just that one, as does removing the latter, and a second build does nothing. Ninja and Make.
set -euo pipefail
build=$1 source=$2
# Libraries with sanitizers want the compiler that made them.
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cp -r "$source/samples" "$work/samples"
fail() { echo "$*"; exit 1; }

for generator in Ninja "Unix Makefiles"; do
  game=$work/game
  rm -rf "$game"
  cmake -S "$work/samples/game" -B "$game" -G "$generator" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
  cmake --build "$game" >"$work/log" || { cat "$work/log"; fail "$generator: build failed"; }
  "$game/game" >"$work/said"
  grep -q 'height 0.5, face 2' "$work/said" || fail "wrong ground: $(cat "$work/said")"
  grep -q 'height 0.6: disjoint' "$work/said" || fail "wrong contact: $(cat "$work/said")"
  grep -q 'height 0.5: touches' "$work/said" || fail "missed contact: $(cat "$work/said")"

  cmake --build "$game" >"$work/log"
  grep -q Cooking "$work/log" && fail "$generator: a second build cooked again"
  sleep 1.1 # Make compares whole seconds on some file systems
  touch "$work/samples/meshes/crate.mtl"
  cmake --build "$game" >"$work/log"
  grep -q 'Cooking crate.bxt' "$work/log" || fail "$generator: a touched .mtl did not recook"
  grep -q 'Cooking level.bxt' "$work/log" && fail "$generator: level was recooked for nothing"
  sleep 1.1
  touch "$work/samples/meshes/level.obj"
  cmake --build "$game" >"$work/log"
  grep -q 'Cooking level.bxt' "$work/log" || fail "$generator: a touched mesh did not recook"
  grep -q 'Cooking crate.bxt' "$work/log" && fail "$generator: crate was recooked for nothing"
  mv "$work/samples/meshes/crate.mtl" "$work/crate.mtl"
  cmake --build "$game" >"$work/log" || { cat "$work/log"; fail "$generator: a .mtl that is gone stops the build"; }
  grep -q 'Cooking crate.bxt' "$work/log" || fail "$generator: a .mtl that is gone did not recook"
  mv "$work/crate.mtl" "$work/samples/meshes/crate.mtl"
done
pages=$work/prefix/share/doc/boxtree
[ -s "$pages/copyright" ] || fail "no licence is installed"
python3 "$source/tests/docs/links_test.py" "$pages" || fail "a link of the pages that are installed"
# Found by a newcomer: samples that need the whole project were configured and built, and made nothing. Those in C need
# what is installed.
for sample in api level bullet_drop; do
  if cmake -S "$pages/samples/$sample" -B "$work/sample" >"$work/log" 2>&1; then fail "samples/$sample is a project of its own"; fi
  grep -q 'DBOXTREE_BUILD_SAMPLES=ON' "$work/log" || { cat "$work/log"; fail "samples/$sample"; }
  rm -rf "$work/sample"
done
{ cmake -S "$pages/samples/c" -B "$work/sample" -DCMAKE_PREFIX_PATH="$work/prefix" && cmake --build "$work/sample"; } \
  >"$work/log" 2>&1 || { cat "$work/log"; fail "samples/c is no project of its own"; }
for program in first_ray tour; do [ -x "$work/sample/$program" ] || fail "samples/c does not make $program"; done
# Found by a newcomer: a plugin exported all that it has of the archives, which those of another plugin could take the place of.
mkdir -p "$work/plugin"
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(plugin LANGUAGES CXX)' 'find_package(boxtree CONFIG REQUIRED)' \
  'add_library(plugin MODULE plugin.cpp)' 'target_link_libraries(plugin PRIVATE boxtree::runtime)' >"$work/plugin/CMakeLists.txt"
printf '%s\n' '#include <boxtree/boxtree.h>' 'extern "C" bool begin() { return boxtree::File::open("level.bxt").ok(); }' >"$work/plugin/plugin.cpp"
{ cmake -S "$work/plugin" -B "$work/plugin/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" &&
  cmake --build "$work/plugin/build"; } >"$work/log" 2>&1 || { cat "$work/log"; fail "a plugin"; }
nm -DC --defined-only "$work/plugin/build/libplugin.so" >"$work/exported"
grep -q ' T begin$' "$work/exported" || fail "a plugin exports nothing"
if grep ' [TDBR] boxtree::' "$work/exported"; then fail "a plugin exports what it has of the archives"; fi
# Found by a newcomer: ninja stops reading a depfile at some characters, and cooked such meshes again each time.
mkdir -p "$work/r&d"
cp "$work/samples/meshes/crate.obj" "$work/samples/meshes/crate.mtl" "$work/r&d"
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(named LANGUAGES CXX)' 'find_package(boxtree CONFIG REQUIRED)' \
  'add_library(named INTERFACE)' 'boxtree_add_cooked_assets(TARGET named MESHES crate.obj)' >"$work/r&d/CMakeLists.txt"
for generator in Ninja "Unix Makefiles"; do
  cmake -S "$work/r&d" -B "$work/named" -G "$generator" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "a folder r&d"; }
  warned=$(tr -s ' \n' ' ' <"$work/log" | grep -c "ninja stops reading a depfile at the '&'" || true)
  [ "$warned" = "$([ "$generator" = Ninja ] && echo 1 || echo 0)" ] || { cat "$work/log"; fail "$generator warned $warned times"; }
  rm -rf "$work/named"
done
# Nothing but public headers is installed, and each of them is enough by itself: no header that
# decodes nodes, and none of the slow ones of the standard library.
public=$(cd "$source" && ls runtime/include/boxtree format/include/boxtree | grep '\.h$' | sort)
[ "$(ls "$work/prefix/include")" = "$(printf 'boxtree\nboxtree_c.h')" ] || fail "installed: $(ls "$work/prefix/include")"
installed=$(cd "$work/prefix/include/boxtree" && find . -type f | sed 's|^\./||' | sort)
[ "$installed" = "$(printf '%s\nconfiguration.h\n' "$public" | sort)" ] ||
  fail "installed headers: $installed"
eigen=$(sed -n 's/^Eigen3_DIR:[A-Z]*=//p' "$build/CMakeCache.txt")/../../../include/eigen3
# Against what the amalgamation has in place of Eigen: Eigen's own includes most of the standard library, which hides what
# a header forgets, and takes longer than all the rest.
mkdir -p "$work/subset/Eigen"
for part in Core Geometry; do
  echo "#include \"$source/runtime/c/amalgamation/eigen_subset.h\"" >"$work/subset/Eigen/$part"
done
for header in $installed; do
  echo "#include <boxtree/$header>" >"$work/alone.cpp"
  "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Werror -I "$work/prefix/include" -isystem "$work/subset" \
    -fsyntax-only -MD -MF "$work/read" -MT it "$work/alone.cpp" || fail "$header is not enough by itself"
  if grep -qE '(codec|grid|variant|filesystem)(\.h)?( |$)' "$work/read"; then
    fail "$header includes $(grep -oE '[^ ]*(codec|grid|variant|filesystem)[^ ]*' "$work/read")"
  fi
done

# Options of which a program names a few give no warning of those that it leaves out.
cat >"$work/options.cpp" <<'CODE'
#include <boxtree/boxtree.h>
boxtree::BindOptions of_tree() { return {.require_face_ids = true, .require_user_data = true}; }
boxtree::SceneOptions of_scene() { return {.require_active_edges = true}; }
boxtree::FaceOptions of_faces() { return {.limits = {.nodes = 10000}}; }
boxtree::SceneFaceOptions of_scene_faces() { return {.layers = 1}; }
CODE
"$compiler" -std=c++20 -Wall -Wextra -Werror -I "$work/prefix/include" -isystem "$eigen" -fsyntax-only "$work/options.cpp" ||
  fail "options give warnings"

# refused MESSAGE OVERLOADS CODE: the compiler says MESSAGE of it, and nothing that matches OVERLOADS. GCC takes the
# headers precompiled; others read them each time.
mkdir -p "$work/precompiled/boxtree"
"$compiler" -std=c++20 -I "$work/prefix/include" -isystem "$eigen" -x c++-header "$work/prefix/include/boxtree/boxtree.h" \
  -o "$work/precompiled/boxtree/boxtree.h.gch"
refused() {
  printf '#include <boxtree/boxtree.h>\n%s\n' "$3" >"$work/refused.cpp"
  if "$compiler" -std=c++20 -I "$work/precompiled" -I "$work/prefix/include" -isystem "$eigen" -fsyntax-only \
    "$work/refused.cpp" 2>"$work/log"; then
    fail "compiles: $3"
  fi
  grep -qF "$1" "$work/log" || { cat "$work/log"; fail "unclear, without: $1"; }
  if grep -E "$2" "$work/log"; then fail "of all overloads: $3"; fi
}
# A visitor that returns nothing is told what to return, by a message and not by all overloads.
refused_visitor() {
  refused "$1" 'no matching function' "void look(const boxtree::Tree& tree) { (void)boxtree::$2; }"
}
refused_visitor 'must return bool: a visitor true to go on' \
  'overlap_sphere(tree, {0, 0, 0}, 1, [](const boxtree::FaceRef&) {})'
refused_visitor 'the largest t that is still of interest' \
  'all_hits(tree, {{0, 0, 9}, {0, 0, -1}}, [](const boxtree::RayHit&) {})'
# Nor is a filter that is temporary, or that is shown something else, an operator= that is missing.
refused_filter() {
  refused "$1" 'no match for|no viable' \
    "void set(boxtree::FaceOptions& tree, boxtree::SceneFaceOptions& scene) { (void)tree, (void)scene; $2; }"
}
refused_filter 'a temporary callable would be gone before the query' \
  'tree.filter = [](const boxtree::FaceRef&) { return true; }'
refused_filter 'a temporary callable would be gone before the query' \
  'scene.instance_filter = [](std::uint32_t) { return true; }'
for filter in tree.filter scene.filter scene.instance_filter; do
  refused_filter 'must be a callable that takes what a filter is shown' \
    "const auto wrong = [](const char*) { return true; }; $filter = wrong"
done
refused_filter 'a filter true for what may be hit' \
  'const auto mute = [](const boxtree::FaceRef&) {}; tree.filter = mute'

refused_visitor 'must return bool: a visitor true to go on' \
  'overlap_sphere(tree, boxtree::Sphere{{0, 0, 0}, 1}, [](const boxtree::FaceRef&) {})'
# Nor is older C++ a page of templates. The headers left out declare plain data, which any C++ takes.
for header in $(sed '/^shape.h$/d;/^triangle.h$/d;/^kinds.h$/d;/^memory.h$/d;/^configuration.h$/d' <<<"$installed"); do
  echo "#include <boxtree/$header>" >"$work/alone.cpp"
  if "$compiler" -std=c++17 -Wfatal-errors -I "$work/prefix/include" -isystem "$eigen" -fsyntax-only "$work/alone.cpp" 2>"$work/log"; then
    fail "$header compiles as C++17"
  fi
  grep -m 1 'error: ' "$work/log" | grep -q 'boxtree needs C++20' || { cat "$work/log"; fail "$header: another error comes first"; }
done

# The component blob is found apart.
mkdir "$work/blob"
cat >"$work/blob/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(blob_user LANGUAGES CXX)
find_package(boxtree CONFIG REQUIRED COMPONENTS blob)
add_executable(blob_user main.cpp)
target_link_libraries(blob_user PRIVATE boxtree::blob)
CMAKE
cat >"$work/blob/main.cpp" <<'CODE'
#include <boxtree/blob.h>
int main(int, char** argv) { return boxtree::open_blob(argv[1]).ok() ? 0 : 1; }
CODE
cmake -S "$work/blob" -B "$work/blob/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
cmake --build "$work/blob/build" >"$work/log" || { cat "$work/log"; fail "blob: build failed"; }
"$work/prefix/bin/boxtree" cook "$source/samples/meshes/level.obj" -o "$work/level.bxt" \
  --codec blob-zstd -q
"$work/blob/build/blob_user" "$work/level.bxt" || fail "blob: not opened"

# The codecs of the paper are there for those who link them.
mkdir "$work/paper"
cat >"$work/paper/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(paper_user LANGUAGES CXX)
find_package(boxtree CONFIG REQUIRED COMPONENTS paper)
add_executable(paper_user main.cpp)
target_link_libraries(paper_user PRIVATE boxtree::paper)
CMAKE
cat >"$work/paper/main.cpp" <<'CODE'
#include <boxtree/boxtree.h>
#include <boxtree/paper.h>
int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return 1;
  if (boxtree::Tree::bind(*file).code() != boxtree::Errc::kCodecUnsupported) return 2;
  boxtree::use_paper_codecs();
  const auto tree = boxtree::Tree::bind(*file);
  return tree.ok() && boxtree::closest_hit(*tree, {{0, 0, 10}, {0, 0, -1}}) ? 0 : 3;
}
CODE
cmake -S "$work/paper" -B "$work/paper/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
cmake --build "$work/paper/build" >"$work/log" || { cat "$work/log"; fail "paper: build failed"; }
"$work/prefix/bin/boxtree" cook "$source/samples/meshes/level.obj" -o "$work/level.bxt" \
  --codec plain-f32 -q
"$work/paper/build/paper_user" "$work/level.bxt" || fail "paper: no answer, status $?"
echo "consumer: as expected"
