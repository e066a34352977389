#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds import against the second reader (read_mesh.py) on generated files and on those of a
folder: faces in their order, positions to the bit, materials, counts, and what is refused.

    import_oracle_test.py BOXTREE_IMPORT [FOLDER] [--files N] [--seed S] [--cuts SHARE] [--notes]

Exits with 1 on a difference; the files are kept then. A file on which the formats and import.h are
silent (a note of the second reader) may be refused; read, it must be as the second reader says.
"""
import argparse
import collections
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from fractions import Fraction

sys.dont_write_bytecode = True  # the folder of a source tree stays as it is
import generate  # noqa: E402
import read_mesh  # noqa: E402

MODES = (("f32", False), ("f64", False), ("f32", True))
UNNAMED = re.compile(rb"material \d+\Z|DefaultMaterial\Z")
MAX_MODEL_BYTES = 20 << 20

# Where neither a format nor import.h says what a statement means: read in either way.
UNSPECIFIED = {
    "a # in a name",
    "a loop in an odd place",
    "a weight other than 1",
    "f with fewer than three corners",
    "odd numbers behind a position",
}


# --------------------------------------------------------------------------------------------------
# Exact geometry

def value_of(bits, precision):
    return read_mesh.f32_of_bits(bits) if precision == "f32" else read_mesh.f64_of_bits(bits)


def points_of(corners, precision):
    return [tuple(Fraction(value_of(bits, precision)) for bits in corner) for corner in corners]


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def area_vector(points):
    """Twice the area by its normal; of a polygon that is not planar, of its projections."""
    total = (0, 0, 0)
    for a, b in zip(points[1:], points[2:]):
        total = tuple(x + y for x, y in zip(total, cross(minus(a, points[0]), minus(b, points[0]))))
    return total


def without_axis(points, axis):
    """Along an axis; areas keep their sign."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    return [(p[u], p[v]) for p in points]


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def is_between(a, b, p):
    return all(min(a[k], b[k]) <= p[k] <= max(a[k], b[k]) for k in range(2))


def segments_intersect(a, b, c, d):
    turns = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)]
    signs = [(t > 0) - (t < 0) for t in turns]
    if signs[0] * signs[1] < 0 and signs[2] * signs[3] < 0:
        return True
    return (signs[0] == 0 and is_between(a, b, c) or signs[1] == 0 and is_between(a, b, d)
            or signs[2] == 0 and is_between(c, d, a) or signs[3] == 0 and is_between(c, d, b))


def is_simple(points):
    """Whether edges of a plane polygon meet only where neighbours share a corner."""
    n = len(points)
    if len(set(points)) < n:
        return False
    for i in range(n):
        a, b, c = points[i], points[(i + 1) % n], points[(i + 2) % n]
        if turn(a, b, c) == 0 and dot(minus(b, a), minus(c, b)) < 0:
            return False  # an edge folds back on its neighbour
        for j in range(i + 2, n):
            if (j + 1) % n != i and segments_intersect(a, b, points[j], points[(j + 1) % n]):
                return False
    return True


def quad_kind(points):
    """'kept' for a quad that is exactly planar and strictly convex, 'split' for one that is clearly
    not, None for what rounding may decide."""
    normal = area_vector(points)
    if normal == (0, 0, 0):
        return None
    edges = [minus(points[(i + 1) % 4], points[i]) for i in range(4)]
    turns = [dot(cross(edges[i - 1], edges[i]), normal) for i in range(4)]
    volume = dot(cross(edges[0], minus(points[2], points[0])), minus(points[3], points[0]))
    size = max(abs(x) for edge in edges for x in edge)
    area = max(abs(x) for x in normal)
    if volume == 0 and all(t > 0 for t in turns):
        return "kept"
    largest = max(abs(x) for p in points for x in p)  # of this the coordinates were rounded
    is_clear = area > size * size / 100 and size > largest / 1000
    if is_clear and (any(t < -area * area / 1000 for t in turns)
                     or abs(volume) > size * size * size / 1000):
        return "split"
    return None


