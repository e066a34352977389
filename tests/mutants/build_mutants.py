#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Builds a mutated tree. A fault that does not compile (the types of both expressions differ, or a
constant is wanted) is taken back, and the build goes on.

    build_mutants.py LIST.json SOURCE_TREE BUILD_FOLDER TARGET...
"""
import json
import os
import re
import subprocess
import sys

ROUNDS = 60  # each takes back at least one fault
ERROR = re.compile(r"([^\s:]+):(\d+):\d+: (?:error|.*required from)")


def restore(source, mutant):
    """Puts the original expression back in the place of a fault."""
    path = os.path.join(source, mutant["file"])
    text = open(path).read()
    mark = f"BOXTREE_MUTANT({mutant['number']}, "
    start = text.index(mark)
    depth, end = 0, start + len("BOXTREE_MUTANT")
    while True:
        depth += {"(": 1, ")": -1}.get(text[end], 0)
        end += 1
        if depth == 0:
            break
    original = " ".join(mutant["original"].split())
    with open(path, "w") as file:
        file.write(text[:start] + "(" + original + ")" + text[end:])


def main():
    list_path, source, build, targets = sys.argv[1], os.path.realpath(sys.argv[2]), sys.argv[3], sys.argv[4:]
    content = json.load(open(list_path))
    for _ in range(ROUNDS):
        done = subprocess.run(["ninja", "-C", build, "-k", "0"] + targets, capture_output=True, text=True)
        if done.returncode == 0:
            print(f"{len(content['mutants'])} faults are built in")
            return
        places = {(os.path.realpath(os.path.join(build, path)), int(line)) for path, line in ERROR.findall(done.stdout)}
        wrong = [m for m in content["mutants"]
                 if any(path == os.path.join(source, m["file"]) and m["line"] <= line <= m["line"] + 4
                        for path, line in places)]
        if not wrong:
            sys.exit(done.stdout[-4000:])
        for mutant in wrong:
            restore(source, mutant)
        content["mutants"] = [m for m in content["mutants"] if m not in wrong]
        with open(list_path, "w") as file:
            json.dump(content, file, indent=1)
    sys.exit("too many faults do not compile")


main()
