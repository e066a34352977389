#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the boxes of a tree, one level per panel, and its surface, from what `boxtree export` writes.

    boxtree cook MESH -o tree.bxt
    boxtree export tree.bxt -o tree.obj --triangles --levels 1-4
    draw_boxes.py tree.obj PICTURE.png      needs python3-pil and fonts-dejavu-core
"""
import math
import re
import sys

from PIL import Image, ImageDraw, ImageFont

PANEL = 250          # pixels of the picture on each side of a panel
SAMPLES = 3          # on each axis of a pixel
YAW, PITCH = math.radians(-28), math.radians(18)
INK = (90, 98, 110)  # legible on white and on dark pages
SURFACE = (205, 196, 182)
BOXES = [(86, 140, 200), (72, 160, 160), (110, 170, 96), (200, 150, 70)]
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def turned(p):
    """The point as seen: x to the right, y up, z towards the eye."""
    x, y, z = p
    x, z = x * math.cos(YAW) + z * math.sin(YAW), z * math.cos(YAW) - x * math.sin(YAW)
    y, z = y * math.cos(PITCH) - z * math.sin(PITCH), z * math.cos(PITCH) + y * math.sin(PITCH)
    return x, y, z


def read_groups(path):
    """[(group, points, faces as corner numbers)] in the order of the file; lines name corners, too."""
    points, groups = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append(tuple(float(word) for word in words[1:4]))
            elif words[0] == "g":
                groups.append((words[1], []))
            elif words[0] in "fl" and groups:
                groups[-1][1].append([int(word) - 1 for word in words[1:]])
    return points, groups


def boxes_of(points, lines):
    """(low, high) of each box of a level, whose twelve edges follow each other."""
    for first in range(0, len(lines), 12):
        corners = [points[c] for line in lines[first:first + 12] for c in line]
        yield (tuple(min(c[k] for c in corners) for k in range(3)),
               tuple(max(c[k] for c in corners) for k in range(3)))


class Panel:
    """A picture with the depth of each pixel."""

    def __init__(self, middle, scale):
        self.side = PANEL * SAMPLES
        self.middle, self.scale = middle, scale
        self.depth = [-math.inf] * (self.side * self.side)
        self.image = Image.new("RGBA", (self.side, self.side), (0, 0, 0, 0))
        self.pixels = self.image.load()

    def seen(self, p):
        x, y, z = turned(p)
        return (self.side / 2 + (x - self.middle[0]) * self.scale,
                self.side / 2 - (y - self.middle[1]) * self.scale, z * self.scale)

    def triangle(self, a, b, c, colour):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0:
            return
        for y in range(max(0, math.ceil(min(a[1], b[1], c[1]))),
                       min(self.side - 1, math.floor(max(a[1], b[1], c[1]))) + 1):
            for x in range(max(0, math.ceil(min(a[0], b[0], c[0]))),
                           min(self.side - 1, math.floor(max(a[0], b[0], c[0]))) + 1):
                v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
                w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
                if v < 0 or w < 0 or v + w > 1:
                    continue
                self.put(x, y, a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2]), colour)

    def put(self, x, y, z, colour):
        at = y * self.side + x
        if z > self.depth[at]:
            self.depth[at] = z
            self.pixels[x, y] = (*colour, 255)

    def line(self, a, b, colour):
        """Two samples wide, and a little nearer than the face that it bounds."""
        steps = max(1, math.ceil(max(abs(b[0] - a[0]), abs(b[1] - a[1]))))
        for i in range(steps + 1):
            x, y, z = (a[k] + (b[k] - a[k]) * i / steps for k in range(3))
            for dx, dy in ((0, 0), (1, 0), (0, 1)):
                px, py = round(x) + dx, round(y) + dy
                if 0 <= px < self.side and 0 <= py < self.side:
                    self.put(px, py, z + 1.5, colour)


def shaded(colour, light):
    return tuple(min(255, round(c * (0.45 + 0.6 * light))) for c in colour)


def light_of(normal):
    length = math.sqrt(sum(n * n for n in normal)) or 1
    lamp = (-0.35, 0.65, 0.67)
    return max(0, sum(n / length * v for n, v in zip(normal, lamp)))


def draw_surface(panel, points, faces):
    seen = [panel.seen(p) for p in points]
    views = [turned(p) for p in points]
    # Normals of corners: the sum over the faces around, so that small faces do not glitter.
    normals = [[0.0, 0.0, 0.0] for _ in points]
    for face in faces:
        a, b, c = (views[corner] for corner in face[:3])
        u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for corner in face:
            for k in range(3):
                normals[corner][k] += normal[k]
    for face in faces:
        normal = [sum(normals[corner][k] for corner in face) for k in range(3)]
        if normal[2] <= 0:
            continue
        colour = shaded(SURFACE, light_of(normal))
        for i in range(1, len(face) - 1):
            panel.triangle(seen[face[0]], seen[face[i]], seen[face[i + 1]], colour)


def draw_box(panel, low, high, colour):
    for axis in range(3):
        for side, corner in ((-1, low), (1, high)):
            normal = turned(tuple(side if k == axis else 0 for k in range(3)))
            if normal[2] <= 0:
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            loop = []
            for a, b in ((low, low), (high, low), (high, high), (low, high)):
                p = [0.0, 0.0, 0.0]
                p[axis], p[u], p[v] = corner[axis], a[u], b[v]
                loop.append(panel.seen(p))
            face = shaded(colour, light_of(normal))
            panel.triangle(loop[0], loop[1], loop[2], face)
            panel.triangle(loop[0], loop[2], loop[3], face)
            edge = shaded(colour, -0.25)
            for i in range(4):
                panel.line(loop[i], loop[(i + 1) % 4], edge)


def draw(path):
    points, groups = read_groups(path)
    (_, faces), levels = groups[0], groups[1:]
    vertices = sorted({corner for face in faces for corner in face})
    views = [turned(points[v]) for v in vertices]
    low = [min(p[k] for p in views) for k in range(2)]
    high = [max(p[k] for p in views) for k in range(2)]
    middle = [(low[k] + high[k]) / 2 for k in range(2)]
    scale = 0.80 * PANEL * SAMPLES / max(high[k] - low[k] for k in range(2))
    picture = Image.new("RGBA", (PANEL * (len(levels) + 1), PANEL + 28), (0, 0, 0, 0))
    text = ImageDraw.Draw(picture)
    font = ImageFont.truetype(FONT, 14)
    for i, (name, lines) in enumerate(levels + [("surface", None)]):
        panel = Panel(middle, scale)
        if lines is None:
            draw_surface(panel, points, faces)
            label = f"{len(faces):,} triangles"
        else:
            boxes = list(boxes_of(points, lines))
            for box in boxes:
                draw_box(panel, *box, BOXES[i % len(BOXES)])
            label = f"level {re.search(r'[0-9]+$', name).group()}: {len(boxes):,} boxes"
        small = panel.image.resize((PANEL, PANEL), Image.LANCZOS)
        picture.paste(small, (i * PANEL, 0))
        text.text((i * PANEL + PANEL / 2, PANEL + 12), label, fill=INK, font=font, anchor="mm")
    return picture


if __name__ == "__main__":
    draw(sys.argv[1]).save(sys.argv[2], optimize=True)