# --------------------------------------------------------------------------------------------------
# Comparison of one file

class Difference(Exception):
    """What import and the second reader do not agree on."""

    notes = ()  # of the second reader about the file


def expect(holds, what):
    if not holds:
        raise Difference(what)


class Ours:
    """One line of boxtree_import."""

    def __init__(self, line, precision):
        said = json.loads(line)
        self.path = bytes.fromhex(said["path"]).decode()
        self.error = said.get("error")
        self.detail = bytes.fromhex(said.get("detail", "")).decode("latin-1")
        self.scene_agrees = said["scene_agrees"]
        if self.error:
            return
        self.counts = said["counts"]
        self.skipped = said["skipped"]
        digits = 8 if precision == "f32" else 16
        hexes = said["positions"]
        numbers = [int(hexes[i:i + digits], 16) for i in range(0, len(hexes), digits)]
        self.vertices = [tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]
        self.faces = said["faces"]
        self.runs = [(first, bytes.fromhex(name)) for first, name in said.get("materials", [])]

    def by_id(self):
        """Lists of corner positions by face id, in order of appearance."""
        groups = []
        for face_id, *corners in self.faces:
            if not groups or groups[-1][0] != face_id:
                groups.append((face_id, []))
            groups[-1][1].append([self.vertices[c] for c in corners])
        return groups

    def material(self, face_id):
        """The name of a face's material; None if it has none."""
        name = None
        for first, at in self.runs:
            if first <= face_id:
                name = at
        return None if name is None or UNNAMED.match(name) else name


class Comparison:
    def __init__(self, taken, ours, precision):
        self.taken, self.ours, self.precision = taken, ours, precision

    def polygon_difference(self, polygon, pieces):
        """Why pieces of one face id are not this polygon; None if they are."""
        corners = self.taken.corners(polygon)
        if len(corners) == 3 or len(pieces) == 1 and len(pieces[0]) == 4:
            if len(pieces) != 1 or list(corners) != list(pieces[0]):
                return "another face"
            if len(corners) == 4 and quad_kind(points_of(corners, self.precision)) == "split":
                return "a quad that is not planar or not convex was kept"
            return None
        if any(len(piece) != 3 or not set(piece) <= set(corners) for piece in pieces):
            return "pieces with other corners"
        points = points_of(corners, self.precision)
        if len(corners) == 4 and quad_kind(points) == "kept":
            return "a planar convex quad was split"
        whole = area_vector(points)
        parts = [area_vector(points_of(piece, self.precision)) for piece in pieces]
        if tuple(map(sum, zip(*parts))) != whole:
            return "pieces of another area"
        axis = max(range(3), key=lambda k: abs(whole[k]))
        if is_simple(without_axis(points, axis)) and (
                sum(abs(part[axis]) for part in parts) != abs(whole[axis])):
            return "pieces that overlap"
        return None

    def same_polygon(self, polygon, pieces):
        return self.polygon_difference(polygon, pieces) is None

    def faces(self):
        """Faces in source order."""
        groups = self.ours.by_id()
        theirs = self.taken.polygons
        ids = [face_id for face_id, _ in groups]
        expect(ids == sorted(set(ids)), "face ids do not ascend")
        expect(len(groups) == len(theirs), f"{len(groups)} faces, not {len(theirs)}")
        for (our_id, pieces), (their_id, polygon) in zip(groups, theirs):
            wrong = self.polygon_difference(polygon, pieces)
            if wrong is None and our_id != their_id:
                wrong = f"face id {our_id}, not {their_id}"
            expect(wrong is None, f"{wrong}, face {their_id}")
        return [polygon for _, polygon in theirs]

    def same_material(self, polygon, face_id):
        if {"a # in a name", "usemtl without a name"} & set(self.taken.notes):
            return True
        theirs = polygon.material
        ours = self.ours.material(face_id)
        if theirs is not None and UNNAMED.match(theirs.encode("latin-1")):
            theirs = None
        return ours == (None if theirs is None else theirs.encode("latin-1"))

    def vertices(self):
        """In the order of the file, each once, if a face uses them."""
        ours = self.ours.vertices
        expect(len(set(ours)) == len(ours), "vertices that are equal were not merged")
        used = {c for face in self.ours.faces for c in face[1:]}
        expect(used == set(range(len(ours))), "vertices that no face uses, or corners without one")
        used_here = {c for _, polygon in self.taken.polygons for c in polygon.corners}
        theirs = dict.fromkeys(self.taken.bits[c] for c in sorted(used_here))
        expect(list(theirs) == ours, "vertices are not in their order")

    def counts(self, polygons):
        ours, mesh = self.ours.counts, self.taken.mesh
        sizes = collections.Counter(min(len(polygon.corners), 5) for polygon in polygons)
        kept = sum(len(face) == 5 for face in self.ours.faces)
        theirs = {"source_faces": len(mesh.polygons), "points_skipped": mesh.points,
                  "lines_skipped": mesh.lines, "empty_skipped": mesh.empty, "quads_kept": kept,
                  "quads_split": sizes[4] - kept, "ngons_split": sizes[5],
                  "source_vertices": len(mesh.vertices)}
        if not self.taken.notes:
            theirs["has_open_end"] = mesh.has_open_end
        for name, count in theirs.items():
            expect(ours[name] == count, f"{name}: {ours[name]}, not {count}")
        expect(ours["source_vertices"] - ours["vertices_unused"] - ours["vertices_welded"]
               == len(self.ours.vertices), "vertices that were unused or welded")

    def run(self):
        expect(self.ours.skipped == self.taken.skipped, "other faces were skipped")
        polygons = self.faces()
        for (face_id, _), polygon in zip(self.ours.by_id(), polygons):
            expect(self.same_material(polygon, face_id), f"face {face_id}: material "
                   f"{self.ours.material(face_id)}, not {polygon.material}")
        self.vertices()
        self.counts(polygons)


