# SPDX-License-Identifier: MIT
"""The folders that a power cut may leave, computed from the recorded calls of a run.

A disk keeps what was flushed. Of what was done to a file after its last fsync any part may be
there: none, all, the first writes only, all but one, half of one, or zeros where the bytes should
be. Of what was done to names after the last fsync of their folder any part may have happened, in
any order. Each single rename, link or unlink happens whole or not at all.
"""
import itertools
import json
import os

MOST_PERMUTED = 4  # names changed since a folder was flushed; of more, samples are taken
SAMPLES = 40


class Content:
    """Bytes and mode of a file."""

    def __init__(self, data=b"", mode=0):
        self.data = data
        self.mode = mode

    def done(self, step):
        """What it is after a step; a part of a write is a step, too."""
        if step["do"] == "write":
            data = self.data.ljust(step["offset"], b"\0")
            end = step["offset"] + len(step["bytes"])
            return Content(data[:step["offset"]] + step["bytes"] + data[end:], self.mode)
        if step["do"] == "truncate":
            return Content(self.data[:step["size"]].ljust(step["size"], b"\0"), self.mode)
        return Content(self.data, step["mode"])


class File:
    """A file on disk, under whatever names, and what has not been flushed."""

    def __init__(self, content):
        self.flushed = content
        self.pending = []

    def now(self):
        content = self.flushed
        for step in self.pending:
            content = content.done(step)
        return content

    def flush(self):
        self.flushed = self.now()
        self.pending = []

    def after_cut(self, random):
        """Contents that a cut may leave."""
        seen = set()
        for steps in self.partial_steps(random):
            content = self.flushed
            for step in steps:
                content = content.done(step)
            key = (content.data, content.mode)
            if key not in seen:
                seen.add(key)
                yield content

    def partial_steps(self, random):
        steps = self.pending
        yield steps
        for i, step in enumerate(steps):
            yield steps[:i]
            yield steps[:i] + steps[i + 1:]
            if step["do"] == "write":
                half = dict(step, bytes=step["bytes"][:len(step["bytes"]) // 2])
                zeros = dict(step, bytes=bytes(len(step["bytes"])))
                yield steps[:i] + [half]
                yield steps[:i] + [zeros] + steps[i + 1:]
        if len(steps) > 1:
            for _ in range(SAMPLES):
                yield [step for step in steps if random.random() < 0.5]


def apply_names(names, step):
    """Changes a dictionary of path -> File; a change of names that are not there is none."""
    if step["do"] in ("create", "link"):
        names.setdefault(step["path"], step["file"])
    elif step["do"] == "unlink":
        names.pop(step["path"], None)
    elif step["from"] in names:
        if step["do"] == "rename":
            names[step["to"]] = names.pop(step["from"])
        elif step["to"] in names:
            names[step["from"]], names[step["to"]] = names[step["to"]], names[step["from"]]


def names_after_cut(names, pending, random):
    """Dictionaries of names that a cut may leave."""
    if len(pending) <= MOST_PERMUTED:
        orders = (order for count in range(len(pending) + 1)
                  for order in itertools.permutations(pending, count))
    else:
        prefixes = [pending[:count] for count in range(len(pending) + 1)]
        orders = prefixes + [random.sample(pending, random.randint(0, len(pending)))
                             for _ in range(SAMPLES)]
    for order in orders:
        left = dict(names)
        for step in order:
            apply_names(left, step)
        yield left


class Disk:
    """What is flushed and what is not, step by step. `folder` is as it was before the run."""

    def __init__(self, folder):
        self.names = {}    # path -> File, as flushed
        self.pending = []  # changes of names
        self.objects = {}  # device:inode -> File
        for base, _, files in os.walk(folder):
            for name in files:
                path = os.path.join(base, name)
                if os.path.islink(path):
                    continue
                status = os.stat(path)
                with open(path, "rb") as file:
                    here = File(Content(file.read(), status.st_mode & 0o7777))
                self.names[path] = here
                self.objects[f"{status.st_dev}:{status.st_ino}"] = here
        self.folder = folder

    def names_now(self):
        names = dict(self.names)
        for step in self.pending:
            apply_names(names, step)
        return names

    def do(self, step):
        """One line of the log. Returns whether it touched the folder."""
        step = dict(step)
        for key in ("path", "from", "to"):
            if key in step:
                step[key] = os.path.normpath(step[key])
        places = [step[key] for key in ("path", "from", "to", "directory") if key in step]
        if any(not place.startswith(self.folder) for place in places):
            return False
        what = step["do"]
        if what == "unknown":
            raise RuntimeError(f"the log does not know {step['what']}")
        if what == "open":
            return self.open(step)
        if what in ("rename", "exchange", "unlink"):
            self.pending.append(step)
        elif what == "link":
            self.pending.append(dict(step, file=self.objects[step["object"]]))
        elif "directory" in step:
            if what == "flush":
                self.flush_folder(step["directory"])
        elif step["object"] not in self.objects:
            return False
        elif what == "flush":
            self.objects[step["object"]].flush()
        else:
            if what == "write":
                step["bytes"] = bytes.fromhex(step["bytes"])
            self.objects[step["object"]].pending.append(step)
        return True

    def open(self, step):
        known = self.names_now().get(step["path"])
        if known is None or step["anonymous"]:
            # A new file, even where an old one had this number.
            self.objects[step["object"]] = File(Content(b"", step["mode"]))
            if not step["anonymous"]:
                self.pending.append({"do": "create", "path": step["path"],
                                     "file": self.objects[step["object"]]})
        elif step["truncate"]:
            known.pending.append({"do": "truncate", "size": 0})
        return True

    def flush_folder(self, folder):
        rest = []
        for step in self.pending:
            place = os.path.dirname(step["path"] if "path" in step else step["to"])
            if place == folder:
                apply_names(self.names, step)
            else:
                rest.append(step)
        self.pending = rest


def check_log(writer, start, disk, log, status, random, places):
    """Cuts the power after every step of a log. `places` has the path of each output.

    Returns the number of states looked at, what is wrong with them, and for each different set of
    names that is left one (names -> Content) that the next run can be tried on.
    """
    faults = []
    litter = {}
    states = 0
    steps = [None, *log]
    for number, step in enumerate(steps):
        if step is not None and not disk.do(step) and number < len(log):
            continue
        is_done = number == len(log) and status == 0
        wrong = set()
        for names in names_after_cut(disk.names, disk.pending, random):
            for name in writer.outputs:
                file = names.get(places[name])
                if file is None:
                    states += 1
                    if start.has_old or is_done:
                        wrong.add(f"{name} is gone")
                    continue
                for content in file.after_cut(random):
                    states += 1
                    is_new = content.data == writer.new[name]
                    is_old = start.has_old and content.data == writer.old(name)
                    if not is_new and not (is_old and not is_done):
                        what = "old" if is_old else f"{len(content.data)} bytes, not old or new"
                        wrong.add(f"{name} is {what}")
                    elif start.has_old and content.mode != 0o640:
                        wrong.add(f"{name} has lost its mode")
            key = tuple(sorted(os.path.basename(path) for path in names))
            litter.setdefault(key, {path: file.now() for path, file in names.items()})
        done = "at the start" if step is None else f"after step {number}, {step['do']}"
        faults += [f"power cut {done}: {what}" for what in sorted(wrong)]
    return states, faults, litter


def read_log(path):
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file]
