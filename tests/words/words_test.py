#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""No page, comment, message or name uses a private term where the field has one.

    words_test.py SOURCE_DIR       exit 1 and a line for each use, with the term to write instead
"""
import pathlib
import re
import sys

# A private term and what to write instead. Words are whole words of text or parts of identifiers.
TERMS = [
    (r"ask(s|ed|ing)?", "query, need, request"),
    (r"questions?(?![ _]marks?\b)", "query, queries"),
    (r"(the|our|whole) house|arrows?", "architecture, folders, dependencies"),
    (r"yardsticks?", "the baseline"),
    (r"a face a leaf", "one triangle per leaf"),
    (r"(node|nodes|pairs?|them|it|both|boxes) (is |are |were )?(taken|takes?) apart|takes? \w+ (nodes? )?apart",
     "expanded"),
    (r"beyond doubt", "conservatively, provably"),
    (r"(the|beyond|within|of|larger|`)\s?reach(?!es|ed|ing|able)\b|\w+_reach|reach_(of|error)|kReach",
     "the largest absolute coordinate"),
    (r"stands? behind (its|their) parents?", "has a larger index than its parent"),
    (r"starts? anew", "is re-based at the root-box entry"),
    (r"is_sound|kSound|judge[sd]?|verdicts?", "is_valid, classify, classification"),
    (r"near_enough|is_near_enough|near enough", "converged"),
    (r"FaceRef::order", "index"),
    (r"hit or free|hit, free|free or hit|hits and frees", "overlapping, disjoint"),
    (r"dearer", "slower"),
    (r"quietly|plainly", "scalar"),
    (r"for who(ever)? wants?|of one's own", "(drop it)"),
    (r"what takes the fewest bytes", "the smallest candidate within the budget wins"),
    (r"digits that the boxes of f32 positions do not have", "skipped: the mesh is f32"),
    (r"defect of boxtree", "internal error"),
    (r"knows better", "is stricter"),
]
SUFFIXES = {".md", ".h", ".cpp", ".py", ".sh", ".txt", ".cmake", ".in", ".toml", ".json"}
# The list itself; recorded inputs; a language's own keywords and other people's names.
LEFT_OUT = re.compile(r"^(tests/words/|tests/fuzz/corpus/|tests/golden/.*\.hex$|build)")


def uses(text):
    text = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text)
    for term, instead in TERMS:
        # Parts of identifiers are words, too, in snake_case and now in CamelCase.
        for found in re.finditer(r"(?<![A-Za-z])(?:%s)(?![A-Za-z])" % term, text, re.IGNORECASE):
            yield text.count("\n", 0, found.start()) + 1, found.group(0), instead


def main():
    root = pathlib.Path(sys.argv[1])
    planted = "// The tree is asked a question beyond doubt; its reach, a verdict: near_enough.\n"
    assert len({word for _, word, _ in uses(planted)}) >= 5, "the check finds nothing"
    count = 0
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in SUFFIXES or LEFT_OUT.match(name) or "/." in "/" + name:
            continue
        for line, word, instead in uses(path.read_text(encoding="utf-8", errors="replace")):
            print(f"{name}:{line}: '{' '.join(word.split())}': write {instead}")
            count += 1
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
