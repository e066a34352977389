#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The torture of writing: whatever fails, and whenever it is killed, a file that boxtree writes is
the old one or the new one, whole, and nothing is left beside it.

    torture.py [--full] [--jobs N] [--case NAME]... BOXTREE SYSCALL_FAULTS FAILING_ALLOCATOR PLANTED

Families of cases: system calls that fail, one or all from one on; allocations likewise; signals at
system calls and at random moments; limits of sizes, memory and descriptors; two writers of one
output, one of them stopped anywhere; power cuts. Without --full a fixed sample of each is run; with
it all of them, and more random moments. --case runs those whose names begin with NAME and keeps
the folders of those that find something. A writer with planted defects shows that every family can
find something.

The last lines count the cases of each family; exit status 1 if any found something.
"""
import argparse
import concurrent.futures
import os
import random
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter

sys.dont_write_bytecode = True  # tests leave the source as it is
# pylint: disable=wrong-import-position
from power_cut import Disk, check_log, read_log
from writers import (FRESH, OVER_OLD, STARTS, TEMPORARY, Folders, Start, Tools, Writer, contents,
                     check_run, check_end, check_files, check_killed, check_next, make_writers, prepare,
                     run, run_traced, strange_files, traced, write_file)

SEED = 20240229
SKIPPED = 77
# What a call of a family is made to fail with; all of them with --full.
ERRORS = ["ENOSPC", "EIO", "EINTR", "ENOMEM"]
# Calls that change what is on disk, and those that decide how.
WRITING = {"write", "flush", "size", "mode", "link", "rename", "unlink", "lock", "random"}
LATE = {"flush", "link", "rename", "unlink", "close", "mode"}
# The disk is full, broken, or gone; memory or descriptors have run out.
FROM_THEN_ON = [("write", "ENOSPC"), ("flush", "EIO"), ("read", "EIO"), ("rename,link", "EROFS"),
                ("open", "EMFILE"), ("memory", "ENOMEM"), ("thread", "ENOMEM"),
                ("open,read,write,flush,mode,link,rename,unlink,stat,list", "EIO")]
OTHER = "other"  # the folder of another writer's inputs
KILLS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]


class Case:
    """One run: its family, a name to repeat it by, and what it does in an empty folder. It returns
    a word for how the run ended and a list of what is wrong."""

    def __init__(self, family, name, action, group=None):
        self.family = family
        self.name = name
        self.action = action
        self.group = group or family  # a sample takes as many of each


class Torture:
    """All cases of some writers."""

    def __init__(self, tools, folders, can_unshare):
        self.tools = tools
        self.folders = folders
        self.can_unshare = can_unshare

    def calls(self, writer, start):
        """(name, family) of each system call that a run makes when nothing disturbs it."""
        folder = self.folders.make()
        prepare(writer, start, folder)
        outcome = run_traced(self.tools, writer, start, folder, [])
        self.folders.drop(folder)
        faults = check_run(writer, start, folder, outcome) if os.path.exists(folder) else []
        if outcome.status != 0 or faults:
            raise RuntimeError(f"{writer.name} {start.name}: {outcome.stderr} {faults}")
        return outcome.report["calls"]

    def call_faults(self, writer, start, errors=None):
        """Each call fails once."""
        calls = self.calls(writer, start)
        for number, (name, family) in enumerate(calls, 1):
            ways = [["--error", error] for error in errors or ERRORS]
            if family in ("read", "write"):
                ways.append(["--short"])
            if family in LATE:
                ways.append(["--late-error", "EIO"])
            for way in ways:
                yield self.fault_case(family, writer, start, number, [], way)

    def lasting_faults(self, writer, start):
        """From some call on all calls of some families fail."""
        calls = self.calls(writer, start)
        for families, error in FROM_THEN_ON:
            count = sum(family in families.split(",") for _, family in calls)
            for number in range(1, count + 1):
                yield self.fault_case("from then on", writer, start, number,
                                      ["--from", "--calls", families], ["--error", error],
                                      families)

    def fault_case(self, family, writer, start, number, more, way, group=None):
        def action(folder):
            prepare(writer, start, folder)
            options = [*more, "--nth", str(number), *way]
            outcome = run_traced(self.tools, writer, start, folder, options)
            may_leave = outcome.report.get("unlink_faulted", False)
            if "memory" in (family, group):
                faults = check_short_of_memory(writer, start, folder, outcome)
            else:
                faults = check_run(writer, start, folder, outcome, may_leave)
            if may_leave and not faults:
                faults = check_next(writer, start, folder)
            return end_of(outcome), faults

        name = "/".join([writer.name, start.name, *(word.strip("-") for word in more),
                         f"call-{number}", "-".join(word.strip("-") for word in way)])
        return Case(family, name, action, group)

    def allocation_faults(self, writer, start):
        """Each allocation fails, alone or with all that come after it."""
        folder = self.folders.make()
        prepare(writer, start, folder)
        report = folder + ".allocations"
        run(writer, folder, variables={"LD_PRELOAD": self.tools.allocator,
                                       "FAILING_ALLOCATION_REPORT": report})
        with open(report, encoding="ascii") as file:
            count = int(file.read())
        for path in (folder, report):
            self.folders.drop(path)

        def make(number, is_lasting):
            def action(folder):
                prepare(writer, start, folder)
                variables = {"LD_PRELOAD": self.tools.allocator,
                             "FAILING_ALLOCATION": str(number)}
                if is_lasting:
                    variables["FAILING_ALLOCATION_FROM"] = "1"
                outcome = run(writer, folder, variables=variables)
                return end_of(outcome), check_short_of_memory(writer, start, folder, outcome)

            name = f"{writer.name}/{start.name}/allocation-{number}{'-on' if is_lasting else ''}"
            return Case("allocation", name, action)

        for number in range(1, count + 1):
            yield make(number, False)
            yield make(number, True)

    def signals_at_calls(self, writer, start):
        """Each call is the last one."""
        for number, (_, family) in enumerate(self.calls(writer, start), 1):
            for which in KILLS:
                for when in ("--signal", "--signal-after"):
                    yield self.signal_case(writer, start, number, family, which, when)
            yield self.signal_case(writer, start, number, family, signal.SIGXFSZ, "--signal-after")

    def signal_case(self, writer, start, number, family, which, when):
        def action(folder):
            prepare(writer, start, folder)
            outcome = run_traced(self.tools, writer, start, folder,
                                 ["--nth", str(number), when, str(int(which))])
            if outcome.status == -which:
                return "killed", check_killed(writer, start, folder)
            return end_of(outcome), check_run(writer, start, folder, outcome)

        moment = which.name + when.removeprefix("--signal")
        name = f"{writer.name}/{start.name}/call-{number}/{moment}"
        return Case("signal at a call", name, action, family)

    def random_kills(self, writer, start, count, random_moments):
        """Signals when the run is anywhere."""
        folder = self.folders.make()
        prepare(writer, start, folder)
        begin = time.monotonic()
        run(writer, folder)
        seconds = time.monotonic() - begin
        self.folders.drop(folder)

        def make(number, which, share):
            def action(folder):
                prepare(writer, start, folder)
                outcome = run(writer, folder, kill=(share * seconds, which))
                if outcome.status == -which:
                    return "killed", check_killed(writer, start, folder)
                return end_of(outcome), check_run(writer, start, folder, outcome)

            name = f"{writer.name}/{start.name}/moment-{number}-{which.name}"
            return Case("random kill", name, action)

        for number in range(count):
            which = random_moments.choice([*KILLS, signal.SIGXFSZ])
            yield make(number, which, random_moments.uniform(0, 1.2))

    def limits(self, writer, start):
        """Files that may not grow, little memory, few descriptors."""
        largest = max(len(data) for data in writer.new.values())
        limits = [(resource.RLIMIT_FSIZE, "file-size", size)
                  for size in [*range(0, largest, 16), largest - 1, largest]]
        limits += [(resource.RLIMIT_AS, "memory", mib << 20) for mib in range(4, 160, 2)]
        limits += [(resource.RLIMIT_NOFILE, "descriptors", number) for number in range(3, 14)]
        for which, what, value in limits:
            def action(folder, which=which, value=value):
                prepare(writer, start, folder)
                outcome = run(writer, folder, limits={which: value})
                if outcome.status == 127 and outcome.stderr:  # it could not even be loaded
                    return "refused", check_files(writer, start, folder)
                if which == resource.RLIMIT_AS:
                    return end_of(outcome), check_short_of_memory(writer, start, folder, outcome)
                return end_of(outcome), check_run(writer, start, folder, outcome)

            yield Case("limit", f"{writer.name}/{start.name}/{what}-{value}", action, what)

    def interleavings(self, writer, other, start, is_apart):
        """Before some call of one writer another one runs, of the same output, to its end.

        `is_apart`: each in a process namespace of its own, where both have the same process id."""
        apart = ["unshare", "--user", "--map-root-user", "--pid", "--fork"] if is_apart else []

        def make(number, family):
            def run_both(folder, at, said):
                prepare(writer, start, folder)
                command = add_other(other, folder)
                second = [*apart, *traced(self.tools, command, start, [], folder + ".other.json")]
                return run_traced(
                    self.tools, writer, start, folder,
                    ["--nth", str(at), "--run", f"{shlex.join(second)} >{said} 2>&1"], apart)

            def action(folder):
                said = folder + ".said"
                outcome = run_both(folder, number, said)
                # A busy machine may see a run of fewer calls than the one that was counted: before
                # the last of these, then.
                for at in range(number - 1, max(0, number - 20), -1):
                    if os.path.exists(said):
                        break
                    shutil.rmtree(folder)
                    os.mkdir(folder)
                    outcome = run_both(folder, at, said)
                with open(said, encoding="utf-8", errors="replace") as file:
                    words = file.read().strip()
                faults = check_end(outcome)
                if outcome.status != 0:
                    faults.append(f"the first ends with {outcome.status}: {outcome.stderr.strip()}")
                report = folder + ".other.json"
                if not os.path.exists(report):
                    return "broken", [*faults, f"the second tells no end: {words}"]
                with open(report, encoding="utf-8") as file:
                    if '"exit":0,' not in file.read():
                        faults.append(f"the second fails: {words}")
                shutil.rmtree(os.path.join(folder, OTHER))
                for path in (said, report):
                    os.unlink(path)
                if outcome.status == 0:
                    faults += check_pair(writer, other, start, folder)
                return end_of(outcome), faults

            name = f"{writer.name}/{start.name}/{'apart' if is_apart else 'beside'}/call-{number}"
            return Case("two writers", name, action, family)

        for number, (_, family) in enumerate(self.calls(writer, start), 1):
            yield make(number, family)

    def races(self, writer, other, start, count):
        """Two writers that nobody holds back, and a reader that looks all the time."""
        apart = ["unshare", "--user", "--map-root-user", "--pid", "--fork"]
        prefix = apart if self.can_unshare else []

        def make(number):
            def action(folder):
                prepare(writer, start, folder)
                commands = [writer.command, add_other(other, folder)]
                faults = []
                with concurrent.futures.ThreadPoolExecutor(2) as pool:
                    runs = [pool.submit(run, writer, folder, [*prefix, *traced(
                        self.tools, command, start, [], f"{folder}.{i}.json")])
                        for i, command in enumerate(commands)]
                    while not all(future.done() for future in runs):
                        faults += check_pair(writer, other, start, folder, is_over=False)
                        time.sleep(0.001)
                for i, future in enumerate(runs):
                    with open(f"{folder}.{i}.json", encoding="utf-8") as file:
                        if '"exit":0,' not in file.read():
                            faults.append(f"writer {i} fails: {future.result().stderr.strip()}")
                    os.unlink(f"{folder}.{i}.json")
                shutil.rmtree(os.path.join(folder, OTHER))
                return "done", sorted(set(faults + check_pair(writer, other, start, folder)))

            return Case("two writers", f"{writer.name}/{start.name}/race-{number}", action)

        for number in range(count):
            yield make(number)

    def power_cuts(self, writer, start, options=(), rounds=1):
        """The power is cut after each step of a run."""
        def make(number):
            def action(folder):
                prepare(writer, start, folder)
                disk = Disk(folder)
                log = folder + ".log"
                outcome = run_traced(self.tools, writer, start, folder,
                                     [*options, "--log", log])
                steps = read_log(log)
                places = {name: os.path.realpath(os.path.join(folder, name))
                          for name in writer.outputs}
                seeded = random.Random(f"{SEED}/{number}")
                states, faults, litter = check_log(writer, start, disk, steps, outcome.status,
                                                   seeded, places)
                faults += check_end(outcome)
                faults += missed_by_log(disk, folder)
                for names in litter.values():
                    faults += self.check_litter(writer, start, folder, names)
                os.unlink(log)
                return f"{states} states", sorted(set(faults))

            what = "-".join(word.strip("-") for word in options)
            name = "/".join(filter(None, [writer.name, start.name, what, f"cut-{number}"]))
            return Case("power cut", name, action)

        for number in range(rounds):
            yield make(number)

    def check_litter(self, writer, start, folder, names):
        """Puts a folder into the state of a power cut and lets the next run clean up."""
        again = self.folders.make()
        prepare(writer, start, again)
        expected = {os.path.relpath(path, folder) for path in names}
        for relative, data in contents(again).items():
            if relative not in expected and not isinstance(data, str):
                os.unlink(os.path.join(again, relative))
        for path, content in names.items():
            place = os.path.join(again, os.path.relpath(path, folder))
            write_file(place, content.data)
            os.chmod(place, content.mode)
        faults = [f"{name} is left behind" for name in strange_files(writer, start, again)
                  if not TEMPORARY.fullmatch(os.path.basename(name))]
        faults += check_next(writer, start, again)
        self.folders.drop(again)
        return faults


def missed_by_log(disk, folder):
    """Whether the recorded calls, all done, give the folder as it is: else some were missed."""
    found = {name: data for name, data in contents(folder).items() if not isinstance(data, str)}
    told = {os.path.relpath(path, folder): file.now().data
            for path, file in disk.names_now().items()}
    return [] if found == told else [
        f"the log misses calls: it tells of {sorted(told)}, and there is {sorted(found)}"]


def check_short_of_memory(writer, start, folder, outcome):
    """As check_run(), but for what assimp does where memory runs out."""
    if writer.by_assimp and outcome.status not in (0, None):
        return check_files(writer, start, folder) + [
            f"{name} is left behind" for name in strange_files(writer, start, folder)]
    return check_run(writer, start, folder, outcome)


def check_pair(writer, other, start, folder, is_over=True):
    """What is wrong with outputs that two writers wrote: each is one of theirs."""
    faults = []
    for name in writer.outputs:
        try:
            with open(os.path.join(folder, name), "rb") as file:
                found = file.read()
        except FileNotFoundError:
            found = None
        allowed = [writer.new[name], as_other(other, name)]
        if not is_over:
            allowed.append(writer.old(name) if start.has_old else None)
        if found not in allowed:
            faults.append(f"{name} is none of the files that were written")
    if is_over:
        faults += [f"{name} is left behind" for name in strange_files(writer, start, folder)]
    return faults


def add_other(other, folder):
    """Puts the inputs of another writer into a folder in a folder, and returns its command."""
    os.mkdir(os.path.join(folder, OTHER))
    for name, data in other.inputs.items():
        write_file(os.path.join(folder, OTHER, name), data)
    return [os.path.join(OTHER, word) if word in other.inputs else word for word in other.command]


def as_other(other, name):
    """What the other writer makes of these inputs: a dependency file tells where they are."""
    data = other.new[name]
    if name.endswith(".d"):
        for given in other.inputs:
            data = data.replace(given.encode(), os.path.join(OTHER, given).encode())
    return data


def end_of(outcome):
    """A word for how a run ended."""
    if outcome.status is None:
        return "endless"
    if outcome.status < 0:
        return "crashed"
    return "survived" if outcome.status == 0 else "refused"


def sample(cases, count, seed):
    """A fixed choice of cases: in turn one of each group."""
    seeded = random.Random(f"{SEED}/{seed}")
    groups = {}
    for case in cases:
        groups.setdefault(case.group, []).append(case)
    for group in groups.values():
        seeded.shuffle(group)
    chosen = []
    while groups and len(chosen) < count:
        for name in sorted(groups):
            chosen.append(groups[name].pop())
            if not groups[name]:
                del groups[name]
    return chosen[:count]


def cases_of(torture, writers, is_full):
    """Everything that is to be run."""
    cook, other = writers["cook"], writers["cook-other"]
    moments = random.Random(f"{SEED}/moments")

    def some(cases, count, seed):
        return list(cases) if is_full else sample(cases, count, seed)

    more = STARTS if is_full else STARTS[:4]
    for start in more:
        yield from some(torture.call_faults(cook, start), 24, f"calls {start.name}")
        yield from some(torture.lasting_faults(cook, start), 6, f"lasting {start.name}")
        yield from some(torture.signals_at_calls(cook, start), 8, f"signals {start.name}")
        yield from torture.random_kills(cook, start, 200 if is_full else 4, moments)
    for start in STARTS:
        yield from torture.power_cuts(cook, start)
    yield from some(torture.allocation_faults(writers["cook-ply"], OVER_OLD), 24, "allocations")
    yield from some(torture.limits(cook, OVER_OLD), 20, "limits")
    pairs = [STARTS[1], STARTS[2], STARTS[3]]
    for start in STARTS if is_full else pairs:
        yield from some(torture.interleavings(cook, other, start, False), 6, f"pair {start.name}")
        if torture.can_unshare:
            yield from some(torture.interleavings(cook, other, start, True), 4,
                            f"apart {start.name}")
        yield from torture.races(cook, other, start, 20 if is_full else 1)
    named = STARTS[3]
    for name, writer in writers.items():
        if name in ("cook", "cook-other"):
            continue
        is_slow = name == "report"
        for start in (OVER_OLD, named):
            calls = torture.call_faults(writer, start, ["EIO", "ENOMEM"])
            if is_full and not is_slow:
                yield from calls
            else:
                yield from sample(calls, 200 if is_full else 1 if is_slow else 6,
                                  f"calls {name} {start.name}")
        if is_full or not is_slow:
            yield from torture.power_cuts(writer, OVER_OLD)
        yield from sample(torture.signals_at_calls(writer, named),
                          (60 if is_slow else 400) if is_full else 1 if is_slow else 2,
                          f"signals {name}")
        yield from sample(torture.allocation_faults(writer, FRESH),
                          (200 if is_slow else 4000) if is_full else 1 if is_slow else 6,
                          f"allocations {name}")
    if torture.can_unshare:
        report = writers["report"]
        yield from sample(torture.interleavings(report, report, OVER_OLD, True),
                          60 if is_full else 1, "reports")
    if is_full:
        # Whatever fails on the way, a power cut after that finds the old file or the new one.
        for start in STARTS:
            for number, (_, family) in enumerate(torture.calls(cook, start), 1):
                if family in WRITING:
                    yield from torture.power_cuts(cook, start,
                                                  ["--nth", str(number), "--error", "EIO"])


def planted_cases(torture, defect):
    """What has to notice a defect: some cases of each family."""
    def planted(name, data):
        command = [torture.tools.planted, defect, "in", "out"]
        return Writer(name, command, {"in": data}, ["out"]).learn(torture.folders)

    text = "".join(f"line {number}\n" for number in range(60)).encode()
    writer, other = planted("planted", text), planted("other", text[::-1])
    yield from sample(torture.call_faults(writer, OVER_OLD, ["EIO"]), 40, "planted over old")
    yield from sample(torture.call_faults(writer, FRESH, ["EIO"]), 20, "planted fresh")
    yield from sample(torture.signals_at_calls(writer, OVER_OLD), 20, "planted signals")
    yield from sample(torture.allocation_faults(writer, OVER_OLD), 6, "planted allocations")
    yield from sample(torture.interleavings(writer, other, FRESH, False), 16, "planted pairs")
    yield from torture.power_cuts(writer, OVER_OLD)
    yield from torture.power_cuts(writer, FRESH)


# Defect -> the families of which at least one has to notice it.
NOTICED_BY = {
    "in-place": ["write", "signal at a call", "power cut"],
    "fixed-name": ["two writers"],
    "litter": ["write", "flush"],
    "mute": ["write", "open"],
    "deaf": ["write", "flush"],
    "short": ["write"],
    "no-flush": ["power cut"],
    "no-folder": ["power cut"],
    "no-sweep": ["signal at a call"],
    "abort": ["allocation"],
    "mode": ["write"],
    "none": [],
}


def run_case(case, folders, is_kept):
    """The word and the findings of a case."""
    folder = folders.make()
    try:
        word, faults = case.action(folder)
    except (OSError, RuntimeError, ValueError) as error:
        word, faults = "broken", [f"the test broke: {error!r}"]
    if is_kept and faults:
        print(f"{case.name}: {word}, see {folder}")
    else:
        folders.drop(folder)
    return word, faults


def run_cases(cases, folders, jobs, is_kept=False):
    """Yields each case with its word and its findings, in the order of the cases."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        waiting = []
        for case in cases:
            waiting.append((case, pool.submit(run_case, case, folders, is_kept)))
            while len(waiting) > 4 * jobs:
                done, future = waiting.pop(0)
                yield done, *future.result()
        for done, future in waiting:
            yield done, *future.result()


