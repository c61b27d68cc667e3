#!/usr/bin/env python3
"""Merges the reports of a batch, in whatever folders below OUT, into OUT/reports.jsonl and OUT/table.csv."""
import csv
import json
import pathlib
import sys

COLUMNS = ("file", "exit", "outcome", "points", "vertices", "seconds", "peak_memory_bytes", "message")


def collect(folder):
    """One dictionary per file: its report, with `file` and `exit` in front."""
    for status in sorted(folder.rglob("*.status")):
        code, file, name = status.read_text().rstrip("\n").split("\t")
        report = status.with_name(name + ".json")
        try:
            content = json.loads(report.read_text())
        except (FileNotFoundError, json.JSONDecodeError):
            content = {}  # stopped before it could write one
        log = status.with_name(name + ".log").read_text(errors="replace").strip().splitlines()
        yield {"file": file, "exit": int(code), "printed": log, **content}


def row_of(report):
    def find(*keys):
        value = report
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        return value

    return {
        "file": report["file"],
        "exit": report["exit"],
        "outcome": find("outcome"),
        "points": find("input", "points") if find("input", "points") is not None else find("input", "vertices"),
        "vertices": find("mesh", "vertices"),
        "seconds": find("stage_seconds", "total"),
        "peak_memory_bytes": find("peak_memory_bytes"),
        "message": report["printed"][0] if report["printed"] else "",
    }


def main():
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} OUT")
    folder = pathlib.Path(sys.argv[1])
    reports = list(collect(folder))
    with open(folder / "reports.jsonl", "w") as lines:
        for report in reports:
            lines.write(json.dumps(report) + "\n")
    with open(folder / "table.csv", "w", newline="") as table:
        writer = csv.DictWriter(table, COLUMNS)
        writer.writeheader()
        writer.writerows(row_of(report) for report in reports)
    good = sum(report["exit"] == 0 for report in reports)
    print(f"{good} of {len(reports)} done; {folder / 'table.csv'}")


if __name__ == "__main__":
    main()
