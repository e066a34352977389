#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A second reader of .bxt files, written from docs/FORMAT.md alone and sharing nothing with the
C++ one. Checks every promise of the specification that can be checked, walks every tree, holds
every triangle against every box above it, and prints what it found as JSON.

    read_bxt.py FILE    exit 0, or 1 with the first broken promise on standard error
"""
import json
import struct
import sys
from fractions import Fraction

import xxhash

NO_OWNER = 0xFFFFFFFF
NODES, VERTICES, CORNERS, FACE_IDS, NAMES, DUPLICATES, ACTIVE_EDGES = 2, 3, 4, 5, 7, 19, 20
MATERIALS, MATERIAL_RUNS, FACE_MATERIALS = 15, 16, 17
USER_DATA_RUNS, FACE_USER_DATA = 22, 23
SCENE, INSTANCES, POSES, INSTANCE_EDGES = 10, 12, 13, 21
TREES, PACK, MEMBERS = 1, 24, 25
EMPTY, LEAF, SUBTREE = 0, 1, 2
EXTERNAL, ARRAYS, GRID, EXACT = 1, 2, 3, 4


class Broken(Exception):
    """A promise of the specification that the file does not keep."""


def expect(holds, promise):
    if not holds:
        raise Broken(promise)


def f32(value):
    """Rounds to the nearest f32, ties to even."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def xxh3(data):
    return xxhash.xxh3_64_intdigest(data)


class File:
    """Header and section table (sections 1 and 2)."""

    def __init__(self, data, may_be_pack=True):
        self.data = data
        expect(len(data) >= 32, "a header has 32 bytes")
        magic, major, _minor, count, incompatible, _compatible, checksum = struct.unpack_from(
            "<8sHHIIIQ", data)
        expect(magic == bytes([0x89, 0x42, 0x58, 0x54, 0x0D, 0x0A, 0x1A, 0x0A]), "magic")
        expect(major == 1 and incompatible in ((0, 2) if may_be_pack else (0,)), "version and features")
        self.is_pack = incompatible == 2
        end = 32 + 16 * count
        expect(end <= len(data), "section table inside the file")
        expect(checksum == xxh3(data[:24] + data[32:end]), "checksum of header and table")
        self.sections = {}
        before = -1
        for i in range(count):
            word, checksum = struct.unpack_from("<QQ", data, 32 + 16 * i)
            size, kind, owner = word & (1 << 40) - 1, word >> 41 & 127, word >> 48
            expect(word >> 41 > before, "sections by owner and kind")
            before = word >> 41
            offset = end + -end % (8 if size < 4096 else 64)
            expect(offset + size <= len(data), "section inside the file")
            expect(not any(data[end:offset]), "zero padding")
            body = data[offset:offset + size]
            expect(checksum == xxh3(body), f"checksum of section {i}")
            self.sections[kind, owner - 1 if owner else NO_OWNER] = body
            end = offset + size
        expect(len(data) == end + -end % 8 and not any(data[end:]), "padding at the end")

    def section(self, kind, owner=NO_OWNER):
        return self.sections.get((kind, owner), b"")


def cut_box(box, axis, side, cut, rounded):
    """The box of a child (section 4): one plane moved inward by one rounded difference or sum."""
    low, high = list(box[0]), list(box[1])
    if side == 0:
        high[axis] = rounded(high[axis] - cut)
    else:
        low[axis] = rounded(low[axis] + cut)
    return (tuple(low), tuple(high))


class Plain:
    """Codecs plain-f32 and plain-f16 (section 5). A node reference is the number of a node."""

    def __init__(self, tree, nodes):
        self.layout = "<I2I2f" if tree.codec == 1 else "<I2I2e"
        self.size = struct.calcsize(self.layout)
        self.nodes = nodes
        self.count = tree.node_count
        expect(len(nodes) == self.size * tree.node_count, "size of section nodes")

    def root(self):
        return 0

    def expand(self, ref, box):
        cutplane, left, right, cut0, cut1 = struct.unpack_from(
            self.layout, self.nodes, ref * self.size)
        axis, kinds = cutplane & 3, ((cutplane >> 2) & 3, (cutplane >> 4) & 3)
        expect(axis <= 2 and cutplane >> 6 == 0, "cutplane")
        children = []
        for side, (kind, child, cut) in enumerate(((kinds[0], left, cut0), (kinds[1], right, cut1))):
            if kind == 0:
                expect(child == 0xFFFFFFFF and cut == 0, "a missing child")
                continue
            child_box = cut_box(box, axis, side, cut, f32)
            if kind == 1:
                children.append(("leaf", (child, 1), child_box))
            else:
                expect(kind == 2 and ref < child < self.count, "a child behind its parent")
                children.append(("subtree", child, child_box))
        return children


