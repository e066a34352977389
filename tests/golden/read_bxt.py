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

import xxhash

NO_OWNER = 0xFFFFFFFF
NODES, VERTICES, CORNERS, FACE_IDS, CERTIFICATE, NAMES = 2, 3, 4, 5, 6, 7
EMPTY, LEAF, SUBTREE = 0, 1, 2


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

    def __init__(self, data):
        self.data = data
        expect(len(data) >= 64, "a header has 64 bytes")
        (magic, major, _minor, header_bytes, file_bytes, incompatible, _compatible, count, zero32,
         zero64, checksum) = struct.unpack_from("<8sHHIQQQIIQQ", data)
        expect(magic == bytes([0x89, 0x42, 0x58, 0x54, 0x0D, 0x0A, 0x1A, 0x0A]), "magic")
        expect(major == 1 and header_bytes == 64 and file_bytes == len(data), "version and sizes")
        expect(incompatible == 0 and zero32 == 0 and zero64 == 0, "features and zeros")
        table = data[64:64 + 40 * count]
        expect(checksum == xxh3(data[:56] + table), "checksum of header and table")
        self.sections = {}
        end = 64 + 40 * count
        for i in range(count):
            kind, flags, owner, zero, offset, size, checksum = struct.unpack_from(
                "<IIIIQQQ", table, 40 * i)
            expect(flags in (0, 1) and zero == 0, "section flags")
            expect(offset % 64 == 0 and end <= offset <= end + 4096, "section offset")
            expect(offset + size <= len(data), "section inside the file")
            expect(not any(data[end:offset]), "zero padding")
            body = data[offset:offset + size]
            expect(checksum == xxh3(body), f"checksum of section {i}")
            expect((kind, owner) not in self.sections, "one section of a kind and owner")
            self.sections[kind, owner] = body
            end = offset + size
        expect(len(data) - end < 64 and not any(data[end:]), "padding at the end")

    def section(self, kind, owner=NO_OWNER):
        return self.sections.get((kind, owner), b"")


class Plain:
    """Codecs plain-f32 and plain-f16 (section 4). A node reference is a range of nodes."""

    def __init__(self, tree, nodes):
        self.layout = "<I2I2f" if tree.codec == 1 else "<I2I2e"
        self.size = struct.calcsize(self.layout)
        self.nodes = nodes
        expect(len(nodes) == self.size * tree.node_count, "size of section nodes")

    def root(self, tree):
        return (0, tree.node_count)

    def expand(self, ref, box):
        begin, end = ref
        cutplane, left, right, cut0, cut1 = struct.unpack_from(
            self.layout, self.nodes, begin * self.size)
        axis, kinds = cutplane & 3, ((cutplane >> 2) & 3, (cutplane >> 4) & 3)
        expect(axis <= 2 and cutplane >> 6 == 0, "cutplane")
        left_end = right if kinds[1] == 2 else end
        children = []
        for side, (kind, child, cut) in enumerate(((kinds[0], left, cut0), (kinds[1], right, cut1))):
            low, high = list(box[0]), list(box[1])
            if side == 0:
                high[axis] = f32(high[axis] - cut)
            else:
                low[axis] = f32(low[axis] + cut)
            child_box = (tuple(low), tuple(high))
            if kind == 0:
                expect(child == 0xFFFFFFFF and cut == 0, "a missing child")
            elif kind == 1:
                children.append(("leaf", (child, 1), child_box))
            else:
                expect(kind == 2, "kind of a child")
                span = (begin + 1, left_end) if side == 0 else (right, end)
                expect(child == span[0] and begin < span[0] < span[1] <= end, "range of a child")
                children.append(("subtree", span, child_box))
        return children


CODECS = {1: ("plain-f32", Plain), 2: ("plain-f16", Plain)}


