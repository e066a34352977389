#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A second reader of OBJ, PLY, STL and OFF files, written from the descriptions of these formats
and from cooker/import/import.h, and sharing nothing with the C++ one. Strict: what a format does
not allow is refused. Where formats and import.h are silent, a note says so: a file with notes may
be refused or read, but if it is read, then as here.

    read_mesh.py FILE... [--f64] [--skip-bad]    prints counts and notes
"""
import math
import os
import re
import struct
import sys
from fractions import Fraction

FAILED, NO_FACES = "import_failed", "no_faces"
NOT_FINITE, OUT_OF_RANGE = "mesh_not_finite", "mesh_index_out_of_range"

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\Z", re.ASCII)
NOT_A_FINITE_NUMBER = re.compile(r"[+-]?(nan(\(\w*\))?|inf|infinity)\Z", re.ASCII | re.IGNORECASE)
BEGUN_NUMBER = re.compile(r"[+-]?([.,]?\d|nan|inf)", re.ASCII | re.IGNORECASE)
INTEGER = re.compile(r"[+-]?\d+\Z", re.ASCII)
LINE_END = re.compile(r"\r\n|\r|\n")

# What f32 has no number for: from here on the nearest is infinity.
F32_OVERFLOW = Fraction(2) ** 128 - Fraction(2) ** 103


class Refused(Exception):
    """The file is not as its format wants it, or nothing can be made of it."""

    def __init__(self, reason, codes=(FAILED,), notes=()):
        super().__init__(reason)
        self.codes = set(codes)
        self.notes = list(notes)


class NotANumber(Refused):
    """Words instead of numbers, or with something behind a number."""

    def __init__(self, words, codes=(FAILED,)):
        wrong = [word for word in map(str, words) if not is_number(word)]
        is_begun = bool(wrong) and all(BEGUN_NUMBER.match(word) for word in wrong)
        super().__init__(f"{' '.join(wrong)!r} is no number", codes,
                         ["a number with something behind it"] if is_begun else [])


class Quotient:
    """A coordinate that is one decimal by another (homogeneous coordinates), not yet rounded."""

    def __init__(self, over, under):
        self.over, self.under = over, under


def exact(number):
    """The value of a number from a file: a decimal word, an integer, a float or a quotient."""
    if isinstance(number, Quotient):
        return exact(number.over) / exact(number.under)
    return Fraction(number)


def next_f32(bits, away):
    """The bits of the next f32 away from zero, or towards it."""
    return bits + 1 if away else bits - 1


def f32_of_bits(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def f64_of_bits(bits):
    return struct.unpack("<d", struct.pack("<Q", bits))[0]


def f32_bits(number):
    """Bits of the nearest f32, ties to even, rounded once. A detour over the nearest f64 is
    harmless unless that lies exactly between two f32: then the decimal itself decides."""
    near = f64_value(number)
    if not math.isfinite(near):
        return struct.unpack("<I", struct.pack("<f", near))[0]
    sign = 0x80000000 if math.copysign(1, near) < 0 else 0
    size = abs(near)
    if size >= F32_OVERFLOW:
        is_below = size == F32_OVERFLOW and abs(exact(number)) < F32_OVERFLOW
        return sign | (0x7F7FFFFF if is_below else 0x7F800000)
    bits = struct.unpack("<I", struct.pack("<f", size))[0]
    rounded = f32_of_bits(bits)
    if rounded == size:
        return sign | bits
    other = next_f32(bits, rounded < size)
    # The neighbour of the largest f32 is infinity, which stands for 2^128 here.
    neighbour = Fraction(2) ** 128 if other == 0x7F800000 else Fraction(f32_of_bits(other))
    if Fraction(size) * 2 == Fraction(rounded) + neighbour and isinstance(number, (str, Quotient)):
        value = abs(exact(number))
        if value != Fraction(size):
            low, high = sorted((bits, other))
            bits = high if value > Fraction(size) else low
    return sign | bits


def f64_value(number):
    """The nearest f64. Python rounds words, fractions and integers once."""
    if isinstance(number, Quotient):
        under = exact(number.under)
        value = exact(number.over) / under
        is_negative = number.over.startswith("-") != (under < 0)
        return math.copysign(float(abs(value)), -1 if is_negative else 1)
    is_nan = isinstance(number, str) and number.lower().lstrip("+-").startswith("nan(")
    return math.nan if is_nan else float(number)


def f64_bits(number):
    return struct.unpack("<Q", struct.pack("<d", f64_value(number)))[0]


def is_number(word):
    return NUMBER.match(word) or NOT_A_FINITE_NUMBER.match(word)


class Polygon:
    """A face with three corners or more. Corners are vertex numbers from 0; out of range is said
    here, as a file may hold such a face and another code decides what becomes of it."""

    def __init__(self, corners, material=None, is_malformed=False):
        self.corners = corners
        self.material = material
        self.is_malformed = is_malformed  # a corner is no number at all


class Mesh:
    """What a file says, before rounding."""

    def __init__(self):
        self.vertices = []  # three numbers each
        self.polygons = []
        self.points = self.lines = self.empty = 0
        self.has_open_end = False
        self.notes = []

    def note(self, text):
        if text not in self.notes:
            self.notes.append(text)

    def add_face(self, corners, **more):
        """Takes a face of any number of corners over, or counts it."""
        if len(corners) >= 3:
            self.polygons.append(Polygon(corners, **more))
            return
        if not all(isinstance(c, int) and 0 <= c < len(self.vertices) for c in corners):
            self.note("a point or line with a vertex number out of range")
        self.points += len(corners) == 1
        self.lines += len(corners) == 2
        self.empty += not corners


def words_of(text):
    """Words between ASCII blanks; str.split takes other characters for blanks, too."""
    return [word for word in re.split(r"[ \t\r\n\f\v]+", text) if word]


def texts_of_lines(data):
    """Lines of a text with any of the three line ends."""
    return LINE_END.split(data.decode("latin-1"))


def has_open_end(data):
    return bool(data) and data[-1:] not in (b"\n", b"\r")


# --------------------------------------------------------------------------------------------------
# OBJ

OBJ_IGNORED = set("vt vn vp g s mg o bevel c_interp d_interp lod mtllib maplib usemap shadow_obj "
                  "trace_obj".split())
OBJ_FREE_FORM = set("cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con ctech "
                    "stech bsp bzp cdc cdp res".split())
OBJ_NAMED = {"usemtl", "mtllib", "g", "o", "maplib", "usemap"}


def obj_statements(data, mesh):
    """Logical lines: without comments, joined where a backslash ends them."""
    if data.startswith(b"\xef\xbb\xbf"):
        data = data[3:]
    if data.endswith(b"\x1a"):
        mesh.note("a last byte 0x1a")
        data = data[:-1]
    joined = ""
    lines = texts_of_lines(data)
    for at, line in enumerate(lines):
        text, sharp, _ = line.partition("#")
        if sharp and re.match(r"[ \t]*(%s)[ \t]" % "|".join(OBJ_NAMED), joined + text):
            mesh.note("a # in a name")
        if not sharp and text.endswith("\\"):
            following = lines[at + 1] if at + 1 < len(lines) else ""
            if len(text) > 1 and text[-2] not in " \t" and following[:1] not in ("", " ", "\t"):
                mesh.note("a backslash within a word")
            if at + 1 >= len(lines) - 1 and not following:
                mesh.note("a backslash before the end of the file")
            joined += text[:-1] + " "
            continue
        yield joined + text
        joined = ""
    if joined:
        yield joined


def obj_words(text, mesh):
    if re.search(r"[\f\v]", text):
        mesh.note("a form feed or vertical tab")
        return re.split(r"[ \t\f\v]+", text.strip(" \t\f\v"))
    return words_of(text)


class Obj:
    """Statements of an OBJ file, one after the other."""

    def __init__(self, data):
        self.mesh = Mesh()
        self.mesh.has_open_end = has_open_end(data)
        self.material = None
        for text in obj_statements(data, self.mesh):
            if text.strip(" \t"):
                self.statement(text)

    def statement(self, text):
        mesh = self.mesh
        words = obj_words(text, mesh)
        if not words or not words[0]:
            return
        keyword, values = words[0], words[1:]
        if keyword == "v":
            mesh.vertices.append(self.position(values))
        elif keyword in ("f", "fo"):
            self.face(values)
        elif keyword in ("l", "p"):
            self.line_or_points(keyword, values)
        elif keyword == "usemtl":
            self.material = text.strip(" \t\f\v")[6:].strip(" \t\f\v")
            if not self.material:
                mesh.note("usemtl without a name")
        elif keyword == "call":
            raise Refused("call: the statements of another file are missing")
        elif keyword in OBJ_FREE_FORM or keyword == "csh":
            mesh.note("free-form geometry or a command")
        elif keyword in OBJ_IGNORED:
            fewest = 3 if keyword == "vn" else 1
            if keyword in ("vt", "vn", "vp") and not (
                    fewest <= len(values) <= 3 and all(NUMBER.match(word) for word in values)):
                mesh.note("an odd normal or texture coordinate")
        else:
            if keyword in ("V", "F") or not re.match(r"[!-~]+\Z", keyword):
                raise Refused(f"no statement of OBJ begins with {keyword!r}")
            mesh.note("a statement that OBJ does not have")

    def position(self, values):
        if len(values) < 3:
            raise Refused(f"a vertex of {values}", notes=["a damaged vertex or corner"])
        if not all(is_number(word) for word in values[:3]):
            raise NotANumber(values[:3])
        if len(values) not in (3, 4, 6) or not all(NUMBER.match(word) for word in values[3:]):
            self.mesh.note("odd numbers behind a position")
        elif len(values) == 4 and Fraction(values[3]) != 1:
            self.mesh.note("a weight other than 1")
        return tuple(values[:3])

    def reference(self, word):
        """The vertex number of one corner, or a word that is none."""
        parts = word.split("/")
        if len(parts) > 3 or not all(INTEGER.match(part) for part in parts if part):
            return word
        if not parts[0]:
            return word
        if parts[-1] == "" and len(parts) > 1:
            self.mesh.note("a slash at the end of a corner")
        number = int(parts[0])
        if number < 0:
            return number + len(self.mesh.vertices) if -number <= len(self.mesh.vertices) else -1
        return number - 1

    def face(self, values):
        corners = [self.reference(word) for word in values]
        if len(corners) < 3:
            self.mesh.note("f with fewer than three corners")
        malformed = any(isinstance(corner, str) for corner in corners)
        if malformed and len(corners) < 3:
            raise Refused(f"a face of {values}", (FAILED, OUT_OF_RANGE),
                          ["a damaged vertex or corner"])
        self.mesh.add_face(corners, material=self.material, is_malformed=malformed)

    def line_or_points(self, keyword, values):
        corners = [self.reference(word) for word in values]
        if keyword == "l":
            self.mesh.lines += max(0, len(corners) - 1)
        else:
            self.mesh.points += len(corners)


def read_obj(data):
    return Obj(data).mesh


# --------------------------------------------------------------------------------------------------
# PLY

PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
             "float": "f", "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H",
             "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}
PLY_FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}


class Property:
    def __init__(self, name, kind, count_kind=None):
        self.name, self.kind, self.count_kind = name, kind, count_kind


class Element:
    def __init__(self, name, count):
        self.name, self.count, self.properties = name, count, []

    def find(self, *names):
        found = [i for i, p in enumerate(self.properties) if p.name in names]
        return found[0] if found else None


class Ply:
    def __init__(self, data):
        self.data = data
        self.mesh = Mesh()
        self.order = "?"
        self.elements = []
        self.at = 0
        self.faces = []
        try:
            self.header()
            self.check_elements()
            if self.order is None:
                self.mesh.has_open_end = has_open_end(data)
                self.text_body()
            else:
                self.binary_body()
        except Refused as refused:
            refused.notes += self.mesh.notes
            raise
        for corners in self.faces:
            self.mesh.add_face(corners)

    def header_line(self, end):
        """One line, ended as the first one is."""
        if end is None:
            found = re.search(rb"\r\n|\r|\n", self.data)
            end = found.group() if found else b"\n"
        stop = self.data.find(end, self.at)
        if stop < 0:
            raise Refused("the header has no end")
        line = self.data[self.at:stop].decode("latin-1")
        self.at = stop + len(end)
        return line, end

    def header(self):
        line, end = self.header_line(None)
        if line != "ply":
            raise Refused("no 'ply' at the start")
        while True:
            line, _ = self.header_line(end)
            words = words_of(line)
            if "\0" in line:
                raise Refused("a zero byte in the header")
            if not words:
                self.mesh.note("an empty line in the header")
            elif words == ["end_header"]:
                break
            elif words[0] not in ("comment", "obj_info"):
                self.header_statement(words)
        if self.order == "?":
            raise Refused("no format in the header")

    def header_statement(self, words):
        if words[0] == "format":
            if self.order != "?" or len(words) < 2 or words[1] not in PLY_FORMATS:
                raise Refused(f"{' '.join(words)!r} in the header")
            if words[2:] != ["1.0"]:
                self.mesh.note("a version other than 1.0")
            self.order = PLY_FORMATS[words[1]]
        elif words[0] == "element" and len(words) > 2 and re.match(r"\d+\Z", words[2], re.ASCII):
            if len(words) > 3:
                self.mesh.note("more words than a line of the header has")
            if self.order == "?":
                self.mesh.note("an element before the format")
            self.elements.append(Element(words[1], int(words[2])))
        elif words[0] == "property" and self.elements:
            self.elements[-1].properties.append(self.property(words[1:]))
        elif words[0] in ("format", "element", "property", "end_header"):
            raise Refused(f"{' '.join(words)!r} in the header", notes=(
                ["a property without an element"] if words[0] == "property" else []))
        else:
            self.mesh.note("an unknown line in the header")

    def property(self, words):
        if len(words) > (4 if words[:1] == ["list"] else 2):
            self.mesh.note("more words than a line of the header has")
        if len(words) >= 2 and words[0] in PLY_TYPES:
            return Property(words[1], PLY_TYPES[words[0]])
        if len(words) >= 4 and words[0] == "list" and words[1] in PLY_TYPES and (
                words[2] in PLY_TYPES):
            if PLY_TYPES[words[1]] in "fd":
                self.mesh.note("a list whose length is a float")
            return Property(words[3], PLY_TYPES[words[2]], PLY_TYPES[words[1]])
        raise Refused(f"property {' '.join(words)!r}", notes=["a property of an unknown type"])

    def check_elements(self):
        names = [element.name for element in self.elements]
        for element in self.elements:
            of_properties = [p.name for p in element.properties]
            if len(set(of_properties)) < len(of_properties):
                self.mesh.note("two properties of one name")
            if not element.properties:
                self.mesh.note("an element without properties")
        if len(set(names)) < len(names):
            self.mesh.note("two elements of one name")
        if not {"vertex", "face"} & set(names):
            raise Refused("neither vertices nor faces", (FAILED, NO_FACES))
        if "face" in names and "vertex" in names[names.index("face"):]:
            self.mesh.note("faces before vertices")
        if "tristrips" in names or "edge" in names or "material" in names:
            self.mesh.note("edges, strips or materials")
        for element in self.elements:
            if element.name == "vertex":
                self.axes = [element.find(axis) for axis in "xyz"]
                if None in self.axes or any(
                        element.properties[i].count_kind for i in self.axes):
                    raise Refused("vertices without x, y and z", (FAILED, NO_FACES, OUT_OF_RANGE))
            if element.name == "face":
                self.corners = element.find("vertex_indices", "vertex_index")
                if self.corners is None or not element.properties[self.corners].count_kind:
                    if element.count == 0 or names.count("face") > 1:
                        self.mesh.note("no vertex_indices")
                    raise Refused("faces without vertex_indices", (FAILED, NO_FACES))
                if element.find("vertex_indices") is not None and (
                        element.find("vertex_index") is not None):
                    self.mesh.note("both vertex_index and vertex_indices")
                if element.properties[self.corners].kind in "fd":
                    self.mesh.note("vertex numbers that are floats")
        if "vertex" not in names:
            raise Refused("no vertices", (FAILED, NO_FACES, OUT_OF_RANGE))

    def take(self, element, values):
        if element.name == "vertex":
            self.mesh.vertices.append(tuple(values[i] for i in self.axes))
        elif element.name == "face":
            self.faces.append(values[self.corners])

    def text_body(self):
        lines = texts_of_lines(self.data[self.at:])
        at = 0
        for element in self.elements:
            for number in range(element.count if element.properties else 0):
                while at < len(lines) and not words_of(lines[at]):
                    at += 1
                if at == len(lines):
                    raise Refused(f"the file ends at {element.name} {number} of {element.count}")
                self.take(element, self.text_element(element, words_of(lines[at])))
                at += 1
        if any(words_of(line) for line in lines[at:]):
            self.mesh.note("more than the header says")

    def text_element(self, element, words):
        values, at = [], 0
        for p in element.properties:
            count = 1
            if p.count_kind:
                if at >= len(words) or not re.match(r"\+?\d+\Z", words[at], re.ASCII):
                    raise Refused(f"a list without its length in {element.name}")
                count = int(words[at])
                at += 1
            if count > len(words) - at:
                raise Refused(f"{element.name} with too few words")
            found = [self.text_value(element, p, word) for word in words[at:at + count]]
            values.append(found if p.count_kind else found[0])
            at += count
        if at != len(words):
            raise Refused(f"{element.name} with too many words")
        return values

    def text_value(self, element, p, word):
        matters = p.name in ("vertex_indices", "vertex_index") if element.name == "face" else (
            element.name == "vertex" and p.name in "xyz")
        if p.kind in "fd":
            if not is_number(word):
                if matters:
                    raise NotANumber([word], (FAILED, NOT_FINITE, OUT_OF_RANGE))
                self.mesh.note("a word where a number is due")
            if element.name == "face" and matters and INTEGER.match(word):
                return int(word)
            return word
        if not INTEGER.match(word):
            if matters and not is_number(word):
                raise NotANumber([word], (FAILED, NOT_FINITE, OUT_OF_RANGE))
            self.mesh.note("a word where an integer is due")
            return word
        value = int(word)
        if element.name == "face" and matters:
            return value
        return word  # -0 is an integer, too

    def binary_body(self):
        for element in self.elements:
            for _ in range(element.count if element.properties else 0):
                self.take(element, [self.binary_values(p) for p in element.properties])
        if self.at != len(self.data):
            self.mesh.note("more than the header says")

    def binary_values(self, p):
        if not p.count_kind:
            return self.unpack(p.kind, 1)[0]
        count = self.unpack(p.count_kind, 1)[0]
        if count != count or count < 0 or count != int(count):
            raise Refused("a list of a length that is no count")
        return list(self.unpack(p.kind, int(count)))

    def unpack(self, kind, count):
        size = count * struct.calcsize("<" + kind)
        if size > len(self.data) - self.at:
            raise Refused("the file ends early")
        values = struct.unpack_from(f"{self.order}{count}{kind}", self.data, self.at)
        self.at += size
        return values


def read_ply(data):
    return Ply(data).mesh


# --------------------------------------------------------------------------------------------------
# STL

def read_stl(data):
    is_solid = data.lstrip()[:5].lower() == b"solid"
    if len(data) >= 84:
        count = struct.unpack_from("<I", data, 80)[0]
        if len(data) == 84 + 50 * count or (not is_solid and len(data) > 84 + 50 * count):
            return read_binary_stl(data, count)
    if is_solid:
        return read_text_stl(data)
    raise Refused("neither a text nor as long as its count says")


def read_binary_stl(data, count):
    mesh = Mesh()
    if len(data) != 84 + 50 * count:
        mesh.note("more than the header says")
    for face in range(count):
        values = struct.unpack_from("<12f", data, 84 + 50 * face)
        for corner in range(1, 4):
            mesh.vertices.append(values[3 * corner:3 * corner + 3])
        mesh.polygons.append(Polygon([3 * face, 3 * face + 1, 3 * face + 2]))
    return mesh


class Words:
    """The words of lines one after the other, for formats where lines mean little."""

    def __init__(self, lines):
        self.lines = lines
        self.line = self.word = 0

    def peek(self):
        while self.line < len(self.lines) and self.word >= len(self.lines[self.line]):
            self.line, self.word = self.line + 1, 0
        return self.lines[self.line][self.word] if self.line < len(self.lines) else None

    def next(self):
        word = self.peek()
        if word is None:
            raise Refused("the file ends early")
        self.word += 1
        return word


class StlText(Words):
    def __init__(self, data):
        self.mesh = Mesh()
        # Every line is its words; names, which may hold keywords, end with their line.
        super().__init__([words_of(line) for line in texts_of_lines(data)])
        while self.peek() is not None:
            self.solid()

    def keyword(self, *keywords):
        for keyword in keywords:
            word = self.next()
            if word.lower() != keyword:
                is_loop = word.lower() in ("outer", "loop", "endloop") or keyword in (
                    "outer", "loop", "endloop")
                raise Refused(f"{word!r} instead of {keyword!r}", notes=[
                    "a word outside of facets" if keyword.endswith("solid") else
                    "a loop in an odd place" if is_loop else "a damaged facet"])

    def name(self):
        self.line, self.word = self.line + 1, 0

    def number(self, matters=True):
        word = self.next()
        if not is_number(word):
            if matters or word.lower() in ("outer", "facet", "vertex"):
                raise NotANumber([word])
            self.mesh.note("a word in a normal")
        elif not matters and not NUMBER.match(word):
            self.mesh.note("a normal that is not finite")
        return word

    def solid(self):
        self.keyword("solid")
        self.name()
        while (self.peek() or "").lower() == "facet":
            self.keyword("facet", "normal")
            for _ in range(3):
                self.number(matters=False)
            if (self.peek() or "").lower() == "vertex":
                self.mesh.note("a facet without 'outer loop'")
            else:
                self.keyword("outer", "loop")
            first = len(self.mesh.vertices)
            for _ in range(3):
                self.keyword("vertex")
                self.mesh.vertices.append(tuple(self.number() for _ in range(3)))
            self.keyword("endloop", "endfacet")
            self.mesh.polygons.append(Polygon([first, first + 1, first + 2]))
        if (self.peek() or "").lower() == "solid":
            self.mesh.note("a solid without an end")
            return
        self.keyword("endsolid")
        self.name()


def read_text_stl(data):
    return StlText(data).mesh


# --------------------------------------------------------------------------------------------------
# OFF

OFF_HEADER = re.compile(r"(ST)?(C)?(N)?(4)?(n)?OFF\Z")


class Off(Words):
    """Comments and line ends removed; lines matter for colours only."""

    def __init__(self, data):
        self.mesh = Mesh()
        self.mesh.has_open_end = has_open_end(data)
        lines = [words_of(line.partition("#")[0]) for line in texts_of_lines(data)]
        super().__init__([line for line in lines if line])
        try:
            self.header()
            self.counts()
            for _ in range(self.vertex_count):
                self.vertex()
            for _ in range(self.face_count):
                self.face()
        except Refused as refused:
            refused.notes += self.mesh.notes
            raise
        if self.peek() is not None:
            self.mesh.note("more than the counts say")

    def rest(self):
        """Words of the line that were not taken."""
        return self.lines[self.line][self.word:] if self.line < len(self.lines) else []

    def count(self):
        word = self.next()
        if not re.match(r"\d+\Z", word, re.ASCII):
            raise Refused(f"{word!r} is no count")
        return int(word)

    def header(self):
        self.has_texture = self.has_colour = self.has_normal = self.has_weight = False
        self.dimension = 3
        word = self.peek()
        if word is None:
            raise Refused("an empty file")
        found = OFF_HEADER.match(word)
        if not found:
            if not re.match(r"\d+\Z", word, re.ASCII):
                raise Refused(f"{word!r} is no header")
            return
        self.next()
        self.has_texture, self.has_colour, self.has_normal, self.has_weight, any_dimension = (
            bool(group) for group in found.groups())
        if any_dimension:
            self.dimension = self.count()
            if self.dimension != 3:
                raise Refused(f"{self.dimension} dimensions")
            self.mesh.note("nOFF")
        if self.has_weight:
            self.mesh.note("4OFF")

    def counts(self):
        self.vertex_count, self.face_count = self.count(), self.count()
        if re.match(r"[+-]?\d+\Z", (self.rest() or [""])[0], re.ASCII):
            self.next()
        else:
            # By the format it may stand on the next line, alone.
            if self.peek() is not None and self.word == 0 and len(self.lines[self.line]) == 1 and (
                    INTEGER.match(self.peek())):
                self.next()

    def vertex(self):
        self.peek()  # moves on to the line where it begins
        whole = 3 + self.has_weight + 3 * self.has_normal + 2 * self.has_texture
        is_alone = self.word == 0 and len(self.rest()) >= whole + 3 * self.has_colour
        words = [self.next() for _ in range(3 + self.has_weight)]
        if not all(is_number(word) for word in words):
            raise NotANumber(words)
        if self.has_weight:
            weight = words.pop()
            if not NUMBER.match(weight) or Fraction(weight) == 0 or not all(
                    NUMBER.match(word) for word in words):
                raise Refused(f"a weight of {weight}", (FAILED, NOT_FINITE))
            words = [Quotient(word, weight) for word in words]
        self.mesh.vertices.append(tuple(words))
        extra = 3 * self.has_normal + 4 * self.has_colour + 2 * self.has_texture
        if is_alone:
            # Colours of three or four numbers are both in use: the line tells.
            rest = self.rest()
            if len(rest) not in (extra, extra - self.has_colour):
                self.mesh.note("more numbers behind a vertex than the header says")
            if not all(NUMBER.match(word) for word in rest):
                self.mesh.note("a word behind a vertex")
            self.word += len(rest)
        else:
            for _ in range(extra):
                if not NUMBER.match(self.next()):
                    self.mesh.note("a word behind a vertex")

    def face(self):
        self.peek()
        count = self.count()
        corners = []
        for _ in range(count):
            word = self.next()
            corners.append(int(word) if INTEGER.match(word) else word)
        colour = self.rest() if self.word else []
        self.word += len(colour)
        if len(colour) > 4 or not all(NUMBER.match(word) for word in colour):
            self.mesh.note("an odd colour of a face")
        malformed = any(isinstance(corner, str) for corner in corners)
        if malformed and count < 3:
            raise NotANumber(corners, (FAILED, OUT_OF_RANGE))
        self.mesh.add_face(corners, is_malformed=malformed)


def read_off(data):
    return Off(data).mesh


# --------------------------------------------------------------------------------------------------

READERS = {".obj": read_obj, ".ply": read_ply, ".stl": read_stl, ".off": read_off}


def read(path):
    """The mesh of a file as it says it, before rounding."""
    with open(path, "rb") as file:
        data = file.read()
    if not data:
        raise Refused("an empty file")
    extension = os.path.splitext(path)[1].lower()
    odd = []
    if extension in (".off", ".obj") and re.search(rb"\0|\\[^\r\n]", data):
        odd = ["a backslash or a zero byte within a line"]
    try:
        mesh = READERS[extension](data)
    except Refused as refused:
        refused.notes += odd
        raise
    mesh.notes += odd
    return mesh


class Taken:
    """What an importer makes of a mesh: corners as bits, faces that were taken and skipped."""

    def __init__(self, mesh, precision, skip_bad=False):
        to_bits = f32_bits if precision == "f32" else f64_bits
        infinity = 0x7F800000 if precision == "f32" else 0x7FF0000000000000
        self.mesh = mesh
        self.notes = list(mesh.notes)
        self.bits = [tuple(to_bits(number) for number in vertex) for vertex in mesh.vertices]
        is_finite = [all(bits & infinity != infinity for bits in vertex) for vertex in self.bits]
        self.polygons, self.skipped = [], []  # pairs of face id and polygon; face ids
        faults = set()
        for face_id, polygon in enumerate(mesh.polygons):
            fault = self.fault(polygon, is_finite)
            faults |= fault
            if fault:
                self.skipped.append(face_id)
            else:
                self.polygons.append((face_id, polygon))
        if any(polygon.is_malformed for polygon in mesh.polygons):
            self.notes.append("a damaged vertex or corner")
        if faults and not skip_bad:
            raise Refused("bad faces", faults, self.notes)
        if not self.polygons:
            raise Refused("no faces", faults | {NO_FACES, FAILED}, self.notes)

    @staticmethod
    def fault(polygon, is_finite):
        if polygon.is_malformed:
            return {FAILED, OUT_OF_RANGE}
        found = set()
        for corner in polygon.corners:
            if not isinstance(corner, int) or not 0 <= corner < len(is_finite):
                found.add(OUT_OF_RANGE)
            elif not is_finite[corner]:
                found.add(NOT_FINITE)
        return found

    def corners(self, polygon):
        return [self.bits[corner] for corner in polygon.corners]


def main(arguments):
    paths = [argument for argument in arguments if not argument.startswith("--")]
    for path in paths:
        try:
            mesh = read(path)
            taken = Taken(mesh, "f64" if "--f64" in arguments else "f32",
                          "--skip-bad" in arguments)
        except Refused as refused:
            print(f"{path}: refused ({', '.join(sorted(refused.codes))}): {refused}")
            continue
        print(f"{path}: {len(mesh.polygons)} faces, {len(mesh.vertices)} vertices, "
              f"{mesh.lines} lines, {mesh.points} points, {len(taken.skipped)} skipped; "
              f"notes: {', '.join(taken.notes) or 'none'}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
