#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The binary interface of boxtree_c.h is the one that is stored here: programs of before run with the library of today.

    abi_test.py SOURCE_DIR              compares, plants changes in copies of the header and expects each to be noticed
    abi_test.py SOURCE_DIR --renew      stores the interface of today, unless it is not compatible and BXT_ABI_VERSION
                                        says that it is

Compatible are functions and constants that are added, and members at the end of structs that begin with their size; they want a
higher minor number of BXT_ABI_VERSION. Anything else wants a higher major number. What is compared is not the library but one of
stubs, of the declarations alone: so it neither depends on its sources nor on how they are compiled (tests/consumer/c_test.sh sees
that the library exports what is declared).
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HEADER = "runtime/include/boxtree_c.h"
FUNCTION = re.compile(r"^BXT_API ([^;(]*?)\b(bxt_\w+)\(([^;]*)\);", re.MULTILINE)
STRUCT = re.compile(r"^typedef struct (bxt_\w+) \{\n(\s*uint32_t struct_size;.*?)^\} \1;", re.MULTILINE | re.DOTALL)
# Members at the end are what `struct_size` is for. abidiff takes a last member of another type for one, too, so the
# members of these structs are compared as they are written.
SUPPRESSED = """[suppress_type]
type_kind = struct
name_regexp = ^({})$
has_data_member_inserted_at = end
"""


class Interface:
    def __init__(self, header, work):
        self.text = header.read_text(encoding="utf-8")
        self.work = work
        work.mkdir()
        (work / "boxtree_c.h").write_text(self.text, encoding="utf-8")
        self.abi = work / "stubs.abi"
        self._make_stubs()

    def _make_stubs(self):
        functions = FUNCTION.findall(self.text)
        assert len(functions) == self.text.count("\nBXT_API "), "a declaration is not read as it is written"
        lines = ["#include <boxtree_c.h>"]
        lines += [f"{result}{name}({arguments}) {{ for (;;) {{}} }}" for result, name, arguments in functions]
        source, library = self.work / "stubs.c", self.work / "libstubs.so.1"
        source.write_text("\n".join(lines) + "\n", encoding="utf-8")
        subprocess.run(["gcc", "-std=c99", "-g", "-O0", "-shared", "-fPIC", "-Wl,-soname,libboxtree.so.1", "-I", self.work,
                        source, "-o", library], check=True)
        subprocess.run(["abidw", "--no-comp-dir-path", "--no-corpus-path", "--no-show-locs", "--type-id-style", "hash",
                        "--out-file", self.abi, library], check=True)

    def constants(self):
        """{name: text of its value} of enumerators and of macros that are numbers; BXT_ABI_VERSION is apart."""
        found = dict(re.findall(r"^\s+(BXT_[A-Z0-9_]+) =\s+(\d+)", self.text, re.MULTILINE))
        found.update(re.findall(r"^#define (BXT_[A-Z0-9_]+) ([0-9]\w*|UINT64_MAX)$", self.text, re.MULTILINE))
        del found["BXT_ABI_VERSION"]
        return found

    def structs(self):
        """{name: its members, as they are declared} of structs that begin with their size."""
        return {name: [" ".join(member.split()) for member in re.sub(r"///<?.*", "", body).split(";") if member.strip()]
                for name, body in STRUCT.findall(self.text)}

    def version(self):
        number = int(re.search(r"^#define BXT_ABI_VERSION (0x[0-9a-f]+)u$", self.text, re.MULTILINE)[1], 16)
        return number >> 16, number & 0xffff


class Stored:
    def __init__(self, folder):
        self.abi = folder / "boxtree_c.abi"
        self._rest = folder / "boxtree_c.json"

    def read(self):
        rest = json.loads(self._rest.read_text(encoding="utf-8"))
        return rest["constants"], rest["structs"], tuple(rest["version"])

    def write(self, interface):
        self.abi.write_bytes(interface.abi.read_bytes())
        rest = {"version": interface.version(), "constants": dict(sorted(interface.constants().items())),
                "structs": interface.structs()}
        self._rest.write_text(json.dumps(rest, indent=1) + "\n", encoding="utf-8")


def abidiff(stored, interface, *options):
    """What abidiff says, "" if nothing has changed."""
    suppressed = interface.work / "suppressed"
    suppressed.write_text(SUPPRESSED.format("|".join(interface.structs())), encoding="utf-8")
    options = [option.replace("SUPPRESSED", str(suppressed)) for option in options]
    run = subprocess.run(["abidiff", "--no-show-locs", *options, stored.abi, interface.abi], text=True, check=False,
                         capture_output=True)
    assert run.returncode in (0, 4, 12), run.stdout + run.stderr  # 1 and 2: abidiff itself has failed
    return run.stdout if run.returncode else ""