class Tree:
    """A TreeRecord and its sections (sections 3, 5 and 6)."""

    def __init__(self, file, index, record):
        (self.codec, self.geometry, self.flags, self.face_count, self.triangle_count,
         self.vertex_count, self.node_count, self.root_kind, self.depth, self.corner_bytes,
         self.corners_per_face, self.face_id_bytes, zero8, self.exponent, name_offset, name_bytes,
         *rest) = struct.unpack_from("<HHIIIIIIIBBBBiII9dQ8Q", record)
        self.origin, self.low, self.high = rest[0:3], tuple(rest[3:6]), tuple(rest[6:9])
        expect(zero8 == 0 and not any(rest[10:]) and self.flags < 4, "zeros of a record")
        expect(self.codec in CODECS and self.geometry in (1, 2), "codec and geometry")
        self.name = file.section(NAMES)[name_offset:name_offset + name_bytes].decode()
        self.nodes = file.section(NODES, index)
        self.vertices = file.section(VERTICES, index)
        self.corners = file.section(CORNERS, index)
        self.ids = file.section(FACE_IDS, index)
        self.certificate = file.section(CERTIFICATE, index)
        self.scalar = "d" if self.flags & 2 else "f"
        if self.geometry == 2:
            stride = 3 * struct.calcsize(self.scalar)
            expect(len(self.vertices) == self.vertex_count * stride, "size of section vertices")
            expect(len(self.corners) == self.face_count * self.corners_per_face
                   * self.corner_bytes, "size of section corners")
        expect(len(self.ids) == self.face_count * self.face_id_bytes, "size of section face_ids")

    def triangles(self, face):
        """Triangles of a face in tree space."""
        width = "<H" if self.corner_bytes == 2 else "<I"
        missing = (1 << (8 * self.corner_bytes)) - 1
        numbers = [struct.unpack_from(width, self.corners,
                                      (face * self.corners_per_face + i) * self.corner_bytes)[0]
                   for i in range(self.corners_per_face)]
        if len(numbers) == 4 and numbers[3] == missing:
            numbers.pop()
        size = 3 * struct.calcsize(self.scalar)
        points = []
        for number in numbers:
            expect(number < self.vertex_count, "a vertex number")
            p = struct.unpack_from("<3" + self.scalar, self.vertices, number * size)
            points.append(tuple((p[k] - self.origin[k]) * 2.0 ** -self.exponent for k in range(3)))
        return [(points[0], points[i], points[i + 1]) for i in range(1, len(points) - 1)]

    def face_id(self, face):
        if self.flags & 1:
            return face
        if not self.face_id_bytes:
            return None
        at = face * self.face_id_bytes
        return int.from_bytes(self.ids[at:at + self.face_id_bytes], "little")

    def walk(self):
        """Visits every leaf; returns what the certificate must say."""
        found = {"depth": 0, "nodes": 0, "leaves": 0, "shrink": 0, "faces": {}, "triangles": 0}
        if self.root_kind == EMPTY:
            expect(self.face_count == 0, "an empty tree has no faces")
            return found
        if self.root_kind == LEAF:
            self.leaf(found, (0, self.face_count), [(self.low, self.high)])
            return found
        codec = CODECS[self.codec][1](self, self.nodes)
        stack = [(codec.root(self), [(self.low, self.high)])]
        while stack:
            ref, path = stack.pop()
            found["nodes"] += 1
            found["depth"] = max(found["depth"], len(path))
            expect(found["nodes"] <= self.node_count, "each node is reached once")
            children = codec.expand(ref, path[-1])
            expect(children, "a node has a child")
            found["shrink"] += len(children) == 1
            for kind, child, box in children:
                if kind == "leaf":
                    self.leaf(found, child, path + [box])
                else:
                    stack.append((child, path + [box]))
        return found

    def leaf(self, found, faces, path):
        found["leaves"] += 1
        for face in range(faces[0], faces[0] + faces[1]):
            expect(face < self.face_count and face not in found["faces"], "each face in one leaf")
            found["faces"][face] = self.face_id(face)
            if self.geometry != 2:
                continue
            for triangle in self.triangles(face):
                found["triangles"] += 1
                for point in triangle:
                    for low, high in path:
                        expect(all(low[k] <= point[k] <= high[k] for k in range(3)),
                               f"face {face} inside every box above it")

    def check(self):
        found = self.walk()
        expect(len(found["faces"]) == self.face_count, "every face is reached")
        expect(found["nodes"] == self.node_count and found["depth"] == self.depth, "counts")
        error, depth, nodes, leaves, faces, shrink, _degenerate, *zeros = struct.unpack(
            "<d6I4Q", self.certificate)
        expect((depth, nodes, leaves, faces, shrink) ==
               (found["depth"], found["nodes"], found["leaves"], self.face_count, found["shrink"])
               and error >= 0 and not any(zeros), "certificate")
        return {"name": self.name, "codec": CODECS[self.codec][0], "faces": self.face_count,
                "triangles": self.triangle_count, "nodes": self.node_count, "depth": self.depth,
                "face_ids": [found["faces"][face] for face in sorted(found["faces"])]}


def read(data):
    file = File(data)
    records = file.section(1)
    expect(len(records) % 192 == 0, "size of section trees")
    return [Tree(file, i, records[192 * i:192 * (i + 1)]).check()
            for i in range(len(records) // 192)]


def main(arguments):
    path = arguments[1]
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".hex"):
        data = bytes.fromhex(data.decode())
    try:
        print(json.dumps({"trees": read(data)}))
    except (Broken, struct.error) as broken:
        print(f"{path}: not as specified: {broken}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
