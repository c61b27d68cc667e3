#!/usr/bin/env python3
"""Checks what Doxygen made of the public headers: it warned of nothing, and no function, class, struct or enumeration is
without a comment.

check_reference.py FOLDER   (with warnings.txt and xml/)
"""
import pathlib
import sys
import xml.etree.ElementTree as tree


def has_comment(element):
    return any("".join(element.find(part).itertext()).strip() for part in ("briefdescription", "detaileddescription"))


def place_of(element):
    location = element.find("location")
    return f"{location.get('file')}:{location.get('line')}"


def undocumented(compound):
    """(place, name) of what has no comment in one file or class."""
    if compound.get("kind") in ("class", "struct"):
        if not has_comment(compound):
            yield place_of(compound), compound.findtext("compoundname")
    for member in compound.iter("memberdef"):
        if member.get("kind") in ("function", "enum") and member.get("prot") == "public" and not has_comment(member):
            yield place_of(member), member.findtext("qualifiedname") or member.findtext("name")


def main():
    folder = pathlib.Path(sys.argv[1])
    warnings = [line for line in (folder / "warnings.txt").read_text().splitlines() if line.strip()]
    functions, failures = 0, [f"doxygen: {line}" for line in warnings]
    for entry in tree.parse(folder / "xml" / "index.xml").getroot():
        if entry.get("kind") not in ("class", "struct", "namespace"):
            continue
        compound = tree.parse(folder / "xml" / (entry.get("refid") + ".xml")).getroot().find("compounddef")
        functions += sum(member.get("kind") == "function" for member in compound.iter("memberdef"))
        failures += [f"{place}: {name} has no comment" for place, name in undocumented(compound)]
    print("\n".join(failures) or f"reference: {functions} functions, all with comments: {folder}/html/index.html")
    sys.exit(bool(failures) or functions == 0)


if __name__ == "__main__":
    main()
