#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Cooks generated meshes with `--write-reordered` and reads what was written with readers of its own:
every face of the source is there once, with all its attributes; split polygons are covered by
triangles with their corners' attributes; face i is face i of the tree (`export --order tree`); and
rays hit the faces that brute force over the written mesh finds, under their numbers there.

    reorder_test.py BOXTREE
"""
import base64
import collections
import json
import math
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile

BOXTREE = sys.argv[1]
NONE = {"o": "default", "g": "default", "s": "off", "usemtl": "DefaultMaterial"}
RAYS = 60


def expect(truth, *what):
    if not truth:
        raise AssertionError(" ".join(map(str, what)))


def run(*words, status=0):
    done = subprocess.run([BOXTREE, *map(str, words)], text=True, capture_output=True, check=False)
    expect(done.returncode == status, "status", done.returncode, words, done.stderr)
    return done.stdout if status == 0 else done.stderr


class Mesh:
    """Positions as text or numbers, and faces: corners as tuples whose first number is the position's,
    with whatever else belongs to the face."""

    def __init__(self):
        self.positions, self.faces, self.rest = [], [], None

    def add(self, corners, state):
        self.faces.append((tuple(corners), state))

    def triangles(self, face):
        corners = [self.positions[corner[0]] for corner in self.faces[face][0]]
        return [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]


def read_obj(path):
    mesh, state, counts = Mesh(), dict(NONE), {"v": 0, "vt": 0, "vn": 0}
    kept, others, libraries = collections.defaultdict(list), [], []
    for line in path.read_text(encoding="utf-8").replace("\\\n", " ").splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0] in counts:
            counts[words[0]] += 1
            kept[words[0]].append(tuple(words[1:]))
        elif words[0] in state:
            state[words[0]] = " ".join(words[1:])
        elif words[0] == "mtllib":
            libraries += [os.path.realpath(path.parent / name) for name in words[1:]]
        elif words[0] in "flp":
            corners = []
            for word in words[1:]:
                parts = (word.split("/") + ["", ""])[:3]
                numbers = [int(part) if part else 0 for part in parts]
                corners.append(tuple(n - 1 if n > 0 else counts[kind] + n if n < 0 else None
                                     for n, kind in zip(numbers, counts)))
            frozen = tuple(sorted(state.items()))
            if words[0] == "f" and len(corners) >= 3:
                mesh.add(corners, frozen)
            else:
                others.append((words[0], tuple(corners), frozen))
    mesh.positions = [tuple(map(float, words[:3])) for words in kept["v"]]
    mesh.rest = (kept, others, libraries)
    return mesh


PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
             "float": "f", "double": "d"}


def read_ply(path):
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    form, elements = None, []
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "format":
            form = words[1]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    order = ">" if form == "binary_big_endian" else "<"
    at, text = end, iter(data[end:].decode("latin-1").split()) if form == "ascii" else None

    def take(kind):
        nonlocal at
        if text is not None:
            word = next(text)
            return float(word) if kind in ("float", "double") else int(word)
        value = struct.unpack_from(order + PLY_TYPES[kind], data, at)[0]
        at += struct.calcsize(PLY_TYPES[kind])
        return value

    mesh, rest = Mesh(), []
    for name, count, properties in elements:
        for _ in range(count):
            row = {}
            for prop in properties:
                if prop[0] == "list":
                    row[prop[3]] = tuple(take(prop[2]) for _ in range(take(prop[1])))
                else:
                    row[prop[1]] = take(prop[0])
            if name == "vertex":
                mesh.positions.append((row["x"], row["y"], row["z"]))
            if name != "face":
                rest.append((name, tuple(sorted(row.items()))))
                continue
            corners = row.pop("vertex_indices")
            pairs = row.pop("texcoord", (None,) * 2 * len(corners))
            corners = [(c, pairs[2 * i:2 * i + 2]) for i, c in enumerate(corners)]
            state = tuple(sorted(row.items()))
            if len(corners) >= 3:
                mesh.add(corners, state)
            else:
                rest.append(("no face", tuple(corners), state))
    mesh.rest = rest
    return mesh


def read_gltf(path):
    data = path.read_bytes()
    chunk = b""
    if path.suffix == ".glb":
        magic, version, size, length, kind = struct.unpack_from("<4sIII4s", data)
        expect((magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON"), "header of", path)
        document = json.loads(data[20:20 + length])
        if 20 + length < len(data):
            size, kind = struct.unpack_from("<I4s", data, 20 + length)
            expect(kind == b"BIN\0" and 28 + length + size == len(data), "chunk of", path)
            chunk = data[28 + length:]
    else:
        document = json.loads(data)
    buffers = []
    for buffer in document["buffers"]:
        uri = buffer.get("uri")
        if uri is None:
            content = chunk
        elif uri.startswith("data:"):
            content = base64.b64decode(uri.split(",", 1)[1], validate=True)
        else:
            content = (path.parent / uri).read_bytes()
        expect(len(content) >= buffer["byteLength"], "length of a buffer")
        buffers.append(content)

    def values(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        kind = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        size = struct.calcsize(kind)
        stride = view.get("byteStride", width * size)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        expect(start % size == 0, "alignment of an accessor")
        expect((accessor["count"] - 1) * stride + width * size + accessor.get("byteOffset", 0)
               <= view["byteLength"], "an accessor beyond its view")
        return [struct.unpack_from(f"<{width}{kind}", buffers[view["buffer"]], start + i * stride)
                for i in range(accessor["count"])]

    mesh = Mesh()
    primitive = document["meshes"][0]["primitives"][0]
    attributes = {name: values(number) for name, number in primitive["attributes"].items()}
    mesh.positions = attributes["POSITION"]
    numbers = ([n for n, in values(primitive["indices"])] if "indices" in primitive
               else list(range(len(mesh.positions))))
    for i in range(0, len(numbers) - 2, 3):
        mesh.add([(n,) for n in numbers[i:i + 3]], None)
    # What is said besides the numbers of vertices.
    rest = json.loads(json.dumps(document))
    rest["meshes"][0]["primitives"][0].pop("indices", None)
    images = [os.path.realpath(path.parent / image.pop("uri")) for image in rest.get("images", [])
              if "uri" in image]
    for array in ("buffers", "bufferViews", "accessors"):
        rest.pop(array)
    mesh.rest = (rest, attributes, images)
    return mesh


READERS = {".obj": read_obj, ".ply": read_ply, ".gltf": read_gltf, ".glb": read_gltf}


def has_in_order(polygon, corners):
    """Whether a polygon has these corners, in the order in which it goes around."""
    if not set(corners) <= set(polygon):
        return False
    at = [polygon.index(corner) for corner in corners]
    return sum(at[i - 1] > at[i] for i in range(len(at))) == 1


def check_faces(source, written):
    """Each polygon of the source once: whole, or as triangles that have each of its edges once."""
    expect(written.positions == source.positions, "positions")
    expect(written.rest == source.rest, "what is no face:", written.rest, source.rest)
    whole = collections.Counter(source.faces)
    parts = []
    for face in written.faces:
        if len(face[0]) <= 4 and whole[face] > 0:
            whole[face] -= 1
        else:
            parts.append(face)
    pieces = collections.defaultdict(list)
    for corners, state in parts:
        expect(len(corners) == 3, "a part is no triangle:", corners)
        owners = [polygon for polygon, its in whole.elements()
                  if its == state and has_in_order(polygon, corners)]
        expect(owners, "a face that the source does not have:", corners, state)
        pieces[owners[0], state].append(corners)
    for (polygon, state), count in whole.items():
        if count == 0:
            continue
        triangles = pieces[polygon, state]
        expect(len(triangles) == count * (len(polygon) - 2), "parts of", polygon, triangles)
        edges = collections.Counter((t[i - 1], t[i]) for t in triangles for i in range(3))
        for i in range(len(polygon)):
            expect(edges[polygon[i - 1], polygon[i]] == count, "an edge of", polygon)
    return len(parts)


def hits_of(mesh, origin, direction):
    """(t, face) of every face that a ray hits, by the test of Moeller and Trumbore."""

    def sub(a, b):
        return (a[0] - b[0], a[1] - b[1], a[2] - b[2])

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    def dot(a, b):
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

    hits = []
    for face in range(len(mesh.faces)):
        for a, b, c in mesh.triangles(face):
            e, f = sub(b, a), sub(c, a)
            p = cross(direction, f)
            det = dot(e, p)
            if det == 0:
                continue
            s = sub(origin, a)
            u = dot(s, p) / det
            q = cross(s, e)
            v = dot(direction, q) / det
            t = dot(f, q) / det
            if u >= 0 and v >= 0 and u + v <= 1 and t >= 0:
                hits.append((t, face))
    return hits


def check_rays(file, mesh, tolerance, *words):
    rng = random.Random(5)
    bounds = [(min(p[k] for p in mesh.positions), max(p[k] for p in mesh.positions)) for k in range(3)]
    rays = []
    for _ in range(RAYS):
        target = [rng.uniform(low, high) for low, high in bounds]
        origin = [0.5 * (low + high) + 3 * (high - low + 1) * rng.uniform(-1, 1) for low, high in bounds]
        rays.append({"origin": origin, "direction": [t - o for t, o in zip(target, origin)]})
    batch = file.with_suffix(".rays")
    batch.write_text("".join(json.dumps(ray) + "\n" for ray in rays), encoding="utf-8")
    answers = [json.loads(line) for line in
               run("query", file, *words, "--batch", batch, "ray").splitlines()]
    expect(len(answers) == len(rays), "answers")
    found = 0
    for ray, answer in zip(rays, answers):
        hits = hits_of(mesh, ray["origin"], ray["direction"])
        expect(answer["hit"] == bool(hits), "hit", ray, answer, hits)
        if not hits:
            continue
        found += 1
        nearest = min(hits)[0]
        near = {face for t, face in hits if t <= nearest + tolerance}
        expect(abs(answer["t"] - nearest) <= tolerance, "t", answer, min(hits))
        expect(answer["face"] in near, "face", answer, sorted(hits)[:3])
        if tolerance < 1e-6:
            expect(answer["face"] == min(near), "the smallest of equal faces", answer, near)
    expect(found > RAYS / 10, "rays that hit:", found)


def check_order(file, mesh):
    """Face i of the tree is face i of the mesh."""
    shown = file.with_suffix(".tree.obj")
    run("export", file, "-o", shown, "--triangles", "--order", "tree", "-q")
    tree = read_obj(shown)
    expect(len(tree.faces) == len(mesh.faces), "faces", len(tree.faces), len(mesh.faces))
    for face in range(len(mesh.faces)):
        ours = [tuple(struct.unpack("<3f", struct.pack("<3f", *tree.positions[c[0]])))
                for c in tree.faces[face][0]]
        theirs = [tuple(struct.unpack("<3f", struct.pack("<3f", *mesh.positions[c[0]])))
                  for c in mesh.faces[face][0]]
        if len(theirs) == 3:  # a leaf's faces may begin with any corner
            expect(ours in [theirs[i:] + theirs[:i] for i in range(3)], "face", face, ours, theirs)
        else:
            expect(ours == theirs, "face", face, ours, theirs)


def check(source, target, *options):
    """Cooks, and checks the pair of files. Returns how many triangles are parts of polygons."""
    file = target.with_name(target.stem + ".bxt")
    json_text = run("cook", source, "-o", file, "--write-reordered", target, "--json", *options)
    expect(json.loads(json_text)["reordered"] == str(target), "report")
    read = READERS[source.suffix]
    written = read(target)
    parts = check_faces(read(source), written)
    if "--f64" not in options:
        written.positions = [tuple(struct.unpack("<3f", struct.pack("<3f", *p)))
                             for p in written.positions]
    is_grid = "--grid-bits" in options
    if "--external" in options:
        run("verify", file, "--mesh", target, "-q")
        check_rays(file, written, 1e-9, "--mesh", target)
        return parts
    run("verify", file, "-q")
    info = json.loads(run("info", file, "--json"))
    text = json.dumps(info)
    expect('"face_ids": 0' in text or '"face_ids": 0.0' in text, "face ids in", text)
    if not is_grid:
        check_order(file, written)
    check_rays(file, written, 1e-3 if is_grid else 1e-9)
    return parts


CODECS = ["auto", "wide8", "wide4", "plain-f16", "packed-f32", "dedup"]


def surface(rng, cells, step=1.0):
    """Vertices and quads of a rough height field."""
    vertices = [(x * step, y * step, rng.uniform(0, 0.7)) for y in range(cells + 1)
                for x in range(cells + 1)]
    quads = [(y * (cells + 1) + x, y * (cells + 1) + x + 1, (y + 1) * (cells + 1) + x + 1,
              (y + 1) * (cells + 1) + x) for y in range(cells) for x in range(cells)]
    return vertices, quads


def polygons(rng, count, at):
    """Planar polygons of 3 to 9 corners, some with a notch, above each other."""
    vertices, faces = [], []
    for n in range(count):
        corners = rng.randint(3, 9)
        radii = [rng.choice([1, 0.35]) if corners > 4 else 1 for _ in range(corners)]
        ring = []
        for i, radius in enumerate(radii):
            angle = 2 * math.pi * i / corners
            ring.append(len(vertices))
            vertices.append((at + radius * math.cos(angle), at + radius * math.sin(angle), 1 + 0.1 * n))
        faces.append(tuple(ring))
    return vertices, faces


def digits(rng, value):
    """A number with more or fewer digits, as programs write them."""
    return rng.choice([repr(value), f"{value:.4f}", f"{value:.9e}"])


def write_obj(path, rng, line_end="\n", relative=False):
    lines = ["# made by a test", "mtllib colours.mtl more.mtl"]
    corners, count = [], 0
    materials = [None, "red", "green", "bl ue"]
    for part in range(6):
        vertices, faces = (surface(rng, 7, 0.4) if part % 2 == 0 else polygons(rng, 9, part))
        if part > 0:
            lines.append(rng.choice(["o part%d" % part, "g group%d more" % part, "s %d" % part]))
        for x, y, z in vertices:
            text = " ".join(digits(rng, c) for c in (x, y, z + part))
            lines.append("v " + text + (" 0.5 0.25 1" if part == 2 else ""))
            lines.append(f"vt {digits(rng, rng.random())} {digits(rng, rng.random())}")
            lines.append(f"vn 0 {digits(rng, rng.random())} 1")
        for face in faces:
            material = rng.choice(materials[1:] if part > 0 else materials[:1])
            if material:
                lines.append("usemtl " + material)
            words = []
            for v in face:
                at = v - len(vertices) if relative else count + v + 1
                words.append(rng.choice([f"{at}/{at}/{at}", f"{at}//{at}", f"{at}/{at}", f"{at}"]))
            lines.append("f " + " ".join(words) + ("  # a face" if rng.random() < 0.1 else ""))
            corners.append(words)
            if rng.random() < 0.05:
                lines.append(rng.choice(["l ", "p "]) + " ".join(words[:2]))
        if part == 1:
            lines += [lines[-1]] if lines[-1].startswith("f ") else []  # the same face again
            lines.append("f \\")
            lines.append(" ".join(str(count + v + 1) for v in faces[0]))
        count += len(vertices)
    path.write_bytes(line_end.join(lines).encode())  # the last line has no end


def test_obj(folder):
    rng = random.Random(1)
    (folder / "colours.mtl").write_text("newmtl red\n", encoding="utf-8")
    (folder / "more.mtl").write_text("newmtl green\n", encoding="utf-8")
    (folder / "there").mkdir()
    parts = 0
    for number, codec in enumerate(CODECS):
        source = folder / f"level{number}.obj"
        write_obj(source, rng, "\r\n" if number == 1 else "\n", relative=number % 2 == 1)
        parts += check(source, folder / "there" / f"level{number}.obj", "--exact", "--codec", codec)
        parts += check(source, folder / f"again{number}.obj", "--f64", "--codec", codec)
    check(source, folder / "grid.obj", "--grid-bits", "18")
    check(source, folder / "outside.obj", "--external")
    # The source is not the tree's mesh any more.
    stderr = run("query", folder / "outside.bxt", "--mesh", source, "ray", "--origin", "0,0,9",
                 "--direction", "0,0,-1", status=3)
    expect("content differs" in stderr, stderr)
    expect(parts > 50, "parts of polygons:", parts)


def test_bad_faces(folder):
    source = folder / "bad.obj"
    source.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 0 0 2\nv 1 0 2\nv 0 1 2\n"
                      "f 1 2 3\nf 1 2 4\nf 1 2 99\nf 5 6 7\n", encoding="utf-8")
    target = folder / "good.obj"
    run("cook", source, "-o", folder / "good.bxt", "--write-reordered", target, "--skip-bad", "-q")
    faces = {tuple(c[0] for c in face) for face, _ in read_obj(target).faces}
    expect(faces == {(0, 1, 2), (4, 5, 6)}, faces)


def write_ply(path, rng, form):
    vertices, faces = surface(rng, 9, 0.3)
    more, shapes = polygons(rng, 25, 1.0)
    faces = faces + [tuple(v + len(vertices) for v in shape) for shape in shapes]
    vertices = vertices + more
    faces += [faces[-1], (0, 1), (2,)]
    rng.shuffle(faces)
    header = ["ply", f"format {form} 1.0", "comment made by a test", f"element vertex {len(vertices)}",
              "property uchar red", "property float x", "property float y", "property float z",
              "property double nx", f"element face {len(faces)}", "property short material",
              "property list uchar int vertex_indices", "property list ushort float texcoord",
              "property list uchar uchar tags", "property float weight", "element edge 2",
              "property int a", "property list uchar int b", "end_header"]
    order = ">" if form == "binary_big_endian" else "<"
    out = []

    def put(kind, *values):
        if form == "ascii":
            out.append(" ".join(repr(v) for v in values))
        else:
            out.append(struct.pack(f"{order}{len(values)}{kind}", *values))

    def end():
        out.append("\n" if form == "ascii" else b"")

    for x, y, z in vertices:
        put("B", rng.randrange(256))
        put("f", *(struct.unpack("<f", struct.pack("<f", c))[0] for c in (x, y, z)))
        put("d", rng.random())
        end()
    for number, face in enumerate(faces):
        put("h", rng.randrange(-5, 5))
        put("B", len(face))
        put("i", *face)
        put("H", 2 * len(face))
        put("f", *(number + i / 16 for i in range(2 * len(face))))
        put("B", 2)
        put("B", 7, number % 256)
        put("f", number / 8)
        end()
    for _ in range(2):
        put("i", 5)
        put("B", 1)
        put("i", 9)
        end()
    head = "\n".join(header) + "\n"
    if form == "ascii":
        path.write_text(head + " ".join(out).replace(" \n ", "\n").rstrip(), encoding="utf-8")
    else:
        path.write_bytes(head.encode() + b"".join(out))


def test_ply(folder):
    rng = random.Random(2)
    parts = 0
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        for codec in CODECS:
            source = folder / f"{form}-{codec}.ply"
            write_ply(source, rng, form)
            parts += check(source, folder / f"{form}-{codec}-tree.ply", "--exact", "--codec", codec)
    expect(parts > 50, "parts of polygons:", parts)
    strips = folder / "strips.ply"
    strips.write_text("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                      "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n", encoding="utf-8")
    stderr = run("cook", strips, "-o", folder / "s.bxt", "--write-reordered", folder / "t.ply", status=5)
    expect("tristrips" in stderr and not (folder / "s.bxt").exists(), stderr)


def gltf_parts(rng, kind):
    vertices, quads = surface(rng, 12, 0.3)
    numbers = [n for a, b, c, d in quads for n in (a, b, c, a, c, d)]
    numbers += numbers[:3]  # the same triangle again
    if kind is None:
        vertices = [vertices[n] for n in numbers]
    positions = b"".join(struct.pack("<3f", *v) for v in vertices)
    normals = b"".join(struct.pack("<3f", 0, rng.random(), 1) for _ in vertices)
    coordinates = b"".join(struct.pack("<2f", rng.random(), rng.random()) for _ in vertices)
    indices = b"" if kind is None else struct.pack(f"<{len(numbers)}{kind}", *numbers)
    views, data = [], b""
    for content in (indices, positions, normals, coordinates) if indices else (
            positions, normals, coordinates):
        data += b"\0" * (-len(data) % 4)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data += content
    base = len(views) - 3
    accessors = [{"bufferView": base + i, "componentType": 5126, "count": len(vertices), "type": t}
                 for i, t in enumerate(("VEC3", "VEC3", "VEC2"))]
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "material": 0}
    if indices:
        accessors.append({"bufferView": 0, "componentType": {"H": 5123, "I": 5125}[kind],
                          "count": len(numbers), "type": "SCALAR"})
        primitive["indices"] = 3
    document = {"asset": {"version": "2.0", "extras": {"by": "a test"}}, "scene": 0,
                "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "name": "level", "scale": [2, 2, 2]}],
                "meshes": [{"name": "ground", "primitives": [primitive]}],
                "materials": [{"name": "grass", "pbrMetallicRoughness": {
                    "metallicFactor": 0.1, "baseColorTexture": {"index": 0}}}],
                "textures": [{"source": 0}], "images": [{"uri": "pictures/gr%20ass.png"}],
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
    return document, data


def write_glb(path, document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) +
                     struct.pack("<I4s", len(text), b"JSON") + text +
                     struct.pack("<I4s", len(data), b"BIN\0") + data)


def scaled(mesh):
    """The mesh as its node places it."""
    mesh.positions = [tuple(2 * x for x in p) for p in mesh.positions]
    return mesh


def test_gltf(folder):
    rng = random.Random(3)
    READERS[".glb"] = READERS[".gltf"] = lambda path: scaled(read_gltf(path))
    (folder / "other").mkdir()
    for kind in ("H", "I", None):
        document, data = gltf_parts(rng, kind)
        glb = folder / f"level-{kind}.glb"
        write_glb(glb, document, data)
        for codec in CODECS:
            target = folder / f"tree-{kind}-{codec}.glb"
            check(glb, target, "--exact", "--codec", codec)
            if kind is not None:  # in place: nothing but numbers of vertices
                before, after = glb.read_bytes(), target.read_bytes()
                expect(len(before) == len(after), "size of", target)
                start = before.index(data[:64])
                size = document["bufferViews"][0]["byteLength"]
                expect(before[:start] == after[:start] and before[start + size:] == after[start + size:],
                       "other bytes of", target)
        check(glb, folder / "other" / f"tree-{kind}.glb", "--exact")
        for name, uri in (("file", f"buffer%20{kind}.bin"), ("data", None)):
            if uri is None:
                uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
            else:
                (folder / f"buffer {kind}.bin").write_bytes(data)
                (folder / f"buffer%20{kind}.bin").write_bytes(data)  # for our reader
            document["buffers"][0]["uri"] = uri
            gltf = folder / f"{name}-{kind}.gltf"
            gltf.write_text(json.dumps(document), encoding="utf-8")
            check(gltf, folder / f"{name}-{kind}-tree.gltf", "--exact")
            check(gltf, folder / "other" / f"{name}-{kind}-tree.gltf", "--exact")
    # Bytes that something else reads, too, are left as they are.
    def other_view(changed):
        changed["bufferViews"].append({"buffer": 0, "byteOffset": 6, "byteLength": 24})
        changed["accessors"].append({"bufferView": len(changed["bufferViews"]) - 1, "componentType": 5123,
                                     "count": 12, "type": "SCALAR"})
        changed["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 1, "indices":
                                                   len(changed["accessors"]) - 1})

    def sparse(changed):
        changed["accessors"].append({"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
            "count": 1, "indices": {"bufferView": 0, "componentType": 5123}, "values": {"bufferView": 1}}})

    def image(changed):
        changed["images"].append({"bufferView": 0, "mimeType": "image/png"})

    for change in (other_view, sparse, image):
        document, data = gltf_parts(rng, "H")
        change(document)
        shared, target = folder / f"{change.__name__}.glb", folder / f"{change.__name__}-tree.glb"
        write_glb(shared, document, data)
        run("cook", shared, "-o", folder / "shared.bxt", "--exact", "--write-reordered", target)
        expect(data in target.read_bytes(), "bytes of", shared)
    # What has no single order.
    document, data = gltf_parts(rng, "H")

    def refused(change, why, *options):
        changed = json.loads(json.dumps(document))
        change(changed)
        write_glb(folder / "refused.glb", changed, data)
        stderr = run("cook", folder / "refused.glb", "-o", folder / "refused.bxt", "--write-reordered",
                     folder / "never.glb", *options, status=5)
        expect(why in stderr, stderr)
        expect(not (folder / "refused.bxt").exists() and not (folder / "never.glb").exists(), "files")

    def second_primitive(changed):
        changed["meshes"][0]["primitives"].append(changed["meshes"][0]["primitives"][0])

    def second_node(changed):
        changed["nodes"].append({"mesh": 0, "translation": [30, 0, 0]})
        changed["scenes"][0]["nodes"].append(1)

    def strip(changed):
        changed["meshes"][0]["primitives"][0]["mode"] = 5

    refused(second_primitive, "2 primitives of triangles")
    refused(second_node, "this is a scene")
    refused(second_node, "placed more than once", "--flatten")
    refused(strip, "strips or fans")


def test_requests(folder):
    source = folder / "a.obj"
    source.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    bxt = folder / "a.bxt"
    for words, status, why in (
            ((source, "--write-reordered", folder / "b.ply"), 1, "in the format of"),
            ((source, "--write-reordered", folder / "b.txt"), 1, ".obj, .ply, .gltf or .glb"),
            ((source, source, "--write-reordered", folder / "b.obj"), 1, "one input"),
            ((source, "--write-reordered", source), 1, "would be written over"),
            ((source, "--write-reordered", folder / "b.obj", "--scene"), 1, "excludes"),
            ((source, "--write-reordered", folder / "b.obj", "--no-face-ids"), 1, "excludes"),
            ((source, "--write-reordered", folder / "none" / "b.obj"), 2, "none")):
        stderr = run("cook", *words, "-o", bxt, "-q", status=status)
        expect(why in stderr, why, stderr)
        expect(not bxt.exists() and not (folder / "b.obj").exists(), "files after", words)


def test_replaced(folder):
    """A mesh is replaced by itself, and if the output is what was cooked with it; no other is lost."""
    source, target, bxt = folder / "a.obj", folder / "b.obj", folder / "a.bxt"
    one_face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    words = ("cook", source, "-o", bxt, "--write-reordered", target, "-q")

    def refused(found):
        target.write_text(found, encoding="utf-8")
        before = bxt.read_bytes() if bxt.exists() else None
        stderr = run(*words, status=2)
        expect("b.obj: expected what an earlier cook has written" in stderr and "it would be lost" in stderr, stderr)
        expect(target.read_text(encoding="utf-8") == found, "the mesh was lost")
        expect((bxt.read_bytes() if bxt.exists() else None) == before, "the output has changed")

    source.write_text(one_face, encoding="utf-8")
    refused(one_face.replace("1 0 0", "2 0 0"))  # no output is there
    refused("no mesh")
    target.write_text("", encoding="utf-8")
    run(*words)
    run(*words)
    for x, options in (("3", ()), ("4", ("--codec", "blob-zstd")), ("5", ("--external",)), ("6", ("--f64",)),
                       ("7", ())):
        source.write_text(one_face.replace("1 0 0", x + " 0 0"), encoding="utf-8")
        run(*words, *options)  # the mesh was that of the output
        expect(f"v {x} 0 0" in target.read_text(encoding="utf-8"), "the mesh is the old one")
    run(*words)
    refused(one_face.replace("1 0 0", "2 0 0"))  # it is of another mesh
    run("cook", source, "-o", bxt, "-q", "--no-face-ids")
    refused(one_face)
    target.unlink()
    run(*words)
    bxt.unlink()
    run(*words)  # the same mesh again


def main():
    for test in (test_obj, test_bad_faces, test_ply, test_gltf, test_requests, test_replaced):
        with tempfile.TemporaryDirectory() as folder:
            test(pathlib.Path(folder))
        print(test.__name__, "as expected")


main()
