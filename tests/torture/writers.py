# SPDX-License-Identifier: MIT
"""Programs that write files, what their folder is like before, and what it may be like after."""
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import threading

OLD_MODE = 0o640  # not what any umask gives: a file that has it was not made anew
SECONDS_TO_END = 120  # far more than any run takes, even on a busy machine
# What is left of a writer that was killed; the next one removes it.
TEMPORARY = re.compile(r"\..+\.[0-9a-f]{16}\.cooking")

CUBE = """v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
v 0 0 1
v 1 0 1
v 0 1 1
v 1 1 1
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""
TETRAHEDRON = "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


class Tools:
    """The programs under test and those that put them under strain."""

    def __init__(self, boxtree, tracer, allocator, planted):
        self.boxtree = os.path.abspath(boxtree)
        self.tracer = os.path.abspath(tracer)
        self.allocator = os.path.abspath(allocator)
        self.planted = os.path.abspath(planted)


class Start:
    """What a folder is like before a run, and what its file system can do."""

    def __init__(self, name, has_old=False, has_link=False, refused=""):
        self.name = name
        self.has_old = has_old
        self.has_link = has_link  # the outputs are symbolic links into another folder
        self.refused = refused    # see `syscall_faults --refuse`


FRESH = Start("fresh")
OVER_OLD = Start("over-old", has_old=True)
STARTS = [
    FRESH,
    OVER_OLD,
    Start("fresh-named", refused="tmpfile"),
    Start("over-old-named", has_old=True, refused="tmpfile"),
    Start("over-old-named-no-exchange", has_old=True, refused="tmpfile,exchange"),
    Start("over-old-no-exchange", has_old=True, refused="exchange"),
    Start("over-link", has_old=True, has_link=True),
    Start("fresh-proc-link", refused="empty-path"),
]


class Writer:
    """A command, run in a folder of its own, that turns inputs into outputs."""

    def __init__(self, name, command, inputs, outputs, by_assimp=False):
        self.name = name
        self.command = command
        self.inputs = inputs    # name -> bytes
        self.outputs = outputs  # names
        # Whether assimp reads the input. Where memory runs out it may crash, or call the input bad.
        self.by_assimp = by_assimp
        self.new = {}           # name -> bytes, after a run that nothing disturbs

    def old(self, name):
        """Longer than what replaces it, so that writing over it in place leaves a mixture. It begins like
        it, and goes on as rules of a depfile do, since a program may refuse to replace another kind of file."""
        new = self.new.get(name, b"")
        return new[:256] + f"old {name}:\n".encode() * (len(new) // 8 + 100)

    def learn(self, folders):
        """Runs it undisturbed to learn what it writes."""
        folder = folders.make()
        prepare(self, FRESH, folder)
        outcome = run(self, folder)
        if outcome.status != 0:
            raise RuntimeError(f"{self.name}: exit {outcome.status}: {outcome.stderr}")
        for name in self.outputs:
            with open(os.path.join(folder, name), "rb") as file:
                self.new[name] = file.read()
        folders.drop(folder)
        return self


class Folders:
    """Empty folders, on a file system that forgets quickly if there is one."""

    def __init__(self):
        memory = "/dev/shm"
        base = memory if os.access(memory, os.W_OK) and not os.environ.get("TMPDIR") else None
        self.root = os.path.realpath(tempfile.mkdtemp(prefix="boxtree-torture-", dir=base))
        self.lock = threading.Lock()
        self.made = 0

    def make(self):
        with self.lock:
            self.made += 1
            number = self.made
        path = os.path.join(self.root, str(number))
        os.mkdir(path)
        return path

    @staticmethod
    def drop(path):
        shutil.rmtree(path, ignore_errors=True)

    def drop_all(self):
        self.drop(self.root)


class Outcome:
    """How a run ended. A negative status is a signal; `report` is what the tracer says, if any."""

    def __init__(self, status, stderr, report=None):
        self.status = status
        self.stderr = stderr
        self.report = report or {}


def write_file(path, data):
    with open(path, "wb") as file:
        file.write(data)


def prepare(writer, start, folder):
    """Puts inputs, old outputs and links into an empty folder. `scratch` is its TMPDIR."""
    os.mkdir(os.path.join(folder, "scratch"))
    for name, data in writer.inputs.items():
        write_file(os.path.join(folder, name), data)
    if start.has_link:
        os.mkdir(os.path.join(folder, "held"))
    for name in writer.outputs:
        path = os.path.join(folder, name)
        if start.has_link:
            os.symlink(os.path.join("held", name), path)
        if start.has_old:
            write_file(path, writer.old(name))
            os.chmod(path, OLD_MODE)


def traced(tools, command, start, options, report):
    """The command under the tracer."""
    refused = ["--refuse", start.refused] if start.refused else []
    return [tools.tracer, "--report", report, *refused, *options, "--", *command]


def run(writer, folder, command=None, variables=None, limits=None, kill=None):
    """Runs the command of a writer, or another, in a folder. `kill` is (seconds, signal)."""
    environment = dict(os.environ, TMPDIR=os.path.join(folder, "scratch"), LC_ALL="C",
                       **(variables or {}))

    def set_limits():
        for which, value in (limits or {}).items():
            resource.setrlimit(which, (value, value))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with subprocess.Popen(command or writer.command, cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, preexec_fn=set_limits) as child:
        if kill is not None:
            try:
                child.wait(kill[0])
            except subprocess.TimeoutExpired:
                child.send_signal(kill[1])
        try:
            _, stderr = child.communicate(timeout=SECONDS_TO_END)
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            return Outcome(None, "")
    return Outcome(child.returncode, stderr.decode(errors="replace"))


def run_traced(tools, writer, start, folder, options, prefix=()):
    """The same under the tracer. `prefix` is a command that runs the tracer."""
    report = folder + ".json"
    outcome = run(writer, folder, [*prefix, *traced(tools, writer.command, start, options, report)])
    if outcome.status == 0:
        with open(report, encoding="utf-8") as file:
            outcome.report = json.load(file)
        os.unlink(report)
        signalled = outcome.report["signal"]
        outcome.status = -signalled if signalled else outcome.report["exit"]
    elif outcome.status is not None:
        raise RuntimeError(f"the tracer failed: {outcome.status} {outcome.stderr}")
    return outcome


def contents(folder):
    """path -> bytes of every file in a folder; of a symbolic link, what it says."""
    found = {}
    for base, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(base, name)
            relative = os.path.relpath(path, folder)
            if os.path.islink(path):
                found[relative] = "-> " + os.readlink(path)
            else:
                with open(path, "rb") as file:
                    found[relative] = file.read()
    return found


def strange_files(writer, start, folder):
    """Files that are neither inputs nor outputs."""
    expected = set(writer.inputs) | set(writer.outputs)
    if start.has_link:
        expected |= {os.path.join("held", name) for name in writer.outputs}
    return sorted(set(contents(folder)) - expected)


def check_files(writer, start, folder, must_be_new=False):
    """What is wrong with inputs and outputs: each output is old or new, and as it was before."""
    faults = []
    files = contents(folder)
    for name, data in writer.inputs.items():
        if files.get(name) != data:
            faults.append(f"the input {name} has changed")
    for name in writer.outputs:
        path = os.path.join(folder, name)
        if start.has_link:
            if files.get(name) != "-> " + os.path.join("held", name):
                faults.append(f"{name} was a symbolic link and is none")
            found = files.get(os.path.join("held", name))
        else:
            found = files.get(name)
        old = writer.old(name) if start.has_old else None
        if must_be_new and found != writer.new[name]:
            faults.append(f"{name} is not the new file")
        elif found not in (old, writer.new[name]):
            size = "missing" if found is None else f"{len(found)} bytes"
            faults.append(f"{name} is neither old nor new: {size}")
        if start.has_old and found is not None and os.stat(path).st_mode & 0o7777 != OLD_MODE:
            faults.append(f"{name} has lost its mode")
    return faults


def check_end(outcome):
    """What is wrong with how a run ended that nobody killed."""
    if outcome.status is None:
        return ["it does not end"]
    if outcome.status < 0:
        return [f"it ended by {signal.Signals(-outcome.status).name}: {outcome.stderr.strip()}"]
    if outcome.status > 0 and not outcome.stderr.strip():
        return [f"exit {outcome.status} without a message"]
    if outcome.status == 5 and "not enough memory" in outcome.stderr:
        return []
    if outcome.status not in (0, 2, 4):  # input and output; internal, as when memory runs out
        return [f"exit {outcome.status} for a fault of the system: {outcome.stderr.strip()}"]
    return []


def check_run(writer, start, folder, outcome, may_leave=False):
    """All that is wrong after a run that nobody killed. `may_leave`: the call failed that removes
    the temporary file."""
    faults = check_end(outcome)
    faults += check_files(writer, start, folder, must_be_new=outcome.status == 0)
    for name in strange_files(writer, start, folder):
        if not (may_leave and TEMPORARY.fullmatch(os.path.basename(name))):
            faults.append(f"{name} is left behind")
    return faults


def check_next(writer, start, folder):
    """What is wrong after the next run, which has to succeed and to remove what is left."""
    outcome = run(writer, folder)
    if outcome.status != 0:
        return [f"the next run ends with {outcome.status}: {outcome.stderr.strip()}"]
    faults = check_files(writer, start, folder, must_be_new=True)
    faults += [f"{name} is not removed by the next run"
               for name in strange_files(writer, start, folder)]
    return faults


def check_killed(writer, start, folder):
    """What is wrong after a run was killed."""
    faults = check_files(writer, start, folder)
    for name in strange_files(writer, start, folder):
        if not TEMPORARY.fullmatch(os.path.basename(name)):
            faults.append(f"{name} is left behind")
    return faults + check_next(writer, start, folder)


def binary_ply(text):
    """The triangles and vertices of an OBJ text of triangles, as a binary PLY file."""
    import struct
    lines = [line.split() for line in text.splitlines()]
    vertices = [tuple(map(float, line[1:])) for line in lines if line[0] == "v"]
    faces = [tuple(int(i) - 1 for i in line[1:]) for line in lines if line[0] == "f"]
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(vertices)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(faces)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    body = b"".join(struct.pack("<3f", *vertex) for vertex in vertices)
    body += b"".join(struct.pack("<B3i", 3, *face) for face in faces)
    return header.encode() + body


def ascii_ply(text):
    """The same as text, which other code reads."""
    lines = [line.split() for line in text.splitlines()]
    vertices = [" ".join(line[1:]) for line in lines if line[0] == "v"]
    faces = [f"{len(line) - 1} " + " ".join(str(int(i) - 1) for i in line[1:])
             for line in lines if line[0] == "f"]
    return "\n".join(["ply", "format ascii 1.0", f"element vertex {len(vertices)}",
                      "property float x", "property float y", "property float z",
                      f"element face {len(faces)}", "property list uchar int vertex_indices",
                      "end_header", *vertices, *faces, ""]).encode()


def make_writers(tools, folders):
    """The commands of boxtree that write files, by name."""
    cook = [tools.boxtree, "cook", "--jobs", "1", "-o", "out.bxt"]
    cube = CUBE.encode()
    depfile = ["--depfile", "out.d"]
    exact = ["--exact", "--codec", "wide8"]
    made = [
        Writer("cook", [*cook, "in.obj", *depfile], {"in.obj": cube}, ["out.d", "out.bxt"],
               by_assimp=True),
        Writer("cook-other", [*cook, "in.obj", *depfile], {"in.obj": TETRAHEDRON.encode()},
               ["out.d", "out.bxt"], by_assimp=True),
        Writer("cook-ply", [*cook, "in.ply", *depfile], {"in.ply": binary_ply(TETRAHEDRON)},
               ["out.d", "out.bxt"]),
        Writer("cook-ascii-ply", [*cook, "in.ply", *exact], {"in.ply": ascii_ply(TETRAHEDRON)},
               ["out.bxt"], by_assimp=True),
        Writer("cook-blob", [*cook, "in.ply", "--codec", "blob-zstd"],
               {"in.ply": binary_ply(TETRAHEDRON)}, ["out.bxt"]),
        Writer("cook-scene", [*cook, "in.obj", "--scene", "--profile", "scene.toml"],
               {"in.obj": cube, "scene.toml": b"# keeps everything\n"}, ["out.bxt"],
               by_assimp=True),
    ]
    for writer in made:
        writer.learn(folders)
    tree = {"in.bxt": made[0].new["out.bxt"]}
    made += [
        Writer("export-glb", [tools.boxtree, "export", "in.bxt", "-o", "out.glb"], tree,
               ["out.glb"]).learn(folders),
        Writer("export-obj", [tools.boxtree, "export", "in.bxt", "-o", "out.obj"], tree,
               ["out.obj"]).learn(folders),
        # Of a report, the table alone is the same in every run: the page tells the machine's load.
        Writer("report", [tools.boxtree, "report", "in.ply", "--no-times", "--quick", "--csv",
                          "out.csv"],
               {"in.ply": binary_ply(TETRAHEDRON)}, ["out.csv"]).learn(folders),
    ]
    return {writer.name: writer for writer in made}
