#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the tests against each fault that mutate.py has seeded, and lists those that no test notices.

    run_mutants.py LIST.json BUILD_FOLDER LOG.jsonl [--jobs N]

A fault is killed when a program of the list below fails, crashes or does not end. The log gets a
line a fault; faults that it has already are not run again, so a run can go on where it stopped.
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys

# Those that take seconds: most faults die there. The seconds are bounds, ten times what each takes.
QUICK = [
    ("tests/unit/primitive/primitive_test", 240),
    ("tests/unit/format/format_test", 60),
    ("tests/unit/file/file_test", 60),
    ("tests/golden/golden_test", 60),
    ("tests/unit/tree/tree_test", 120),
    ("tests/unit/proof/proof_test", 60),
    ("tests/unit/scene/scene_test", 120),
    ("tests/oracle/exact/boxtree_exact", 240),
    ("tests/unit/encode/encode_test", 240),
    ("tests/unit/query/queries_test", 600),
]
# For what those leave alive.
SLOW = [
    ("tests/fuzz/mutation_test", 600),
    ("tests/robustness/robustness_test", 600),
    ("tests/unit/walk/wide_walks_test", 600),
]


def arguments_of(program):
    if program.endswith("boxtree_exact"):
        return ["--answers", "100000", "--seed", "1"]
    return ["--gtest_brief=1", "--gtest_fail_fast"]


def first_to_notice(programs, build, number):
    """The program that notices a fault, and how; nothing if none does."""
    environment = dict(os.environ, BOXTREE_MUTANT=str(number))
    for program, seconds in programs:
        path = os.path.join(build, program)
        if not os.path.exists(path):
            continue
        try:
            done = subprocess.run([path] + arguments_of(program), env=environment, timeout=seconds,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return program, "does not end"
        if done.returncode != 0:
            return program, f"status {done.returncode}"
    return None


def is_left(entry, after):
    """Whether a fault is still to be run by the quick programs, or after them by all."""
    if entry is None:
        return True
    return entry["noticed_by"] is None and entry["tried"] == "quick" and after == "all"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("list")
    parser.add_argument("build")
    parser.add_argument("log")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    mutants = json.load(open(options.list))["mutants"]
    known = {}  # the last line of a fault counts
    if os.path.exists(options.log):
        known = {entry["number"]: entry for entry in map(json.loads, open(options.log))}
    if not known:
        found = first_to_notice(QUICK + SLOW, options.build, 0)
        if found is not None:
            sys.exit(f"{found[0]} fails without any fault: {found[1]}")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, open(options.log, "a") as log:
        for programs, after in ((QUICK, "quick"), (SLOW, "all")):
            rest = [m for m in mutants if is_left(known.get(m["number"]), after)]
            running = {pool.submit(first_to_notice, programs, options.build, m["number"]): m for m in rest}
            for future in concurrent.futures.as_completed(running):
                mutant, noticed = running[future], future.result()
                entry = dict(mutant, noticed_by=noticed[0] if noticed else None,
                             how=noticed[1] if noticed else None, tried=after)
                known[mutant["number"]] = entry
                print(json.dumps(entry), file=log, flush=True)
    survivors = [entry for entry in known.values() if entry["noticed_by"] is None]
    for entry in sorted(survivors, key=lambda e: (e["file"], e["line"])):
        print(f"{entry['file']}:{entry['line']}: {entry['kind']}: {entry['original']}  ->  {entry['mutated']}")
    print(f"{len(known)} faults, {len(known) - len(survivors)} noticed, {len(survivors)} not")


main()
