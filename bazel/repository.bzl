# SPDX-License-Identifier: MIT
"""The program `boxtree` of this machine as a repository, for WORKSPACE:

    load("@boxtree_rules//:repository.bzl", "boxtree_tool")
    boxtree_tool(name = "boxtree")

Actions depend on the bytes of the program and on what `boxtree --version` prints: the versions of the libraries
that bytes of a cooked file depend on, which are shared ones. Bazel reads those when its server starts.
"""

_NOT_FOUND = """boxtree_tool(name = "{name}"): no program `boxtree`; expected the attribute `path`, the environment \
variable BOXTREE_TOOL, or a folder of PATH with it. See "Start" in the README of boxtree."""

_DOES_NOT_RUN = """boxtree_tool(name = "{name}"): `{program} --version` ends with status {status}: {error}"""

_BUILD = """package(default_visibility = ["//visibility:public"])

exports_files([
    "boxtree",
    "version.txt",
])
"""

def _boxtree_tool(repository):
    path = repository.attr.path or repository.os.environ.get("BOXTREE_TOOL")
    program = repository.path(path) if path else repository.which("boxtree")
    if not program or not program.exists:
        fail(_NOT_FOUND.format(name = repository.name))
    version = repository.execute([program, "--version"])
    if version.return_code != 0:
        fail(_DOES_NOT_RUN.format(
            name = repository.name,
            program = program,
            status = version.return_code,
            error = version.stderr,
        ))
    repository.symlink(program, "boxtree")
    repository.file("version.txt", version.stdout)
    repository.file("BUILD", _BUILD)

boxtree_tool = repository_rule(
    implementation = _boxtree_tool,
    doc = "Makes @NAME//:boxtree the program of this machine.",
    attrs = {"path": attr.string(doc = "Of the program. Default: $BOXTREE_TOOL, or `boxtree` in PATH.")},
    environ = [
        "BOXTREE_TOOL",
        "PATH",
    ],
    local = True,
)
