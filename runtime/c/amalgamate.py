#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the runtime and its C interface as two files, boxtree_amalgamated.cpp and boxtree_c.h, that
any C++20 compiler takes and that need nothing else: no CMake, no Eigen, no Highway, no xxHash.

    amalgamate.py SOURCE_DIR OUTPUT_DIR

All queries, the wide codecs, without vectors. With BXT_ONLY_RAYS defined: files, trees, rays and
traversals alone.
"""
import pathlib
import re
import sys

# In the order in which they follow each other; a file without a query in CMake's lists is always there.
FOLDERS = ("format", "runtime/file", "runtime/primitive", "runtime/tree", "runtime/walk", "runtime/query",
           "runtime/scene", "runtime/c")
# Walks by Highway, codecs of the paper, and what the amalgamation has files of its own for.
LEFT_OUT = re.compile(r"_wide\.cpp$|/chosen_targets\.cpp$|/cluster_avx512\.cpp$|/codec_p(lain|acked)\.cpp$|"
                      r"runtime/file/checksum\.cpp$")
OWN = ("runtime/c/amalgamation/checksum.cpp",)
EIGEN = "runtime/c/amalgamation/eigen_subset.h"
# Files of the C interface that are about some queries alone.
OF_QUERIES = {"runtime/c/cast.cpp": {"cast"}, "runtime/c/overlap.cpp": {"box"}, "runtime/c/pair.cpp": {"pair"},
              "runtime/c/point.cpp": {"point"}, "runtime/c/scene.cpp": {"scene"}}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"].*$')
CONDITION = re.compile(r"BOXTREE_HAS_(\w+?)_QUERIES")
EVERYTHING = frozenset({"*"})

TOP = """// SPDX-License-Identifier: MIT
// boxtree %(version)s as one file: the runtime, which opens .bxt files and answers queries, behind its C interface,
// boxtree_c.h. Written by runtime/c/amalgamate.py; change the sources that it is made of.
//
//   c++ -std=c++20 -O2 -c boxtree_amalgamated.cpp      g++ and clang++
//   cl /std:c++20 /O2 /fp:strict /EHsc /c boxtree_amalgamated.cpp      (not tested)
//
// -DBXT_ONLY_RAYS: rays and traversals of trees alone. Answers are those of every other build, to the bit.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || __FINITE_MATH_ONLY__ + 0 > 0
#error "boxtree decides by exact arithmetic: compile it without -ffast-math and its parts (-fassociative-math, ...)"
#endif
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("-ffp-contract=off", "-fno-math-errno")
#elif defined(__clang__)
#if defined(__x86_64__) || defined(__i386__)
#pragma float_control(precise, on)  // clang does not tell which parts of -ffast-math it is given; elsewhere it has no such pragma
#endif
#pragma clang fp contract(off) reassociate(off)
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
#include <cfloat>
#if FLT_EVAL_METHOD != 0
#error "boxtree needs doubles that are computed as doubles: for 32-bit x86 compile with -msse2 -mfpmath=sse"
#endif

