# SPDX-License-Identifier: MIT
"""Rules that cook meshes into .bxt files, an action a file.

    load("@boxtree_rules//:defs.bzl", "boxtree_mesh", "boxtree_scene")

A cook reads its inputs and what these name (buffers of glTF, MTL of OBJ, lists of hidden faces), all of which have to be
declared: what is not is not there in the sandbox, and the cook fails. Its bytes depend on them, on their names, on the options and on
the program; so a result of a remote cache is what a cook here would have written. The GUIDE of boxtree has an example.
"""

def _cook(ctx, inputs, arguments):
    out = ctx.outputs.out or ctx.actions.declare_file(ctx.label.name + ".bxt")
    command = ctx.actions.args()
    command.add("cook")
    command.add_all(arguments)
    command.add("--output", out)
    if ctx.file.costs:
        command.add("--costs", ctx.file.costs)
        inputs = inputs + [ctx.file.costs]
    command.add_all([ctx.expand_location(option, ctx.attr.data) for option in ctx.attr.options])
    command.add("--jobs", str(ctx.attr.jobs))
    command.add_all(["--quiet", "--require-files"])
    ctx.actions.run(
        executable = ctx.file._boxtree,
        arguments = [command],
        inputs = inputs + ctx.files.data + [ctx.file._version],
        outputs = [out],
        mnemonic = "Boxtree",
        progress_message = "Cooking %s" % out.short_path,
    )
    files = depset([out])
    return [DefaultInfo(files = files, runfiles = ctx.runfiles([out]))]

def _boxtree_mesh(ctx):
    return _cook(ctx, ctx.files.srcs, ctx.files.srcs)

def _boxtree_scene(ctx):
    return _cook(ctx, ctx.files.srcs + [ctx.file.profile], ctx.files.srcs + ["--profile", ctx.file.profile])

def _attributes(**own):
    return dict(
        own,
        data = attr.label_list(
            allow_files = True,
            doc = "What the inputs name: buffers of glTF, MTL of OBJ, lists of hidden faces, meshes that a profile names.",
        ),
        out = attr.output(doc = "The cooked file. Default: NAME.bxt."),
        options = attr.string_list(
            doc = "Of `boxtree cook`, one word each; $(location LABEL) stands for a file of `data`.",
        ),
        costs = attr.label(
            allow_single_file = True,
            doc = "Of `boxtree bench --calibrate`: what costs time on the machines that the files are for.",
        ),
        jobs = attr.int(
            default = 1,
            doc = "Threads of a cook; never its bytes. Bazel runs as many cooks as the machine has cores.",
        ),
        _boxtree = attr.label(
            default = "@boxtree//:boxtree",
            allow_single_file = True,
            executable = True,
            cfg = "exec",
        ),
        _version = attr.label(default = "@boxtree//:version.txt", allow_single_file = True),
    )

boxtree_mesh = rule(
    implementation = _boxtree_mesh,
    doc = "Cooks meshes into one file, a tree each.",
    attrs = _attributes(
        srcs = attr.label_list(allow_files = True, allow_empty = False, mandatory = True, doc = "Meshes."),
    ),
)

boxtree_scene = rule(
    implementation = _boxtree_scene,
    doc = "Cooks what a profile describes: a scene, or meshes of which parts are left out.",
    attrs = _attributes(
        profile = attr.label(allow_single_file = True, mandatory = True, doc = "docs/PROFILE.md of boxtree."),
        srcs = attr.label_list(allow_files = True, doc = "Meshes, where the profile names none."),
    ),
)
