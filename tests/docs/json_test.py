#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/JSON.md has every field that commands print with --json, and no other: each command runs in each of
its ways, and the fields of what it prints, their types, and which may be absent, are compared with the page.

    json_test.py SOURCE_DIR BOXTREE
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

TYPES = ("object", "array", "text", "number", "whole", "boolean", "null")
PEERS = """#!/bin/sh
echo '{"rows": [{"mesh": "crate", "library": "fcl", "variant": "obb", "metric": "time", "value": 1.5, "unit": "ns"}]}'
"""
# Parts that are left out of the scene, of one tree of it, and instances.
PARTS = """
[scene]
source = "level.gltf"
queries = ["ray", "box", "pair"]
[[object]]
name = "crates"
match = ["Crate"]
motion = "moving"
face_ids = false
[[object]]
name = "gone"
match = ["Barrel 8"]
leave_out = true
[[object]]
name = "none"
match = ["Nothing is called so"]
"""
NAMELESS = """
[scene]
source = "level.gltf"
names = false
"""
BATCH = """{"kind":"ray","origin":[0,0,9],"direction":[0,0,-1]}
{"kind":"cone"}
"""
RESULTS = '{"rows":[{"id":"S1","what":"hashes","figure":0,"limit":0,"pass":true}]}'

JOB = '{"inputs":["%s.obj"],"output":"job.bxt"}'

BAD = """mtllib lost.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v nan 0 0
f 1 2 4
f 1 2 3
"""

FLAT = """v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
"""

FIELD = """deg 1
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
usemtl grass
f 1 2 3
usemtl stone
f 1 3 4
"""