AGREE, AGREE_REFUSED = "read alike", "refused"
SILENT, SILENT_REFUSED = "read, noted", "refused, noted"
DIFFERENT = "DIFFERENT"


def compare(path, line, precision, skip_bad):
    """How the two agree, and the notes; a Difference if they do not."""
    notes = []
    try:
        ours = Ours(line, precision)
        expect(ours.scene_agrees, "import_scene and import_mesh differ")
        try:
            mesh = read_mesh.read(path)
            notes = mesh.notes
            taken = read_mesh.Taken(mesh, precision, skip_bad)
            notes = taken.notes
        except read_mesh.Refused as refused:
            notes = notes + refused.notes
            expect(ours.error, f"read, not refused: {refused}")
            # Damage of several kinds may be told by any of them; that of one has its own code.
            expect(ours.error in refused.codes or notes or refused.codes == {read_mesh.FAILED},
                   f"{ours.error}, not {sorted(refused.codes)}: {ours.detail}")
            return AGREE_REFUSED, notes
        if ours.error:
            expect(notes, f"refused: {ours.error}: {ours.detail}")
            return SILENT_REFUSED, notes
        Comparison(taken, ours, precision).run()
        return SILENT if notes else AGREE, notes
    except Difference as difference:
        difference.notes = notes
        raise


# --------------------------------------------------------------------------------------------------
# Many files

