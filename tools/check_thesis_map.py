#!/usr/bin/env python3
"""Checks docs/thesis-map.md: every function, checker and test that a row names exists where the code is.

Rows of its tables have four cells: thesis | functions | checkers | tests. Names stand in backticks: functions and
checkers as declared in include/ or src/ (checkers also in tests/), tests as `Suite.Name`, or `function` of a Python test.
Every row needs at least one function and one test. Exits 1 and names the line of every breach.
"""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MAP = "docs/thesis-map.md"

TEST = re.compile(r"\bTEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)")
PROPERTY = re.compile(r"\bRC_GTEST(?:_FIXTURE)?_PROP\s*\(\s*(\w+)\s*,\s*(\w+)\s*,")
PYTHON_TEST = re.compile(r"^\s*def (test_\w+)", re.MULTILINE)
# A declaration or definition: a function's name before its parameters, or a type's after its keyword.
DECLARED = re.compile(r"\b(\w+)\s*\(|\b(?:class|struct|enum class|using)\s+(\w+)")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def texts(folders, endings):
    for folder in folders:
        for place, _, files in os.walk(os.path.join(ROOT, folder)):
            for name in sorted(files):
                if name.endswith(endings):
                    with open(os.path.join(place, name), encoding="utf-8") as file:
                        yield file.read()


def declared(folders):
    names = set()
    for text in texts(folders, (".h", ".cpp")):
        for function, kind in DECLARED.findall(COMMENT.sub("", text)):
            names.add(function or kind)
    return names


def known_tests():
    names = set()
    for text in texts(["tests"], (".cpp",)):
        names.update(f"{suite}.{name}" for suite, name in TEST.findall(text) + PROPERTY.findall(text))
    for text in texts(["tests"], (".py",)):
        names.update(PYTHON_TEST.findall(text))
    return names


def rows():
    with open(os.path.join(ROOT, MAP), encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            is_row = line.startswith("|") and not re.fullmatch(r"[|\s:-]+", line.strip())
            if is_row and cells[0].lower() != "thesis":
                yield number, cells


def main():
    functions = declared(["include", "src"])
    checkers = functions | declared(["tests"])
    tests = known_tests()
    breaches, count = [], 0
    for number, cells in rows():
        count += 1
        if len(cells) != 4:
            breaches.append(f"{MAP}:{number}: {len(cells)} cells instead of 4")
            continue
        for cell, known, what, needed in ((cells[1], functions, "function", True), (cells[2], checkers, "checker", False),
                                          (cells[3], tests, "test", True)):
            names = re.findall(r"`([^`]+)`", cell)
            if needed and not names:
                breaches.append(f"{MAP}:{number}: no {what}")
            for name in names:
                bare = name if what == "test" else name.split("::")[-1]
                if bare not in known:
                    breaches.append(f"{MAP}:{number}: no {what} `{name}` in the code")
    if count == 0:
        breaches.append(f"{MAP}: no table rows found")
    if breaches:
        print("\n".join(breaches))
        return 1
    print(f"{count} rows of {MAP} hold")
    return 0


if __name__ == "__main__":
    sys.exit(main())
