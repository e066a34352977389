#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Dependencies point one way: cooker -> runtime -> format, and inside each of them no folder includes
one that comes after it. Looks at what sources include and, given a build, at what the libraries need of
the linker.

    check_dependencies.py SOURCE_DIR [BUILD_DIR]       exit 1 and a line for each include against the order
"""
import pathlib
import re
import subprocess
import sys

# Each folder may include itself and those before it. "." is what lies in the part's own folder.
ORDER = {
    "format": ["."],
    "runtime": ["file", "primitive", "tree", "walk", "query", "scene", "c", "paper", "blob"],
    "cooker": ["text", "system", "import", "quantise", "build", "encode", "proof", "choose", "write",
               "scene", ".", "reorder", "shell", "farm", "tile", "export", "report", "cli"],
}
PARTS = list(ORDER)
# Other people's headers that a part may include, beside those of the C++ standard library.
LIBRARIES = {
    "format": (),
    "runtime": ("Eigen/", "hwy/", "xxhash.h", "lzma.h", "zstd.h", "xmmintrin.h", "intrin.h",
                "sys/", "fcntl.h", "io.h", "unistd.h", "windows.h"),
}
# What takes seconds of every source that sees it, and what of the project may include it.
SLOW_HEADERS = {"CLI/": ("cooker/cli/command_app.h",),
                "nlohmann/": ("cooker/text/json.cpp",),
                "xxhash.h": ("runtime/file/checksum.cpp",)}
PRINTS = ("iostream", "cstdio", "stdio.h", "print")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
PUBLIC = "boxtree/"
# The C interface, and what of C99 it may include.
C_HEADER = "boxtree_c.h"
OF_C99 = ("math.h", "stdbool.h", "stddef.h", "stdint.h")
# What format shares with applications, in format/include.
OF_FORMAT = ("boxtree/error.h", "boxtree/export.h", "boxtree/kinds.h", "boxtree/memory.h")


def folder_of(path):
    """('runtime', 'query') of runtime/query/ray.cpp; '.' for files of the part's own folder."""
    names = path.split("/")
    return names[0], names[1] if len(names) > 2 else "."


def fault_of(source, folder, name, quoted):
    """Why a source in that folder must not include that name; None if it may."""
    part = source.split("/")[0]
    if source == "runtime/include/" + C_HEADER:
        return None if name in OF_C99 else "the C interface includes C99 alone"
    if name == C_HEADER:
        return None if source.startswith("runtime/c/") else "only runtime/c knows the C interface"
    if name.startswith(PUBLIC):
        if part == "format" and name not in OF_FORMAT:
            return "format does not depend on the runtime"
        return None
    if folder == "include" and (quoted or name.split("/")[0] in PARTS):
        return "a public header includes nothing private"
    if quoted or name.split("/")[0] in PARTS:
        if not quoted:
            return 'a private header is included by its path in quotes: "%s"' % name
        other, other_folder = folder_of(name)
        if other not in PARTS:
            return "only a header of the project is included in quotes"
        if PARTS.index(other) > PARTS.index(part):
            return f"{part} comes before {other}"
        if other != part:
            return None
        order = ORDER[part]
        for each in (folder, other_folder):
            if each not in order:
                return f"{part}/{each} is missing in the order of {part}'s folders"
        if order.index(other_folder) > order.index(folder):
            return f"{part}/{folder} comes before {part}/{other_folder}"
        return None
    if part in LIBRARIES and ("/" in name or name.endswith(".h")):
        if not name.startswith(LIBRARIES[part]):
            return f"{part} does not use {name}"
    for start, allowed in SLOW_HEADERS.items():
        if name.startswith(start) and not source.startswith(allowed):
            return f"only {', '.join(allowed)} may include {name}"
    if part in LIBRARIES and name in PRINTS:
        return f"{part} prints nothing"
    return None


def check_includes(source_dir):
    faults = []
    for part in PARTS:
        for path in sorted((source_dir / part).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            source = path.relative_to(source_dir).as_posix()
            for bracket, name in INCLUDE.findall(path.read_text(encoding="utf-8")):
                fault = fault_of(source, folder_of(source)[1], name, bracket == '"')
                if fault:
                    faults.append(f"{source}: {name}: {fault}")
    return faults


OUTPUT = r"\b(printf|puts|abort|exit|std::cout|std::cerr)\b|Assimp|tbb::|XXH"
# Symbols that each library must not need.
SYMBOLS = {
    "format/libboxtree_format.a": OUTPUT,
    "runtime/libboxtree_runtime.a": OUTPUT + r"|fmt::|nlohmann|boxtree::cooker",
}
# Templates of headers are compiled into whoever uses them: the runtime neither needs nor has these.
PAPER = r"PlainCodec|PackedCodec|k(Plain|Packed|Dedup)\w*Functions"


def symbols_of(library, *options):
    return subprocess.run(["nm", "-C", *options, str(library)], check=True, text=True,
                          capture_output=True).stdout.splitlines()


def check_symbols(build_dir):
    faults = []
    for library, forbidden in SYMBOLS.items():
        faults += [f"{library}: {line.strip()}: prints, ends the program or links what it must not"
                   for line in symbols_of(build_dir / library, "-u") if re.search(forbidden, line)]
    faults += [f"runtime: {line.strip()}: belongs to boxtree::paper"
               for line in symbols_of(build_dir / "runtime/libboxtree_runtime.a")
               if re.search(PAPER, line)]
    if not any(re.search(PAPER, line) for line in symbols_of(build_dir / "runtime/libboxtree_paper.a")):
        faults.append("boxtree::paper has none of the names that boxtree::runtime must not have")
    return faults


def main():
    faults = check_includes(pathlib.Path(sys.argv[1]))
    if len(sys.argv) > 2:
        faults += check_symbols(pathlib.Path(sys.argv[2]))
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(1)
    print("dependencies point one way")


if __name__ == "__main__":
    main()
