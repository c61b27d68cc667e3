#!/usr/bin/env python3
"""Checks that all C++ files are as clang-format writes them; says how to mend those that are not.

Skips, with a message that ctest understands, where clang-format is missing or of another major version than the one
that the files were written with: its output changes between versions.
"""

import os
import re
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
VERSION = 14


def find_program():
    for name in (f"clang-format-{VERSION}", "clang-format"):
        path = shutil.which(name)
        if path:
            text = subprocess.run([path, "--version"], capture_output=True, text=True).stdout
            found = re.search(r"version (\d+)", text)
            if found and int(found.group(1)) == VERSION:
                return path
    return None


def main():
    program = find_program()
    if program is None:
        print(f"certa-test-skipped: no clang-format {VERSION} here")
        return 0
    files = []
    for folder in ("include", "src", "cli", "python", "tests", "bench", "examples"):
        for place, _, names in os.walk(os.path.join(ROOT, folder)):
            files += [os.path.join(place, name) for name in sorted(names) if name.endswith((".h", ".cpp"))]
    unformatted = []
    for path in files:
        done = subprocess.run([program, "--dry-run", "-Werror", "--style=file", path], capture_output=True)
        if done.returncode != 0:
            unformatted.append(os.path.relpath(path, ROOT))
    if unformatted:
        print(f"Run: {os.path.basename(program)} -i " + " ".join(unformatted))
        return 1
    print(f"{len(files)} files are formatted")
    return 0


if __name__ == "__main__":
    sys.exit(main())