class Tally:
    def __init__(self, keep):
        self.outcomes = collections.defaultdict(collections.Counter)
        self.notes = collections.Counter()
        self.differences = []
        self.keep = keep

    def add(self, path, outcome, notes):
        self.outcomes[os.path.splitext(path)[1].lower()][outcome] += 1
        for note in notes:
            self.notes[note, outcome] += 1

    def differ(self, path, mode, what, notes=()):
        if UNSPECIFIED & set(notes):
            self.add(path, SILENT, sorted(UNSPECIFIED & set(notes)))
            return
        self.add(path, DIFFERENT, ())
        self.differences.append((path, mode, what))
        if len(self.differences) <= 200 and path not in {at for at, _, _ in self.differences[:-1]}:
            print(f"{os.path.basename(path)}, {mode}: {what}", flush=True)
        if self.keep in os.path.dirname(path):
            shutil.copy(path, os.path.join(self.keep, "different"))

    def print(self, with_notes):
        names = (AGREE, AGREE_REFUSED, SILENT, SILENT_REFUSED, DIFFERENT)
        print(f"{'':6}" + "".join(f"{name:>16}" for name in names))
        for extension, counts in sorted(self.outcomes.items()):
            print(f"{extension:6}" + "".join(f"{counts[name]:16}" for name in names))
        if with_notes:
            for (note, outcome), count in sorted(self.notes.items()):
                print(f"{count:8} {outcome:16} {note}")


def lines_of(program, paths, precision, skip_bad):
    """A line of boxtree_import for each path; None from where on it died."""
    command = [program] + ["--f64"] * (precision == "f64") + ["--skip-bad"] * skip_bad
    rest = list(paths)
    while rest:
        done = subprocess.run(command, input="".join(path + "\n" for path in rest).encode(),
                              stdout=subprocess.PIPE, check=False)
        lines = done.stdout.decode().splitlines()
        yield from lines[:len(rest)]
        if len(lines) < len(rest):
            yield None
        rest = rest[len(lines) + 1:]


def compare_all(program, paths, tally):
    for precision, skip_bad in MODES:
        mode = precision + (", skip bad" if skip_bad else "")
        for path, line in zip(paths, lines_of(program, paths, precision, skip_bad)):
            if line is None:
                tally.differ(path, mode, "import died")
                continue
            try:
                tally.add(path, *compare(path, line, precision, skip_bad))
            except Difference as difference:
                tally.differ(path, mode, str(difference), difference.notes)


def check_reader(case, path):
    """The second reader against the generator, which knows what it wrote."""
    mesh = read_mesh.read(path)
    found = [([tuple(mesh.vertices[c]) for c in polygon.corners], polygon.material)
             for polygon in mesh.polygons]

    def values(corners):
        return [[x if isinstance(x, float) else read_mesh.exact(x) for x in at] for at in corners]

    expect(len(found) == len(case.expected), "the second reader: number of faces")
    for (corners, material), (wanted, name) in zip(found, case.expected):
        expect(values(corners) == values(wanted), f"the second reader: {corners}, not {wanted}")
        expect(material == name, f"the second reader: material {material}, not {name}")


def generated(program, count, seed, cut_share, tally, folder):
    for first in range(0, 1 << 62, 500):
        batch = []
        for number, case in enumerate(generate.cases(seed, count, cut_share)):
            if not first <= number < first + 500:
                continue
            batch.append(case.write(folder))
            if case.expected is not None:
                try:
                    check_reader(case, batch[-1])
                except (Difference, read_mesh.Refused) as difference:
                    tally.differ(batch[-1], "reader", str(difference))
        if not batch:
            return
        compare_all(program, batch, tally)
        for path in batch:
            os.remove(path)


def models(folder):
    for parent, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            path = os.path.join(parent, name)
            if os.path.splitext(name)[1].lower() in read_mesh.READERS and (
                    os.path.getsize(path) < MAX_MODEL_BYTES):
                yield path