def check_planted(torture, folders, jobs, is_full):
    """Returns what is wrong with the checks: defects that they do not notice. A sample has the cases
    that have to notice one, and all cases of the writer without defects."""
    unnoticed = []
    for defect, families in NOTICED_BY.items():
        found = Counter()
        first = {}
        cases = (case for case in planted_cases(torture, defect)
                 if is_full or not families or case.family in families)
        for case, _, faults in run_cases(cases, folders, jobs):
            found[case.family] += bool(faults)
            if faults:
                first.setdefault(case.family, f"{case.name}: {faults[0]}")
        for family in families:
            if found[family] == 0:
                unnoticed.append(f"the defect {defect} is not noticed by: {family}")
        if not families and found.total() > 0:
            unnoticed.append(f"a writer without defects is blamed: {first}")
        noticed = ", ".join(f"{family} {count}" for family, count in sorted(found.items()) if count)
        print(f"planted {defect}: noticed by {noticed or 'none'}")
    return unnoticed


def may_unshare():
    command = ["unshare", "--user", "--map-root-user", "--pid", "--fork", "true"]
    try:
        return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode == 0
    except OSError:
        return False


def may_trace(tools):
    return subprocess.run([tools.tracer, "--report", os.devnull, "--", "true"],
                          stderr=subprocess.DEVNULL, check=False).returncode != SKIPPED


