#!/usr/bin/python3
"""Every file of the models folder: meshed and verified within the recorded size, or refused for the recorded reasons.

    models_test.py CERTA [quick|long [SECONDS]]  checks expected.tsv against what CERTA does now, SECONDS a file at most
    models_test.py CERTA record [OPTIONS...]     prints the rows of all files as CERTA handles them now

expected.tsv, one row per file and options:
  outcome   meshed (and verified by the independent checker), refused, unreadable
  vertices  most vertices that the mesh may have: what was measured and a little, so that regressions fail
  defects   for refused: exactly these kinds
  why       for refused: how often each, and the first elements of each
Each refusal is also tested here, in rational arithmetic on the numbers of the file: facets that are said to cross do.
"""

import collections
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile
from fractions import Fraction

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = os.environ.get("CERTA_MODELS", "")
FOLDERS = ("plc", "plc_eco", "cad", "scan", "thingi", "defects")
COLUMNS = ("file", "options", "run", "outcome", "vertices", "defects", "why")
QUICK_FACETS, QUICK_VERTICES = 8200, 30_000  # what the quick run covers: input's facets, result's vertices
SECONDS = int(sys.argv[3]) if len(sys.argv) > 3 and sys.argv[2] != "record" else 600  # for one file


def run(certa, file, options):
    """(exit code, report) of one run of `conform`; the report of a crash is empty."""
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        command = [certa, "conform", os.path.join(MODELS, file), "--quiet", "--json", report, *options]
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=SECONDS)
        except subprocess.TimeoutExpired:
            return "timeout", {}
        if not os.path.exists(report):
            return done.returncode, {"stderr": done.stderr}
        with open(report, encoding="utf-8") as stream:
            return done.returncode, json.load(stream)


def defects_of(report):
    return report.get("error", {}).get("defects", [])


def outcome_of(code, report):
    if code == 0 and report.get("outcome") == "done":
        promises = {"delaunay", "conforming", "faithful", "labelled"}
        verified = promises <= set(report.get("proved", [])) and report["check"]["violation_count"] == 0
        return "meshed" if verified else "unverified"
    if code == 3:
        return "refused" if defects_of(report) else "unreadable"
    if code == 4:
        return "unfinished"
    return f"exit {code}"


def summary(defects):
    """'crossing_facets 37 (facets 1533 and 1535)' for each kind, in alphabetical order."""
    groups = collections.defaultdict(list)
    for defect in defects:
        groups[defect["kind"]].append(defect)
    parts = []
    for kind, group in sorted(groups.items()):
        names = " and ".join(f"{e['kind']} {e['id']}" for e in group[0]["elements"][:2])
        parts.append(f"{kind} {len(group)}" + (f" ({names})" if names else ""))
    return "; ".join(parts)


# --- exact tests of what a refusal says ---

def read_off(path):
    """Points as rationals, polygons as lists of indices, of an OFF file as Certa writes it."""
    with open(path, encoding="utf-8") as stream:
        words = [w for line in stream for w in line.split("#")[0].split()]
    points, polygons = int(words[1]), int(words[2])
    numbers = words[4:4 + 3 * points]
    places = [tuple(Fraction(float(x)) for x in numbers[3 * i:3 * i + 3]) for i in range(points)]
    at, faces = 4 + 3 * points, []
    for _ in range(polygons):
        count = int(words[at])
        faces.append([int(w) for w in words[at + 1:at + 1 + count]])
        at += 1 + count
    return places, faces


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def side(a, b, c, d):
    return dot(cross(sub(b, a), sub(c, a)), sub(d, a))


def cut_triangle(triangle, edge):
    """The point where an edge crosses the plane of a triangle properly, and lies in the closed triangle; or None."""
    p, q = edge
    a, b, c = triangle
    below, above = side(a, b, c, p), side(a, b, c, q)
    if (below > 0) == (above > 0) or below == 0 or above == 0:
        return None
    t = below / (below - above)
    x = tuple(p[i] + t * (q[i] - p[i]) for i in range(3))
    n = cross(sub(b, a), sub(c, a))
    if all(dot(cross(sub(v, u), sub(x, u)), n) >= 0 for u, v in ((a, b), (b, c), (c, a))):
        return x
    return None


