#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The report's page in a real browser: it renders, says nothing on the console, uses no network,
follows light and dark, and a telephone needs no sideways scrolling but inside tables and plots.

    report_page_test.py BOXTREE

Without chromium it skips (exit 77).
"""
import html
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77  # what ctest is told to take for "skipped"
PROBE = """<script>document.documentElement.setAttribute("data-probe", JSON.stringify([
document.documentElement.scrollWidth, window.innerWidth,
performance.getEntriesByType("resource").length,
Math.min(...[...document.querySelectorAll("svg")].map(s => s.getBoundingClientRect().width)),
getComputedStyle(document.body).backgroundColor]))</script>"""


# Windows without a head are never narrower than 500 pixels; a frame in one may be.
FRAME = """<!DOCTYPE html><meta charset="utf-8"><body><iframe width="400" height="900" srcdoc="{}">
</iframe><script>addEventListener("load", () => document.documentElement.setAttribute("data-probe",
document.querySelector("iframe").contentDocument.documentElement.getAttribute("data-probe")))
</script></body>"""


def write_mesh(path):
    """A wavy square of 24 x 24 cells, two triangles each."""
    cells = 24
    with open(path, "w", encoding="ascii") as file:
        for y in range(cells + 1):
            for x in range(cells + 1):
                file.write(f"v {x / 7} {y / 7} {(x * x + 3 * y) % 11 / 9}\n")
        for y in range(cells):
            for x in range(cells):
                first = y * (cells + 1) + x + 1
                below = first + cells + 1
                file.write(f"f {first} {first + 1} {below + 1}\nf {first} {below + 1} {below}\n")


def browse(chromium, page, *options):
    """Runs the browser once. Returns its standard output; fails on any message of the console."""
    result = subprocess.run(
        [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
         "--no-first-run", "--hide-scrollbars", "--enable-logging=stderr", "--log-level=0",
         f"--user-data-dir={os.path.abspath('profile')}", *options,
         f"file://{os.path.abspath(page)}"],
        capture_output=True, text=True, timeout=240, check=True)
    said = [line for line in result.stderr.splitlines() if "CONSOLE" in line]
    assert not said, f"console: {said}"
    return result.stdout


def probe(chromium, page, *options):
    dom = browse(chromium, page, "--dump-dom", *options)
    found = re.search(r'<html[^>]* data-probe="([^"]+)"', dom)
    assert found, "the page was not rendered"
    width, window, resources, narrowest, back = re.fullmatch(
        r'\[([\d.]+),([\d.]+),([\d.]+),([\d.]+),(.*)\]',
        found[1].replace("&quot;", '"')).groups()
    assert resources == "0", f"{resources} resources requested"
    assert float(width) <= float(window), f"{width} wide in a window of {window}"
    assert float(narrowest) > 300, f"a plot of {narrowest} pixels cannot be read"
    return float(window), [int(part) for part in re.findall(r"\d+", back)[:3]], dom


def colours(path):
    """The different pixels of a PNG file that a browser wrote: 8 bits, RGB or RGBA."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            header = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += size + 12
    width, height, depth, colour = header
    assert depth == 8 and colour in (2, 6), header
    each = 3 if colour == 2 else 4
    raw, line = zlib.decompress(packed), bytes(width * each)
    found = set()
    for y in range(height):
        start = y * (width * each + 1)
        kind, now = raw[start], bytearray(raw[start + 1:start + 1 + width * each])
        for i in range(len(now)):
            left = now[i - each] if i >= each else 0
            corner = line[i - each] if i >= each else 0
            up = line[i]
            if kind == 1:
                now[i] = (now[i] + left) & 255
            elif kind == 2:
                now[i] = (now[i] + up) & 255
            elif kind == 3:
                now[i] = (now[i] + (left + up) // 2) & 255
            elif kind == 4:
                near = left + up - corner
                best = min((left, up, corner), key=lambda value: abs(near - value))
                now[i] = (now[i] + best) & 255
        line = bytes(now)
        found.update(line[i:i + 3] for i in range(0, len(line), each))
    return found


def main(boxtree):
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        print("skipped: chromium is not installed")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        write_mesh("wavy.obj")
        subprocess.run([boxtree, "report", "wavy.obj", "-o", "report.html", "--quick",
                        "--no-times"], check=True, stdout=subprocess.DEVNULL)
        with open("report.html", encoding="utf-8") as file:
            page = file.read()
        assert "<script" not in page and "http" not in page
        with open("probe.html", "w", encoding="utf-8") as file:
            file.write(page.replace("</body>", PROBE + "</body>"))
        _, light, dom = probe(chromium, "probe.html", "--window-size=1200,900")
        assert dom.count("<svg") == page.count("<svg") >= 23, "plots were lost"
        assert min(light) > 200, f"light: {light}"
        _, dark, _ = probe(chromium, "probe.html", "--window-size=1200,900",
                           "--blink-settings=preferredColorScheme=0")
        assert max(dark) < 60, f"dark: {dark}"
        with open("frame.html", "w", encoding="utf-8") as file:
            file.write(FRAME.format(html.escape(page.replace("</body>", PROBE + "</body>"))))
        narrow, _, _ = probe(chromium, "frame.html")
        assert narrow <= 400, f"the narrow window is {narrow} wide"
        browse(chromium, "report.html", "--window-size=1000,2400", "--screenshot=shot.png")
        seen = colours("shot.png")
        assert len(seen) > 20, f"a picture of {len(seen)} colours is empty"
        assert bytes(light) in seen, "the background is not there"
    print(f"rendered in light, in dark and {narrow:.0f} pixels wide, without a word on the console")


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