def torture_all(options, tools, folders):
    """Runs everything; returns the exit status."""
    print(f"seed {SEED}, {'all cases' if options.full else 'a sample'}, {options.jobs} at a time")
    torture = Torture(tools, folders, may_unshare())
    if not torture.can_unshare:
        print("left out: writers in other process namespaces, which need unprivileged unshare")
    writers = make_writers(tools, folders)
    everything = options.full or options.case
    cases = cases_of(torture, writers, everything)
    if options.case:
        cases = (case for case in cases if case.name.startswith(tuple(options.case)))
    words = {}
    findings = Counter()
    for case, word, faults in run_cases(cases, folders, options.jobs, bool(options.case)):
        counted = words.setdefault(case.family, Counter())
        counted["cases"] += 1
        if case.family == "power cut" and word.endswith(" states"):
            counted["states"] += int(word.split()[0])
        else:
            counted[word] += 1
        findings[case.family] += bool(faults)
        for fault in faults:
            print(f"FINDING {case.family}: {case.name}: {fault}", flush=True)
    unnoticed = [] if options.case else check_planted(
        torture, folders, options.jobs, options.full)
    for fault in unnoticed:
        print(f"FINDING planted: {fault}")
    for family, counted in sorted(words.items()):
        told = [f"{counted[word]} {word}" for word in
                ("states", "refused", "survived", "killed", "done", "crashed", "endless", "broken")
                if counted[word]]
        print(f"{family}: {counted['cases']} faults, {', '.join(told)}, "
              f"{findings[family]} findings")
    total = sum(counted["cases"] for counted in words.values())
    print(f"all: {total} faults, {findings.total() + len(unnoticed)} findings")
    return 1 if findings.total() + len(unnoticed) > 0 or total == 0 else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--jobs", type=int, default=min(os.cpu_count() or 1, 4))
    parser.add_argument("--case", action="append", help="run the cases whose names begin with this")
    parser.add_argument("--skip", help="say why nothing can be tested here")
    parser.add_argument("programs", nargs="*")
    options = parser.parse_args()
    if options.skip:
        print(f"skipped: {options.skip}")
        return SKIPPED
    if len(options.programs) != 4:
        parser.error("expected BOXTREE SYSCALL_FAULTS FAILING_ALLOCATOR PLANTED")
    tools = Tools(*options.programs)
    if not may_trace(tools):
        print("skipped: this machine permits no tracing of processes")
        return SKIPPED
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # by way of what cleans up
    folders = Folders()
    try:
        return torture_all(options, tools, folders)
    finally:
        if not options.case:
            folders.drop_all()


if __name__ == "__main__":
    sys.exit(main())