def flat_overlap(s, t):
    """Whether two triangles in one plane have common interior points: no side of either separates them."""
    n = cross(sub(s[1], s[0]), sub(s[2], s[0]))
    for one, other in ((s, t), (t, s)):
        m = cross(sub(one[1], one[0]), sub(one[2], one[0]))
        for i in range(3):
            u, v = one[i], one[(i + 1) % 3]
            inward = cross(m, sub(v, u))
            if all(dot(inward, sub(x, u)) <= 0 for x in other):
                return False
    return n != (0, 0, 0)


def triangles_cross(s, t):
    """Whether two triangles share more than common vertices, sides, or contacts at vertices."""
    ns = cross(sub(s[1], s[0]), sub(s[2], s[0]))
    nt = cross(sub(t[1], t[0]), sub(t[2], t[0]))
    if (0, 0, 0) in (ns, nt):
        return False
    if all(side(*s, x) == 0 for x in t):
        return flat_overlap(s, t)
    corners = set(s) | set(t)
    for one, other in ((s, t), (t, s)):
        for i in range(3):
            x = cut_triangle(one, (other[i], other[(i + 1) % 3]))
            if x is not None and x not in corners:
                return True
        # A corner within the other triangle that is no corner of it: a contact that is no common face.
        for x in other:
            if x not in one and side(*one, x) == 0:
                n = cross(sub(one[1], one[0]), sub(one[2], one[0]))
                if all(dot(cross(sub(v, u), sub(x, u)), n) >= 0
                       for u, v in ((one[0], one[1]), (one[1], one[2]), (one[2], one[0]))):
                    return True
    return False


def fan(places, face):
    return [(places[face[0]], places[face[i]], places[face[i + 1]]) for i in range(1, len(face) - 1)]


def segments_of(defect):
    """The ends of the segments that a message names: '... segment 29 (from vertex 8 to vertex 51) ...'."""
    return [(int(a) - 1, int(b) - 1) for a, b in
            re.findall(r"segment \d+ \(from vertex (\d+) to vertex (\d+)\)", defect["message"])]


def lies_on(p, a, b):
    """Whether p lies on segment ab up to 1e-9 of its length."""
    d, r = sub(b, a), sub(p, a)
    n = cross(d, r)
    return dot(n, n) <= Fraction(1, 10**18) * dot(d, d) ** 2 and 0 <= dot(r, d) <= dot(d, d)


def segments_cross(a, b, c, d):
    """Whether two segments meet, up to 1e-9 of their lengths."""
    if lies_on(a, c, d) or lies_on(b, c, d) or lies_on(c, a, b) or lies_on(d, a, b):
        return True
    u, v, r = sub(b, a), sub(d, c), sub(c, a)
    n = cross(u, v)
    size = dot(n, n)
    if size == 0:
        return False
    apart = dot(r, n) ** 2 <= Fraction(1, 10**18) * size * max(dot(u, u), dot(v, v))
    return apart and 0 <= dot(cross(r, v), n) <= size and 0 <= dot(cross(r, u), n) <= size


def are_coplanar(places):
    """Whether all points lie in one plane, exactly."""
    a = places[0] if places else None
    b = next((p for p in places if p != a), None)
    if b is None:
        return True
    c = next((p for p in places if cross(sub(b, a), sub(p, a)) != (0, 0, 0)), None)
    return c is None or all(side(a, b, c, p) == 0 for p in places)