// ---- configuration
#ifdef BXT_ONLY_RAYS
#define BOXTREE_AMALGAMATED_HAS_ALL 0
#else
#define BOXTREE_AMALGAMATED_HAS_ALL 1
#endif
#define BOXTREE_VERSION "%(version)s"
%(macros)s#define BOXTREE_CODEC_NAMES "wide8 wide4"
#define BOXTREE_WALKS_BY_VECTORS false
#define BOXTREE_LEFT_OUT_TARGETS 0
"""


BIT_CAST = """
namespace boxtree {
template <class To, class From>
constexpr To amalgamated_bit_cast(const From& from) noexcept {
#ifdef __cpp_lib_bit_cast
  return std::bit_cast<To>(from);
#else
  return __builtin_bit_cast(To, from);
#endif
}
}  // namespace boxtree
"""


class Amalgamation:
    def __init__(self, source):
        self.source = source
        cmake = (source / "runtime/CMakeLists.txt").read_text(encoding="utf-8")
        self.queries = {}
        for query, files in re.findall(r"set\(sources_of_(\w+) ([^)]*)\)", cmake):
            for file in files.split():
                # scene_cast.cpp and its like are there if both are.
                self.queries.setdefault("runtime/" + file, set()).add(query.removeprefix("scene_"))
        for file in list(self.queries):
            if file.startswith("runtime/scene/"):
                self.queries[file] = {"scene"}
        self.queries.update(OF_QUERIES)
        known = {p.relative_to(source).as_posix() for p in source.glob("runtime/*/*.cpp")}
        if not self.queries or not known.issuperset(self.queries):
            raise SystemExit(f"amalgamate: not in runtime/: {sorted(self.queries.keys() - known)}, of the lists sources_of_* in CMake")
        self.parts = [p.relative_to(source).as_posix() for folder in FOLDERS
                      for p in sorted((source / folder).glob("*.cpp"))]
        self.parts = [*OWN, *(part for part in self.parts if not LEFT_OUT.search(part))]
        self.guards = {}
        for part in self.parts:
            self.spread(part, frozenset(self.queries.get(part, EVERYTHING)), set())
        self.written = set()
        self.system = set()
        self.out = []

    def path_of(self, bracket, name):
        """A file of the project that an include means; None of the system's."""
        if name.startswith("Eigen/"):
            return EIGEN
        if name in ("boxtree/configuration.h", "boxtree_c.h"):
            return ""
        if name.startswith("boxtree/"):
            places = ("format/include/", "runtime/include/")
            return next(p + name for p in places if (self.source / (p + name)).exists())
        return name if bracket == '"' else None

    def lines(self, path):
        return (self.source / path).read_text(encoding="utf-8").splitlines()

    def includes(self, path):
        """Files that a file includes, and the queries that an #if around needs."""
        conditions = []
        for line in self.lines(path):
            if re.match(r"\s*#\s*if", line):
                conditions.append(frozenset(q.lower() for q in CONDITION.findall(line)))
            elif re.match(r"\s*#\s*endif", line):
                conditions.pop()
            found = INCLUDE.match(line)
            if found:
                needed = [c for c in conditions if c]
                yield self.path_of(*found.groups()), needed[-1] if needed else None

    def spread(self, path, guard, seen):
        """Every file that `path` includes is needed where it is."""
        if (path, guard) in seen:
            return
        seen.add((path, guard))
        self.guards[path] = self.guards.get(path, frozenset()) | guard
        for other, condition in self.includes(path):
            if other:
                self.spread(other, condition or guard, seen)

    def write(self, path):
        """The text of a file, after that of what it includes, under its guard."""
        if path in self.written:
            return
        self.written.add(path)
        body = []
        depth = 0
        for line in self.lines(path):
            if re.match(r"\s*#\s*(if|ifdef|ifndef)\b", line):
                depth += 1
            elif re.match(r"\s*#\s*endif", line):
                depth -= 1
            found = INCLUDE.match(line)
            if line.startswith("#pragma once") or line.startswith("// SPDX"):
                continue
            if not found:
                body.append(line)
                continue
            other = self.path_of(*found.groups())
            if other == "":
                continue
            if other:
                self.write(other)
            elif depth > 0:
                body.append(line)  # of one system alone
            elif line not in self.system:
                self.system.add(line)
        guard = self.guards[path]
        text = "\n".join(body).strip("\n")
        # Takes out each #if that was around includes alone, the inner ones first.
        removed = 1
        while removed:
            text, removed = re.subn(r"^#if [^\n]*\n(?:\s*\n)*#endif[^\n]*\n?", "", text, flags=re.MULTILINE)
        self.out.append(f"\n// ---- {path}")
        if "*" not in guard:
            macros = " || ".join(f"BOXTREE_HAS_{q.upper()}_QUERIES" for q in sorted(guard))
            text = f"#if {macros}\n{text}\n#endif"
        self.out.append(text)

    def text(self):
        for part in self.parts:
            self.write(part)
        version = re.search(r"project\(boxtree VERSION ([\d.]+)", (self.source / "CMakeLists.txt").read_text()).group(1)
        parts = (self.source / "cmake/BoxtreeParts.cmake").read_text(encoding="utf-8")
        macros = ""
        for codec in re.search(r"set\(BOXTREE_ALL_CODECS ([^)]*)\)", parts).group(1).split():
            name = codec.replace("-", "_").upper()
            macros += f"#define BOXTREE_HAS_{name} {int(codec.startswith('wide'))}\n"
        for query in re.search(r"set\(BOXTREE_ALL_QUERIES ([^)]*)\)", parts).group(1).split():
            value = "1" if query == "ray" else "BOXTREE_AMALGAMATED_HAS_ALL"
            macros += f"#define BOXTREE_HAS_{query.upper()}_QUERIES {value}\n"
        top = TOP % {"version": version, "macros": macros}
        system = '\n// ---- the C++ library\n' + "\n".join(sorted(self.system)) + '\n\n#include "boxtree_c.h"\n'
        # Where the C++ library has none yet.
        code = "\n".join(self.out).replace("std::bit_cast", "boxtree::amalgamated_bit_cast")
        return top + system + BIT_CAST + code + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, output = map(pathlib.Path, sys.argv[1:])
    if not (source / "runtime/CMakeLists.txt").is_file():
        sys.exit(f"amalgamate.py: {source}: no sources of boxtree; SOURCE_DIR is the folder that has runtime/ in it")
    text = Amalgamation(source).text()
    output.mkdir(parents=True, exist_ok=True)
    (output / "boxtree_amalgamated.cpp").write_text(text, encoding="utf-8")
    header = (source / "runtime/include/boxtree_c.h").read_text(encoding="utf-8")
    (output / "boxtree_c.h").write_text(header, encoding="utf-8")


main()
