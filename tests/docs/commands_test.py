#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What the pages show is true: commands run as printed and print what stands below them, programs
compile, and the README's answers what the command above it answers.

    commands_test.py SOURCE_DIR BOXTREE CXX INCLUDES LIBRARIES     the last two separated by ;

tests/bare_machine.sh and tests/bare_packages.sh run what builds or installs the project (BUILDS below) on
a bare Debian.
"""
import fnmatch
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

from blocks import blocks_of

# What installs packages or builds for long, mostly for another system, as tests/platforms/run.sh does.
BUILDS = re.compile(r"^(samples/quickstart\.sh|tests/run\.sh|samples/packages\.sh|cmake -S \. -B build-(deb|windows|windows-cli|arm64) )")

# What this test itself writes.
WRITTEN_HERE = {"make/", "ninja/", "precompiled/", "program", "program.cpp", "program.out", "query.out"}
# What uses an installation for C, or the two files in its place, which tests/consumer/c_test.sh and tests/platforms/run.sh
# run with what it prints.
USES_C = re.compile(r"^(cc |python3 runtime/c/amalgamate\.py )")

# What programs of the pages use of the application around them.
AROUND = """
#include <charconv>
#include <cstdio>
#include <string>
static int report(const std::string& what) { std::puts(what.c_str()); return 1; }
template <class... Values> void use(const Values&...) {}
static void use(double t, const Eigen::Vector3d&, const Eigen::Vector3d&, unsigned face) {
  char digits[32] = {};
  std::to_chars(digits, digits + sizeof(digits) - 1, t);
  std::printf("t: %s\\nface: %u\\n", digits, face);
}
static void step_on(const std::optional<std::string_view>&) {}
static void step_on(std::string_view) {}
static void touch(const boxtree::ScenePair&) {}
"""
FREE = """
extern boxtree::Result<boxtree::File> file;
"""

# What a rule must do after a change, and that it does it once. `is_fresh` and `cook` are the tool's.
RECOOKS = r"""
recooks() {
  local why=$1
  shift
  "$@"
  if is_fresh; then echo "does not cook $why"; exit 1; fi
  cook
  is_fresh || { echo "cooks twice $why"; exit 1; }
}
"""


def take_interrupts():
    """As in a terminal: what runs in the background of a script ignores them, with all that it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def fail(page, line, what):
    sys.exit(f"{page}:{line}: {what}")


def as_pattern(line):
    """A line of output; `...` stands for anything, a run of blanks for another."""
    parts = [r"\s+".join(map(re.escape, part.split())) for part in line.strip().split("...")]
    return re.compile(r"\s*" + r".*".join(parts) + r"\s*$")