def check_teeth(program, folder):
    """Differences that are planted are found."""
    path = os.path.join(folder, "planted.obj")
    with open(path, "w", encoding="ascii") as file:
        file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.1\nv -1 .5 0\nv 5 5 5\nusemtl a\nf 1 2 3\n"
                   "usemtl b\nf 2 4 3\nf 1 2 4 3 5\nf -5 -3 -2\n")
    line = next(lines_of(program, [path], "f32", False))
    compare(path, line, "f32", False)
    said = json.loads(line)

    def changed(change):
        copy = json.loads(line)
        change(copy)
        return json.dumps(copy)

    def swap_corners(copy):
        copy["faces"][0][1:3] = reversed(copy["faces"][0][1:3])

    def flip_bit(copy):
        at = copy["positions"]
        copy["positions"] = at[:7] + format(int(at[7], 16) ^ 1, "x") + at[8:]

    plants = {
        "a bit of a position": flip_bit,
        "winding": swap_corners,
        "a face too few": lambda copy: copy["faces"].pop(),
        "a face too many": lambda copy: copy["faces"].append(copy["faces"][-1]),
        "order of faces": lambda copy: copy["faces"].insert(0, copy["faces"].pop(1)),
        "a piece of a polygon": lambda copy: copy["faces"].pop(3),
        "a face id": lambda copy: copy["faces"][0].__setitem__(0, 7),
        "a material": lambda copy: copy["materials"][0].__setitem__(1, b"c".hex()),
        "where materials change": lambda copy: copy["materials"][1].__setitem__(0, 2),
        "an error": lambda copy: copy.update(error="import_failed"),
        "a skipped face": lambda copy: copy["skipped"].append(0),
        "scenes": lambda copy: copy.update(scene_agrees=False),
    }
    for name in said["counts"]:
        if name not in ("meshes", "degenerate_faces"):
            plants[name] = lambda copy, name=name: copy["counts"].update({name: 77})
    missed = []
    for name, change in plants.items():
        try:
            compare(path, changed(change), "f32", False)
            missed.append(name)
        except Difference:
            pass
    with open(path, "a", encoding="ascii") as file:
        file.write("f 1 2 99\n")  # now the second reader refuses
    try:
        compare(path, line, "f32", False)
        missed.append("a file that is refused")
    except Difference:
        pass
    check_rounding(missed)
    for name in missed:
        print(f"a planted difference was missed: {name}")
    return not missed


def check_rounding(missed):
    """f32_bits, with its detour over f64, against the definition."""
    rng = generate.random.Random("rounding")
    for _ in range(2000):
        word = generate.any_number(rng)
        bits = read_mesh.f32_bits(word) & 0x7FFFFFFF
        size = abs(read_mesh.exact(word))
        near = [Fraction(2) ** 128 if b == 0x7F800000 else Fraction(read_mesh.f32_of_bits(b))
                for b in (max(bits - 1, 0), bits, min(bits + 1, 0x7F800000))]
        apart = [abs(size - x) for x in near]
        is_tie = apart[1] in (apart[0], apart[2]) and bits not in (0, 0x7F800000)
        if apart[1] > min(apart) and size < read_mesh.F32_OVERFLOW or is_tie and bits & 1:
            missed.append(f"rounding of {word}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", nargs="?")
    parser.add_argument("--files", type=int, default=600)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--cuts", type=float, default=0.2, help="share of all truncations [0.2]")
    parser.add_argument("--notes", action="store_true", help="print notes and how often")
    arguments = parser.parse_args()
    keep = tempfile.mkdtemp(prefix="import_oracle")
    os.mkdir(os.path.join(keep, "different"))
    tally = Tally(keep)
    has_teeth = check_teeth(arguments.program, keep)
    generated(arguments.program, arguments.files, arguments.seed, arguments.cuts, tally, keep)
    if arguments.folder:
        compare_all(arguments.program, list(models(arguments.folder)), tally)
    tally.print(arguments.notes)
    if tally.differences:
        print(f"{len(tally.differences)} differences; generated files are in {keep}/different")
    else:
        shutil.rmtree(keep)
    return 1 if tally.differences or not has_teeth else 0


if __name__ == "__main__":
    sys.exit(main())