def changes(stored, interface):
    """(what is not compatible, what is new), each as text."""
    before, members, _ = stored.read()
    now, members_now = interface.constants(), interface.structs()
    broken = abidiff(stored, interface, "--no-added-syms", "--suppressions", "SUPPRESSED")
    broken += "".join(f"{name} was {value} and is {now.get(name, 'gone')}\n" for name, value in before.items()
                      if now.get(name) != value)
    broken += "".join(f"{name} had the members {old}\n" for name, old in members.items()
                      if members_now.get(name, [])[:len(old)] != old)
    added = abidiff(stored, interface)
    added += "".join(f"{name} is new\n" for name in now if name not in before)
    return broken, added


def fault(stored, interface):
    """Why the test fails, "" if it does not."""
    broken, added = changes(stored, interface)
    _, _, version = stored.read()
    major, minor = interface.version()
    renew = "Then store it: tests/abi/abi_test.py . --renew\n"
    if broken and major == version[0]:
        return f"{broken}not compatible: BXT_ABI_VERSION needs a higher major number, or the change to be undone. {renew}"
    if added and (major, minor) == version:
        return f"{added}compatible: BXT_ABI_VERSION needs a higher minor number. {renew}"
    if added or (major, minor) != version:
        return f"{added}{renew}"
    return ""


# What is planted in the header: text, what takes its place, and whether it is compatible.
PLANTED = [
    ("BXT_API uint32_t bxt_file_tree_count(const bxt_file* file);\n", "", False),
    ("bxt_tree_prefetch(const bxt_tree* tree, uint32_t levels)", "bxt_tree_prefetch(const bxt_tree* tree, uint64_t levels)", False),
    ("BXT_API bool bxt_file_has_scene(", "BXT_API uint32_t bxt_file_has_scene(", False),
    ("  double u, v;", "  bxt_vec3 planted;\n  double u, v;", False),
    ("  double depth;            ///", "  float depth;            ///", False),
    ("  double x, y, z;\n} bxt_vec3;", "  double x, y, z, planted;\n} bxt_vec3;", False),
    ("typedef double (*bxt_ray_visitor)(void* context, const bxt_ray_hit* hit);",
     "typedef float (*bxt_ray_visitor)(void* context, const bxt_ray_hit* hit);", False),
    ("  BXT_TRUNCATED = 11,", "  BXT_TRUNCATED = 12,", False),
    ("#define BXT_NO_FACE 0xffffffffu", "#define BXT_NO_FACE 0u", False),
    ("BXT_API uint32_t bxt_abi_version(void);", "BXT_API uint32_t bxt_abi_version(void);\nBXT_API void bxt_planted(void);", True),
    ("} bxt_ray_hit;", "  double planted;\n} bxt_ray_hit;", True),
    ("  BXT_INTERNAL = 90 ", "  BXT_PLANTED = 79,\n  BXT_INTERNAL = 90 ", True),
]


def check_planted(header, stored, work):
    text = header.read_text(encoding="utf-8")
    for number, (old, new, is_compatible) in enumerate(PLANTED):
        assert text.count(old) == 1, old
        changed = work / f"changed{number}.h"
        changed.write_text(text.replace(old, new), encoding="utf-8")
        said = fault(stored, Interface(changed, work / f"planted{number}"))
        expected = "\ncompatible: " if is_compatible else "\nnot compatible: "
        assert expected in "\n" + said, f"{new!r} for {old!r}: {said!r}"
        # A version that says so is believed, and wants to be stored.
        major, minor = Interface(changed, work / f"again{number}").version()
        higher = f"0x{(major << 16) + minor + 1 if is_compatible else (major + 1) << 16:x}u"
        raised = re.sub(r"(#define BXT_ABI_VERSION) \w+", rf"\1 {higher}", changed.read_text(encoding="utf-8"))
        changed.write_text(raised, encoding="utf-8")
        said = fault(stored, Interface(changed, work / f"raised{number}"))
        assert "compatible: " not in said and said.endswith("--renew\n"), said


def main():
    source = pathlib.Path(sys.argv[1])
    stored = Stored(source / "tests/abi")
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        interface = Interface(source / HEADER, work / "now")
        if sys.argv[2:] == ["--renew"]:
            if stored.abi.exists() and "compatible: " in (said := fault(stored, interface)):
                sys.exit(said)
            stored.write(interface)
            return
        if said := fault(stored, interface):
            sys.exit(said)
        check_planted(source / HEADER, stored, work)
        print(f"the interface is the stored one; {len(PLANTED)} planted changes were noticed")


if __name__ == "__main__":
    main()
