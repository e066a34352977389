#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The examples of FORMAT.md 8.1 are what the cooker writes: its commands give the bytes that it shows, every
row of its tables is what is at that bit, and the second reader finds the same corners.

    format_example_test.py SOURCE_DIR BOXTREE
"""
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

from blocks import blocks_of

SIGN_BITS = 32  # of origin, the only field with a sign


def rows_of(text, first_column):
    """Cells of the rows of all tables whose first column has that title, one list for each table."""
    tables = []
    for table in re.findall(r"(?:^\|.*\|\n)+", text, re.MULTILINE):
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        if rows[0][0] == first_column:
            tables.append(rows[2:])
    return tables


def numbers(cell):
    return [int(number) for number in cell.split(",")]


class Example:
    def __init__(self, source, boxtree, reader, text, blocks, work, name="crate", is_whole=True):
        self.text = text
        (_, command, _), (_, shown, _) = blocks
        assert command.startswith("boxtree cook ") and command.count("\n") == 1, command
        arguments = command.split()[1:]
        output = work / arguments[arguments.index("-o") + 1]
        arguments[arguments.index("-o") + 1] = str(output)
        subprocess.run([boxtree, *arguments, "-q"], cwd=source, check=True)
        self.file_bytes = output.read_bytes()
        file = reader.File(self.file_bytes)
        records = file.section(1)
        trees = [reader.Tree(file, i, records[128 * i:128 * (i + 1)]) for i in range(len(records) // 128)]
        self.tree = next(tree for tree in trees if tree.name == name)
        self.number = trees.index(self.tree)
        self.bytes = bytes.fromhex(shown)
        table = bytes([1, 0, 0, 0])  # the only cluster begins at byte 4
        shown = table + self.bytes
        assert self.tree.vertices[:len(shown)] == shown, self.tree.vertices.hex(" ")
        assert not is_whole or self.tree.vertices[len(shown):] == bytes(72), self.tree.vertices.hex(" ")
        self.read = self.record_strips(reader)

    def record_strips(self, reader):
        """Of each leaf, what the second reader makes of it: the vertices of each face."""
        strips = []

        class Recorded(reader.Clusters):
            def strip(self, *arguments):
                faces, references, end = super().strip(*arguments)
                strips.append([[references[reference] for reference in face] for face in faces])
                return faces, references, end

        Recorded(self.tree)
        return strips

    def check_fields(self, is_whole):
        whole = int.from_bytes(self.bytes, "little")
        covered, fields = 0, {}
        for row in sum(rows_of(self.text, "from"), []):
            byte, bit = row[0].split(".")
            if " x " in row[1]:
                count, width = (int(part) for part in row[1].split(" x "))
                widths = [width] * count
            else:
                widths = [int(part) for part in row[1].split(" + ")]
            shown, at, found, bits = numbers(row[3]), 8 * int(byte) + int(bit), [], 0
            for width in widths:
                found.append((whole >> at) & ((1 << width) - 1))
                bits |= ((1 << width) - 1) << at
                at += width
            if widths[0] == SIGN_BITS:
                found = [value - (value >> (SIGN_BITS - 1) << SIGN_BITS) for value in found]
            assert found == shown, (row, found)
            fields[row[2]] = found
            if len(row) == 5:
                group = int(row[2].split()[1]) // fields["group_size"][0]
                for k, axis in enumerate("xyz"):
                    base = fields.get(f"base of {axis}", [0])[group] << fields.get("base_shift", [0] * 3)[k]
                    assert numbers(row[4])[k] == fields["origin"][k] + base + found[k], row
                    wider = fields.get(f"wider of {axis}", [0])[group]
                    assert widths[k] == fields["width"][k] + wider, row
            assert covered & bits == 0, f"two rows have bits of {row}"
            covered |= bits
        assert not is_whole or whole & ~covered == 0, "bits that no row shows"

    def check_faces(self):
        tables = rows_of(self.text, "face")
        assert len(tables) == len(self.read), (len(tables), len(self.read))
        for rows, faces in zip(tables, self.read):
            entered = 0
            assert [numbers(row[3 if len(row) == 5 else 1]) for row in rows] == faces, (rows, faces)
            for row in rows:
                if len(row) != 5:
                    continue
                if row[2] == "apart":
                    assert row[1] == "none" and row[4] == "0", row
                else:
                    side, turn, e = numbers(row[2])
                    assert int(row[1]) == 3 * side + turn and e == entered + 1 + side and row[4] == str(turn), row
                entered = int(row[4])


def check_export(source, boxtree, text, crate):
    """The command below the examples writes the faces that the second reader finds, in its order."""
    command = text[text.index("```sh\n") + 6:text.index("\n```\n")]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "crate.bxt").write_bytes(crate.file_bytes)
        words = command.split()
        assert words[0] == "boxtree", command
        subprocess.run([boxtree, *words[1:]], cwd=work, check=True, stdout=subprocess.DEVNULL)
        lines = [line.split() for line in (work / "crate.obj").read_text(encoding="utf-8").splitlines()]
    vertices = [[float(x) for x in line[1:]] for line in lines if line[:1] == ["v"]]
    faces = [[vertices[int(number) - 1] for number in line[1:]] for line in lines if line[:1] == ["f"]]
    step = 2.0 ** crate.tree.grid_exponent
    assert faces == [[[x * step for x in point] for point in face] for face in crate.tree.clusters.faces]


def main():
    source, boxtree = pathlib.Path(sys.argv[1]), sys.argv[2]
    sys.path.insert(0, str(source / "tests/golden"))
    import read_bxt  # pylint: disable=import-outside-toplevel
    page = source / "docs/FORMAT.md"
    text = page.read_text(encoding="utf-8")
    start = text.index("#### Example")
    middle = text.index("```sh", text.index("```hex", start))
    third = text.index("With geometry exact the fields", middle)
    end = re.compile(r"\n##+ ").search(text, third).start()
    blocks = [block for block in blocks_of(page)
              if text.count("\n", 0, start) < block[2] <= text.count("\n", 0, end)]
    assert [language for language, _, _ in blocks] == ["sh", "hex"] * 3, "three examples"
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        level, quads = (Example(source, boxtree, read_bxt, part, blocks[2 * i:2 * i + 2], work)
                        for i, part in enumerate((text[start:middle], text[middle:third])))
        exact = Example(source, boxtree, read_bxt, text[third:end], blocks[4:], work, "wall", is_whole=False)
    level.check_fields(True)
    level.check_faces()
    quads.check_fields(False)
    quads.check_faces()
    exact.check_fields(False)
    check_export(source, boxtree, text[end:], level)
    # What the text says of the trees.
    assert f"The tree `crate`, number {level.number}, of" in text
    assert (level.tree.geometry, level.tree.corners_per_face, level.tree.exponent,
            level.tree.grid_exponent, level.tree.face_count) == (read_bxt.GRID, 3, -15, -16, 12)
    assert not any(level.tree.origin)
    assert {abs(x) * 2.0 ** -16 for face in level.tree.clusters.faces for point in face for x in point} == {
        0.399993896484375}
    assert (quads.tree.geometry, quads.tree.corners_per_face, quads.tree.face_count) == (read_bxt.GRID, 4, 6)
    assert f"The tree `wall`, number {exact.number}, of" in text
    assert (exact.tree.geometry, exact.tree.face_count) == (read_bxt.EXACT, 48)
    vertices = {tuple(point) for face in exact.tree.clusters.faces for point in face}
    for words in (0x40000000, 0x3f800000, 0x3e19999a), (0xc0000000, 0x3f800000, 0x3e19999a):
        assert all(f"{word:X}" in text[third:end] for word in words), words
        assert struct.unpack(">3f", struct.pack(">3I", *words)) in vertices, words
    assert [536870912 << 1, 254 << 22, 520932557 << 1] == [0x40000000, 0x3f800000, 0x3e19999a]
    assert (-1 - -536870913) << 1 | 1 << 31 == 0xc0000000
    print("the examples are as cooked")


if __name__ == "__main__":
    main()
