#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The README's picture shows what the cooker makes today: drawn again, it is the same but for a
thousandth of full scale on average, which another version of the library that scales it may differ by.

    picture_test.py SOURCE_DIR BOXTREE
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageChops, ImageStat

MAX_MEAN_DIFFERENCE = 0.255  # of 255


def difference(first, second):
    return max(ImageStat.Stat(ImageChops.difference(first, second)).mean)


def main():
    folder = pathlib.Path(sys.argv[1]) / "docs/picture"
    with tempfile.TemporaryDirectory() as work:
        drawn = pathlib.Path(work) / "boxes.png"
        subprocess.run([folder / "draw.sh", sys.argv[2], drawn], check=True)
        committed, again = (Image.open(path).convert("RGBA") for path in (folder / "boxes.png", drawn))
    assert committed.size == again.size, (committed.size, again.size)
    # Two panels that have changed places are a difference that must be noticed.
    width, height = again.size
    swapped = again.copy()
    swapped.paste(again.crop((0, 0, width // 5, height)), (width // 5, 0))
    assert difference(committed, swapped) > 10 * MAX_MEAN_DIFFERENCE
    assert difference(committed, again) <= MAX_MEAN_DIFFERENCE, difference(committed, again)


if __name__ == "__main__":
    main()
