#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The commands of a report's page do what the page says: each writes a file of as many bytes, in the encoding
that it names, and the surface moves as far.

    report_commands_test.py BOXTREE SOURCE_DIR
"""
import html
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

CONCLUSION = re.compile(
    r"([^.>]*): (wide8|wide4), (arrays|exact|grid)(?: (\d+))?\..{0,40}?"
    r"([\d.]+) bytes per triangle, a file of (\d+) bytes, tree included:.*?"
    r"(No position changes by a single bit|No point of the surface moves by more than).*?"
    r"In the folder of the mesh: <code>boxtree (cook [^<]*?)\s*<", re.DOTALL)


def write_strip(path, cells):
    """A bent strip of triangles. A single cell and its neighbour are less than a leaf."""
    with open(path, "w", encoding="ascii") as file:
        for x in range(cells + 1):
            file.write(f"v {x / 3} 0 {x * x / 7}\nv {x / 3} 0.7 {x * x / 9}\n")
        for x in range(cells):
            a = 2 * x + 1
            file.write(f"f {a} {a + 2} {a + 3}\nf {a} {a + 3} {a + 1}\n")


def write_doubles(path):
    """A bent strip as PLY, of doubles that f32 does not hold."""
    cells = 60
    points = [f"{x / 3} {y} {x * x / 7}" for x in range(cells + 1) for y in (0, 0.7)]
    faces = [f"3 {a} {a + 2} {a + 3}\n3 {a} {a + 3} {a + 1}" for a in range(0, 2 * cells, 2)]
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *(f"property double {k}" for k in "xyz"),
              f"element face {2 * cells}", "property list uchar int vertex_indices", "end_header"]
    pathlib.Path(path).write_text("\n".join(header + points + faces) + "\n", encoding="ascii")


def run(boxtree, *arguments):
    return subprocess.run([boxtree, *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True).stdout


def check(boxtree, mesh, *options):
    """How many recommendations have which store."""
    mesh = pathlib.Path(mesh)
    run(boxtree, "report", mesh, "-o", "page.html", "--json-out", "figures.json", "--quick", "-q", *options)
    page = html.unescape(re.sub("</?span>", "", pathlib.Path("page.html").read_text(encoding="utf-8")))
    figures = json.loads(pathlib.Path("figures.json").read_text(encoding="utf-8"))["meshes"][0]
    found = CONCLUSION.findall(page)
    commands = page.count("In the folder of the mesh:")
    assert len(found) == commands > 0, (len(found), commands)
    stores = []
    for roles, codec, store, bits, each, size, surface, command in found:
        cook, name, output, made, *options = shlex.split(command)
        assert (name, output, made) == (mesh.name, "-o", mesh.stem + ".bxt"), command
        arguments = [cook, mesh, "-o", "made.bxt", *options]
        run(boxtree, *arguments, "-q")
        made, = json.loads(run(boxtree, "info", "made.bxt", "--json"))["trees"]
        assert (made["codec"], made["geometry"]) == (codec, store), (mesh, roles, command, made)
        assert os.path.getsize("made.bxt") == int(size), (mesh, roles, command, os.path.getsize("made.bxt"), size)
        run(boxtree, *(word for word in arguments if word != "--strip"), "-q")
        sections = json.loads(run(boxtree, "info", "made.bxt", "--json"))["sections"]
        record, = [16 + section["bytes"] for section in sections if section["kind"] == "cook_record"]
        assert f"the record of its cook, some {record / 1000:.1f} KB, and the name of its mesh." in page, (mesh, record)
        assert each == f"{int(size) / made['triangles']:.2f}", (each, size, made["triangles"])
        is_exact = store in ("arrays", "exact")
        assert is_exact or f"--grid-bits {bits}" in command, command
        assert surface.endswith("single bit") or not is_exact, (mesh, roles)
        assert is_exact or not re.search("(?i)bit for bit", roles), (mesh, roles)
        point, = [point for point in figures["points"]
                  if (point["codec"], point["geometry"], point["grid_bits"]) == (codec, store, int(bits) if bits else None)]
        assert point["bytes"]["total"] == int(size)
        stores.append(store)
    advice = {point["name"]: point for point in figures["points"]}[figures["advice"]["fastest_exact"]]
    assert advice["surface"]["max"] == 0, advice
    return stores


def main():
    boxtree, source = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        write_strip("one.obj", 1)
        write_strip("few.obj", 5)
        write_strip("more of it's.obj", 200)
        write_doubles("doubles.ply")
        stores = set()
        for mesh in ("one.obj", "few.obj", "more of it's.obj", "doubles.ply", source / "samples/meshes/crate.obj",
                     source / "samples/level/level.gltf"):  # a scene, if it were not flattened
            stores.update(check(boxtree, mesh, "--no-times"))
        stores.update(check(boxtree, source / "samples/meshes/crate.obj"))  # by times of this machine
    assert stores == {"arrays", "exact", "grid"}, stores
    print("every printed command gives the printed file")


if __name__ == "__main__":
    main()
