#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The API reference: built without a warning, the same bytes twice, and whole. What it must have is read from the headers, the
pages and the samples. Then faults are planted in a copy, each of which must be noticed.

    reference_test.py SOURCE_DIR
"""
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

C_HEADER = "runtime/include/boxtree_c.h"
INCLUDES = ("format/include/boxtree", "runtime/include/boxtree")
# Headers of queries: each function of theirs is on a page, beside its own.
QUERIES = ("ray", "cast", "collide", "overlap", "closest", "contact", "distance", "traverse", "scene")

TYPE = re.compile(r"^(?:struct|(?:enum )?class)\s+(?:\[\[nodiscard\]\]\s+)?(\w+)[^;]*\{", re.MULTILINE)
ALIAS = re.compile(r"^using (\w+) =", re.MULTILINE)
CONSTANT = re.compile(r"^inline constexpr \S+ (\w+) =", re.MULTILINE)
FUNCTION = re.compile(r"^(?!using|class|struct|template|static_assert|inline constexpr)"
                      r"(?:[\w:<>&\[\]]+ )+[&*]?(\w+)\(", re.MULTILINE)
ENUM = re.compile(r"^enum class (\w+).*?\{(.*?)^\};", re.MULTILINE | re.DOTALL)
ENUMERATOR_ROW = re.compile(r'</a>(k\w+)&#160;</td><td class="fielddoc">(?:<p[^>]*>)?\s*([^<]*)')
ENUMERATOR = re.compile(r"^\s+(k\w+)", re.MULTILINE)


def text_of(page):
    """What a reader sees of a page, with single blanks."""
    return " ".join(html.unescape(re.sub(r"<[^>]*>", "", page.read_text(encoding="utf-8"))).split())


class Reference:
    def __init__(self, source):
        self.source = source
        self.out = source / "reference"

    def build(self):
        """What the build printed and whether it succeeded."""
        shutil.rmtree(self.out, ignore_errors=True)
        run = subprocess.run([self.source / "docs/api/build.sh", self.out, "1.2.3"], text=True, check=False,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return run.stdout, run.returncode == 0

    def headers(self):
        return sorted(path for folder in INCLUDES for path in (self.source / folder).glob("*.h"))

    def pages(self):
        """{id: source} of the Markdown pages."""
        result = {}
        for path in sorted((self.source / "docs/api").glob("*.md")):
            text = path.read_text(encoding="utf-8")
            result[re.match(r"# .* \{#(\w+)\}\n", text)[1]] = text
        return result

    def faults(self):
        """What is missing in the reference that was built."""
        return self.faults_of_headers() + self.faults_of_c() + self.faults_of_pages() + self.faults_of_samples() + self.faults_of_errors()

    def page(self, name):
        return self.out / ("index.html" if name == "mainpage" else f"{name}.html")

    def faults_of_headers(self):
        faults = []
        linked = "".join(self.page(name).read_text(encoding="utf-8") for name in self.pages())
        for header in self.headers():
            page = self.out / f"group__{header.stem.replace('_', '__')}__h.html"  # as Doxygen writes _
            if not page.exists():
                faults.append(f"{header.name} has no page")
                continue
            # The mark of what a shared library exports is no part of a declaration.
            code = header.read_text(encoding="utf-8").replace("BOXTREE_API ", "")
            seen = text_of(page)
            if f"boxtree/{header.name}" not in seen:
                faults.append(f"{header.name}: the page does not name it")
            functions = FUNCTION.findall(code)
            for name in TYPE.findall(code) + ALIAS.findall(code) + CONSTANT.findall(code) + functions:
                if not re.search(rf"boxtree::{name}\b", seen):
                    faults.append(f"{header.name}: {name} is not in the reference")
            # Doxygen 1.9.4 warns of no enumerator.
            described = dict(ENUMERATOR_ROW.findall(page.read_text(encoding="utf-8")))
            faults += [f"{header.name}: {enum}::{name} is not documented" for enum, body in ENUM.findall(code)
                       for name in ENUMERATOR.findall(body) if not described.get(name)]
            if header.stem in QUERIES:
                faults += [f"{header.name}: no page leads to {name}" for name in functions
                           if not re.search(rf'href="group__\w+\.html#\w+"[^>]*>(boxtree::)?{name}(\(\))?</a>', linked)]
        return faults

    def faults_of_c(self):
        """Whatever the C header declares is on its page, in words."""
        page = self.out / "group__boxtree__c__h.html"
        text = (self.source / C_HEADER).read_text(encoding="utf-8")
        code = re.sub(r"//.*", "", text)
        code = code[code.index("BXT_ABI_VERSION"):]
        names = set(re.findall(r"^BXT_API [^(]*[ *](bxt_\w+)\(|^static inline \w+ (bxt_\w+)\(|\} (bxt_\w+);|\(\*(bxt_\w+)\)\("
                               r"|^#define (BXT_[A-Z_]+) ", code, re.MULTILINE))
        names = {name for found in names for name in found if name}
        seen = text_of(page)
        rows = re.findall(r'</a>(BXT_\w+)&#160;</td><td class="fielddoc">(.*?)</td>', page.read_text(encoding="utf-8"), re.DOTALL)
        described = {name: re.sub(r"<[^>]*>|\s", "", text) for name, text in rows}
        enumerators = set(re.findall(r"^\s+(BXT_\w+) =", code, re.MULTILINE))
        faults = [f"boxtree_c.h: {name} is not in the reference" for name in sorted(names)
                  if not re.search(rf"\b{name}\b", seen)]
        faults += [f"boxtree_c.h: {name} is not documented" for name in sorted(enumerators) if not described.get(name)]
        # Doxygen warns of no member of theirs. Plain structs, as bxt_vec3, may have some that speak for themselves.
        for body in re.findall(r"^typedef struct bxt_\w+ \{\n(.*?)^\}", text, re.MULTILINE | re.DOTALL):
            lines = [""] + body.splitlines()
            faults += [f"boxtree_c.h: {line.strip()} is not documented" for before, line in zip(lines, lines[1:])
                       if "///" in body and ";" in line and "///" not in line and not before.strip().startswith("///")]
        return faults if len(names) > 140 and len(enumerators) > 60 else faults + ["boxtree_c.h is not read as it is written"]

    def faults_of_pages(self):
        tree = (self.out / "navtreedata.js").read_text(encoding="utf-8")
        first = self.page("mainpage").read_text(encoding="utf-8")
        return [f"page {name} is not in the tree, or the first page does not lead to it" for name in self.pages()
                if f'"{self.page(name).name}"' not in tree or
                (name != "mainpage" and f'href="{name}.html"' not in first)]

    def faults_of_samples(self):
        faults = []
        pages = {text_of(self.page(name)) for name in self.pages()}
        for program in sorted((self.source / "samples/api").glob("*.cpp")):
            lines = [" ".join(line.split()) for line in program.read_text(encoding="utf-8").splitlines()]
            if not any(all(line in page for line in lines) for page in pages):
                faults.append(f"samples/api/{program.name} is on no page")
        listed = text_of(self.out / "examples.html")
        for program in sorted((self.source / "samples").glob("*/*.c*")):
            name = program.relative_to(self.source / "samples").as_posix()
            is_program = re.search(r"^int main\(", program.read_text(encoding="utf-8"), re.MULTILINE)
            if is_program and not name.startswith("api/") and name not in listed:
                faults.append(f"samples/{name} is not among the programs")
        return faults

    def faults_of_errors(self):
        """The table of the page has the numbers of the header and the rows of error.cpp; so have the comments of the header."""
        code = (self.source / INCLUDES[0] / "error.h").read_text(encoding="utf-8")
        numbers = dict(re.findall(r"^  (k\w+) = (\d+),", code, re.MULTILINE))
        rows = re.findall(r'ErrcInfo\{Errc::(\w+),\s*"(\w+)",\s*"([^"]+)",\s*(\d)\}',
                          (self.source / "format/error.cpp").read_text(encoding="utf-8"))
        seen, on_page = text_of(self.page("errors")), text_of(self.page("group__error__h"))
        faults = [f"{name} has no row in error.cpp" for name in numbers if name not in dict(row[:2] for row in rows)]
        faults += [f"error.h says something else of {row[0]} than error.cpp" for row in rows
                   if f"{row[0]} {row[2][0].upper()}{row[2][1:]}." not in on_page]
        return faults + [f"errors.md lacks the row of {row[1]}" for row in rows
                         if " ".join((numbers[row[0]], *row[1:])) not in seen]


def copy_of(source, folder):
    for name in ("docs/api", *INCLUDES, "samples"):
        shutil.copytree(source / name, folder / name)
    for name in ("format/error.cpp", C_HEADER):
        shutil.copy(source / name, folder / name)
    return Reference(folder)


def bytes_of(folder):
    return {path.relative_to(folder): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


# What is planted: file, text, what takes its place, and what must be said of it: by Doxygen, ...
WARNED_OF = [
    ("runtime/include/boxtree/ray.h", "}  // namespace boxtree", "int planted_function(const Tree& tree);\n\n}  // namespace boxtree",
     r"ray\.h:\d+: .*planted_function.* is not documented"),
    ("runtime/include/boxtree/tree.h", " private:\n", "  int planted_member() const;\n\n private:\n", r"planted_member.* is not documented"),
    ("runtime/include/boxtree/ray.h", "struct RayHit {\n", "struct RayHit {\n  int planted_field;\n", r"planted_field.* is not documented"),
    ("runtime/include/boxtree/query.h", "}  // namespace boxtree", "struct Planted { int member; };\n\n}  // namespace boxtree",
     r"Planted is not documented"),
    ("runtime/include/boxtree_c.h", "/// The version of boxtree", "BXT_API int bxt_planted(void);\n/// The version of boxtree",
     r"boxtree_c\.h:\d+: .*bxt_planted.* is not documented"),
    ("docs/api/ray.md", "\\include api/ray.cpp", "\\include api/planted.cpp", r"api/planted\.cpp"),
    ("docs/api/ray.md", "\\ref errors", "\\ref planted_page", r"ray\.md:\d+: .*planted_page"),
    ("docs/api/programs.dox", "/// \\example game/game.cpp", "///", r"game/game\.cpp"),
]
# ... and by the faults of a reference that it built.
FAULTY = [
    ("format/include/boxtree/kinds.h", "enum class BlobMethod : std::uint32_t {\n",
     "enum class BlobMethod : std::uint32_t {\n  kPlanted = 9,\n", r"kPlanted.* is not documented"),
    ("runtime/include/boxtree_c.h", "  BXT_OK = 0,", "  BXT_PLANTED = 9,\n  BXT_OK = 0,", r"BXT_PLANTED is not documented"),
    ("runtime/include/boxtree_c.h", "  bxt_vec3 direction;    ///< Of any", "  double planted;\n  bxt_vec3 direction;    ///< Of any",
     r"boxtree_c\.h: double planted; is not documented"),
    ("docs/api/ray.md", "\\include api/ray.cpp", "", r"samples/api/ray\.cpp is on no page"),
    ("docs/api/main.md", "\\subpage box ", "Boxes ", r"the first page does not lead to it"),
    ("docs/api/errors.md", "| 59 |", "| 58 |", r"errors\.md lacks the row of work_limit"),
    ("format/include/boxtree/error.h", "///< No such file.", "///< No file.", r"error\.h says something else of kFileNotFound"),
]


def check_planted(source, work):
    for place, planted in (("warned", WARNED_OF), ("faulty", FAULTY)):
        copy = copy_of(source, work / place)
        for name, old, new, _ in planted:
            path = copy.source / name
            text = path.read_text(encoding="utf-8")
            assert old in text, (name, old)
            path.write_text(text.replace(old, new), encoding="utf-8")
        said, _ = copy.build()
        if planted is FAULTY:
            assert not said, said
            said = "\n".join(copy.faults())
        for name, _, new, expected in planted:
            assert re.search(expected, said), f"{name}: {new!r} went unnoticed: {said!r}"


def check_export_macro(source, work):
    """A macro that marks what a shared library exports leaves the reference as it is."""
    copy = copy_of(source, work / "marked")
    header = copy.source / "runtime/include/boxtree/ray.h"
    text = header.read_text(encoding="utf-8")
    if "BOXTREE_API" not in text:
        header.write_text(re.sub(r"^RayResult ", "BOXTREE_API RayResult ", text, flags=re.MULTILINE), encoding="utf-8")
    assert copy.build() == ("", True)
    assert not copy.faults(), copy.faults()
    assert "BOXTREE_API" not in text_of(copy.out / "group__ray__h.html")


def main():
    source = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        reference = copy_of(source, work / "first")
        said, is_built = reference.build()
        if said or not is_built:
            sys.exit(f"the reference has warnings:\n{said}")
        faults = reference.faults()
        if faults:
            sys.exit("\n".join(faults))
        again = copy_of(source, work / "a folder of another name")
        again.build()
        first, second = bytes_of(reference.out), bytes_of(again.out)
        differing = sorted(str(name) for name in first.keys() | second.keys() if first.get(name) != second.get(name))
        assert not differing, f"differ from build to build: {differing}"
        check_export_macro(source, work)
        check_planted(source, work)
        print(f"{len(reference.headers())} headers, {len(reference.pages())} pages; {len(WARNED_OF) + len(FAULTY)} planted faults were noticed")


if __name__ == "__main__":
    main()