def is_true(defect, places, faces):
    """Whether the file's own numbers show the defect; None where this program has no test for the kind."""
    kind = defect["kind"]
    ids = [e["id"] - 1 for e in defect["elements"]]
    kinds = [e["kind"] for e in defect["elements"]]
    if kind == "empty_input":
        return are_coplanar(places)
    if kind in ("crossing_segments", "overlapping_segments") and kinds == ["segment", "segment"]:
        return segments_cross(*(places[v] for ends in segments_of(defect) for v in ends))
    if kind == "point_on_segment":
        ends = segments_of(defect)[0]
        return lies_on(places[ids[kinds.index("vertex")]], places[ends[0]], places[ends[1]])
    if kind in ("segment_in_facet", "point_near_facet"):
        face = [places[v] for v in faces[ids[kinds.index("facet")]]]
        other = ids[1 - kinds.index("facet")]
        ends = [places[v] for v in segments_of(defect)[0]] if kind == "segment_in_facet" else [places[other]]
        n = cross(sub(face[1], face[0]), sub(face[2], face[0]))
        heights = [dot(n, sub(p, face[0])) ** 2 for p in ends]
        return max(heights) <= Fraction(1, 10**18) * dot(n, n) * max(dot(sub(p, face[0]), sub(p, face[0])) for p in face)
    if kind == "duplicate_point":
        return len({places[i] for i in ids}) == 1 and len(set(ids)) > 1
    if kind == "repeated_facet":
        return len({frozenset(places[v] for v in faces[i]) for i in ids}) == 1 and len(set(ids)) > 1
    if kind in ("crossing_facets", "overlapping_facets") and kinds == ["facet", "facet"]:
        if all(len(faces[i]) == 3 for i in ids):
            return any(triangles_cross(s, t) for s in fan(places, faces[ids[0]]) for t in fan(places, faces[ids[1]]))
        return None
    if kind == "repeated_vertex_in_polygon":
        face = faces[ids[kinds.index("facet")]]
        return len(set(face)) < len(face)
    if kind == "degenerate_facet":
        face = [places[v] for v in faces[ids[kinds.index("facet")]]]
        area = [sum(cross(face[i - 1], face[i])[k] for i in range(len(face))) for k in range(3)]
        size = max(dot(sub(p, face[0]), sub(p, face[0])) for p in face)
        return float(dot(area, area)) <= 1e-20 * float(size) ** 2
    if kind == "non_planar_facet":
        face = [places[v] for v in faces[ids[kinds.index("facet")]]]
        return len(face) > 3 and any(side(face[0], face[1], face[2], p) != 0 or
                                     side(face[1], face[2], face[3], p) != 0 for p in face)
    return None


def justify(certa, file, defects, limit):
    """Sentences about defects that the file's numbers do not show, and how many were tested."""
    with tempfile.TemporaryDirectory() as folder:
        off = os.path.join(folder, "model.off")
        made = subprocess.run([certa, "convert", os.path.join(MODELS, file), off, "--quiet"], capture_output=True,
                              text=True, timeout=SECONDS)
        if made.returncode != 0:
            return [], 0
        places, faces = read_off(off)
    false, tested = [], 0
    for defect in defects[:limit]:
        verdict = is_true(defect, places, faces)
        tested += verdict is not None
        if verdict is False:
            false.append(f"{file}: not so: {defect['message']}")
    return false, tested


# --- recording and checking ---

def model_files():
    return [f"{folder}/{name}" for folder in FOLDERS if os.path.isdir(os.path.join(MODELS, folder))
            for name in sorted(os.listdir(os.path.join(MODELS, folder)))
            if not name.endswith((".md", ".tsv", ".txt")) and name != "README"]


