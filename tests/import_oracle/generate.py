#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files with every odd spelling that OBJ, PLY, STL and OFF allow, and damaged ones, for the
comparison of two readers. The same seed gives the same files.

    generate.py FOLDER [--files N] [--seed S]
"""
import argparse
import math
import os
import random
import struct
from decimal import Decimal, localcontext
from fractions import Fraction

FORMATS = ("obj", "ply", "stl", "off")


class Case:
    """A file, the files beside it, and what it says if it is well formed: a list of
    (corner numbers as exact values, material) for each face of three corners or more."""

    def __init__(self, name, data, kind, expected=None, beside=None):
        self.name, self.data, self.kind = name, data, kind
        self.expected, self.beside = expected, beside or {}

    def write(self, folder):
        for name, data in [(self.name, self.data), *self.beside.items()]:
            with open(os.path.join(folder, name), "wb") as file:
                file.write(data)
        return os.path.join(folder, self.name)


# --------------------------------------------------------------------------------------------------
# Numbers

def decimal_of(value):
    """A fraction whose denominator is a power of two or ten, as an exact Decimal."""
    with localcontext() as context:
        context.prec = 2000
        return Decimal(value.numerator) / Decimal(value.denominator)


def beside(rng, value):
    """A decimal at, just above or just below a value, spelled with or without an exponent."""
    exact = decimal_of(value)
    with localcontext() as context:
        context.prec = 2000
        exponent = exact.as_tuple().exponent - rng.choice((1, 2, 30))
        exact += rng.choice((-1, 0, 0, 1)) * Decimal((0, (1,), exponent))
        return format(exact, rng.choice("fE"))


def halfway_f32(rng):
    """Exactly between two f32, or next to it: what is rounded twice goes wrong here."""
    exponent = rng.choice((rng.randrange(100, 150), rng.randrange(1, 254), 0))
    bits = exponent << 23 | rng.getrandbits(23)
    low, high = struct.unpack("<2f", struct.pack("<2I", bits, bits + 1))
    return rng.choice(("", "-")) + beside(rng, (Fraction(low) + Fraction(high)) / 2)


def halfway_f64(rng):
    low = math.ldexp(rng.random() + 0.5, rng.choice((0, 3, 20, -20, -126, -1022, 1000)))
    high = math.nextafter(low, math.inf)
    return rng.choice(("", "-")) + beside(rng, (Fraction(low) + Fraction(high)) / 2)


def limit(rng):
    return rng.choice((
        "3.4028234663852886e38", "3.4028235677973365e38", "3.4028235677973366e38", "1e38",
        "340282346638528859811704183484516925440", "340282356779733661637539395458142568447",
        "340282356779733661637539395458142568448", "1e39", "1.7976931348623157e308", "1e400",
        "1.401298464324817e-45", "7.006492321624085e-46", "7.006492321624086e-46", "1e-46",
        "1.1754943508222875e-38", "1.1754942106924411e-38", "4.9e-324", "2.4703282292062327e-324",
        "2.4703282292062328e-324", "1e-400", "-1e-400", "0e999", "1e-99999", "-0", "-0.0",
        "-.0e-0"))


def many_digits(rng):
    digits = "".join(rng.choice("0123456789") for _ in range(rng.randrange(10, 60)))
    point = rng.randrange(len(digits) + 1)
    return rng.choice(("", "-", "+")) + digits[:point] + "." + digits[point:]


def odd_spelling(rng):
    return rng.choice(("1E+3", ".5", "5.", "+1", "-.25", "1e3", "1.e-2", "+.5E+01", "00012",
                       "-007.50", "1e0005", "0.1", "1.0000000000000000000001", "0000", "1E0",
                       "-3e-0", "0.30000001", "16777217", "9007199254740993", "1e22", "1e23",
                       "123456789012345678901234567890", "0.1e1", "1" + "0" * 30 + "e-30",
                       "0." + "0" * 40 + "1e40"))


def any_number(rng):
    return rng.choice((halfway_f32, halfway_f64, limit, many_digits, odd_spelling,
                       odd_spelling))(rng)


def small_number(rng):
    return rng.choice((str(rng.randrange(-9, 10)), f"{rng.uniform(-9, 9):.{rng.randrange(1, 9)}f}",
                       f"{rng.uniform(-9, 9):.{rng.randrange(1, 9)}e}", repr(rng.uniform(-1, 1))))


def respelled(rng, word):
    """The same value, spelled otherwise."""
    if rng.random() < 0.6:
        return word
    sign = word[0] if word[0] in "+-" else ""
    size = word[len(sign):]
    if not sign and rng.random() < 0.3:
        sign = "+"
    if rng.random() < 0.3:
        size = "0" * rng.randrange(1, 4) + size
    if "e" in size.lower():
        return sign + (size.upper() if rng.random() < 0.5 else size)
    if "." not in size and rng.random() < 0.5:
        size += "."
    if "." in size and rng.random() < 0.5:
        size += "0" * rng.randrange(0, 5)
    if rng.random() < 0.3:
        size += rng.choice(("e0", "E+0", "e-00", "E0"))
    if size.startswith("0.") and len(size) > 2 and size[2].isdigit() and rng.random() < 0.3:
        size = size[1:]
    return sign + size


# --------------------------------------------------------------------------------------------------
# Meshes

class Model:
    def __init__(self):
        self.vertices, self.faces = [], []

    def add(self, corners):
        first = len(self.vertices)
        self.vertices += corners
        self.faces.append(list(range(first, len(self.vertices))))


def in_plane(rng, outline):
    """Places an outline in a plane that no axis is normal to, or in one of the axes."""
    axes = [[rng.choice((0, 1, -1, 2)) for _ in range(3)] for _ in range(2)]
    if rng.random() < 0.5 or all(a * d == b * c for (a, b), (c, d) in (
            (axes[0][:2], axes[1][:2]), (axes[0][1:], axes[1][1:]))):
        axes = rng.sample([[1, 0, 0], [0, 1, 0], [0, 0, 1]], 2)
    shift = [rng.randrange(-99, 99) for _ in range(3)]
    scale = Fraction(rng.choice(("1", "0.25", "1000", "0.001", "0.1")))
    return [tuple(format(decimal_of(scale * (u * axes[0][k] + v * axes[1][k] + shift[k])), "f")
                  for k in range(3)) for u, v in outline]


def star(rng, corners):
    """A polygon around the origin, concave as a rule."""
    angles = sorted(rng.uniform(0, 2 * math.pi) for _ in range(corners))
    return [(round(64 * r * math.cos(a)), round(64 * r * math.sin(a)))
            for a, r in ((a, rng.uniform(0.2, 1)) for a in angles)]


def comb(rng, teeth):
    """Concave corners in a row, with corners on straight edges."""
    top = [point for i in range(teeth) for point in ((2 * i + 1, 9), (2 * i, rng.randrange(1, 8)))]
    return [(0, 0), (teeth, 0), (2 * teeth - 1, 0), *reversed(top)]


def shape(rng):
    kind = rng.randrange(6)
    if kind == 0:
        return in_plane(rng, [(0, 0), (rng.randrange(1, 9), 0), (9, 9), (0, rng.randrange(1, 9))])
    if kind == 1:
        return in_plane(rng, [(0, 0), (9, 0), (rng.randrange(1, 4), rng.randrange(1, 4)), (0, 9)])
    if kind == 2:
        return in_plane(rng, star(rng, rng.randrange(3, 12)))
    if kind == 3:
        return in_plane(rng, comb(rng, rng.randrange(1, 5)))
    if kind == 4:
        corners = in_plane(rng, star(rng, rng.randrange(3, 8)))
        corners.insert(rng.randrange(len(corners)), rng.choice(corners))  # a corner twice
        return corners
    return [tuple(small_number(rng) for _ in range(3)) for _ in range(rng.randrange(3, 9))]


def make_model(rng, triangles_only=False):
    model = Model()
    number = any_number if rng.random() < 0.5 else small_number
    if rng.random() < 0.5 and not triangles_only:
        for _ in range(rng.randrange(1, 6)):
            model.add(shape(rng))
        return model
    for _ in range(rng.randrange(3, 12)):
        model.vertices.append(tuple(number(rng) for _ in range(3)))
    if rng.random() < 0.5:  # the same again, perhaps spelled otherwise: to be welded
        for _ in range(3):
            vertex = rng.choice(model.vertices)
            model.vertices.append(tuple(respelled(rng, word) for word in vertex))
    for _ in range(rng.randrange(1, 9)):
        size = 3 if triangles_only or rng.random() < 0.8 else rng.randrange(3, 7)
        model.faces.append([rng.randrange(len(model.vertices)) for _ in range(size)])
    return model


def expected_of(model, faces=None):
    return [([model.vertices[i] for i in face], None)
            for face in (model.faces if faces is None else faces) if len(face) >= 3]


# --------------------------------------------------------------------------------------------------
# Texts

def blank(rng):
    return rng.choice((" ", " ", " ", "  ", "\t", " \t "))


def joined(rng, words):
    text = words[0]
    for word in words[1:]:
        text += blank(rng) + word
    return text


def line_end(rng):
    return rng.choice(("\n", "\n", "\n", "\r\n", "\r"))


NAMES = ("red", "Material.001", "a name with blanks", "x/y", "\xe9t\xe9", "0", "v", "red", "Red",
         "-1", "default", "a\tb", "C:\\textures\\a.png", "\"quoted\"")


class ObjText:
    def __init__(self, rng, model):
        self.rng, self.model = rng, model
        self.end = line_end(rng)
        self.is_odd = rng.random() < 0.8
        self.lines = []
        self.expected = []
        self.material = None
        self.beside = {}
        self.textures = self.normals = 0
        self.numbers = {}  # of vertices that were written

    def put(self, words):
        rng = self.rng
        if not self.is_odd:
            self.lines.append(" ".join(words) + self.end)
            return
        text = words[0]
        for word in words[1:]:
            is_broken = rng.random() < 0.03 and self.end != "\r"
            text += blank(rng)
            if is_broken:
                text += "\\" + self.end + rng.choice(("", " ", "\t"))
            text += word
        if rng.random() < 0.1:
            text = rng.choice((" ", "\t", "   ")) + text
        if rng.random() < 0.1:
            text += blank(rng)
        if rng.random() < 0.1:
            text += rng.choice((" # a comment", "#", " #\\", "\t# v 1 2 3", " # \xe9"))
        self.lines.append(text + self.end)

    def name_line(self, keyword, name):
        self.lines.append(keyword + blank(self.rng) + name + self.rng.choice(("", " ")) + self.end)

    def vertex(self, number):
        rng = self.rng
        if number in self.numbers:
            return
        self.numbers[number] = len(self.numbers)
        extra = rng.choice(([], [], [], [], ["1"], ["1.0"], ["0.5", ".25", "1"]))
        self.put(["v", *(respelled(rng, word) for word in self.model.vertices[number]), *extra])

    def clutter(self):
        rng = self.rng
        kind = rng.randrange(12)
        if kind == 0:
            self.lines.append(rng.choice(("# a comment", "", "#", "\t", "  ", "# C:\\", "#v 1 2 3"))
                              + self.end)
        elif kind == 1:
            self.name_line(rng.choice("go"), rng.choice(NAMES))
        elif kind == 2:
            self.material = rng.choice(NAMES)
            self.name_line("usemtl", self.material)
        elif kind == 3:
            self.put(["s", rng.choice(("off", "1", "0"))])
        elif kind == 4 and len(self.numbers) > 1:
            self.put(["l", "1", str(len(self.numbers))])
        elif kind == 5 and self.numbers:
            self.put(["p", "1"])
        elif kind == 6:
            self.put(["g"])
        elif kind == 7:
            self.put(["g", "one", "two"])

    def corner_words(self, face):
        rng = self.rng
        form = rng.randrange(4)
        if form in (1, 3) and (not self.textures or rng.random() < 0.3):
            self.put(["vt", *(small_number(rng) for _ in range(rng.choice((2, 3))))])
            self.textures += 1
        if form in (2, 3) and (not self.normals or rng.random() < 0.3):
            self.put(["vn", *(small_number(rng) for _ in range(3))])
            self.normals += 1

        def reference(number, count):
            zeros = "0" * (rng.random() < 0.01)
            return str(number - count) if rng.random() < 0.3 else zeros + str(number + 1)

        words = []
        for vertex in face:
            word = reference(self.numbers[vertex], len(self.numbers))
            if form == 1:
                word += "/" + reference(rng.randrange(self.textures), self.textures)
            elif form == 2:
                word += "//" + reference(rng.randrange(self.normals), self.normals)
            elif form == 3:
                word += ("/" + reference(rng.randrange(self.textures), self.textures) + "/"
                         + reference(rng.randrange(self.normals), self.normals))
            words.append(word)
        return words

    def write(self):
        rng, model = self.rng, self.model
        with_clutter = rng.random() < 0.6
        if rng.random() < 0.5:
            library = f"library{rng.randrange(9)}.mtl"
            self.beside[library] = "".join(f"newmtl {name}\nKd 1 0 0\n" for name in dict.fromkeys(
                NAMES)).encode("latin-1")
            self.name_line("mtllib", library)
        if rng.random() < 0.5:
            for number in range(len(model.vertices)):
                self.vertex(number)
        for face in model.faces:
            while with_clutter and rng.random() < 0.5:
                self.clutter()
            for number in face:
                self.vertex(number)
            words = self.corner_words(face)
            self.put(["f", *words])
            self.expected.append(([model.vertices[i] for i in face], self.material))
        text = "".join(self.lines)
        if rng.random() < 0.1:
            text = text[:-len(self.end)]
        data = text.encode("latin-1")
        return (b"\xef\xbb\xbf" if rng.random() < 0.1 else b"") + data


def obj_case(rng, name):
    text = ObjText(rng, make_model(rng))
    data = text.write()
    return Case(name, data, "well formed", text.expected, text.beside)


PLY_POSITIONS = ("float", "float", "float", "double", "float32", "float64", "int", "short", "uchar",
                 "char", "ushort", "uint", "int8", "uint8", "int16", "uint16", "int32", "uint32")
PLY_STRUCT = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
              "float": "f", "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H",
              "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}
PLY_INTEGERS = [name for name, code in PLY_STRUCT.items() if code not in "fd"]


def ply_value(rng, kind, word=None):
    """A value of a type: the word itself where it fits, else any."""
    code = PLY_STRUCT[kind]
    if code in "fd":
        if word is None:
            word = small_number(rng)
        value = float(word)
        if code == "f":
            try:
                value = struct.unpack("<f", struct.pack("<f", value))[0]
            except OverflowError:
                value = 1.0
        return value
    bits = 8 * struct.calcsize("<" + code)
    low = 0 if code.isupper() else -(1 << (bits - 1))
    return rng.choice((rng.randrange(low, low + (1 << bits)), max(low, rng.randrange(-9, 99))))


class PlyFile:
    """Header and body in one of the three formats, element by element."""

    def __init__(self, rng, model):
        self.rng, self.model = rng, model
        self.format = rng.choice(("ascii", "binary_little_endian", "binary_big_endian"))
        self.is_text = self.format == "ascii"
        self.order = ">" if "big" in self.format else "<"
        self.end = rng.choice(("\n", "\n", "\r\n", "\r"))
        self.header, self.body = ["ply", f"format {self.format} 1.0"], []
        self.points = []

    def comment(self):
        if self.rng.random() < 0.2:
            self.header.append(self.rng.choice((
                "comment made by hand", "obj_info num_cols 4", "comment", "comment element face 3",
                "comment  end_header ", "obj_info", "comment \xe9")))

    def element(self, name, properties, rows):
        """Properties are (type, name) or (count type, type, name), rows lists of values."""
        rng = self.rng
        self.comment()
        self.header.append(f"element {name} {len(rows)}")
        for p in properties:
            self.comment()
            self.header.append("property " + ("list " if len(p) == 3 else "") + " ".join(p))
        for row in rows:
            words, data = [], b""
            for p, value in zip(properties, row):
                code = PLY_STRUCT[p[-2]]
                values = value if len(p) == 3 else [value]
                if len(p) == 3:
                    words.append(str(len(values)))
                    if not self.is_text:
                        data += struct.pack(self.order + PLY_STRUCT[p[0]], len(values))
                if self.is_text:
                    words += [v if isinstance(v, str) else repr(v) for v in values]
                else:
                    data += struct.pack(f"{self.order}{len(values)}{code}", *values)
            if self.is_text:
                edge = rng.choice(("", "", "", " ", "\t"))
                self.body.append((edge + joined(rng, words) + rng.choice(("", "", " ")) + self.end)
                                 .encode("latin-1"))
            else:
                self.body.append(data)

    def extras(self):
        """Properties beside those that matter."""
        rng = self.rng
        names = rng.sample(["nx", "red", "s", "confidence", "flags", "quality"],
                           rng.randrange(0, 3))
        return [(rng.choice(list(PLY_STRUCT)), name) if rng.random() < 0.8 else
                (rng.choice(("uchar", "ushort", "uint")), rng.choice(list(PLY_STRUCT)), name)
                for name in names]

    def any_value(self, p):
        if len(p) == 3:
            return [ply_value(self.rng, p[1]) for _ in range(self.rng.randrange(0, 4))]
        return ply_value(self.rng, p[0])

    def vertices(self):
        rng = self.rng
        kinds = [rng.choice(PLY_POSITIONS)] * 3
        if rng.random() < 0.1:
            kinds = [rng.choice(PLY_POSITIONS) for _ in range(3)]
        properties = [(kind, axis) for kind, axis in zip(kinds, "xyz")]
        if rng.random() < 0.2:
            rng.shuffle(properties)
        for extra in self.extras():
            properties.insert(rng.randrange(len(properties) + 1), extra)
        rows = []
        for vertex in self.model.vertices:
            at = {}
            for kind, axis, word in zip(kinds, "xyz", vertex):
                at[axis] = ply_value(rng, kind, word)
                if self.is_text and PLY_STRUCT[kind] in "fd":
                    at[axis] = respelled(rng, word)
            self.points.append(tuple(at[axis] for axis in "xyz"))
            rows.append([at[p[-1]] if p[-1] in at else self.any_value(p) for p in properties])
        self.element("vertex", properties, rows)

    def faces(self):
        rng = self.rng
        corners = (rng.choice(PLY_INTEGERS), rng.choice(PLY_INTEGERS),
                   rng.choice(("vertex_indices", "vertex_index")))
        if rng.random() < 0.5:
            corners = ("uchar", "int", corners[2])
        properties = [corners]
        for extra in self.extras():
            properties.insert(rng.randrange(len(properties) + 1), extra)
        rows = [[face if p == corners else self.any_value(p) for p in properties]
                for face in self.model.faces]
        self.element("face", properties, rows)

    def other(self, name):
        rng = self.rng
        properties = self.extras() or [("int", "i")]
        self.element(name, properties,
                     [[self.any_value(p) for p in properties] for _ in range(rng.randrange(0, 4))])

    def write(self):
        rng = self.rng
        if rng.random() < 0.1:
            for size in (0, 1, 2):
                self.model.faces.append([0] * size)
        parts = [self.vertices, self.faces]
        if rng.random() < 0.1:
            parts.reverse()
        for name in ("user", "camera"):
            if rng.random() < 0.15:
                parts.insert(rng.randrange(len(parts) + 1), lambda name=name: self.other(name))
        for part in parts:
            part()
        self.comment()
        self.header.append("end_header")
        header = "".join(line + self.end for line in self.header)
        if rng.random() < 0.1:
            header = header.replace(" ", "  ")
        body = b"".join(self.body)
        if self.is_text and rng.random() < 0.1:
            body = body[:-len(self.end)]
        return header.encode("latin-1") + body


def ply_case(rng, name):
    model = make_model(rng)
    file = PlyFile(rng, model)
    data = file.write()
    expected = [([file.points[i] for i in face], None) for face in model.faces if len(face) >= 3]
    return Case(name, data, f"well formed, {file.format}", expected)


def stl_case(rng, name):
    model = make_model(rng, triangles_only=True)
    if rng.random() < 0.4:
        header = rng.choice((b"", b"solid of a CAD", b"solid\nfacet normal 0 0 1\n",
                             b"COLOR=\1\2\3\4", bytes(80)))
        header = header.ljust(80, rng.choice((b"\0", b" ")))[:80]
        data = header + struct.pack("<I", len(model.faces))
        expected = []
        for face in model.faces:
            at = [tuple(ply_value(rng, "float", word) for word in model.vertices[i]) for i in face]
            data += struct.pack("<12fH", *(rng.uniform(-1, 1) for _ in range(3)), *sum(at, ()),
                                rng.choice((0, 0, 0xFFFF)))
            expected.append((at, None))
        return Case(name, data, "well formed, binary", expected)
    end = line_end(rng)
    change = rng.choice((str, str, str.upper, str.title))
    text = ""
    expected = []
    solids = rng.choice((1, 1, 1, 2, 3))
    is_odd = rng.random() < 0.7

    def put(*words):
        line = joined(rng, words) if is_odd else " ".join(words)
        edge = rng.choice(("", " ", "\t", "      ")) if is_odd else ""
        empty = end if is_odd and rng.random() < 0.05 else ""
        return edge + line + (rng.choice(("", "", " ")) if is_odd else "") + end + empty

    for solid in range(solids):
        title = rng.choice(([], ["a"], ["a", "facet"], ["\xe9"], ["endsolid"]))
        first = put(change("solid"), *title)
        text += first if solid or not text else first
        for face in model.faces[solid::solids]:
            text += put(change("facet"), change("normal"), *(small_number(rng) for _ in range(3)))
            text += put(change("outer"), change("loop"))
            for i in face:
                text += put(change("vertex"), *(respelled(rng, word) for word in model.vertices[i]))
            text += put(change("endloop")) + put(change("endfacet"))
            expected.append(([model.vertices[i] for i in face], None))
        text += put(change("endsolid"), *title)
    text = text.lstrip() if rng.random() < 0.9 else text
    if rng.random() < 0.1:
        text = text.rstrip("\r\n")
    return Case(name, text.encode("latin-1"), "well formed, text", expected)


def off_case(rng, name):
    model = make_model(rng)
    end = line_end(rng)
    is_odd = rng.random() < 0.7
    prefix = rng.choice(("", "", "", "C", "N", "ST", "CN", "STC", "STN", "STCN"))

    def put(words):
        line = joined(rng, words) if is_odd else " ".join(words)
        if is_odd and rng.random() < 0.1:
            line = rng.choice((" ", "\t")) + line
        if is_odd and rng.random() < 0.1:
            line += rng.choice((" ", "\t", " # a comment", "#", " # 3 0 1 2"))
        clutter = rng.choice(("", "# a comment", "  ", "#3 0 1 2")) + end
        return line + end + (clutter if is_odd and rng.random() < 0.05 else "")

    counts = [str(len(model.vertices)), str(len(model.faces)), rng.choice(("0", "12"))]
    text = put(["# before the header"]) if is_odd and rng.random() < 0.1 else ""
    kind = rng.random()
    if prefix == "" and kind < 0.1:
        text += put(counts)
    elif kind < 0.3:
        text += put([prefix + "OFF", *counts])
    else:
        text += put([prefix + "OFF"]) + put(counts)
    colours = rng.choice((["255", "0", "0", "255"], ["1", "0.5", "0", "1"], ["255", "0", "0"]))
    for vertex in model.vertices:
        words = [respelled(rng, word) for word in vertex]
        if "N" in prefix:
            words += [small_number(rng) for _ in range(3)]
        if "C" in prefix:
            words += colours
        if "ST" in prefix:
            words += [small_number(rng) for _ in range(2)]
        text += put(words)
    for face in model.faces:
        colour = rng.choice(([], [], [], ["7"], ["255", "0", "0"], ["1.0", "0.5", "0"],
                             ["0", "1", "2", "3"], ["0.1", "0.2", "0.3", "1"]))
        text += put([str(len(face)), *(str(i) for i in face), *colour])
    if rng.random() < 0.1:
        text = text.rstrip("\r\n")
    return Case(name, text.encode("latin-1"), "well formed", expected_of(model))


# --------------------------------------------------------------------------------------------------
# Damage

JUNK = ("nan", "NaN", "inf", "-inf", "Infinity", "1,5", "0x10", "1e", "abc", "--1", "1.0f", "1_0",
        "-", "+", ".", "1..2", "1e+", "e5", "1d5", "1.#IND", "nan(ind)", "\xd9\xa3", "1e99999",
        "1e5.5", "", "1 2", "\0", "\x0c", "1/2", "1e-", "0b1", "1'000", "0x1p3", "\xa0", "+-1",
        "1+1", "inff", "*")
NUMBERS = ("0", "-1", "-2", "1", "2", "99", "-99", "2147483647", "2147483648", "-2147483648",
           "4294967295", "4294967296", "4294967297", "18446744073709551616", "18446744073709551617",
           "1.5", "1.0", "1e0", "x", "3x", "+1", "01", "-0", "1/", "1//", "/1", "1/1/1/1", "1/x",
           "1//x", "1/99", "1//99", "1/0", "99999999999999999999999")


def damaged_text(rng, data):
    ends = b"\r\n" if b"\r\n" in data else b"\n" if b"\n" in data else b"\r"
    lines = data.split(ends)
    kind = rng.randrange(8)
    at = rng.randrange(len(lines))
    if kind <= 2:  # a word of a line
        for _ in range(20):
            at = rng.randrange(len(lines))
            words = lines[at].split(b" ")
            i = rng.randrange(len(words))
            if words[i].strip() and (words[i][-1:].isdigit() or rng.random() < 0.1):
                words[i] = rng.choice(JUNK + NUMBERS).encode("latin-1")
                lines[at] = b" ".join(words)
                break
    elif kind == 3:
        del lines[at]
    elif kind == 4:
        lines.insert(at, lines[rng.randrange(len(lines))])
    elif kind == 5 and at + 1 < len(lines):
        lines[at], lines[at + 1] = lines[at + 1], lines[at]
    elif kind == 6:
        words = lines[at].split(b" ")
        rng.choice((words.pop, lambda: words.append(b"1"), lambda: words.append(words[-1])))()
        lines[at] = b" ".join(words)
    else:
        return damaged_bytes(rng, data)
    return ends.join(lines)


def damaged_bytes(rng, data):
    at = rng.randrange(len(data))
    kind = rng.randrange(4)
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + bytes([data[at] ^ 1 << rng.randrange(8)]) + data[at + 1:]
    if kind == 2:
        return data[:at] + data[at + rng.randrange(1, 5):]
    return data[:at] + bytes(rng.choice(((0,), (255,), (10,), (13,), (32,), (35,), (92,), (48,)))
                             ) + data[at:]


def damaged_binary(rng, data, header_bytes):
    kind = rng.randrange(4)
    if kind == 0 and len(data) > header_bytes + 4:
        at = rng.randrange(header_bytes, len(data) - 3)
        number = rng.choice((struct.pack("<f", math.nan), struct.pack("<f", math.inf),
                             struct.pack(">f", -math.inf), b"\xff\xff\xff\xff", b"\0\0\0\x80",
                             b"\0\0\0\0", b"\x7f\xf0\0\0"))
        return data[:at] + number + data[at + 4:]
    if kind == 1:
        return data + bytes(rng.randrange(1, 60))
    return damaged_bytes(rng, data)


def damaged(rng, case):
    data = case.data
    for _ in range(rng.choice((1, 1, 1, 2))):
        if not data:
            break
        if "binary" in case.kind and rng.random() < 0.7:
            end = data.find(b"end_header")
            data = damaged_binary(rng, data, end + 11 if end >= 0 else min(80, len(data)))
        else:
            data = damaged_text(rng, data)
    return Case(case.name, data, "damaged", None, case.beside)


MAKERS = {"obj": obj_case, "ply": ply_case, "stl": stl_case, "off": off_case}

# Small files for every truncation.
_PLY = ("ply\nformat {} 1.0\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n")
_PLY_BODY = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1) + struct.pack(
    "<B3iB4i", 3, 0, 1, 2, 4, 0, 2, 3, 1)
_FACET = ("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\n"
          "endfacet\n")
SAMPLES = {
    "a.obj": b"v 0 0 0\nv 1 0 0\nv 0 1.25 0\nv 0 0 1\nusemtl a b\nf 1 2 3\nf 1/1 2/1 -1/1\n"
             b"f 4 2 1\n",
    "b.obj": b"v 0 0 0 1\r\nv 1 0 0 1\r\nv 0 1 0 1\r\nf \\\r\n1 2 3 # x\r\nf 1 2 3",
    "c.ply": (_PLY.format("ascii") + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 2 3 1\n").encode(),
    "d.ply": _PLY.format("binary_little_endian").encode() + _PLY_BODY,
    "e.stl": ("solid a\n" + 2 * _FACET + "endsolid a\n").encode(),
    "f.stl": bytes(80) + struct.pack("<I12fH12fH", 2, *range(12), 0, *range(3, 15), 0),
    "g.off": b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n3 0 1 2\n4 0 2 3 1 255 0 0\n",
    "h.off": b"COFF 3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2",
}


def truncations(rng, share):
    """Samples cut after every byte, or a share of these."""
    for name, data in SAMPLES.items():
        stem, extension = name.split(".")
        for size in range(len(data) + 1):
            if rng.random() < share:
                yield Case(f"cut-{stem}-{size}.{extension}", data[:size], "truncated")


def cases(seed, count, cut_share=1.0):
    """`count` files of all formats in turn, a third of them damaged, and truncations."""
    for number in range(count):
        rng = random.Random(f"{seed} {number}")
        extension = FORMATS[number % len(FORMATS)]
        case = MAKERS[extension](rng, f"file-{seed}-{number}.{extension}")
        yield damaged(rng, case) if rng.random() < 0.35 else case
    yield from truncations(random.Random(f"{seed} cuts"), cut_share)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--files", type=int, default=1000)
    parser.add_argument("--seed", default="1")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    for case in cases(arguments.seed, arguments.files):
        case.write(arguments.folder)


if __name__ == "__main__":
    main()
