#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Links of the pages lead to files and headings that are there, and the guide lists all of its sections.

links_test.py SOURCE
"""
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1]).resolve()
failures = []


def without_code(text):
    """The text without blocks and spans of code, in which brackets are no links."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "", text)


def anchor_of(heading):
    """The anchor of a heading that no other has, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors(page):
    """The anchors of a page's headings."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
    found = []
    for heading in re.findall(r"^#{1,6} +(.+?) *$", text, flags=re.M):
        name = anchor_of(heading)
        found.append(f"{name}-{found.count(name)}" if name in found else name)
    return found


pages = [page for folder in ("", "docs", "samples", "tests", "tools") for page in (
    (source / folder).glob("*.md") if folder == "" else (source / folder).rglob("*.md"))]
assert len(pages) > 10, pages
links = 0
for page in pages:
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        links += 1
        path, _, anchor = target.partition("#")
        to = (page.parent / path).resolve() if path else page
        if not to.exists():
            failures.append(f"{page.relative_to(source)}: {target}: no such file")
        elif anchor and to.suffix == ".md" and anchor not in anchors(to):
            failures.append(f"{page.relative_to(source)}: {target}: no such heading")
assert links > 50, links

guide = source / "docs" / "GUIDE.md"
listed = re.findall(r"\]\(#([^)]+)\)", re.search(r"^Sections: .*?\n\n", guide.read_text(), re.M | re.S)[0])
sections = re.findall(r"^## +(.+?) *$", without_code(guide.read_text()), re.M)
for section in sections:
    if anchor_of(section) not in listed:
        failures.append(f"docs/GUIDE.md: the section '{section}' is not in the list at its top")

for failure in failures:
    print(failure)
print(f"{len(pages)} pages, {links} links, {len(sections)} sections")
sys.exit(1 if failures else 0)
