#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Cook, of a manifest, too, and report show their steps on a terminal, and only once they have worked half a
second. Elsewhere report prints a line a step, and cook nothing. Cook writes no file to a terminal.

No time here depends on the machine: the work is doubled until it is long enough to be shown, and
silence is required only of runs that took less than half a second from start to end.

    progress_test.py BOXTREE
"""
import json
import os
import pty
import re
import subprocess
import sys
import tempfile
import time

SHOWN_AFTER = 0.5  # seconds, as in step_printer.h
LINE_EVERY = 2.0
GIVE_UP_AFTER = 20.0  # by then nearly all of a run's steps come later than SHOWN_AFTER
ERASE = "\r\x1b[K"  # to the start of the line, and clear it
STEPS = re.compile(rf"(?:{re.escape(ERASE)}(?:import|build|write) [\w.]+ \.\.\.)+")
LINES = re.compile(r"(?:boxtree: \[ *\d+ %\] [\w .:,-]+ \.\.\.\n)+")
JOBS = re.compile(rf"(?:(?:{re.escape(ERASE)})+\[#*\.*\] \d+ of \d+ jobs, \d+ a second, \d+ s left \.\.\.)+")
SHARES = re.compile(rf"(?:{re.escape(ERASE)}\[#*\.*\] [\w .:,-]+ \.\.\.)+")


def write_grid(path, cells):
    """A square of cells x cells faces."""
    with open(path, "w", encoding="ascii") as file:
        for y in range(cells + 1):
            for x in range(cells + 1):
                file.write(f"v {x} {y} {x * y % 7}\n")
        for y in range(cells):
            for x in range(cells):
                first = y * (cells + 1) + x + 1
                file.write(f"f {first} {first + 1} {first + cells + 2} {first + cells + 1}\n")


def run_on_terminal(command, names, expected=0, **others):
    """Runs the command with a terminal as its streams of these names. Returns the seconds it took
    and what the terminal was sent."""
    ours, theirs = pty.openpty()
    streams = others | {name: theirs for name in names}
    start = time.monotonic()
    with subprocess.Popen(command, **streams) as child:
        os.close(theirs)
        sent = b""
        try:
            while part := os.read(ours, 65536):
                sent += part
        except OSError:
            pass  # Linux's way to say that the last writer has closed a terminal
        status = child.wait()
    seconds = time.monotonic() - start
    os.close(ours)
    assert status == expected, f"exit {status}: {command}"
    return seconds, sent.decode()


def cook(boxtree, count, *options):
    """Of `count` inputs, each by a name of its own, as equal ones are warned of."""
    names = [f"grid{i}.obj" for i in range(count)]
    for name in names:
        if not os.path.exists(name):
            os.link("grid.obj", name)
    return [boxtree, "cook", *names, "-o", "grid.bxt", *options]


def report(boxtree, count, *options):
    return [boxtree, "report", *["grid.obj"] * count, "--quick", "--no-times", *options]


def cook_manifest(boxtree, count):
    """Of `count` jobs, none of which was cooked before."""
    with open(f"jobs{count}.jsonl", "w", encoding="ascii") as file:
        for i in range(count):
            file.write(json.dumps({"inputs": ["grid.obj"], "output": f"of{count}/{i}.bxt"}) + "\n")
    return [boxtree, "cook", "--manifest", file.name]


def find_long_work(command_of, pattern):
    """Returns how many inputs it takes until steps are shown."""
    count = 1
    while True:
        seconds, sent = run_on_terminal(command_of(count), ["stderr"], stdout=subprocess.DEVNULL)
        if sent:
            assert seconds >= SHOWN_AFTER, f"steps shown in a run of {seconds:.3f} s: {sent!r}"
            assert pattern.fullmatch(sent.removesuffix(ERASE)), f"not a list of steps: {sent!r}"
            assert sent.endswith(ERASE), f"the last step stays on the terminal: {sent!r}"
            return count
        assert seconds < GIVE_UP_AFTER, f"nothing shown in {seconds:.3f} s"
        count *= 2


def find_lines(boxtree):
    """Found by a newcomer: a report of a minute is not silent in a pipe, unless that is requested."""
    for options in ([], ["--paper"]):
        count = 1
        while True:
            start = time.monotonic()
            done = subprocess.run(report(boxtree, count, *options), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.PIPE, text=True, check=True)
            seconds = time.monotonic() - start
            if done.stderr:
                assert LINES.fullmatch(done.stderr), f"not a line a step: {done.stderr!r}"
                assert done.stderr.count("\n") * LINE_EVERY <= seconds, f"too many lines: {done.stderr!r}"
                break
            assert seconds < GIVE_UP_AFTER, f"nothing printed in {seconds:.3f} s"
            count *= 2
        done = subprocess.run(report(boxtree, count, "-q", "-o", "page.html", *options), stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, check=True)
        assert done.stderr == "", f"not quiet: {done.stderr!r}"


def main(boxtree):
    try:
        for end in pty.openpty():
            os.close(end)
    except OSError as error:
        print(f"skipped: this machine has no pseudo-terminal ({error})")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        write_grid("grid.obj", 40)
        # Twice what was just long enough: the runs below are long even if the machine is now less
        # busy than it was.
        count = 2 * find_long_work(lambda count: cook(boxtree, count), STEPS)
        with open("errors", "w+", encoding="ascii") as errors:
            _, sent = run_on_terminal(cook(boxtree, count), ["stdin", "stdout"], stderr=errors)
            errors.seek(0)
            assert errors.read() == "", "steps shown in a file"
            assert "\x1b" not in sent, f"steps shown on standard output: {sent!r}"
            assert "wrote grid.bxt" in sent, f"no report: {sent!r}"
        _, sent = run_on_terminal(cook(boxtree, count, "--quiet"), ["stdout", "stderr"])
        assert sent == "", f"not quiet: {sent!r}"
        for options in ([], ["--paper"]):
            find_long_work(lambda count, options=options: report(boxtree, count, *options), SHARES)
        find_long_work(lambda count: cook_manifest(boxtree, count), JOBS)
        find_lines(boxtree)
        for command in (["cook", "grid.obj", "-o", "-"], ["export", "grid.bxt", "-o", "-"]):
            _, sent = run_on_terminal([boxtree, *command], ["stdout", "stderr"], expected=1)
            wanted = (f"boxtree: usage: {command[0]}: --output: expected a file or a pipe, and standard output is a "
                      "terminal\r\n")
            assert sent == wanted, f"not refused: {sent!r}"
    print(f"steps of {count // 2} inputs shown on a terminal, of more of them nowhere else")


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
