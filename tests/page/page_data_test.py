#!/usr/bin/python3
"""What `certa view` embeds, read back without a browser, and the command's contract about it.

Run by ctest as `page_data_test.py CERTA`; needs nothing but Python's own library.
"""

import array
import base64
import html.parser
import itertools
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest

CERTA = sys.argv.pop(1) if len(sys.argv) > 1 else "certa"
TYPES = {"u8": "B", "u16": "H", "u32": "I", "i32": "i", "i64": "q", "f32": "f", "f64": "d"}

PLATE = """8 3 0 1
1 0 0 0 4
2 10 0 0 4
3 10 10 0 4
4 0 10 0 4
5 3 3 0 0
6 7 3 0 0
7 7 7 0 0
8 3 7 0 0
2 1
3 1 21
4 1 2 3 4
4 5 6 7 8
2 1 5
1 5 4 0
1 0 33
2 1 2
0
0
"""


def critical_leaves(certificate):
    """(low corner, size, sign) of leaves with a sign and no slope, in units of the finest cells."""
    text, found = iter(certificate["octree"]), []

    def visit(low, size):
        letter = next(text)
        if letter == "(":
            for child in range(8):
                visit(tuple(low[a] + (child >> a & 1) * size // 2 for a in range(3)), size // 2)
        elif (ord(letter) - 97) % 7 == 0 and letter != "h":
            found.append((low, size, (ord(letter) - 97) // 7 - 1))

    visit((0, 0, 0), 1 << certificate["grid"]["resolution"])
    return found


class Elements(html.parser.HTMLParser):
    """Texts of the page's script elements by id, and its title."""

    def __init__(self):
        super().__init__()
        self.texts, self.current, self.tags = {}, None, []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag == "script":
            self.current = dict(attributes).get("id", "viewer")
            self.texts.setdefault(self.current, "")

    def handle_endtag(self, tag):
        if tag == "script":
            self.current = None

    def handle_data(self, data):
        if self.current:
            self.texts[self.current] += data


class Page:
    def __init__(self, text):
        parser = Elements()
        parser.feed(text)
        self.texts = parser.texts
        self.manifest = json.loads(parser.texts["certa-manifest"])
        self.models = self.manifest["models"]

    def numbers(self, reference):
        values = array.array(TYPES[reference["type"]], base64.b64decode(self.texts[f"certa-array-{reference['id']}"], validate=True))
        assert len(values) == reference["count"]
        return list(values)

    def field(self, model, name, location):
        return next(f for f in self.models[model]["fields"] if f["name"] == name and f["location"] == location)


class ViewTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def load(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)

    def run_certa(self, *arguments, **options):
        return subprocess.run([CERTA, *arguments], capture_output=True, cwd=self.folder, timeout=300, **options)

    def expect(self, code, *arguments, **options):
        done = self.run_certa(*arguments, **options)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stderr.decode(errors='replace')}")
        return done

    def view(self, *arguments):
        self.expect(0, "view", *arguments, "-o", "page.html")
        with open(self.path("page.html"), encoding="utf-8") as file:
            return Page(file.read())

    def test_numbers_come_back_exactly(self):
        random.seed(5)
        rows = []
        for _ in range(300):
            # Far from the origin and small: single precision of the coordinates themselves would be useless.
            place = [5e6 + random.random() * 1e-2 for _ in range(3)]
            rows.append((*place, random.gauss(0, 1) * 10 ** random.randint(-200, 200), (-5, 3, 70000)[_ % 3], random.random(),
                         random.random(), random.random()))
        header = "ply\nformat ascii 1.0\nelement vertex 300\nproperty double x\nproperty double y\nproperty double z\n" \
                 "property double wild\nproperty int tag\n" + "".join(f"property double dir_{c}\n" for c in "xyz") + \
                 "element face 100\nproperty list uchar int vertex_indices\nend_header\n"
        faces = [[3 * i, 3 * i + 1, 3 * i + 2] for i in range(100)]
        self.write("cloud.ply", header + "".join(" ".join(map(repr, row)) + "\n" for row in rows) +
                   "".join("3 %d %d %d\n" % tuple(face) for face in faces))
        page = self.view("cloud.ply")
        model = page.models[0]
        self.assertEqual(page.manifest["title"], "cloud.ply")
        self.assertEqual(page.numbers(page.field(0, "wild", "vertices")["array"]), [row[3] for row in rows])
        self.assertEqual(page.field(0, "wild", "vertices")["min"], min(row[3] for row in rows))
        self.assertEqual(page.numbers(page.field(0, "tag", "vertices")["array"]), [row[4] for row in rows])
        self.assertEqual(page.field(0, "tag", "vertices")["array"]["type"], "i32")
        self.assertEqual(page.numbers(page.field(0, "dir", "vertices")["array"]), [x for row in rows for x in row[5:]])
        self.assertEqual(page.numbers(model["corners"]), [v for face in faces for v in face])
        self.assertEqual(model["corners"]["type"], "u16")
        self.assertEqual(model["degree"], 3)
        # Positions: single precision of the model's size, wherever it lies.
        self.assertEqual(math.frexp(model["scale"])[0], 0.5)
        stored = page.numbers(model["positions"])
        self.assertLessEqual(max(map(abs, stored)), 1)
        for i, row in enumerate(rows):
            for c in range(3):
                self.assertAlmostEqual(model["origin"][c] + model["scale"] * stored[3 * i + c], row[c], delta=1e-9)

    def test_any_size_of_model(self):
        for power in (-320, -200, 0, 200, 308):
            with self.subTest(power=power):
                self.write("odd.off", f"OFF\n3 1 0\n-1e{power} 0 0\n1e{power} 0 0\n0 1e{power} 0\n3 0 1 2\n")
                page = self.view("odd.off")
                stored = page.numbers(page.models[0]["positions"])
                self.assertTrue(all(math.isfinite(x) for x in stored))
                self.assertGreater(max(stored), 0.4)
                self.assertAlmostEqual(stored[0], -stored[3], delta=1e-3)
        # What no element uses does not count, however far it is.
        self.write("stray.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n1e300 7 7\n3 0 1 2\n")
        page = self.view("stray.off")
        self.assertEqual(page.models[0]["upper"], [1, 1, 0])
        self.assertTrue(all(math.isfinite(x) for x in page.numbers(page.models[0]["positions"])))
        self.write("point.off", "OFF\n1 0 0\n7 7 7\n")
        self.assertEqual(self.view("point.off").models[0]["scale"], 1)

    def test_complexes_keep_facets_holes_and_markers(self):
        self.write("plate.poly", PLATE)
        page = self.view("plate.poly")
        model = page.models[0]
        self.assertEqual(page.numbers(model["facets"]), [0, 3])
        self.assertEqual(page.numbers(model["offsets"]), [0, 4, 8, 10])
        self.assertEqual(page.numbers(model["corners"]), [0, 1, 2, 3, 4, 5, 6, 7, 0, 4])
        self.assertEqual(model["facet_hole_owners"], [0])
        scale, origin = model["scale"], model["origin"]
        self.assertEqual([origin[c] + scale * model["facet_holes"][0][c] for c in range(3)], [5, 4, 0])
        self.assertEqual(page.numbers(page.field(0, "marker", "polygons")["array"]), [21, 21, 21])
        self.assertEqual(page.numbers(page.field(0, "marker", "vertices")["array"]), [4, 4, 4, 4, 0, 0, 0, 0])
        self.assertEqual(page.numbers(page.field(0, "marker", "segments")["array"]), [33])
        self.assertEqual(model["counts"]["facets"], 1)
        self.assertEqual(page.numbers(model["segments"]), [0, 1])

    def test_volume_meshes_keep_labels_and_remarks(self):
        self.write("two.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 -1 0\n"
                   "Tetrahedra\n2\n1 2 3 4 1\n1 3 2 5 2\nTriangles\n1\n1 2 3 6\nEnd\n")
        page = self.view("two.mesh")
        model = page.models[0]
        self.assertEqual(page.numbers(model["tetrahedra"]), [0, 1, 2, 3, 0, 2, 1, 4])
        self.assertEqual(page.numbers(page.field(0, "marker", "tetrahedra")["array"]), [1, 2])
        self.assertEqual(page.field(0, "marker", "tetrahedra")["kind"], "label")
        self.assertEqual(model["counts"], {"polygons": 1, "triangles": 1, "quads": 0, "segments": 0, "tetrahedra": 2, "regions": 2})

    def test_names_cannot_break_the_page(self):
        name = "</script><b>'\"&.off"
        # A slash makes folders of a file name.
        os.mkdir(self.path("<"))
        self.write(name, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.write("é€🐰.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        page = self.view(name, "é€🐰.off")
        self.assertEqual([model["name"] for model in page.models], [os.path.basename(name), "é€🐰.off"])
        raw = os.fsencode(self.path("bad")) + b"\xff.off"
        with open(raw, "w") as file:
            file.write("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.assertEqual(self.view(raw).models[0]["name"], "bad\ufffd.off")

    def test_several_files_and_their_names(self):
        os.mkdir(self.path("in"))
        for name in ("part.off", "in/part.off", "in/other.off"):
            self.write(name, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        names = [model["name"] for model in self.view("part.off", "in/other.off").models]
        self.assertEqual(names, ["part.off", "other.off"])
        names = [model["name"] for model in self.view("part.off", "in/part.off").models]
        self.assertEqual(names, ["part.off", "in/part.off"])
        self.assertEqual(self.view("part.off", "--title", "A & B").manifest["title"], "A & B")
        self.assertEqual(self.view("part.off").manifest["up"], "z")
        self.assertEqual(self.view("part.off", "--up", "y").manifest["up"], "y")

    def test_contract(self):
        triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        self.write("part.off", triangle)
        inputs = {"part.off"}
        for arguments in ([], ["part.off", "-o", "page.off"], ["part.off", "-o", "page"], ["part.off", "--up", "x"], ["part.off", "-o", "-", "--json", "-"],
                          ["-", "-", "--input-format", "off"], ["part.off", "-o", "page.html", "--json", "page.html"]):
            with self.subTest(arguments=arguments):
                self.expect(2, "view", *arguments)
        self.expect(3, "view", "nowhere.off", "-o", "page.html")
        self.expect(3, "view", "part.off", "-o", "no/such/page.html")
        self.write("none.off", "OFF\n0 0 0\n")
        inputs.add("none.off")
        self.assertIn(b"no points", self.expect(3, "view", "part.off", "none.off", "-o", "page.html").stderr)
        done = self.expect(0, "view", "part.off")
        self.assertEqual(done.stdout, b"")
        self.assertEqual(set(os.listdir(self.folder)), inputs)
        self.expect(0, "view", "part.off", "-o", "page.html")
        with open(self.path("page.html"), "rb") as file:
            text = file.read()
        self.assertEqual(self.expect(0, "view", "part.off", "-o", "-").stdout, text)
        done = self.expect(0, "view", "-", "--input-format", "off", "-o", "-", "--title", "part.off", input=triangle.encode())
        self.assertEqual(done.stdout, text.replace(b'"name":"part.off"', b'"name":"standard input"'))
        report = json.loads(self.expect(0, "view", "part.off", "-o", "page.html", "--json", "-").stdout)
        self.assertEqual(report["inputs"][0]["points"], 3)
        self.assertEqual(report["page"]["bytes"], len(text))
        self.assertEqual(report["output"], {"path": "page.html", "format": "html"})
        help_text = self.expect(0, "view", "--help").stdout.decode()
        self.assertIn("Examples:\n  certa view ", help_text)

    def test_critical_clusters_of_a_certificate(self):
        """Boxes and clusters as decoded here, by brute force, from what docs/formats.md says of octrees."""
        for name, function in (("torus", "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"), ("spheres", "((x-0.7)^2+y^2+z^2-0.2)*((x+0.7)^2+y^2+z^2-0.2)")):
            with self.subTest(name=name):
                self.expect(0, "implicit", function, "-o", "s.off", "--certificate", "s.json", "--json", "report.json", "--no-verify")
                certificate, report = self.load("s.json"), self.load("report.json")
                factors = certificate.get("factors", [certificate])
                leaves = [(f,) + leaf for f, factor in enumerate(factors) for leaf in critical_leaves(factor)]
                groups = list(range(len(leaves)))
                for i, j in itertools.combinations(range(len(leaves)), 2):
                    (f, a, m, _), (g, b, n, _) = leaves[i], leaves[j]
                    if f == g and groups[i] != groups[j] and all(p <= q + n and q <= p + m for p, q in zip(a, b)):
                        groups = [groups[i] if group == groups[j] else group for group in groups]
                page = self.view("s.off", "s.json")
                model = page.models[1]
                self.assertTrue(model["overlay"])
                self.assertEqual(model["counts"]["boxes"], len(leaves))
                self.assertEqual(model["counts"]["clusters"], len(set(groups)))
                if len(factors) == 1:
                    self.assertEqual(report["statistics"]["clusters"], len(set(groups)))
                signs = page.numbers(page.field(1, "sign", "polygons")["array"])
                boxes = page.numbers(page.field(1, "box", "polygons")["array"])
                clusters = page.numbers(page.field(1, "cluster", "polygons")["array"])
                self.assertEqual({(b, s) for b, s in zip(boxes, signs)} - {(i + 1, leaf[3]) for i, leaf in enumerate(leaves)}, set())
                # One cluster's faces: the area of the boundary of its boxes, where these have one size.
                for number in set(clusters):
                    own = [leaf for leaf, group in zip(leaves, groups) if group == groups[boxes[clusters.index(number)] - 1]]
                    if len({leaf[2] for leaf in own}) > 1:
                        continue
                    cells = {leaf[1] for leaf in own}
                    size = own[0][2]
                    free = sum(tuple(c + (step if k == axis else 0) for k, c in enumerate(cell)) not in cells
                               for cell in cells for axis in range(3) for step in (-size, size))
                    self.assertEqual(clusters.count(number), free)

    def test_undecided_boxes_of_a_report(self):
        for function, code, reason in (("x^2+y^2-z^2", 4, 1), ("x^2+y^2-1", 4, 2)):
            with self.subTest(function=function):
                self.expect(code, "implicit", function, "--json", "report.json")
                obstacles = self.load("report.json")["obstacles"]
                page = self.view("report.json")
                model = page.models[0]
                self.assertTrue(model["overlay"])
                self.assertEqual(model["counts"]["boxes"], len(obstacles))
                self.assertEqual(set(page.numbers(page.field(0, "reason", "polygons")["array"])), {reason})
                self.assertEqual(len(page.numbers(page.field(0, "box", "polygons")["array"])), 6 * len(obstacles))
                self.assertEqual(page.numbers(page.field(0, "reason", "vertices")["array"]).count(reason), len(obstacles))
                self.assertEqual(model["counts"]["segments"], 12)  # the box of the problem

    def test_other_json_is_refused(self):
        grid = '"grid":{"first":[-2,-2,-2],"count":[4,4,4],"exponent":[0,0,0],"resolution":2}'
        for text in ("{}", "[]", "[", "", '{"command":"conform"}', '{"format":"certa implicit certificate"}', '{"format":"certa implicit product","factors":[]}',
                     '{"command":"implicit","obstacles":[],"box":{"low":[0,0],"high":[1,1,1]}}',
                     *('{"format":"certa implicit certificate",%s,"octree":"%s"}' % (grid, tree) for tree in ("", "(abc", "(((((((((", "?", "(zzzzzzzz"))):
            with self.subTest(text=text):
                self.write("odd.json", text)
                self.assertIn(b"odd.json", self.expect(3, "view", "odd.json", "-o", "page.html").stderr)

    def test_protecting_balls_and_shield_edges(self):
        if b"conform" not in self.expect(0, "--help").stdout:
            self.skipTest("this certa has no conform")
        self.write("wedge.off", "OFF\n6 2 0\n0 0 0\n0 0 1\n3 0 0.2\n3 0 0.9\n3 0.4 0.1\n3 0.4 0.8\n4 0 2 3 1\n4 0 4 5 1\n")
        self.expect(0, "conform", "wedge.off", "-o", "plain.vtu")
        self.assertNotIn("balls", self.view("plain.vtu").models[0]["counts"])
        self.expect(0, "conform", "wedge.off", "--protect", "all", "-o", "wedge.mesh")  # which has no room for them
        self.expect(0, "conform", "wedge.off", "--protect", "all", "-o", "wedge.vtu", "--json", "report.json")
        page = self.view("wedge.vtu")
        model = page.models[0]
        self.assertEqual(model["counts"]["balls"], self.load("report.json")["statistics"]["protecting_balls"])
        radii = page.numbers(page.field(0, "ball_radius", "vertices")["array"])
        places = list(zip(*[iter(page.numbers(model["positions"]))] * 3))
        balls = [(places[v], radius / model["scale"]) for v, radius in enumerate(radii) if radius > 0]
        self.assertEqual(len(balls), model["counts"]["balls"])
        shields = page.numbers(model["shields"])
        self.assertEqual(len(shields), 2 * model["counts"]["shields"])
        self.assertGreaterEqual(model["counts"]["shields"], 2 * 4)  # each corner of both facets has one
        for a, b in zip(shields[::2], shields[1::2]):
            self.assertTrue(any(abs(math.dist(places[a], c) - r) < 1e-5 and abs(math.dist(places[b], c) - r) < 1e-5 for c, r in balls))


if __name__ == "__main__":
    unittest.main()
