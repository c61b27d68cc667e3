#!/usr/bin/env python3
"""Doxygen's input filter: the fixed labels of our comments become headings. Lines stay where they are.

label_headings.py HEADER
"""
import re
import sys

LABEL = re.compile(r"^(\s*///) (Definition|Input|Result|Errors|Guarantee|Cost|Source|Promises|Conventions):\s+", re.MULTILINE)

with open(sys.argv[1], encoding="utf-8") as header:
    sys.stdout.write(LABEL.sub(r"\1 @heading{\2} ", header.read()))
