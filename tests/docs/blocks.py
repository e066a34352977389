#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fenced code blocks of a Markdown page: `blocks.py PAGE sh` prints those of one language in a row."""
import pathlib
import re
import sys


def blocks_of(page):
    """[(language, text, line number)] in the order of the page."""
    text = pathlib.Path(page).read_text(encoding="utf-8")
    return [(found.group(1), found.group(2), text.count("\n", 0, found.start()) + 1)
            for found in re.finditer(r"^```(\w+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)]


if __name__ == "__main__":
    sys.stdout.write("".join(text for language, text, _ in blocks_of(sys.argv[1])
                             if language == sys.argv[2]))
