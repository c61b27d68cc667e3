#!/usr/bin/env python3
"""Remeshes every clean model of a folder at several vertex counts, and prints one line for each.

    remesh_sweep.py CERTA MODELS [--counts 500,1500,5000,default] [--subdivide N] [--timeout SECONDS] [--names NAME...]

Clean: INDEX.tsv in MODELS says manifold, without self-intersections, of cad, scan or surfaces. The command checks each
result itself; exit code 4 is a broken promise. Columns: vertices, share of quads, regions and triangles of mending, CPU
seconds of reading, remeshing and checking. With --subdivide: rounds that were done, vertices that were held back, faces that
stayed coarse.
"""
import argparse
import csv
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile


def clean_models(folder):
    with open(folder / "INDEX.tsv", encoding="utf-8") as index:
        for row in csv.DictReader(index, delimiter="\t"):
            is_ours = row["file"].split("/")[0] in ("cad", "scan", "surfaces")
            if is_ours and row["manifold"] == "yes" and row["self_intersecting_pairs"] == "0":
                yield row["file"], int(row["vertices"])


def number(pattern, text):
    found = re.search(pattern, text)
    return found.group(1).replace(",", "") if found else "-"


def subdivision_of(record):
    if not record:
        return ""
    statistics = json.loads(pathlib.Path(record).read_text(encoding="utf-8"))["statistics"]
    return (f"  {statistics['subdivision_rounds']} rounds, {statistics['held_vertices']} held, "
            f"{statistics.get('coarse_faces', '-')} coarse")


def run(certa, file, count, subdivide, timeout, output):
    goal = [] if count == "default" else ["--vertices", count]
    record = output + ".json"
    if subdivide:
        goal += ["--subdivide", str(subdivide), "--json", record]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        job = subprocess.run([certa, "remesh", str(file), *goal, "-o", output], capture_output=True, text=True,
                             timeout=timeout, check=False)
        code, text = job.returncode, job.stdout + job.stderr
    except subprocess.TimeoutExpired:
        code, text = "time", ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    vertices = number(r"result\s+([\d,]+) vertices", text)
    quads = number(r"quads \((\d+) %", text)
    regions, triangles = number(r"mended\s+([\d,]+) region", text), number(r"by ([\d,]+) triangles", text)
    print(f"{file.name:32} {count:>7} {code!s:>5} {vertices:>7} {quads:>4} % {regions:>4} / {triangles:<6} {seconds:7.1f}"
          + subdivision_of(record if subdivide and code == 0 else ""), flush=True)
    if code not in (0, "time"):
        print("    " + "\n    ".join(text.strip().splitlines()[-3:]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("certa")
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--counts", default="500,1500,5000,default")
    parser.add_argument("--subdivide", type=int, default=0, metavar="N", help="rounds of subdivision")
    parser.add_argument("--timeout", type=float, default=600.0)
    parser.add_argument("--names", nargs="*", default=[])
    arguments = parser.parse_args()
    print(f"{'model':32} {'asked':>7} {'exit':>5} {'has':>7} quads    mended       CPU s")
    with tempfile.TemporaryDirectory() as folder:
        for file, _ in clean_models(arguments.models):
            if arguments.names and not any(name in file for name in arguments.names):
                continue
            for count in arguments.counts.split(","):
                run(arguments.certa, arguments.models / file, count, arguments.subdivide, arguments.timeout, folder + "/out.obj")
    return 0


if __name__ == "__main__":
    sys.exit(main())