class Packed:
    """Codecs packed-f32, packed-f16, packed-f64 and dedup (section 6). A node reference is a kind
    and a number. Bits are read from one large integer, not by words."""

    def __init__(self, tree, nodes):
        *self.counts, cut_count, self.node_bits, self.face_bits, self.cut_bits, self.root_kind = (
            struct.unpack_from("<4II4B", nodes))
        expect(not any(nodes[24:64]) and sum(self.counts) == tree.node_count, "packed header")
        self.table = struct.unpack_from(f"<{cut_count}f", nodes, 64)
        self.codec = tree.codec
        at = 64 + 4 * cut_count
        self.arrays = []
        for kind in range(4):
            at = (at + 7) // 8 * 8
            size = (self.counts[kind] * self.width(kind) + 7) // 8
            self.arrays.append(nodes[at:at + size])
            at += size
        expect(len(nodes) == at + 8 and not any(nodes[at:]), "size of section nodes")

    def leaf_sides(self, kind):
        return ((True, True), (True, False), (False, True), (False, False))[kind]

    def width(self, kind):
        leaves = self.leaf_sides(kind)
        return 2 + sum(self.face_bits if leaf else 2 + self.node_bits for leaf in leaves
                       ) + 2 * self.cut_bits

    def root(self):
        return (self.root_kind, 0)

    def cut(self, bits):
        if self.codec == 4:
            return struct.unpack("<e", struct.pack("<H", bits))[0]
        if self.codec == 5:
            return struct.unpack("<d", struct.pack("<Q", bits))[0]
        if self.table:
            expect(bits < len(self.table), "number of a cut")
            return self.table[bits]
        return struct.unpack("<f", struct.pack("<I", bits))[0]

    def expand(self, ref, box):
        kind, number = ref
        width = self.width(kind)
        first = number * width
        piece = int.from_bytes(self.arrays[kind][first // 8:(first + width + 7) // 8], "little")
        piece >>= first % 8
        taken = 0

        def field(bits):
            nonlocal taken
            value = (piece >> taken) & ((1 << bits) - 1)
            taken += bits
            return value

        leaves = self.leaf_sides(kind)
        axis = field(2)
        expect(axis <= 2, "axis")
        kinds = [None if leaf else field(2) for leaf in leaves]
        numbers = [field(self.face_bits if leaf else self.node_bits) for leaf in leaves]
        cuts = [field(self.cut_bits) for _ in leaves]
        rounded = float if self.codec == 5 else f32
        children = []
        for side in range(2):
            if not leaves[side] and numbers[side] == (1 << self.node_bits) - 1:
                expect(kinds[side] == 0 and self.cut(cuts[side]) == 0, "a missing child")
                continue
            child_box = cut_box(box, axis, side, self.cut(cuts[side]), rounded)
            if leaves[side]:
                children.append(("leaf", (numbers[side], 1), child_box))
            else:
                expect(numbers[side] < self.counts[kinds[side]], "number of a node")
                children.append(("subtree", (kinds[side], numbers[side]), child_box))
        return children


class Wide:
    """Codecs wide8 and wide4 (section 7). A node reference is the number of a node."""

    def __init__(self, tree, nodes):
        self.is_wide8 = tree.codec == 7
        self.size = 64 if self.is_wide8 else 32
        self.nodes = nodes
        self.count = tree.node_count
        self.faces = tree.leaf_faces
        expect(len(nodes) == self.size * tree.node_count, "size of section nodes")

    def root(self):
        return 0

    def fields(self, ref):
        """Codes as [side][axis][child], and the links."""
        node = self.nodes[ref * self.size:(ref + 1) * self.size]
        if self.is_wide8:
            codes = [[list(node[24 * side + 8 * axis:24 * side + 8 * axis + 8])
                      for axis in range(3)] for side in range(2)]
            first_node, first_leaf, mask, count = struct.unpack_from("<IIBB", node, 48)
            expect(not any(node[58:]), "zeros of a node")
        else:
            words = struct.unpack_from("<6I", node)
            codes = [[[(words[3 * side + axis] >> (4 * i)) & 15 for i in range(8)]
                      for axis in range(3)] for side in range(2)]
            links = struct.unpack_from("<Q", node, 24)[0]
            first_node, first_leaf = links & (2 ** 26 - 1), (links >> 26) & (2 ** 27 - 1)
            mask, count = (links >> 53) & 255, (links >> 61) + 1
        return codes, first_node, first_leaf, mask, count

    def expand(self, ref, box):
        codes, next_node, next_leaf, mask, count = self.fields(ref)
        expect(1 <= count <= 8 and mask >> count == 0, "children of a node")
        expect(not any(any(axis[count:]) for side in codes for axis in side),
               "zero codes of children that are not there")
        of_extent = 255 if self.is_wide8 else 688
        children = []
        for i in range(count):
            low, high = [], []
            for k in range(3):
                step = f32(f32(box[1][k] - box[0][k]) * f32(1 / of_extent))
                steps = [codes[side][k][i] * (1 if self.is_wide8 else codes[side][k][i] + 24)
                         for side in range(2)]
                low.append(f32(box[0][k] + f32(steps[0] * step)))
                high.append(f32(box[1][k] - f32(steps[1] * step)))
            child_box = (tuple(low), tuple(high))
            if mask >> i & 1:
                expect(ref < next_node < self.count, "a child behind its parent")
                children.append(("subtree", next_node, child_box))
                next_node += 1
            else:
                first = 8 * next_leaf
                expect(first < self.faces, "number of a leaf")
                children.append(("leaf", (first, min(8, self.faces - first)), child_box))
                next_leaf += 1
        return children


class Bits:
    """Fields of bits behind each other, counted from the least significant."""

    def __init__(self, data, at):
        self.data, self.at = data, at

    def take(self, width):
        first, self.at = self.at, self.at + width
        expect(self.at <= 8 * len(self.data), "a field inside its cluster")
        piece = int.from_bytes(self.data[first // 8:(self.at + 7) // 8], "little")
        return (piece >> (first % 8)) & ((1 << width) - 1)

    def below(self, limit):
        return self.take(max(0, limit - 1).bit_length())

    def zeros(self, end):
        expect(end >= self.at, "fields do not overlap")
        expect(self.take(end - self.at) == 0, "zero bits between fields")


class Clusters:
    """Geometry exact and grid (section 8.1): faces as lists of corners, which are f64 of object
    space, f32 from the tree's origin on, or places on the grid."""

    CLUSTER_FACES, LEAF_FACES, HEADER, PADDING = 512, 8, 24, 72

    def __init__(self, tree):
        self.exact = tree.geometry == EXACT
        self.bits = 64 if self.exact and tree.flags & 2 else 32
        self.has_quads = tree.corners_per_face == 4
        self.faces = []
        count = -(-tree.face_count // self.CLUSTER_FACES)
        expect(not tree.corners and len(tree.vertices) >= 4 * count, "a table of clusters")
        padding = self.PADDING if count else 0
        end = len(tree.vertices) - padding
        expect(end >= 0 and end % 4 == 0 and not any(tree.vertices[end:]),
               "padding after the last cluster")
        starts = [4 * start for start in struct.unpack_from(f"<{count}I", tree.vertices)] + [end]
        expect(starts[0] == 4 * count and starts == sorted(starts), "clusters follow each other")
        for start, end in zip(starts, starts[1:]):
            left = tree.face_count - len(self.faces)
            self.cluster(tree.vertices[start:end], min(self.CLUSTER_FACES, left))

    def cluster(self, data, faces):
        """Appends the faces of a cluster."""
        (axes, group_size, vertex_count, leaves_at, start_slope, start_bias, first_bias, first_slope,
         start_bits, first_bits, old_bits) = struct.unpack_from("<9sB5H4B", data)
        trailing, shift, width = (axes[i:i + 3] for i in range(0, 9, 3))
        for k in range(3):
            expect(max(trailing[k], shift[k]) < self.bits and width[k] <= self.bits,
                   "header of a cluster")
        expect(start_bits <= 16 and first_bits <= 11 and old_bits <= 4, "header of a cluster")
        expect(2 <= group_size <= 128 and 1 <= vertex_count <= 16 * group_size, "groups of a cluster")
        bits = Bits(data, 8 * self.HEADER)
        origin = [bits.take(self.bits) for _ in range(3)]
        table = [(bits.take(start_bits), bits.take(first_bits))
                 for _ in range(-(-faces // self.LEAF_FACES))]
        bits.zeros(-(-bits.at // 8) * 8)
        groups = -(-vertex_count // group_size)
        base = [[bits.take(8) for _ in range(groups)] for _ in range(3)]
        widths = []
        for k in range(3):
            widths.append([width[k] + bits.take(4) for _ in range(groups)])
            bits.zeros(-(-bits.at // 8) * 8)
            expect(max(widths[k]) <= self.bits, "width of a group")

        def coordinate(k, group):
            m = self.signed(origin[k] + (base[k][group] << shift[k]) + bits.take(widths[k][group]))
            if not self.exact:
                return self.signed(m << trailing[k])
            return -self.real((-1 - m) << trailing[k]) if m < 0 else self.real(m << trailing[k])

        vertices = []
        for group in range(groups):
            for _ in range(min(group_size, vertex_count - len(vertices))):
                vertices.append(tuple(coordinate(k, group) for k in range(3)))
            bits.zeros(-(-bits.at // 8) * 8)
        expect(bits.at == 8 * leaves_at, "leaves behind the vertices")
        used = 0
        for i, (start, first) in enumerate(table):
            bits.zeros(8 * (leaves_at + (i * start_slope >> 3) + start - start_bias))
            expect((i * first_slope >> 3) + first - first_bias == used, "the first vertex of a leaf")
            count = min(self.LEAF_FACES, faces - self.LEAF_FACES * i)
            corners, references, used = self.strip(bits, count, used, old_bits)
            expect(0 <= min(references) and max(references) < vertex_count, "a vertex that exists")
            self.faces += [[vertices[references[corner]] for corner in face] for face in corners]
        expect(used == vertex_count, "every vertex is used")
        end = (bits.at + 31) // 32 * 32
        bits.zeros(end)
        expect(end == 8 * len(data), "clusters follow each other")

    def strip(self, bits, count, first, old_bits):
        """The fields of a leaf: its faces as numbers of references, the vertex of each of these, and
        the first vertex of the next leaf."""
        is_quad = [self.has_quads and bits.take(1) for _ in range(count)]
        steps = [6] + [bits.take(3) for _ in range(count - 1)]
        expect(7 not in steps, "step of a strip")
        aparts = steps.count(6)
        is_new = [bits.take(1) for _ in range(count)]
        wider = bits.take(3)
        old_bits += wider
        is_new += [bits.take(1) for _ in range(2 * aparts + sum(is_quad))]
        expect(wider == 0 or not all(is_new), "no width of old references that are not there")
        end = first + sum(is_new)
        new = iter(range(first, end))
        references = [next(new) if each else end - 1 - bits.take(old_bits) for each in is_new]
        thirds = iter(range(count))
        apart = iter(range(count, count + 2 * aparts))
        fourths = iter(range(count + 2 * aparts, len(references)))
        faces, entered = [], 0
        for step, quad in zip(steps, is_quad):
            if step == 6:
                face, entered = [next(apart), next(apart), next(thirds)], 0
            else:
                side, turn = divmod(step, 3)
                edge, face = entered + 1 + side, [None] * 3
                face[turn] = faces[-1][(edge + 1) % 3]
                face[(turn + 1) % 3] = faces[-1][edge % 3]
                face[(turn + 2) % 3] = next(thirds)
                entered = turn
            faces.append(face + [next(fourths)] if quad else face)
        return faces, references, end

    def signed(self, value):
        value &= (1 << self.bits) - 1
        return value - (value >> (self.bits - 1) << self.bits)

    def real(self, value):
        whole, real = ("<q", "<d") if self.bits == 64 else ("<i", "<f")
        return struct.unpack(real, struct.pack(whole, self.signed(value)))[0]


CODECS = {1: ("plain-f32", Plain), 2: ("plain-f16", Plain), 3: ("packed-f32", Packed),
          4: ("packed-f16", Packed), 5: ("packed-f64", Packed), 6: ("dedup", Packed),
          7: ("wide8", Wide), 8: ("wide4", Wide)}


def material_names(file):
    """The names of a file's materials (section 11.1)."""
    records, names = file.section(MATERIALS), file.section(NAMES)
    expect(len(records) % 8 == 0, "size of section materials")
    found = []
    for offset, size in struct.iter_unpack("<II", records):
        expect(offset + size <= len(names), "the name of a material in section names")
        found.append(names[offset:offset + size].decode())
    return found


class Tree:
    """A TreeRecord and its sections (sections 3 and 8)."""

    def __init__(self, file, index, record):
        (self.codec, self.geometry, self.root_kind, self.depth, self.flags, self.corner_bytes,
         self.corners_per_face, self.duplicate_bytes, self.face_count, self.triangle_count,
         self.node_count, self.duplicate_count, degenerate, name_offset, name_bytes, self.exponent,
         self.grid_exponent, error, *rest) = struct.unpack_from("<8B7I2h10dQ", record)
        self.origin, self.low, self.high = rest[0:3], tuple(rest[3:6]), tuple(rest[6:9])
        self.leaf_faces = self.face_count - self.duplicate_count
        expect(self.flags < 4, "flags of a record")
        expect(degenerate <= self.triangle_count and 0 <= error < float("inf"),
               "triangles without area and the error")
        expect(self.duplicate_bytes in ((1, 2, 4) if self.duplicate_count else (0,)),
               "width of duplicates")
        expect(self.duplicate_count == 0 or self.leaf_faces > 0,
               "duplicates have an original")
        expect(self.codec in CODECS and EXTERNAL <= self.geometry <= EXACT,
               "codec and geometry")
        expect(abs(self.exponent) <= 1010, "scale exponent")
        if self.geometry == GRID:
            expect(abs(self.grid_exponent) <= 1010
                   and abs(self.grid_exponent - self.exponent) <= 64, "step of the grid")
        else:
            expect(self.grid_exponent == 0, "a step without a grid")
        expect(self.corner_bytes in ((2, 4) if self.geometry == ARRAYS else (0,)),
               "width of corners")
        expect(self.corners_per_face in ((0,) if self.geometry == EXTERNAL else (3, 4)),
               "corners of a face")
        self.name = file.section(NAMES)[name_offset:name_offset + name_bytes].decode()
        self.nodes = file.section(NODES, index)
        self.vertices = file.section(VERTICES, index)
        self.corners = file.section(CORNERS, index)
        self.ids = file.section(FACE_IDS, index)
        self.duplicates = file.section(DUPLICATES, index)
        self.edges = file.section(ACTIVE_EDGES, index)
        self.material_runs = file.section(MATERIAL_RUNS, index)
        self.face_materials = file.section(FACE_MATERIALS, index)
        self.material_names = material_names(file)
        self.user_data_runs = file.section(USER_DATA_RUNS, index)
        self.face_user_data = file.section(FACE_USER_DATA, index)
        self.scalar = "d" if self.flags & 2 else "f"
        if self.geometry == EXTERNAL:
            expect(not self.vertices and not self.corners, "no arrays")
            expect(self.flags & 1 or self.ids or not self.face_count,
                   "numbers of the application's faces")
        if self.geometry == ARRAYS:
            stride = 3 * struct.calcsize(self.scalar)
            self.vertex_count = len(self.vertices) // stride
            expect(len(self.vertices) % stride == 0, "size of section vertices")
            expect(len(self.corners) == self.face_count * self.corners_per_face
                   * self.corner_bytes, "size of section corners")
        self.clusters = Clusters(self) if self.geometry in (GRID, EXACT) else None
        expect(not self.ids or self.face_count > 0 and not self.flags & 1,
               "face ids of faces in tree order")
        self.face_ids = self.read_face_ids() if self.ids else None
        expect(len(self.duplicates) == self.duplicate_count * self.duplicate_bytes,
               "size of section duplicates")

    def triangles(self, face):
        """Triangles of a face in tree space."""
        if self.geometry == GRID or self.geometry == EXACT and not self.flags & 2:
            step = 2.0 ** (self.grid_exponent - self.exponent)  # exact: grid_exponent is 0
            points = [tuple(n * step for n in point) for point in self.stored(face)]
        else:
            points = [tuple((point[k] - self.origin[k]) * 2.0 ** -self.exponent for k in range(3))
                      for point in self.stored(face)]
        return [(points[0], points[i], points[i + 1]) for i in range(1, len(points) - 1)]

    def stored(self, face):
        """Corners of a face as the file holds them; see Clusters and array_points."""
        if self.geometry == ARRAYS:
            return self.array_points(face)
        return self.clusters.faces[face]

    def array_points(self, face):
        width = "<H" if self.corner_bytes == 2 else "<I"
        missing = (1 << (8 * self.corner_bytes)) - 1
        numbers = [struct.unpack_from(width, self.corners,
                                      (face * self.corners_per_face + i) * self.corner_bytes)[0]
                   for i in range(self.corners_per_face)]
        if len(numbers) == 4 and numbers[3] == missing:
            numbers.pop()
        expect(all(number < self.vertex_count for number in numbers), "a vertex number")
        size = 3 * struct.calcsize(self.scalar)
        return [struct.unpack_from("<3" + self.scalar, self.vertices, number * size)
                for number in numbers]

    def read_face_ids(self):
        """All face ids (section 8.2)."""
        def field(at, width):
            expect(0 <= at and at + width <= 8 * len(self.ids), "a field of face ids")
            data = self.ids[at // 8:(at + width + 7) // 8]
            return int.from_bytes(data, "little") >> at % 8 & (1 << width) - 1

        ids = []
        groups = (self.face_count + 1023) // 1024
        blocks_left = (self.face_count + 63) // 64
        end = (groups * 8 + blocks_left * 4) * 8
        expect(end <= 8 * len(self.ids), "size of section face_ids")
        for group in range(groups):
            count = min(16, blocks_left)
            blocks_left -= count
            base, begin, *blocks = struct.unpack_from(f"<{2 + count}I", self.ids, group * 72)
            expect(begin * 32 == end + -end % 32 and not field(end, -end % 32), "begin of a group")
            end = begin * 32
            for number, block in enumerate(blocks):
                faces = min(64, self.face_count - group * 1024 - number * 64)
                middle, offset_bits, start_bits = block & 0xffff, block >> 16 & 31, block >> 21 & 31
                interval_bits, grain = block >> 26 & 7, block >> 29
                expect(grain <= 6, "grain of a block")
                middle += begin * 32
                width = offset_bits + interval_bits
                largest = 0
                for i in range(faces):
                    value = field(middle + i * width, width)
                    interval, offset = value >> offset_bits, value & (1 << offset_bits) - 1
                    largest = max(largest, interval)
                    start = field(middle - (interval + 1) * start_bits, start_bits)
                    face_id = (base + start + offset + (i >> grain << grain)) % 2 ** 32
                    expect(face_id <= 2 ** 31 - 2, "a face id")
                    ids.append(face_id)
                expect(middle - (largest + 1) * start_bits == end, "starts of a block")
                end = middle + faces * width
        rest = -end % 32 + 64
        expect(end + rest == 8 * len(self.ids) and not field(end, rest), "end of section face_ids")
        return ids

    def active_edges(self):
        """For each face the active edges of its triangles (section 8.3), or None without them."""
        if not self.edges or self.geometry == EXTERNAL:
            return None
        expect(len(self.edges) >= 16, "a header of active edges")
        degrees, starts, seed, by_face, zero = struct.unpack_from("<fIIB3s", self.edges)
        leaves = (self.face_count + 7) // 8
        codes_end = 16 + (2 * leaves + 7) // 8
        bits_end = codes_end + ((starts + 63 + 7) // 8 if starts else 0)
        expect(0 <= degrees <= 90 and by_face <= 1 and not any(zero), "header of active edges")
        expect(len(self.edges) == bits_end + (8 if starts else 0), "size of section active_edges")
        expect(not any(self.edges[bits_end:]), "zeros after the bits of edges")
        codes = int.from_bytes(self.edges[16:codes_end], "little")
        bits = int.from_bytes(self.edges[codes_end:bits_end], "little")
        expect(codes >> 2 * leaves == 0 and bits >> starts + 63 == 0, "zeros in active edges")
        expect(starts > 0 or bits == 0, "bits of edges")
        used = False

        def bit(p, q, r):
            if not by_face and q < p:
                p, q = q, p
            ends = [x + 0.0 for x in (p + q + r if by_face else p + q)]
            key = xxh3(struct.pack(f"<{1 + len(ends)}d", seed, *ends))
            start = (key >> 32) * starts >> 32
            mixed = key * 0x9E3779B97F4A7C15 % 2 ** 64
            selected = (mixed << 32 | mixed >> 32) % 2 ** 64 | 1
            return bin(bits >> start & selected).count("1") % 2

        def has_area(a, b, c):
            u, v = ([Fraction(p[k]) - Fraction(a[k]) for k in range(3)] for p in (b, c))
            return any(u[i] * v[j] != u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0)))

        faces = []
        for face in range(self.face_count):
            code = codes >> 2 * (face // 8) & 3
            expect(code <= 2 and (code < 2 or starts), "the code of a leaf")
            used |= code == 2
            found = []
            for t in self.triangles(face):
                if code == 1 or not has_area(*t):
                    found.append(7)
                else:
                    found.append(sum(bit(t[i], t[(i + 1) % 3], t[(i + 2) % 3]) << i for i in range(3)) if code else 0)
            faces.append(found if len(found) == 1 else [found[0] & 3, found[1] & 6])  # no diagonal of a quad
        expect(used == (starts > 0), "bits are there for leaves that have them")
        return faces

    def materials(self):
        """The name of the material of each face (section 11.1)."""
        names = self.material_names
        width = 1 if len(names) <= 256 else 2 if len(names) <= 65536 else 4
        numbers = self.face_numbers("material", self.material_runs, self.face_materials, [width])
        expect(all(number is None or number < len(names) for number in numbers),
               "the material of a face")
        return [None if number is None else names[number] for number in numbers]

    def user_data(self):
        """The user data of each face (section 8.4)."""
        return self.face_numbers("user data", self.user_data_runs, self.face_user_data, [1, 2, 4])

    def face_numbers(self, what, runs, faces, widths):
        """The number of each face, by runs of source faces or by face."""
        expect(not runs or not faces, "runs or faces have " + what)
        if faces:
            width = len(faces) // self.face_count
            expect(width in widths and len(faces) == width * self.face_count,
                   "size of %s of faces" % what)
            return [int.from_bytes(faces[i:i + width], "little")
                    for i in range(0, len(faces), width)]
        expect(len(runs) % 8 == 0, "size of runs of " + what)
        runs = list(struct.iter_unpack("<II", runs))
        expect(len(runs) <= self.face_count, "a face for each run")
        for i, (first, _) in enumerate(runs):
            expect(first > runs[i - 1][0] if i else first == 0, "runs ascend from face 0")
        found = []
        for face in range(self.face_count):
            known = self.face_id(face)
            if len(runs) == 1:
                found.append(runs[0][1])
            elif not runs or known is None:
                found.append(None)
            else:
                found.append([number for first, number in runs if first <= known][-1])
        return found

    def face_id(self, face):
        if self.flags & 1:
            return face
        return self.face_ids[face] if self.face_ids else None

    def walk(self):
        """Visits every leaf; returns what the record must say."""
        found = {"depth": 0, "nodes": 0, "faces": {}, "triangles": 0}
        if self.root_kind == EMPTY:
            expect(self.face_count == 0, "an empty tree has no faces")
            return found
        if self.root_kind == LEAF:
            self.leaf(found, (0, self.leaf_faces), [(self.low, self.high)])
            return found
        codec = CODECS[self.codec][1](self, self.nodes)
        stack = [(codec.root(), [(self.low, self.high)])]
        while stack:
            ref, path = stack.pop()
            found["nodes"] += 1
            found["depth"] = max(found["depth"], len(path))
            expect(found["nodes"] <= self.node_count, "each node is reached once")
            children = codec.expand(ref, path[-1])
            expect(children, "a node has a child")
            for kind, child, box in children:
                if kind == "leaf":
                    self.leaf(found, child, path + [box])
                else:
                    stack.append((child, path + [box]))
        return found

    def leaf(self, found, faces, path):
        for face in range(faces[0], faces[0] + faces[1]):
            expect(face < self.leaf_faces and face not in found["faces"], "each face in one leaf")
            found["faces"][face] = self.face_id(face)
            if self.geometry == EXTERNAL:
                continue
            for triangle in self.triangles(face):
                found["triangles"] += 1
                for point in triangle:
                    for low, high in path:
                        expect(all(low[k] <= point[k] <= high[k] for k in range(3)),
                               f"face {face} inside every box above it")

    def copies(self, found):
        """Duplicates, by the faces that stand for them in leaves."""
        before = 0
        for i in range(self.duplicate_count):
            at = i * self.duplicate_bytes
            original = int.from_bytes(self.duplicates[at:at + self.duplicate_bytes], "little")
            expect(before <= original < self.leaf_faces, "originals ascend and are in leaves")
            before = original
            face = self.leaf_faces + i
            found["faces"][face] = self.face_id(face)
            if self.face_id(face) is not None:
                expect(self.face_id(original) <= self.face_id(face), "originals have smaller ids")
            if self.geometry == EXTERNAL:
                continue
            found["triangles"] += len(self.triangles(face))
            # repr tells -0 from 0
            expect(repr(self.stored(face)) == repr(self.stored(original)),
                   "a duplicate is the same")

    def check(self):
        found = self.walk()
        self.copies(found)
        expect(len(found["faces"]) == self.face_count, "every face is reached")
        if self.geometry != EXTERNAL:
            expect(found["triangles"] == self.triangle_count, "every quad has two triangles")
        expect(found["nodes"] == self.node_count and found["depth"] == self.depth, "counts")
        return {"name": self.name, "codec": CODECS[self.codec][0], "faces": self.face_count,
                "duplicates": self.duplicate_count, "triangles": self.triangle_count,
                "nodes": self.node_count, "depth": self.depth,
                "face_ids": [found["faces"][face] for face in sorted(found["faces"])],
                "active_edges": self.active_edges(), "materials": self.materials(),
                "user_data": self.user_data()}


class Placed:
    """A static instance in the world (section 11)."""

    def __init__(self, file, trees, number):
        self.tree = trees[struct.unpack_from("<I", file.section(INSTANCES), 16 * number)[0]]
        size = file.section(SCENE)[20]
        rows = struct.unpack_from("<12f" if size == 4 else "<12d", file.section(POSES),
                                  12 * size * number)
        self.rows = [rows[4 * i:4 * i + 4] for i in range(3)]
        self.sides = {}
        for face in range(self.tree.leaf_faces):
            corners = self.corners(face)
            for i, corner in enumerate(corners):
                ends = frozenset((corner, corners[(i + 1) % len(corners)]))
                self.sides.setdefault(ends, set()).add(frozenset(corners))

    def corners(self, face):
        """Corners of a face in world coordinates."""
        triangles = self.tree.triangles(face)
        return [self.world(p) for p in list(triangles[0]) + [t[2] for t in triangles[1:]]]

    def world(self, point):
        o, scale = self.tree.origin, 2.0 ** self.tree.exponent
        x, y, z = (coordinate * scale for coordinate in point)
        moved = [(((m0 * o[0] + m1 * o[1]) + m2 * o[2]) + t if any(o) else t, m0, m1, m2)
                 for m0, m1, m2, t in self.rows]
        return tuple((((t + m0 * x) + m1 * y) + m2 * z) + 0.0 for t, m0, m1, m2 in moved)


def instance_edges(file, trees):
    """For each static instance the edges that are not active there (section 11.2): face and bits."""
    section = file.section(INSTANCE_EDGES)
    if not section or any(tree.geometry == EXTERNAL for tree in trees):
        return None
    count = struct.unpack_from("<I", file.section(SCENE), 4)[0]
    expect(len(section) >= 8 * count and len(section) % 4 == 0, "size of section instance_edges")
    entries = struct.unpack(f"<{len(section) // 4 - 2 * count}I", section[8 * count:])
    instances = [Placed(file, trees, i) for i in range(count)]
    lists = []
    for i, placed in enumerate(instances):
        first, size = struct.unpack_from("<2I", section, 8 * i)
        expect(first + size <= len(entries), "a list inside the section")
        before = -1
        lists.append([])
        for entry in entries[first:first + size]:
            face, bits = entry >> 4, entry & 15
            expect(before < face < placed.tree.leaf_faces, "faces of a list ascend")
            before = face
            corners = placed.corners(face)
            expect(0 < bits < 1 << len(corners), "edges of a face")
            for e, corner in enumerate(corners):
                if not bits >> e & 1:
                    continue
                ends = frozenset((corner, corners[(e + 1) % len(corners)]))
                expect(len(placed.sides[ends]) == 1, "an edge that a tree has once")
                others = {sheet for other in instances if other is not placed
                          for sheet in other.sides.get(ends, ())} - {frozenset(corners)}
                expect(len(others) >= 1, "the edge of another instance")
            lists[-1].append([face, bits])
    return lists


def packed(file):
    """Of each tree of a pack (section 13): its name, its member and its number there."""
    rows, names, members = file.section(PACK), file.section(NAMES), file.section(MEMBERS)
    expect((TREES, NO_OWNER) not in file.sections, "no section trees in a pack")
    expect((PACK, NO_OWNER) in file.sections and len(rows) % 32 == 0, "size of section pack")
    found, by_place = [], {}
    before = None
    for place, size, tree, at, length, prefix in struct.iter_unpack("<QQIIII", rows):
        expect(at + length <= len(names), "a name inside the section")
        name = names[at:at + length]
        name.decode()
        expect(before is None or before < name, "names ascend")
        before = name
        expect(0 < prefix == length or 0 < prefix < length - 1 and name[prefix:prefix + 1] == b"/",
               "a name begins with that of a member")
        by_place.setdefault((place, size), []).append((tree, name, prefix))
        found.append((name, (place, size), tree))
    end, before = 0, None
    files = {}
    for (place, size), trees in sorted(by_place.items()):
        begin = end + -end % 64
        expect(place == begin and place + size <= len(members), "members one behind another")
        expect(not any(members[end:begin]), "zeros between members")
        end = place + size
        member = {name[:prefix] for _, name, prefix in trees}
        expect(len(member) == 1 and (before is None or before < max(member)), "names of members ascend")
        before = max(member)
        inside = files[place, size] = File(members[place:end], may_be_pack=False)
        count = len(inside.section(TREES)) // 128
        expect(sorted(tree for tree, _, _ in trees) == list(range(count)), "each tree of a member once")
        expect(all((prefix == len(name)) == (count == 1) for _, name, prefix in trees), "names of trees")
    expect(end == len(members), "the end of the last member")
    return found, files


def read_pack(file):
    found, files = packed(file)
    read_members = {place: check_file(member)[0] for place, member in files.items()}
    return [{**read_members[place][tree], "name": name.decode()} for name, place, tree in found]


def read(data):
    return read_file(data)[0]


def read_file(data):
    """What is found of the trees, and the edges where instances meet."""
    file = File(data)
    return (read_pack(file), None) if file.is_pack else check_file(file)


def check_file(file):
    records = file.section(TREES)
    expect((TREES, NO_OWNER) in file.sections, "section trees")
    expect(len(records) % 128 == 0, "size of section trees")
    trees = [Tree(file, i, records[128 * i:128 * (i + 1)]) for i in range(len(records) // 128)]
    return [tree.check() for tree in trees], instance_edges(file, trees)


def main(arguments):
    path = arguments[1]
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".hex"):
        data = bytes.fromhex(data.decode())
    try:
        trees, edges = read_file(data)
        print(json.dumps({"trees": trees, "instance_edges": edges}))
    except (Broken, struct.error) as broken:
        print(f"{path}: not as specified: {broken}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
