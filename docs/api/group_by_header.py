# SPDX-License-Identifier: MIT
"""Doxygen's filter of public headers: makes of each one a group, described by the comment that it begins with.

Lines keep their numbers, so that warnings name the right ones.
    group_by_header.py HEADER
"""
import pathlib
import sys

# What declarations stand between.
BEGIN, END = "namespace boxtree {", "}  // namespace boxtree"
C_HEADER, BEGIN_OF_C, END_OF_C = "boxtree_c.h", "// ---- The library ", "#endif  // BOXTREE_C_H"


def filtered(name, lines):
    """The lines of header `name`, its first comment and its declarations in the group `name`."""
    group = name.removesuffix(".h")
    shown = name if name == C_HEADER else f"boxtree/{name}"
    result = [f"/// \\defgroup {group}_h {shown}"]
    in_first_comment = True
    for line in lines[1:]:  # the first one is the licence
        in_first_comment = in_first_comment and line.startswith("//")
        if in_first_comment:
            line = line.replace("//", "///", 1)
        elif line == BEGIN:
            line = f"{BEGIN} /** \\addtogroup {group}_h */ /** \\{{ */"
        elif line == END:
            line = f"/** \\}} */ {END}"
        elif name == C_HEADER and line.startswith(BEGIN_OF_C):
            line = f"/** \\addtogroup {group}_h */ /** \\{{ */"
        elif name == C_HEADER and line == END_OF_C:
            line = f"/** \\}} */\n{END_OF_C}"
        result.append(line)
    return result


def main():
    header = pathlib.Path(sys.argv[1])
    print("\n".join(filtered(header.name, header.read_text(encoding="utf-8").splitlines())))


if __name__ == "__main__":
    main()