class Pages:
    def __init__(self, source, boxtree, compiler, includes, libraries, work):
        self.source, self.boxtree, self.work = source, boxtree, work
        folders = [folder for folder in includes.split(";") if folder]
        self.compile = [compiler, "-std=c++20", "-ffp-contract=off",
                        *(flag for folder in folders for flag in ("-isystem", folder))]
        self.libraries = [library for library in libraries.split(";") if library]
        # The folder of the sources, in which nothing that is written stays.
        for entry in source.iterdir():
            if not entry.name.startswith((".", "build")):
                (work / entry.name).symlink_to(entry)
        self.environment = dict(os.environ, PATH=f"{pathlib.Path(boxtree).parent}:{os.environ['PATH']}")
        self.said = ""
        self.ran = 0
        # g++ takes the header that all programs include from here, compiled once.
        header = next(path for path in (pathlib.Path(folder, "boxtree/boxtree.h") for folder in folders) if path.exists())
        (work / "precompiled/boxtree").mkdir(parents=True)
        subprocess.run([*self.compile, "-w", "-x", "c++-header", header, "-o",
                        work / "precompiled/boxtree/boxtree.h.gch"], check=True)
        self.compile[1:1] = ["-isystem", str(work / "precompiled")]

    def run(self, page, text, line):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=self.work, text=True,
                              env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              preexec_fn=take_interrupts)
        if done.returncode != 0:
            fail(page, line, f"status {done.returncode}:\n{text}\n{done.stdout}")
        self.said = done.stdout
        self.ran += text.count("\n")

    def check_output(self, page, text, line):
        lines = self.said.splitlines()
        for wanted in text.splitlines():
            if wanted.startswith("# "):  # which command prints what follows
                continue
            if not any(as_pattern(wanted).match(found) for found in lines):
                fail(page, line, f"not printed: {wanted}\nprinted:\n{self.said}")

    def program(self, page, text, line):
        """Compiled; linked and run where it needs nothing of an application, for its output."""
        # What is precompiled comes first, or is read again.
        includes = "".join(sorted(re.findall(r"^#include.*\n", text, re.MULTILINE),
                                  key=lambda include: "<boxtree/boxtree.h>" not in include))
        body = re.sub(r"^#include.*\n", "", text, flags=re.MULTILINE)
        is_whole = "File::open" in body
        code = (includes + AROUND + ("" if is_whole else FREE) +
                "int run() {\n" + body + "  return 0;\n}\n" + ("int main() { return run(); }\n" if is_whole else ""))
        path = self.work / "program.cpp"
        path.write_text(code, encoding="utf-8")
        command = [*self.compile, "-Werror", str(path), "-o", "program"]
        done = subprocess.run(command + (self.libraries if is_whole else ["-fsyntax-only"]), cwd=self.work,
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            fail(page, line, done.stdout)
        if is_whole:
            self.run(page, "./program\n", line)

    def build_folder(self, name, file, text):
        """The meshes of the samples, one of them in a folder, with a boxtree of their own, whose time may change."""
        folder = self.work / name
        shutil.copytree(self.source / "samples/meshes", folder)
        (folder / "levels").mkdir()
        shutil.copy(folder / "level.obj", folder / "levels/yard.obj")
        (folder / "bin").mkdir()
        shutil.copy(self.boxtree, folder / "bin/boxtree")
        (folder / file).write_text(text, encoding="utf-8")

    def makefile(self, page, text, line):
        """Cooks what the rule names, and again only if something changes that the files depend on."""
        self.build_folder("make", "Makefile", text)
        self.run(page, RECOOKS + """
cd make
export PATH=$PWD/bin:$PATH
cook() { make; }
is_fresh() { make -q; }
recooks 'without the cooked files' true
recooks 'for another material library' touch crate.mtl
recooks 'for another boxtree' touch bin/boxtree
recooks 'for other options' sed -i 's/--quiet/--quiet --exact/' Makefile
boxtree info out/crate.bxt out/levels/yard.bxt | grep -c ', geometry arrays' | grep -x 2
# A Makefile that makes the PATH itself is told that $(shell) does not see it, or works (GNU make 4.4).
sed -i '1i export PATH := $(CURDIR)/bin:$(PATH)' Makefile
cooks() { env PATH=/usr/bin:/bin make -B >said 2>&1; }
cooks || grep -q 'make was called without boxtree on the PATH' said
sed -i 's|^BOXTREE := .*|BOXTREE := bin/boxtree|' Makefile
cooks
""", line)

    def ninja(self, page, text, line):
        """The same with ninja."""
        assert "/usr/local/bin/boxtree" in text
        self.build_folder("ninja", "build.ninja", text.replace("/usr/local/bin/boxtree", "bin/boxtree"))
        self.run(page, RECOOKS + """
cd ninja
cook() { ninja; }
is_fresh() { ninja -n | grep 'no work'; }
recooks 'without the cooked files' true
recooks 'for another material library' touch crate.mtl
recooks 'for another boxtree' touch bin/boxtree
recooks 'for other options' sed -i 's/--quiet/--quiet --exact/' build.ninja
boxtree info out/crate.bxt out/levels/yard.bxt | grep -c ', geometry arrays' | grep -x 2
""", line)

    def profile(self, page, text, line):
        """Lines of the sample's profile, in its order."""
        lines = iter([re.sub(r"\s*#.*", "", each)
                      for each in (self.source / "samples/level/scene.toml").read_text().splitlines()])
        for wanted in filter(None, text.splitlines()):
            if wanted not in lines:
                fail(page, line, f"not in samples/level/scene.toml: {wanted}")

    def check_retries(self):
        """The GUIDE's list of what may pass has every error of the operating system and of too little memory,
        each with its status of docs/api/errors.md."""
        errors = dict(re.findall(r"^\| \d+ \| `(\w+)` \|.*\| (\d) \|$",
                                 (self.source / "docs/api/errors.md").read_text(encoding="utf-8"), re.MULTILINE))
        guide = (self.source / "docs/GUIDE.md").read_text(encoding="utf-8")
        listed = dict(re.findall(r"^\| `(\w+)` \| (\d) \|", guide[guide.index("## Exit statuses"):], re.MULTILINE))
        wanted = {name: status for name, status in errors.items()
                  if status == "2" or name in ("out_of_memory", "import_failed")}
        if listed != wanted:
            fail("docs/GUIDE.md", 0, f"what may pass: listed {listed}, expected {wanted}")

    def check_ignored(self):
        """What commands write into the folder of the sources is nothing that git would add."""
        ignored = [line.removeprefix("/") for line in (self.source / ".gitignore").read_text(encoding="utf-8").splitlines()
                   if not line.startswith("#")]
        written = {entry.name + "/" * entry.is_dir() for entry in self.work.iterdir()
                   if not entry.is_symlink()} - WRITTEN_HERE
        left = sorted(name for name in written if not any(fnmatch.fnmatch(name, pattern) for pattern in ignored))
        if left or not written:
            fail(".gitignore", 0, f"does not name {left} of {sorted(written)}")

    def check(self, page):
        is_of_c = False
        for language, text, line in blocks_of(self.source / page):
            if language == "sh" and BUILDS.match(text):
                continue
            if is_of_c and language == "text":
                is_of_c = False
                continue
            is_of_c = language == "sh" and bool(USES_C.match(text))
            if is_of_c or language == "c":
                continue
            {"sh": self.run, "text": self.check_output, "cpp": self.program, "toml": self.profile,
             "make": self.makefile, "ninja": self.ninja,
             # tests/consumer
             "cmake": lambda *_: None, "makefile": lambda *_: None, "starlark": lambda *_: None}[language](page, text, line)


def main():
    source, boxtree, compiler, includes, libraries = sys.argv[1:]
    with tempfile.TemporaryDirectory() as work:
        pages = Pages(pathlib.Path(source), boxtree, compiler, includes, libraries, pathlib.Path(work))
        pages.check("README.md")
        # The README's program prints what its command does.
        pages.run("README.md", "./program | grep ^t: >program.out\n"
                  "boxtree query bunny.bxt ray --origin 0,0,10 --direction 0,0,-1 | grep ^t: >query.out\n"
                  "cmp program.out query.out\n", 0)
        pages.check("docs/GUIDE.md")
        pages.check_retries()
        pages.check_ignored()
        assert pages.ran > 30, f"only {pages.ran} commands were found"
    print(f"{pages.ran} commands run as printed")


if __name__ == "__main__":
    main()
