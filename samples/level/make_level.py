#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes level.gltf: a courtyard with stairs, walls and props, most of them placed many times.

    make_level.py OUTPUT.gltf

Metres, y upward. Deterministic: the file in the repository is this script's output.
"""
import base64
import json
import math
import struct
import sys


class Level:
    """A glTF document in the making: meshes once, nodes as often as they are placed."""

    def __init__(self):
        self.document = {
            "asset": {"version": "2.0", "generator": "samples/level/make_level.py"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }
        self.bytes = bytearray()
        self.materials = {}

    def material(self, name):
        if name not in self.materials:
            self.materials[name] = len(self.document["materials"])
            self.document["materials"].append({"name": name})
        return self.materials[name]

    def accessor(self, data, component, kind, count, target, **extra):
        while len(self.bytes) % 4:
            self.bytes.append(0)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), "target": target}
        self.bytes += data
        self.document["bufferViews"].append(view)
        self.document["accessors"].append(
            {"bufferView": len(self.document["bufferViews"]) - 1, "componentType": component,
             "type": kind, "count": count, **extra})
        return len(self.document["accessors"]) - 1

    def mesh(self, name, primitives):
        """primitives: (material, points, triangles) each."""
        parts = []
        for material, points, triangles in primitives:
            points = [struct.unpack("3f", struct.pack("3f", *p)) for p in points]
            low = [min(p[k] for p in points) for k in range(3)]
            high = [max(p[k] for p in points) for k in range(3)]
            position = self.accessor(b"".join(struct.pack("<3f", *p) for p in points), 5126, "VEC3",
                                     len(points), 34962, min=low, max=high)
            indices = [corner for triangle in triangles for corner in triangle]
            corners = self.accessor(struct.pack(f"<{len(indices)}H", *indices), 5123, "SCALAR",
                                    len(indices), 34963)
            parts.append({"attributes": {"POSITION": position}, "indices": corners,
                          "material": self.material(material)})
        self.document["meshes"].append({"name": name, "primitives": parts})
        return len(self.document["meshes"]) - 1

    def node(self, name, parent=None, **fields):
        number = len(self.document["nodes"])
        self.document["nodes"].append({"name": name, **fields})
        if parent is None:
            self.document["scenes"][0]["nodes"].append(number)
        else:
            self.document["nodes"][parent].setdefault("children", []).append(number)
        return number

    def write(self, path):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        self.document["buffers"].append({"byteLength": len(self.bytes), "uri": uri})
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            json.dump(self.document, file, indent=1)
            file.write("\n")


def box(low, high):
    points = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def join(*parts):
    points, triangles = [], []
    for more_points, more_triangles in parts:
        base = len(points)
        points += more_points
        triangles += [tuple(base + corner for corner in t) for t in more_triangles]
    return points, triangles


def turned(profile, segments):
    """A body of revolution about y; profile: (radius, height) from below, ends on the axis."""
    points, triangles = [], []
    for radius, height in profile:
        for i in range(segments):
            angle = 2 * math.pi * i / segments
            points.append((radius * math.cos(angle), height, radius * math.sin(angle)))
    for ring in range(len(profile) - 1):
        for i in range(segments):
            a, b = ring * segments + i, ring * segments + (i + 1) % segments
            triangles += [(a, a + segments, b), (b, a + segments, b + segments)]
    return points, triangles


def ground(cells, size, height):
    step = size / cells
    points = [(x * step - size / 2, height(x * step - size / 2, z * step - size / 2), z * step - size / 2)
              for z in range(cells + 1) for x in range(cells + 1)]
    triangles = []
    for z in range(cells):
        for x in range(cells):
            a = z * (cells + 1) + x
            triangles += [(a, a + cells + 1, a + 1), (a + 1, a + cells + 1, a + cells + 2)]
    return points, triangles


def main(path):
    level = Level()

    # A paved square, flat, in rolling grass: two materials of one mesh that meet without a gap.
    def height(x, z):
        outside = max(0.0, max(abs(x), abs(z)) - 8)
        return 0.25 * outside * math.sin(0.6 * x) * math.cos(0.5 * z)

    points, triangles = ground(24, 24, height)
    paved = [t for t in triangles if all(max(abs(points[c][0]), abs(points[c][2])) <= 8 for c in t)]
    grass = [t for t in triangles if t not in set(paved)]
    floor = level.mesh("floor", [("stone", points, paved), ("grass", points, grass)])

    step = level.mesh("step", [("stone",) + box((-1.5, 0, -0.15), (1.5, 0.18, 0.15))])
    landing = level.mesh("landing", [("stone",) + box((-1.5, 0, -1), (1.5, 0.18, 1))])
    wall = level.mesh("wall", [("brick",) + join(
        box((-2, 0, -0.15), (2, 1, 0.15)), box((-2, 1, -0.15), (-0.6, 2, 0.15)),
        box((0.6, 1, -0.15), (2, 2, 0.15)), box((-2, 2, -0.15), (2, 3, 0.15)))])
    pillar = level.mesh("pillar", [("stone",) + turned(
        [(0, 0), (0.4, 0), (0.4, 0.2), (0.25, 0.3), (0.22, 2.6), (0.4, 2.8), (0.4, 3), (0, 3)], 24)])
    barrel = level.mesh("barrel", [("wood",) + turned(
        [(0, 0), (0.28, 0), (0.34, 0.25), (0.36, 0.45), (0.34, 0.65), (0.28, 0.9), (0, 0.9)], 20)])
    lamp = level.mesh("lamp", [
        ("iron",) + turned([(0, 0), (0.12, 0), (0.05, 0.1), (0.04, 2.2), (0, 2.2)], 12),
        ("glass",) + turned([(0, 2.2)] + [(0.15 * math.sin(math.pi * i / 8),
                                           2.35 - 0.15 * math.cos(math.pi * i / 8))
                                          for i in range(1, 8)] + [(0, 2.5)], 16)])
    crate = level.mesh("crate", [("wood",) + box((-0.4, -0.4, -0.4), (0.4, 0.4, 0.4))])

    def quarter(turns):
        """Rotation about y, in numbers that every reader has alike."""
        return [0, [0, math.sqrt(0.5), 1, math.sqrt(0.5)][turns], 0, [1, math.sqrt(0.5), 0, -math.sqrt(0.5)][turns]]

    level.node("Floor", mesh=floor)
    stairs = level.node("Stairs", translation=[0, 0, -3])
    for i in range(10):
        level.node(f"Step {i + 1}", stairs, mesh=step, translation=[0, 0.18 * i, -0.3 * i])
    level.node("Landing", stairs, mesh=landing, translation=[0, 1.8 - 0.18, -3.85])
    for side in range(4):
        row = level.node(f"Side {side + 1}", rotation=quarter(side))
        for i in range(4):
            if side == 0 and i in (1, 2):
                continue  # the gate
            level.node(f"Wall {side + 1}.{i + 1}", row, mesh=wall, translation=[4 * i - 6, 0, 8])
        for i in range(2):
            level.node(f"Pillar {side + 1}.{i + 1}", row, mesh=pillar, translation=[5 * i - 2.5, 0, 5.5],
                       scale=[1, 1 + 0.1 * i, 1])
    props = level.node("Props")
    for i in range(12):
        angle = 2 * math.pi * i / 12 + 0.2
        level.node(f"Barrel {i + 1}", props, mesh=barrel, translation=[6.8 * math.cos(angle), 0, 6.8 * math.sin(angle)],
                   rotation=[0, math.sin(0.3 * i), 0, math.cos(0.3 * i)], scale=[1 + 0.02 * i] * 3)
    for i in range(6):
        level.node(f"Lamp {i + 1}", props, mesh=lamp, translation=[4.5 * (i % 3 - 1), 0, -6.5 + 13 * (i // 3)])
    level.node("Crate", mesh=crate, translation=[0.5, 4, -4.5])
    level.write(path)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
