#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What one system or one compiler alone has stands behind a condition of the preprocessor that says so, or in a
file that is nothing elsewhere.

    check_portability.py SOURCE_DIR       exit 1 and a line for each use without its condition
"""
import pathlib
import re
import sys

# A condition, of those that a line is below, and what needs it. "posix" is what Windows does not have.
CONDITIONS = {
    "windows": re.compile(r"defined\(_WIN32\)|ifdef _WIN32|_MSC_VER"),
    "posix": re.compile(r"ifndef _WIN32|!defined\(_WIN32\)|defined\(__linux__\)|ifdef __linux__|defined\(__APPLE__\)|ifdef __APPLE__"),
    "linux": re.compile(r"defined\(__linux__\)|ifdef __linux__|ifdef O_TMPFILE"),
    "macos": re.compile(r"defined\(__APPLE__\)|ifdef __APPLE__|ifdef F_FULLFSYNC"),
    "a later clang": re.compile(r"(?!)"),  # no condition helps
    "a later libc++": re.compile(r"(?!)"),
    "gnu": re.compile(r"__GNUC__|__clang__|__aarch64__|__has_feature|_MSC_VER|__cpp_lib_bit_cast|_WIN32"),
}
USES = {
    "windows": r"<(windows|io|intrin|psapi|shellapi)\.h>|\b(_wfopen|_setmode|_fileno|_open_osfhandle|_get_osfhandle)\b",
    "posix": r"<(unistd|dirent|poll|spawn|sys/(mman|stat|file|resource|wait|random|utsname|time|types))\.h>|"
             r"\b(mmap|munmap|mprotect|fork|waitpid|sigaction|flock|fchmod|fchown|fmemopen|newlocale|sysconf)\(",
    "linux": r"\b(memfd_create|MFD_\w+|pipe2|renameat2|RENAME_EXCHANGE|AT_EMPTY_PATH|O_TMPFILE|prctl|getrandom|"
             r"statx|copy_file_range)\b|/proc/self|<sys/prctl\.h>|<linux/",
    "macos": r"\b(renamex_np|RENAME_SWAP|_NSGetEnviron|F_FULLFSYNC)\b|<crt_externs\.h>",
    # What answers a subrange, which Debian 12's clang 14 does not take of its libstdc++, and views: the builds with
    # sanitizers and the fuzzers are its.
    "a later clang": r"\bviews::|\branges::(search|search_n|find_end|equal_range|unique|remove|remove_if|partition|"
                     r"stable_partition|rotate|subrange)\b",
    # Games and robots build these against the libc++ 14 of Debian 12 and of its emscripten, which has none of it.
    "a later libc++": r"\branges::\w+",
    "gnu": r"__builtin_\w+|__attribute__|__int128|\basm\b|\btypeof\b|__extension__|#pragma GCC",
}
USES = {name: re.compile(pattern) for name, pattern in USES.items()}
# What the cooker alone may use.
OF_COOKER = ("a later libc++",)
# Of a build that is for Linux and macOS alone: what reads by assimp (BOXTREE_ASSIMP).
POSIX_FILES = ("cooker/import/trial.cpp", "cooker/import/recording_io.cpp")
# Headers that MinGW and MSVC have, too.
ON_WINDOWS = ("<sys/stat.h>", "<sys/types.h>")
COMMENT = re.compile(r"//.*$")


def uses_without_condition(text, allowed):
    """(line number, name of the condition, what was used), but for conditions that are `allowed`"""
    conditions = []  # for each #if that is open, all its conditions up to here
    for number, line in enumerate(text.splitlines(), 1):
        code = COMMENT.sub("", line)
        directive = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b", code)
        if directive:
            kind = directive.group(1)
            if kind in ("if", "ifdef", "ifndef"):
                conditions.append(code.lstrip("# "))
            elif kind == "endif":
                conditions.pop()
            elif kind == "elif":
                conditions[-1] = code + not_of(conditions[-1])
            else:
                conditions[-1] = not_of(conditions[-1])
            continue
        around = "\n".join(conditions)
        for name, use in USES.items():
            for found in use.finditer(code):
                if found.group() in ON_WINDOWS or CONDITIONS[name].search(around):
                    continue
                if name in allowed:
                    continue
                yield number, name, found.group()


def not_of(condition):
    """What the other branch knows."""
    known = ""
    if re.search(r"ifdef _WIN32|^if defined\(_WIN32\)", condition):
        known += " ifndef _WIN32"
    if "ifndef _WIN32" in condition:
        known += " ifdef _WIN32"
    if re.search(r"ifndef __linux__", condition):
        known += " ifdef __linux__"
    if "_MSC_VER" in condition:
        known += " __GNUC__"
    if "BXT_BUILDS_SHARED" in condition and "_WIN32" in condition or "__cpp_lib_bit_cast" in condition:
        known += " __GNUC__"
    return known


def main():
    source = pathlib.Path(sys.argv[1])
    faults = []
    for part in ("format", "runtime", "cooker"):
        for path in sorted((source / part).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = path.relative_to(source).as_posix()
            allowed = (("posix",) if name in POSIX_FILES else ()) + (OF_COOKER if part == "cooker" else ())
            for number, condition, use in uses_without_condition(path.read_text(encoding="utf-8"), allowed):
                faults.append(f"{name}:{number}: {use} outside a condition that says {condition}")
    for fault in faults:
        print(fault)
    if faults:
        sys.exit(1)
    print("what one system or compiler alone has stands behind a condition")


if __name__ == "__main__":
    main()
