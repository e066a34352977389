#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Seeds small faults into a copy of the sources: each is an expression that a number in the
environment (BOXTREE_MUTANT) swaps for a wrong one, so that one build holds all of them.

    mutate.py SOURCE_TREE COMPILE_COMMANDS COUNT SEED LIST.json

Writes the changed files into SOURCE_TREE and the list of faults. Kinds: a comparison that becomes
its neighbour or its opposite, + for -, * for +, and for or, a whole number off by one, a check that
is dropped, min for max, rounding in the wrong direction. Expressions of templates whose types are
not known, and of constants, are left alone.
"""
import json
import os
import random
import sys

from clang import cindex
from clang.cindex import CursorKind, TypeKind

COMPARISONS = {"<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"], "==": ["!="], "!=": ["=="]}
ARITHMETIC = {"+": ["-"], "-": ["+"], "*": ["+"], "&&": ["||"], "||": ["&&"], "&": ["|"], "|": ["&"], "<<": [">>"], ">>": ["<<"]}
CALLS = {"min": "max", "max": "min", "float_above": "float_below", "float_below": "float_above",
         "scaled_below": "scaled_above", "scaled_above": "scaled_below"}
NUMBERS = {TypeKind.BOOL, TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.FLOAT, TypeKind.DOUBLE,
           TypeKind.UCHAR, TypeKind.SHORT, TypeKind.USHORT, TypeKind.LONGLONG, TypeKind.ULONGLONG}
# Values here are needed when the program is compiled.
CONSTANT = {CursorKind.STATIC_ASSERT, CursorKind.ENUM_CONSTANT_DECL, CursorKind.CASE_STMT,
            CursorKind.TEMPLATE_NON_TYPE_PARAMETER, CursorKind.FIELD_DECL, CursorKind.ALIGNED_ATTR}


def kind_of(cursor):
    try:
        return cursor.kind
    except ValueError:  # newer than these bindings
        return None


def is_number(cursor):
    try:
        return cursor.type.get_canonical().kind in NUMBERS
    except ValueError:
        return False


def tokens_of(cursor):
    return [t.spelling for t in cursor.get_tokens()]


def is_constant(cursor):
    """Whether a declaration is evaluated by the compiler."""
    kind = kind_of(cursor)
    if kind in CONSTANT:
        return True
    if kind in (CursorKind.VAR_DECL, CursorKind.FUNCTION_DECL, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR,
                       CursorKind.FUNCTION_TEMPLATE):
        head = []
        for token in cursor.get_tokens():
            if token.spelling in ("{", "=", ";"):
                break
            head.append(token.spelling)
        return "constexpr" in head or "consteval" in head or "concept" in head
    if kind == CursorKind.IF_STMT:
        return tokens_of(cursor)[1:2] == ["constexpr"]
    return False


class Finder:
    def __init__(self, root):
        self.root = root
        self.text = {}
        self.found = {}  # (path, start, end, replacement) -> kind

    def source(self, path):
        if path not in self.text:
            with open(path, "rb") as file:
                self.text[path] = file.read()
        return self.text[path]

    def place(self, cursor):
        """Path and extent, if it is a source of ours and no macro."""
        start, end = cursor.extent.start, cursor.extent.end
        if start.file is None or end.file is None or start.file.name != end.file.name:
            return None
        path = os.path.realpath(start.file.name)
        if not any(path.startswith(os.path.join(self.root, folder) + "/") for folder in ("runtime", "format")):
            return None
        return path, start.offset, end.offset

    def add(self, cursor, replacement, kind):
        place = self.place(cursor)
        if place is None:
            return
        path, start, end = place
        original = self.source(path)[start:end].decode()
        if not original.strip() or "HWY_" in original or "#" in original or original.count("\n") > 4:
            return
        self.found[(path, start, end, replacement)] = kind

    def binary(self, cursor):
        children = list(cursor.get_children())
        if len(children) != 2 or self.place(cursor) is None:
            return
        path, start, end = self.place(cursor)
        left, right = children[0].extent, children[1].extent
        between = self.source(path)[left.end.offset:right.start.offset].decode()
        operator = between.strip()
        changes = COMPARISONS.get(operator) if all(map(is_number, children)) else None
        if changes is None and is_number(cursor) and all(map(is_number, children)):
            changes = ARITHMETIC.get(operator)
        for change in changes or []:
            text = self.source(path)
            mutated = (f"({text[start:left.end.offset].decode()}) {change} "
                       f"({text[right.start.offset:end].decode()})")
            self.add(cursor, mutated, f"{operator} -> {change}")

    def call(self, cursor):
        change = CALLS.get(cursor.spelling)
        if change is None or not is_number(cursor):
            return
        place = self.place(cursor)
        if place is None:
            return
        path, start, end = place
        text = self.source(path)[start:end].decode()
        at = text.find(cursor.spelling)
        if at < 0 or "{" in text:
            return
        self.add(cursor, text[:at] + change + text[at + len(cursor.spelling):], f"{cursor.spelling} -> {change}")

    def condition(self, cursor):
        """A check: an `if` that only returns, or goes on to the next round."""
        children = list(cursor.get_children())
        if len(children) != 2 or kind_of(children[1]) not in (CursorKind.RETURN_STMT, CursorKind.CONTINUE_STMT):
            return
        if not is_number(children[0]) or kind_of(children[0]) == CursorKind.DECL_STMT:
            return
        self.add(children[0], "false", "check dropped")

    def literal(self, cursor):
        place = self.place(cursor)
        if place is None:
            return
        path, start, end = place
        text = self.source(path)[start:end].decode()
        if text.isdigit():
            self.add(cursor, f"{int(text) + 1}", "off by one")

    def visit(self, cursor):
        if is_constant(cursor):
            return
        kind = kind_of(cursor)
        if kind == CursorKind.BINARY_OPERATOR:
            self.binary(cursor)
        elif kind == CursorKind.CALL_EXPR:
            self.call(cursor)
        elif kind == CursorKind.IF_STMT:
            self.condition(cursor)
        elif kind == CursorKind.INTEGER_LITERAL:
            self.literal(cursor)
        elif kind == CursorKind.TYPE_REF:
            return
        for child in cursor.get_children():
            self.visit(child)


def choose(found, count, seed):
    """A spread over all files, no two that share a character."""
    rest = sorted(found.items())
    random.Random(seed).shuffle(rest)
    taken, places = [], {}
    for (path, start, end, replacement), kind in rest:
        if len(taken) == count:
            break
        if any(start < e and s < end for s, e in places.get(path, [])):
            continue
        places.setdefault(path, []).append((start, end))
        taken.append((path, start, end, replacement, kind))
    return taken


def main():
    root, commands, count, seed, list_path = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]), sys.argv[5]
    root = os.path.realpath(root)
    finder = Finder(root)
    index = cindex.Index.create()
    for command in json.load(open(commands)):
        path = os.path.realpath(os.path.join(command["directory"], command["file"]))
        if not path.startswith((root + "/runtime/", root + "/format/")):
            continue
        words = command["command"].split()
        flags = [w for w in words[1:] if w.startswith(("-I", "-D", "-std", "-isystem", "-m"))]
        unit = index.parse(path, args=flags + ["-I/usr/lib/llvm-14/lib/clang/14.0.6/include"])
        for cursor in unit.cursor.get_children():
            place = finder.place(cursor)
            if place is not None or kind_of(cursor) in (CursorKind.NAMESPACE, CursorKind.UNEXPOSED_DECL):
                finder.visit(cursor)
    taken = choose(finder.found, count, seed)
    listed = []
    by_path = {}
    for number, (path, start, end, replacement, kind) in enumerate(taken, 1):
        text = finder.source(path)
        original = text[start:end].decode()
        line = text[:start].count(b"\n") + 1
        listed.append({"number": number, "file": os.path.relpath(path, root), "line": line, "kind": kind,
                       "original": original, "mutated": replacement})
        by_path.setdefault(path, []).append((start, end, number, replacement, original))
    for path, changes in by_path.items():
        text = finder.source(path)
        for start, end, number, replacement, original in sorted(changes, reverse=True):
            lines = "\n" * original.count("\n")  # keeps the numbers of lines that follow
            flat = " ".join(original.split())
            new = f"BOXTREE_MUTANT({number}, ({' '.join(replacement.split())}), ({flat}))" + lines
            text = text[:start] + new.encode() + text[end:]
        with open(path, "wb") as file:
            file.write(text)
    with open(list_path, "w") as file:
        json.dump({"candidates": len(finder.found), "mutants": listed}, file, indent=1)
    print(f"{len(finder.found)} places, {len(listed)} faults")


main()