def row_of(certa, file, options):
    code, report = run(certa, file, options)
    outcome = outcome_of(code, report)
    row = {"file": file, "options": " ".join(options) or "-", "outcome": outcome, "vertices": "-", "defects": "-",
           "why": "-", "run": "long" if options or report.get("input", {}).get("facets", 0) > QUICK_FACETS else "quick"}
    if outcome == "meshed":
        count = report["mesh"]["vertices"]
        added = count - report["statistics"]["input_points"]
        if count > QUICK_VERTICES:
            row["run"] = "long"
        row["vertices"] = str(count + (added // 50 + 2 if added else 0))
    elif outcome == "refused":
        row["defects"] = ",".join(sorted({d["kind"] for d in defects_of(report)}))
        row["why"] = summary(defects_of(report))
    else:
        obstacles = report.get("obstacles", [])
        row["why"] = (obstacles[0]["message"] if obstacles else
                      report.get("error", {}).get("message", report.get("stderr", "?"))).replace(MODELS + "/", "").strip()
    return row


def record(certa, options):
    print("\t".join(COLUMNS))
    for file in model_files():
        row = row_of(certa, file, options)
        print("\t".join(row[c].replace("\t", " ").replace("\n", " ") for c in COLUMNS), flush=True)
    return 0


def read_expected():
    with open(os.path.join(HERE, "expected.tsv"), encoding="utf-8") as stream:
        lines = [line.rstrip("\n").split("\t") for line in stream if line.strip() and not line.startswith("#")]
    assert tuple(lines[0]) == COLUMNS, lines[0]
    return [dict(zip(COLUMNS, line)) for line in lines[1:]]


def failures_of(certa, expected, long, proved):
    """What is wrong with one file, in sentences; counts in `proved` the defects that were tested here."""
    file = expected["file"]
    options = [] if expected["options"] == "-" else expected["options"].split()
    name = " ".join([file, *options])
    code, report = run(certa, file, options)
    outcome = outcome_of(code, report)
    if outcome != expected["outcome"]:
        detail = report.get("error", {}).get("message") or report.get("stderr") or \
            "".join(o["message"] for o in report.get("obstacles", [])[:1])
        return [f"{name}: {outcome} instead of {expected['outcome']}: {str(detail)[:300]}"]
    if outcome == "meshed":
        count = report["mesh"]["vertices"]
        if count > int(expected["vertices"]):
            return [f"{name}: {count} vertices, at most {expected['vertices']} expected"]
        if "--gabriel" in options and "gabriel" not in report["proved"]:
            return [f"{name}: gabriel was not proved"]
    if outcome == "refused":
        defects = defects_of(report)
        kinds = ",".join(sorted({d["kind"] for d in defects}))
        if kinds != expected["defects"]:
            return [f"{name}: refused for {kinds} instead of {expected['defects']}"]
        silent = [d for d in defects if not d["message"]]
        if silent:
            return [f"{name}: {len(silent)} defects without a message"]
        false, tested = justify(certa, file, defects, 10_000 if long else 12)
        proved.update(refused=1, tested=tested, justified=tested > 0)
        return false
    return []


def index_failures(rows):
    """Files whose self-intersections another tool counted must be refused, flawless ones meshed (or laid flat first)."""
    with open(os.path.join(MODELS, "INDEX.tsv"), encoding="utf-8") as stream:
        lines = [line.rstrip("\n").split("\t") for line in stream]
    index = {line[0]: dict(zip(lines[0], line)) for line in lines[1:]}
    failures = []
    for row in rows:
        entry = index.get(row["file"])
        if row["options"] != "-" or entry is None or not entry.get("self_intersecting_pairs", "").isdigit():
            continue
        if int(entry["self_intersecting_pairs"]) > 0 and row["outcome"] != "refused":
            failures.append(f"{row['file']}: intersects itself by INDEX.tsv, but is {row['outcome']}")
    return failures


def check(certa, mode):
    rows = read_expected()
    failures = index_failures(rows)
    listed = {row["file"] for row in rows}
    failures += [f"{file}: has no row in expected.tsv" for file in model_files() if file not in listed]
    failures += [f"{row['file']}: a refusal needs a reason" for row in rows
                 if row["outcome"] == "refused" and row["why"] in ("-", "")]
    proved = collections.Counter()
    chosen = [row for row in rows if mode == "long" or row["run"] == "quick"]
    with concurrent.futures.ThreadPoolExecutor(max_workers=1 if mode == "long" else 2) as pool:
        for result in pool.map(lambda row: failures_of(certa, row, mode == "long", proved), chosen):
            failures += result
    for failure in failures:
        print("FAILED", failure)
    if 4 * proved["justified"] < 3 * proved["refused"]:
        failures.append(f"only {proved['justified']} of {proved['refused']} refusals could be tested here")
    print(f"{len(chosen)} rows, {len(failures)} failures; {proved['refused']} refused, {proved['justified']} of them "
          f"tested here by {proved['tested']} defects")
    return 1 if failures else 0


def main():
    if not os.path.exists(os.path.join(MODELS, "INDEX.tsv")):
        print("certa-test-skipped: needs the models folder (CERTA_MODELS)")
        return 0
    certa, mode = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "quick"
    return record(certa, sys.argv[3:]) if mode == "record" else check(certa, mode)


if __name__ == "__main__":
    sys.exit(main())