ZONES = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
property int zone
end_header
0 0 0
1 0 0
1 1 0
0 1 0
3 0 1 2 300
3 0 2 3 7
"""

INSTANCED = """{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36,
"uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
"""

# Sections of the page, and command lines with all that they print. [STATUS] of those that fail.
ALL = "--min=-99,-99,-99 --max 99,99,99"
VIEW = "0.01,0,0,0,0,0.01,0,0,0,0,0.005,0.5,0,0,0,1"
RUNS = {
    "cook": [
        "cook crate.obj -o crate.bxt",
        "cook crate.obj -o arrays.bxt --exact --for speed --no-face-ids",
        "cook crate.obj -o ordered.bxt --write-reordered ordered.obj",
        "cook bad.obj -o bad.bxt --skip-bad",
        "cook crate.obj -o external.bxt --external",
        "cook crate.obj -o edges.bxt --active-edges 5",
        "cook field.obj -o groups.bxt --user-data groups",
        "cook --scene field.obj -o groups.bxt --user-data groups",
        "cook instanced.gltf -o instanced.bxt",
        "cook --scene instanced.gltf -o instanced.bxt",
        "cook field.obj -o field.bxt --materials",
        "cook field.obj -o stripped.bxt --strip",
        "cook field.obj -o no_ids.bxt --materials --no-face-ids",
        "cook zones.ply -o zones.bxt --user-data zone",
        "cook crate.obj -o numbered.bxt --exact",
        "cook zones.ply -o idless.bxt --user-data zone --no-face-ids",
        "cook crate.obj -o blob.bxt --codec blob-zstd",
        "cook crate.obj crate.obj -o small.bxt --tolerance 0.001 --for memory --max-slowdown 9",
        "cook --scene bad.obj -o scene.bxt --skip-bad",
        "cook level.gltf -o level.bxt --user-data primitives",
        "cook level.gltf level.gltf -o levels.bxt --user-data primitives",
        "cook level.gltf -o level.bxt",
        "cook --profile parts.toml -o parts.bxt",
        "cook --profile nameless.toml -o nameless.bxt",
    ],
    "pack": ["pack crate.bxt scene.bxt field.bxt stripped.bxt --names path -o packed.bxt"],
    "split": ["split packed.bxt -o taken"],
    "tile": ["tile crate.obj crate.obj --triangles-per-tile 4 -o tiles.jsonl"],
    "merge": ["merge numbered.bxt -o world.bxt"],
    "key": ["key crate.obj", "key bad.obj crate.obj -o two.bxt --exact", "key --manifest one.jsonl"],
    "cook --cache, --manifest": [
        "cook crate.obj -o cached.bxt --cache cooked",
        "cook bad.obj -o bad_cached.bxt --skip-bad --cache cooked",
        "cook crate.obj -o cached.bxt --cache cooked",
        "cook --manifest one.jsonl",
        "cook --manifest one.jsonl",
        "[3] cook --manifest bad.jsonl",
        "[2] cook --manifest absent.jsonl",
    ],
    "info": [
        "info crate.bxt",
        "info stripped.bxt",
        "info edges.bxt",
        "info field.bxt",
        "info zones.bxt",
        "[3] info arrays.bxt external.bxt blob.bxt level.gltf",
        "info parts.bxt",
        "info level.bxt",
        "info packed.bxt",
        "info damaged.bxt corrupt.bxt",
    ],
    "verify": ["verify crate.bxt", "[3] verify crate.bxt damaged.bxt"],
    "query FILE ray": [
        "query crate.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1",
        "query crate.bxt ray --origin 9,9,9 --direction 0,0,-1",
        "query arrays.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1",
        "query arrays.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1 --all",
        "query crate.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1 --all",
        "query field.bxt ray --origin 0.2,0.8,9 --direction 0,0,-1",
        "query zones.bxt ray --origin 0.2,0.8,9 --direction 0,0,-1",
        "query zones.bxt ray --origin 0.2,0.8,9 --direction 0,0,-1 --all",
        "query level.bxt ray --origin 0.5,10,-4.5 --direction 0,-1,0",
        "query parts.bxt ray --origin 0.5,10,-4.5 --direction 0,-1,0",
        "query nameless.bxt ray --origin 0.5,10,-4.5 --direction 0,-1,0",
        "query level.bxt ray --origin 0.5,10,-4.5 --direction 0,-1,0 --all",
        "query nameless.bxt ray --origin 0.5,10,-4.5 --direction 0,-1,0 --all",
        "query arrays.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1e-320",
        "query arrays.bxt ray --origin 0.2,0.1,9 --direction 0,0,-1e-320 --all",
    ],
    "query FILE collide": [
        "query edges.bxt collide --sphere 0.25 --at 0.2,0.1,1.1",
        "query crate.bxt collide --sphere 2 --at 0.2,0.1,0.5",
        "query arrays.bxt collide --box 0.1,0.2,0.6 --at 0.2,0.1,0.1 --merge 0.1",
        "query zones.bxt collide --sphere 2 --at 0.2,0.1,0.5",
        "query level.bxt collide --sphere 0.5 --at 0,0.3,-3.3",
        "query nameless.bxt collide --sphere 0.5 --at 0,0.3,-3.3",
    ],
    "query FILE cast": [
        "query crate.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1",
        "query edges.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1",
        "query edges.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1 --all",
        "query arrays.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1 --t-max 1",
        "query arrays.bxt cast --box 1,1,1 --at 0.2,0.1,9 --direction 0,0,-1 --any",
        "query crate.bxt cast --capsule 0,0,1,0.25 --at 0.2,0.1,9 --direction 0,0,-1 --all",
        "query arrays.bxt cast --capsule 0,0,1,0.25 --at 0.2,0.1,9 --direction 0,0,-1 --all",
        "query zones.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1",
        "query zones.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1 --all",
        "query level.bxt cast --sphere 0.25 --at 0,10,-3.3 --direction 0,-1,0",
        "query level.bxt cast --sphere 0.25 --at 0,10,-3.3 --direction 0,-1,0 --all",
        "query nameless.bxt cast --sphere 0.25 --at 0,10,-3.3 --direction 0,-1,0",
        "query nameless.bxt cast --sphere 0.25 --at 0,10,-3.3 --direction 0,-1,0 --all",
        "query arrays.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1e-320",
        "query arrays.bxt cast --sphere 0.25 --at 0.2,0.1,9 --direction 0,0,-1e-320 --all",
    ],
    "query FILE box, sphere, frustum": [
        f"query arrays.bxt frustum --matrix {VIEW}",
        f"query level.bxt frustum --matrix {VIEW}",
        f"query level.bxt frustum --matrix {VIEW} --instances",
        f"query nameless.bxt frustum --matrix {VIEW} --instances",
        "query crate.bxt sphere --center 0,0,0 --radius 9",
        f"query arrays.bxt box {ALL}",
        f"query field.bxt box {ALL}",
        f"query zones.bxt box {ALL}",
        f"query level.bxt box {ALL}",
        f"query parts.bxt box {ALL}",
        f"query nameless.bxt box {ALL}",
    ],
    "query FILE point": [
        "query crate.bxt point --at 9,9,9",
        "query arrays.bxt point --at 9,9,9",
        "query crate.bxt point --at 9,9,9 --max-distance 1",
        "query crate.bxt point --at 9,9,9 --max-distance 1 --budget 9",
        "query crate.bxt point --at 9,9,9 --relative-error 0.5",
        "query field.bxt point --at 3,2,1",
        "query zones.bxt point --at 3,2,1",
        "query level.bxt point --at 3,2,1",
        "query nameless.bxt point --at 3,2,1",
    ],
    "query FILE pair, contacts": [
        "query crate.bxt pair arrays.bxt",
        "query crate.bxt pair arrays.bxt --contacts",
        "query field.bxt pair no_ids.bxt --pose 0.1,0,0",
        "query field.bxt pair no_ids.bxt --pose 0.1,0,0 --contacts",
        "query zones.bxt pair idless.bxt --pose 0.1,0,0",
        "query zones.bxt pair idless.bxt --pose 0.1,0,0 --contacts",
        "query nameless.bxt --tree 0 pair nameless.bxt --tree2 0 --contacts",
        "query level.bxt pair level.bxt --tree2 crate --pose 0,0.3,0",
        "query parts.bxt contacts --move Crate=0.8,2.1,-6.8",
        "query parts.bxt contacts --move Crate=0.8,2.1,-6.8 --points",
        "query nameless.bxt pair crate.bxt --pose 0,0.3,0 --contacts",
        "query nameless.bxt pair crate.bxt --pose 0,0.3,0",
    ],
    "query FILE distance": [
        "query crate.bxt distance arrays.bxt --pose 9,0,0",
        "query crate.bxt distance crate.bxt --pose 9,0,0 --max-distance 1",
        "query field.bxt distance no_ids.bxt --pose 9,0,0",
        "query zones.bxt distance idless.bxt --pose 9,0,0",
        "query nameless.bxt --tree 0 distance field.bxt --pose 99,0,0",
        "query level.bxt distance crate.bxt --pose 0,20,0",
        "query nameless.bxt distance crate.bxt --pose 0,20,0",
        "query parts.bxt --layer none distance crate.bxt",
    ],
    "query FILE overlap": [
        "query crate.bxt overlap arrays.bxt",
        "query crate.bxt overlap crate.bxt --pose 9,0,0",
        "query field.bxt overlap no_ids.bxt",
        "query zones.bxt overlap idless.bxt",
        "query nameless.bxt --tree 0 overlap nameless.bxt --tree2 0",
        f"query crate.bxt box {ALL} --within 0",
        f"query field.bxt box {ALL} --within 0",
        f"query zones.bxt box {ALL} --within 0",
        f"query nameless.bxt --tree 0 box {ALL} --within 0",
        f"query arrays.bxt box {ALL} --within 0",
    ],
    "query FILE --batch": ["[1] query crate.bxt --batch batch"],
    "bench": ["bench crate.bxt --quick --runs 1"],
    "bench --approximate": ["bench crate.bxt --approximate --quick --runs 1"],
    "bench --pages": ["bench crate.bxt --pages --quick"],
    "bench --calibrate": ["bench --calibrate crate.obj --runs 1"],
    "report": ["report crate.obj flat.obj --quick --peers ./peers --include results.json",
               "report crate.obj --quick --no-times --tolerance 0.001",
               "report crate.obj --quick --no-times --f64"],
    "report --paper": ["report --paper crate.obj --quick --peers ./peers"],
    "export": ["export crate.bxt -o crate.glb", "export level.bxt -o level.glb --leaves"],
}


def type_of(value):
    for python, name in ((bool, "boolean"), (int, "whole"), (float, "number"), (str, "text"), (list, "array"),
                         (dict, "object")):
        if isinstance(value, python):
            return name
    return "null"


class Place:
    """A field of the page, or an object or array around fields, which need not be listed itself."""

    def __init__(self):
        self.types, self.may_be_absent, self.is_listed = set(), False, False
        self.inside = {}  # by key; "[]" for the elements of an array; a key in capitals is any key
        self.seen = set()

    def at(self, path):
        place = self
        for key in re.findall(r"\[\]|[^.\[]+", path):
            place.types.add("array" if key == "[]" else "object")
            place = place.inside.setdefault(key, Place())
        return place

    def find(self, key):
        return self.inside.get(key) or next((each for name, each in self.inside.items() if name.isupper()), None)

    def compare(self, value, path, faults):
        kind = type_of(value)
        self.seen.add(kind)
        if kind not in self.types and not (kind == "whole" and "number" in self.types):
            faults.add(f"{path}: printed {kind}, the page says {' or '.join(sorted(self.types))}")
        elif kind == "array":
            for each in value:
                self.inside.setdefault("[]", Place()).compare(each, path + "[]", faults)
        elif kind == "object":
            for key, each in value.items():
                place, name = self.find(key), f"{path}.{key}".lstrip(".")
                if place is None:
                    faults.add(f"{name}: printed ({type_of(each)}), not on the page")
                else:
                    place.compare(each, name, faults)
            for key, place in self.inside.items():
                if key not in value and not (key.isupper() or place.may_be_absent or key == "[]"):
                    faults.add(f"{path}.{key}: not printed, but the page does not say when it is absent")

    def unseen(self, path, faults):
        """What the page says and no command printed."""
        for kind in self.types - self.seen:
            if not (kind == "number" and "whole" in self.seen):
                faults.add(f"{path}: never printed as {kind}")
        for key, place in self.inside.items():
            place.unseen(path + key if key == "[]" else f"{path}.{key}".lstrip("."), faults)


# Of these no input is known.
UNSEEN = {"report: meshes[].advice: never printed as null"}


def sections_of(page):
    """The fields of each section, by its heading."""
    sections = {}
    for heading, text in re.findall(r"^## (.*)\n((?:(?!## ).*\n)*)", page, re.MULTILINE):
        root = Place()
        for name, types, meaning in re.findall(r"^\| `([^`|]+)` \| ([^|]+) \| ([^|]+) \|$", text, re.MULTILINE):
            place = root.at(name)
            place.is_listed = True
            place.types.update(types.replace(",", " ").replace(" or ", " ").split())
            place.may_be_absent = "absent" in meaning
            if place.types - set(TYPES):
                sys.exit(f"{name}: unknown type in {types}")
        if root.inside:
            sections[heading.replace("`", "")] = root
    return sections


class Runs:
    def __init__(self, source, boxtree, work):
        self.boxtree, self.work = boxtree, work
        for path in (source / "samples/meshes").iterdir():
            shutil.copy(path, work)
        shutil.copy(source / "samples/level/level.gltf", work)
        for name, text in (("parts.toml", PARTS), ("nameless.toml", NAMELESS), ("batch", BATCH),
                           ("results.json", RESULTS), ("one.jsonl", JOB % "crate"), ("bad.jsonl", JOB % "bad"),
                           ("absent.jsonl", JOB % "absent"), ("bad.obj", BAD), ("flat.obj", FLAT), ("field.obj", FIELD),
                           ("zones.ply", ZONES), ("instanced.gltf", INSTANCED),
                           ("peers", PEERS)):
            (work / name).write_text(text)
        (work / "peers").chmod(0o755)

    def damage(self, name, kind, damaged):
        """A copy of a file whose first section of that kind has nothing but ones."""
        section = next(each for each in self.documents("info " + name)[0]["sections"] if each["kind"] == kind)
        data, end = bytearray((self.work / name).read_bytes()), section["offset"] + section["bytes"]
        data[section["offset"]:end] = b"\xff" * section["bytes"]
        (self.work / damaged).write_bytes(data)

    def documents(self, line):
        """What a command line prints; of several files, that of each."""
        status, words = 0, line.split()
        if line.startswith("["):
            status, words = int(words[0].strip("[]")), words[1:]
        done = subprocess.run([self.boxtree, *words, "--json"], cwd=self.work, capture_output=True, text=True,
                              timeout=300, check=False)
        if done.returncode != status:
            sys.exit(f"{line}: exit {done.returncode}, expected {status}\n{done.stderr}")
        document = json.loads(done.stdout)
        if next(iter(document)) != "schema" or document.pop("schema") != 1:
            sys.exit(f"{line}: the document does not begin with schema 1")
        return document["files"] if words[0] in ("info", "verify") and list(document) == ["files"] else [document]


def main():
    source, boxtree = pathlib.Path(sys.argv[1]), sys.argv[2]
    sections = sections_of((source / "docs/JSON.md").read_text(encoding="utf-8"))
    faults = [f"{name}: a section, but no runs" for name in set(sections) - set(RUNS)]
    count = 0
    with tempfile.TemporaryDirectory() as name:
        runs = Runs(source, boxtree, pathlib.Path(name))
        for heading, lines in RUNS.items():
            root, found = sections.get(heading, Place()), set()
            for line in lines:
                for document in runs.documents(line):
                    for answer in document.get("answers", []):
                        if "error" not in answer:  # has the fields of its kind, and its line
                            rest = {key: answer.pop(key) for key in list(answer) if key != "line"}
                            sections["query FILE ray"].compare(rest, "answers[]", found)
                    root.compare(document, "", found)
                    count += 1
            if heading == "cook":
                runs.damage("arrays.bxt", "corners", "damaged.bxt")
                runs.damage("level.bxt", "instances", "corrupt.bxt")
            root.unseen("", found)
            faults += sorted({f"{heading}: {fault}" for fault in found} - UNSEEN)
    if faults:
        sys.exit("docs/JSON.md:\n" + "\n".join(faults))
    print(f"docs/JSON.md: {count} documents have the fields of {len(sections)} sections")


if __name__ == "__main__":
    main()
