#!/usr/bin/env python3
"""Checks the architecture: who may include whom, what public headers may include, how long files may be, their names.

The table below is the only place where the arrows of ARCHITECTURE.md are written down for a machine. Run from anywhere;
exits 1 and names file and line for every breach.
"""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Room -> rooms whose private headers it may include, besides its own. Public headers are open to all.
ALLOWED = {
    "core": set(),
    "interval": {"core"},
    "expression": {"core", "interval"},
    "implicit": {"core", "interval", "expression"},
    "exact": {"core"},
    "mesh": {"core", "exact"},
    "io": {"core", "exact", "mesh"},
    "page": {"core", "mesh", "io"},
    "delaunay": {"core", "exact", "mesh"},
    "conforming": {"core", "exact", "mesh", "delaunay"},
    "curvature": {"core", "exact", "mesh"},
    "remeshing": {"core", "exact", "mesh", "delaunay", "curvature"},
    "verify": {"core"},  # shares no code with what it checks
    "frontend": set(),
    "cli": {"frontend"},
    "python": {"frontend"},
}
# Libraries that only some rooms may see: header prefix -> rooms.
LIBRARIES = {
    "CGAL/": {"exact", "delaunay", "conforming", "remeshing", "verify"},
    "boost/": {"exact", "delaunay", "conforming", "remeshing", "verify", "cli"},
    "tao/": {"expression"},
    "mpfi": {"verify"},
    "CLI/": {"cli"},
    "nlohmann/": {"cli"},
    "pybind11/": {"python"},
}
# Only this room builds CGAL's triangulations.
TRIANGULATIONS = re.compile(r"CGAL/(Constrained_)?(Delaunay_)?(Constrained_Delaunay_)?[Tt]riangulation")
# Headers that public headers must not drag into users' builds.
PUBLIC_FORBIDDEN = re.compile(r"^(CGAL|Eigen|boost|tbb|gmp|mpfr|iostream|istream|ostream|fstream|sstream|iomanip|regex)\b")
FORBIDDEN_NAME = re.compile(r"(^|_)(utils?|helpers?|misc|common|managers?|base)(_|\.|$)")
MAX_LINES = 800
# Algorithms take and return values: they never print or end the process.
SILENT = {"core", "interval", "expression", "implicit", "exact", "mesh", "page", "delaunay", "conforming", "curvature"} | {
    "remeshing",
    "verify",
}
NOISE = re.compile(r"\bstd::(cout|cerr|clog)\b|\bstd::exit\b|[^\w.:>]exit\s*\(|\bf?printf\s*\(|\bfesetround\s*\(")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def sources(folder):
    for place, folders, files in os.walk(os.path.join(ROOT, folder)):
        folders[:] = sorted(name for name in folders if name not in ("__pycache__", "corpus"))
        for name in sorted(files):
            if name.endswith((".h", ".cpp", ".hpp", ".cc", ".py", ".in")):
                yield os.path.relpath(os.path.join(place, name), ROOT)


def room_of(path):
    parts = path.split(os.sep)
    return parts[1] if parts[0] == "src" else parts[0]


class Checker:
    def __init__(self):
        self.breaches = []
        self.files = 0

    def breach(self, path, line, text):
        self.breaches.append(f"{path}:{line}: {text}")

    def check_include(self, path, number, quote, header):
        room = room_of(path)
        first = header.split("/")[0]
        if path.startswith("include"):
            if PUBLIC_FORBIDDEN.match(header):
                self.breach(path, number, f"public headers must not include <{header}>")
            if quote == '"':
                self.breach(path, number, "public headers include each other as <certa/...>")
            return
        if room not in ALLOWED:
            return
        if first in ALLOWED and first != room and first != "cli" and first not in ALLOWED[room]:
            self.breach(path, number, f"{room} must not include {header}: allowed are {sorted(ALLOWED[room]) or 'none'}")
        for prefix, rooms in LIBRARIES.items():
            if header.startswith(prefix) and room not in rooms:
                self.breach(path, number, f"{room} must not include <{header}>")
        if TRIANGULATIONS.match(header) and room not in ("delaunay", "verify"):
            self.breach(path, number, f"only delaunay builds triangulations: <{header}>")
        if quote == '"' and path.startswith("src") and first not in ALLOWED:
            self.breach(path, number, f'write "{room}/{header}": private headers are named from src/')
        if header.startswith("CGAL/") and path.endswith(".h"):
            self.breach(path, number, "CGAL is included in .cpp files only")

    def check_file(self, path):
        self.files += 1
        room = room_of(path)
        if FORBIDDEN_NAME.search(os.path.basename(path)):
            self.breach(path, 1, "the name says nothing about the content")
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            lines = file.read().split("\n")
        if len(lines) - 1 > MAX_LINES:
            self.breach(path, len(lines) - 1, f"longer than {MAX_LINES} lines")
        if path.endswith(".cpp") and not lines[0].startswith("//"):
            self.breach(path, 1, "a source file opens with its purpose")
        if path.endswith(".h") and "#pragma once" not in lines[:3]:
            self.breach(path, 1, "a header starts with #pragma once")
        for number, line in enumerate(lines, 1):
            found = INCLUDE.match(line)
            if found:
                self.check_include(path, number, found.group(1), found.group(2))
            if path.startswith("src") and room in SILENT and NOISE.search(line.split("//")[0]):
                self.breach(path, number, "algorithms do not print, exit or touch the rounding mode")


def main():
    checker = Checker()
    for folder in ("include", "src", "cli", "python", "tests", "bench", "examples", "tools"):
        for path in sources(folder):
            checker.check_file(path)
    unknown = [room for room in sorted(os.listdir(os.path.join(ROOT, "src"))) if room not in ALLOWED]
    for room in unknown:
        checker.breach(f"src/{room}", 1, "a room without a row in tools/check_layers.py")
    if checker.breaches:
        print("\n".join(checker.breaches))
        return 1
    print(f"{checker.files} files keep to the architecture")
    return 0


if __name__ == "__main__":
    sys.exit(main())
