#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every function of boxtree_c.h is called by a test in this folder, and every struct with a size is
in struct_test.cpp.

    functions_test.py SOURCE_DIR       exit 1 and a line for each that is not
"""
import pathlib
import re
import sys


def main():
    source = pathlib.Path(sys.argv[1])
    header = (source / "runtime/include/boxtree_c.h").read_text(encoding="utf-8")
    folder = source / "tests/unit/c"
    tests = "\n".join(path.read_text(encoding="utf-8") for path in sorted(folder.glob("*.[hc]*")))
    functions = set(re.findall(r"^BXT_API [^;(]*?(bxt_\w+)\(", header, re.MULTILINE))
    functions |= set(re.findall(r"^static inline \w+ (bxt_\w+)\(", header, re.MULTILINE))
    faults = [f"{name}: no test calls it" for name in sorted(functions)
              if not re.search(rf"\b{name}\b", tests)]
    structs = set(re.findall(r"^typedef struct (bxt_\w+) \{\n  uint32_t struct_size;", header,
                             re.MULTILINE))
    of_sizes = (folder / "struct_test.cpp").read_text(encoding="utf-8")
    # Visitors are shown pair contacts, nobody hands any over; of errors library_test.cpp sees to it.
    structs -= {"bxt_error", "bxt_pair_contact"}
    faults += [f"{name}: no test of its size" for name in sorted(structs)
               if not re.search(rf"\b{name}\b", of_sizes)]
    if len(functions) < 100 or len(structs) < 20:
        faults.append("boxtree_c.h is not read as it is written")
    print("\n".join(faults) or f"{len(functions)} functions, {len(structs)} structs")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
