#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Man pages and completions name the options that --help-all names, all of them and no others, for every
command and kind; pages are clean troff, completions are tried in the shells, and examples run as printed.

    manual_test.py BOXTREE SOURCE_DIR CMAKE BUILD_DIR
"""
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SHELLS = ("bash", "zsh", "fish")
# In the order in which a page has them.
SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "KINDS", "EXIT STATUS", "EXAMPLES",
            "SEE ALSO"]
ALWAYS = {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "EXAMPLES", "SEE ALSO"}

# How files begin that gzip -9n has written, as Debian wants them: no name, no time, the best compression.
GZIP_9N = b"\x1f\x8b\x08" + 5 * b"\0" + b"\2"

# Words before the cursor, and what is offered there among others, and what is not. Folders are.
OFFERS = [
    (["cook", ""], {"bunny.obj", "two words.PLY", "folder"}, {"bunny.bxt", "scene.toml", "notes.txt"}),
    (["cook", "bunny.obj", "-o", ""], {"bunny.bxt", "folder"}, {"bunny.obj", "notes.txt"}),
    (["cook", "--codec", ""], {"auto", "wide8", "dedup", "blob-zstd"}, {"memory", "bunny.obj"}),
    (["cook", "--for", "m"], {"memory"}, {"speed"}),
    (["cook", "--profile", ""], {"scene.toml", "folder"}, {"bunny.obj", "bunny.bxt"}),
    (["cook", "--jobs", ""], set(), {"bunny.obj", "info", "auto"}),
    (["cook", "-", "--format", ""], {"obj", "ply", "glb", "3ds"}, {"bunny.obj"}),
    (["info", "bunny.bxt", ""], {"bunny.bxt", "folder"}, {"bunny.obj"}),
    (["query", ""], {"bunny.bxt", "folder"}, {"bunny.obj", "ray"}),  # FILE comes before KIND
    (["query", "--json", ""], {"bunny.bxt"}, {"ray"}),
    (["query", "bunny.bxt", ""], {"ray", "pair", "contacts"}, {"cook", "bunny.bxt"}),
    (["query", "--tree", "ray", "bunny.bxt", "r"], {"ray"}, {"pair"}),
    (["query", "bunny.bxt", "--batch", ""], {"notes.txt", "bunny.bxt"}, {"ray"}),
    (["query", "bunny.bxt", "pair", ""], {"bunny.bxt"}, {"bunny.obj", "ray"}),
    (["export", "bunny.bxt", "--order", ""], {"source", "tree"}, {"bunny.bxt"}),
    (["help", "qu"], {"query"}, {"cook"}),
    (["help", ""], {"query", "cook", "help"}, {"ray", "bunny.bxt"}),
    (["help", "query", ""], {"ray", "contacts"}, {"cook", "bunny.bxt"}),
    (["help", "query", "ray", ""], set(), {"ray", "cook", "bunny.bxt"}),
    (["help", "cook", ""], set(), {"ray", "cook", "bunny.obj"}),
    (["help", "query", "--man-pages", ""], {"folder"}, {"ray"}),
    (["help", "--man-pages", ""], {"folder"}, {"bunny.obj"}),
    (["completion", ""], set(SHELLS), {"cook"}),
]
FILES = ["bunny.bxt", "bunny.obj", "two words.PLY", "scene.toml", "notes.txt"]

BASH = """
source ./script
COMP_WORDS=(boxtree "$@") COMP_CWORD=$#
_boxtree
printf '%s\\n' "${COMPREPLY[@]}"
"""
# zsh completes within its line editor only: here its functions print what they are given.
ZSH = """
compadd() { while [[ $1 == -* ]]; do shift; done; for word; do [[ $word == $current* ]] && print -r -- $word; done }
_describe() {
  [[ $1 == -o ]] && shift
  local entry
  for entry in ${(P)2}; do entry=${entry%%:*}; [[ $entry == $current* ]] && print -r -- $entry; done
}
_files() {
  setopt local_options null_glob
  print -rl -- *(/)
  if [[ $1 == -g ]]; then print -rl -- ${~2}; elif [[ $1 != -/ ]]; then print -rl -- *(.); fi
}
compset() { current=${current#*=} }
words=(boxtree "$@") CURRENT=$(( $# + 1 )) current=${@[-1]}
source ./script
true
"""
FISH = """
source ./script
set last $argv[-1]
set -e argv[-1]
complete -C (string join ' ' -- boxtree (string escape -- $argv) $last) | string replace -r '\\t.*' ''
true
"""


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, **options)
    if done.returncode != 0 or done.stderr:
        sys.exit(f"{command}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Manual:
    def __init__(self, boxtree, work):
        self.boxtree, self.work = boxtree, work
        # [] is the program; the help names what is below.
        self.commands = [[]] + [[name] for name in self.names_below([])]
        self.kinds = [command + [kind] for command in self.commands[1:]
                      for kind in self.names_below(command)]

    def names_below(self, command):
        text = run([self.boxtree, *command, "--help"])
        found = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.MULTILINE)
        return re.findall(r"^  (\S+)", found[1], re.MULTILINE) if found else []

    def options_in_help(self, command):
        text = run([self.boxtree, *command, "--help-all"])
        if not command:
            text = text[:text.index("Subcommands:")]
        lines = re.findall(r"^  (-.*?)(?:  .*)?$", text, re.MULTILINE)
        return {name for line in lines for name in re.findall(r"(?<![\w-])--?[\w-]+", line)}

    def page(self, command):
        return run([self.boxtree, "help", "--man", *command])


def expect(what, found, expected):
    if found != expected:
        sys.exit(f"{what}: not there {sorted(expected - found)}, not expected {sorted(found - expected)}")


def options_in_page(page):
    """Of the command and, by its name, of each kind."""
    options, kind = {"": set()}, ""
    for before, line in zip(page.split("\n"), page.split("\n")[1:]):
        if line.startswith(".SS "):
            kind = line[4:]
            options[kind] = set()
        if before == ".TP":
            plain = re.sub(r"\\f.", "", line).replace("\\-", "-")
            options[kind].update(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", plain))
    return options


def check_pages(manual):
    names = {"-".join(["boxtree"] + command) for command in manual.commands}
    for command in manual.commands:
        name = "-".join(["boxtree"] + command)
        page = manual.page(command)
        found = options_in_page(page)
        expect(f"{name}.1", found.pop(""), manual.options_in_help(command))
        kinds = [kind for kind in manual.kinds if kind[:1] == command]
        expect(f"{name}.1, kinds", set(found), {kind[1] for kind in kinds})
        for kind in kinds:
            expect(f"{name}.1, {kind[1]}", found[kind[1]], manual.options_in_help(kind))
        sections = re.findall(r"^\.SH (.*)$", page, re.MULTILINE)
        if sections != [each for each in SECTIONS if each in sections] or not ALWAYS <= set(sections):
            sys.exit(f"{name}.1: sections {sections}")
        statuses = page[page.index(".SH EXIT STATUS"):]
        if "127, and 134" not in statuses:
            sys.exit(f"{name}.1: nothing of the statuses of the system")
        audits = not command or any("--audit" in option for option in manual.options_in_help(command))
        if ("\n\\fB7\\fR\n" in statuses) != audits:
            sys.exit(f"{name}.1: status 7 is for those that audit a cache")
        others = set(re.findall(r"^\\fB(.*)\\fR\(1\),?$", page[page.index(".SH SEE ALSO"):], re.MULTILINE))
        expect(f"{name}.1, see also", {other.replace("\\-", "-") for other in others}, names - {name})
        run(["groff", "-man", "-ww", "-Tutf8", "-z"], input=page)
        # A page that is the same whenever it is built has no date.
        lint = subprocess.run(["mandoc", "-T", "lint", "-W", "warning"], input=page, text=True,
                              capture_output=True, check=False)
        remarks = [line for line in lint.stdout.splitlines() if 'missing date, using ""' not in line]
        if remarks:
            sys.exit(f"{name}.1: {remarks}")
    folder = manual.work / "pages"
    folder.mkdir()
    run([manual.boxtree, "help", "--man-pages", folder])
    expect("--man-pages", {path.name for path in folder.iterdir()}, {name + ".1" for name in names})
    for command in manual.commands:
        page = folder / ("-".join(["boxtree"] + command) + ".1")
        if page.read_text() != manual.page(command):
            sys.exit(f"{page.name}: --man-pages and --man differ")


def check_completions(manual, folder):
    for name in FILES:
        (folder / name).touch()
    (folder / "folder").mkdir()
    programs = {"bash": ["bash", "--norc", "-c", BASH, "bash"], "zsh": ["zsh", "-f", "-c", ZSH, "zsh"],
                "fish": ["fish", "--no-config", "-c", FISH, "--"]}
    for shell in SHELLS:
        script = folder / "script"
        script.write_text(run([manual.boxtree, "completion", shell]))
        run([shell, "--no-execute" if shell == "fish" else "-n", script])

        def offered(words):
            return {line.rstrip("/") for line in
                    run(programs[shell] + words, cwd=folder).splitlines() if line}

        for command in manual.commands + manual.kinds:
            expected = manual.options_in_help(command)
            before = command
            if len(command) == 2:
                before = [command[0], "bunny.bxt", command[1]]
                expected = expected | manual.options_in_help(command[:1])
            found = offered(before + ["-"])
            if shell == "fish":  # it offers short names only where they have no long one
                found |= offered(before + ["--"])
                expected = {name for name in expected if name.startswith("--")}
                found = {name for name in found if name.startswith("--")}
            expect(f"{shell}: {command}", found, expected)
        expect(f"{shell}: commands", offered([""]) & {command[0] for command in manual.commands[1:]},
               {command[0] for command in manual.commands[1:]})
        for words, wanted, unwanted in OFFERS:
            found = offered(words)
            if not wanted <= found or unwanted & found:
                sys.exit(f"{shell}: {words}: offered {sorted(found)}; expected {sorted(wanted)}, "
                         f"not {sorted(unwanted)}")
        script.unlink()
    # A word after = is a value, too, as each shell splits it.
    for shell, words in (("bash", ["cook", "--codec", "=", "wi"]), ("zsh", ["cook", "--codec=wi"]),
                         ("fish", ["cook", "--codec=wi"])):
        (folder / "script").write_text(run([manual.boxtree, "completion", shell]))
        found = run(programs[shell] + words, cwd=folder).replace("--codec=", "").split()
        expect(f"{shell}: {words}", set(found), {"wide8", "wide4"})


def check_examples(manual, source, folder):
    for mesh in ("bunny.obj", "horse.obj", "cat.obj"):
        shutil.copy(source / "samples/meshes/crate.obj", folder / mesh)
    for name in ("level.gltf", "scene.toml"):
        shutil.copy(source / "samples/level" / name, folder)
    (folder / "jobs.jsonl").write_text('{"inputs": ["bunny.obj"], "output": "job.bxt"}\n')
    (folder / "bin").mkdir()
    (folder / "bin/boxtree").symlink_to(manual.boxtree)
    path = f"{folder}/bin:{os.environ['PATH']}"
    count = 0
    for command in manual.commands[1:]:
        page = run(["groff", "-man", "-Tutf8", "-P-cbou", "-rLL=300n"], input=manual.page(command))
        shown = page[page.index("\nEXAMPLES\n"):page.index("\nSEE ALSO\n")]
        lines = re.findall(r"^ {11}(\S.*)$", shown, re.MULTILINE)
        if not lines:
            sys.exit(f"{command}: no examples")
        in_help = run([manual.boxtree, *command, "--help"])
        for line in lines:
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", line], cwd=folder, text=True,
                                  capture_output=True, env={**os.environ, "PATH": path}, check=False,
                                  timeout=300)
            if done.returncode != 0:
                sys.exit(f"{command}: {line}: exit {done.returncode}\n{done.stdout}{done.stderr}")
            if f"  {line}\n" not in in_help and not manual.names_below(command):
                sys.exit(f"{command}: --help does not show {line}")
            count += 1
    return count


def check_installed(manual, cmake, build, prefix):
    run([cmake, "--install", build, "--prefix", prefix, "--component", "boxtree_program"])
    share = prefix / "share"
    changes = (pathlib.Path(build) / "changelog.gz").read_bytes()
    if changes[:9] != GZIP_9N:
        sys.exit(f"the changelog of packages is not as gzip -9n writes it: {changes[:10]}")
    expect("installed pages", {path.name for path in (share / "man/man1").iterdir()},
           {"-".join(["boxtree"] + command) + ".1.gz" for command in manual.commands})
    for command in manual.commands:
        page = (share / "man/man1" / ("-".join(["boxtree"] + command) + ".1.gz")).read_bytes()
        if gzip.decompress(page).decode() != manual.page(command):
            sys.exit(f"the installed page of {command} is not what boxtree help --man prints")
        if page[:9] != GZIP_9N:
            sys.exit(f"the installed page of {command} is not as gzip -9n writes it: {page[:10]}")
    for shell, place in (("bash", "bash-completion/completions/boxtree"),
                         ("zsh", "zsh/site-functions/_boxtree"),
                         ("zsh", "zsh/vendor-completions/_boxtree"),
                         ("fish", "fish/vendor_completions.d/boxtree.fish")):
        if (share / place).read_text() != run([manual.boxtree, "completion", shell]):
            sys.exit(f"{place} is not what boxtree completion {shell} prints")


def main():
    boxtree, source, cmake, build = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        for folder in ("completions", "examples", "prefix"):
            (work / folder).mkdir()
        manual = Manual(boxtree, work)
        check_pages(manual)
        check_completions(manual, work / "completions")
        count = check_examples(manual, pathlib.Path(source), work / "examples")
        check_installed(manual, cmake, build, work / "prefix")
        print(f"manual: {len(manual.commands)} pages, {len(manual.kinds)} kinds, {count} examples")


main()
