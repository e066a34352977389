#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Damaged files with good checksums, before both readers: what `boxtree verify` accepts, the second
reader (tests/golden/read_bxt.py, written from docs/FORMAT.md alone) must accept, too. What ours
refuses and theirs accepts is counted by code: theirs does not look at everything.

    two_readers_test.py VERIFY GOLDEN_DIR CORPUS_DIR [--files N] [--seed S]
"""
import argparse
import collections
import glob
import random
import struct
import subprocess
import sys

import xxhash

QUERY_BYTES = 64  # behind each file of the corpus


def places(data):
    """Offset and size of each section that lies in the file, in the order of the table."""
    count = struct.unpack_from("<I", data, 12)[0]
    end = 32 + 16 * count
    found = []
    for i in range(count if end <= len(data) else 0):
        size = struct.unpack_from("<Q", data, 32 + 16 * i)[0] & (1 << 40) - 1
        offset = end + -end % (8 if size < 4096 else 64)
        end = offset + size
        if end > len(data):
            break
        found.append((offset, size))
    return found


def repair(data):
    """Makes the checksums of sections and header right again."""
    end = 32 + 16 * struct.unpack_from("<I", data, 12)[0]
    if end > len(data):
        return
    for i, (offset, size) in enumerate(places(data)):
        body = bytes(data[offset:offset + size])
        struct.pack_into("<Q", data, 32 + 16 * i + 8, xxhash.xxh3_64_intdigest(body))
    head = bytes(data[:24]) + bytes(data[32:end])
    struct.pack_into("<Q", data, 24, xxhash.xxh3_64_intdigest(head))


def sections(data):
    return [place for place in places(data) if place[1]]


def damaged(whole, rng):
    data = bytearray(whole)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        if rng.random() < 0.1:
            offset, size = 0, min(len(data), 32 + 16 * len(sections(whole)))
        else:
            offset, size = rng.choice(sections(whole))
        width = rng.choice([w for w in (1, 2, 4, 8) if w <= size])
        at = offset + width * rng.randrange(size // width)
        value = int.from_bytes(data[at:at + width], "little")
        top = 1 << (8 * width)
        value = rng.choice((value + 1, value - 1, 0, top - 1, value ^ 1 << rng.randrange(8 * width),
                            rng.randrange(top))) % top
        data[at:at + width] = value.to_bytes(width, "little")
    repair(data)
    return bytes(data)


class Ours:
    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def answer(self, data):
        self.process.stdin.write(struct.pack("<I", len(data)) + data)
        self.process.stdin.flush()
        return self.process.stdout.readline().decode(errors="replace").rstrip("\n")


def theirs(read_bxt, data):
    try:
        read_bxt.read(data)
    except (read_bxt.Broken, struct.error, UnicodeDecodeError, IndexError, ArithmeticError) as broken:
        return f"{type(broken).__name__}: {broken}"
    return "ok"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("verify")
    parser.add_argument("golden")
    parser.add_argument("corpus")
    parser.add_argument("--files", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    sys.path.insert(0, arguments.golden)
    import read_bxt  # pylint: disable=import-outside-toplevel

    wholes = [bytes.fromhex(open(path, encoding="ascii").read())
              for path in sorted(glob.glob(arguments.golden + "/v*.hex"))]
    for path in sorted(glob.glob(arguments.corpus + "/*")):
        with open(path, "rb") as file:
            wholes.append(file.read()[:-QUERY_BYTES])
    ours = Ours(arguments.verify)
    wholes = [whole for whole in wholes if ours.answer(whole) == "ok"]
    if len(wholes) < 10:
        sys.exit(f"only {len(wholes)} whole files to begin with")
    for whole in wholes:
        said = theirs(read_bxt, whole)
        if said != "ok":
            sys.exit(f"the second reader refuses a whole file: {said}")

    rng = random.Random(arguments.seed)
    both = collections.Counter()
    only_ours = collections.Counter()
    for number in range(arguments.files):
        data = damaged(rng.choice(wholes), rng)
        first, second = ours.answer(data), theirs(read_bxt, data)
        if first == "ok" and second != "ok":
            with open(f"two-readers-{number}.bxt", "wb") as file:
                file.write(data)
            sys.exit(f"verify accepts two-readers-{number}.bxt, the second reader does not: {second}")
        both[first == "ok", second == "ok"] += 1
        if first != "ok" and second == "ok":
            only_ours[first.split(":")[0]] += 1
    if not both[True, True] or not both[False, False]:
        sys.exit("no file was accepted, or none refused")
    print(f"{arguments.files} files: {both[True, True]} accepted by both, {both[False, False]} "
          f"refused by both, {both[False, True]} refused by ours alone: "
          + ", ".join(f"{code} {count}" for code, count in only_ours.most_common()))


if __name__ == "__main__":
    main()
