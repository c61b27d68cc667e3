#!/usr/bin/python3
"""Pages as they look in headless Chromium: what is drawn is counted in elements and pixels and compared with the input.

Run by ctest as `browser_test.py CERTA [FOLDER_OF_PYTHON_PACKAGE]`; skips with a message where there is no Chromium.
"""

import itertools
import math
import os
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools"))
from browser import Browser, find_chromium  # noqa: E402

CERTA = sys.argv.pop(1) if len(sys.argv) > 1 else "certa"
MODULE = sys.argv.pop(1) if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]) else None  # folder of the Python package

PLATE_RINGS = """16 3 0 0
1 0 0 0
2 10 0 0
3 10 10 0
4 0 10 0
5 1 1 0
6 9 1 0
7 9 9 0
8 1 9 0
9 3 3 0
10 7 3 0
11 7 7 0
12 3 7 0
13 4 4 0
14 6 4 0
15 6 6 0
16 4 6 0
1 0
%d %d
4 1 2 3 4
%s0
0
"""


def torus(rings, sides):
    """A torus (radii 1 and 0.4) as PLY with its Gaussian curvature and both principal directions."""
    vertices, faces = [], []
    for i, j in itertools.product(range(rings), range(sides)):
        u, v = 2 * math.pi * i / rings, 2 * math.pi * j / sides
        cu, su, cv, sv = math.cos(u), math.sin(u), math.cos(v), math.sin(v)
        vertices.append(((1 + 0.4 * cv) * cu, (1 + 0.4 * cv) * su, 0.4 * sv, cv / (1 + 0.4 * cv) / 0.4,
                         -su, cu, 0, -sv * cu, -sv * su, cv))
        a, b = i * sides + j, (i + 1) % rings * sides + j
        c, d = (i + 1) % rings * sides + (j + 1) % sides, i * sides + (j + 1) % sides
        faces += [(a, b, c), (a, c, d)]
    names = "x y z gaussian dir_min_x dir_min_y dir_min_z dir_max_x dir_max_y dir_max_z".split()
    return "\n".join(["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property double {n}" for n in names),
                      f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header",
                      *(" ".join(map(repr, v)) for v in vertices), *("3 %d %d %d" % f for f in faces)]) + "\n"


class Block:
    """Cubes of an n x n x n grid, six tetrahedra each (Kuhn's), in two regions; the boundary is its triangles."""

    def __init__(self, n):
        index = lambda p: (p[0] * (n + 1) + p[1]) * (n + 1) + p[2]
        self.points = [(x * 1.0, y * 1.0, z * 1.0) for x, y, z in itertools.product(range(n + 1), repeat=3)]
        self.tetrahedra, self.regions = [], []
        for cube in itertools.product(range(n), repeat=3):
            for order in itertools.permutations(range(3)):
                place, corners = list(cube), [index(cube)]
                for axis in order:
                    place[axis] += 1
                    corners.append(index(place))
                even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
                self.tetrahedra.append(tuple(corners) if even else (corners[0], corners[2], corners[1], corners[3]))
                self.regions.append(1 if cube[2] < n // 2 else 2)
        self.triangles = self.boundary(range(len(self.tetrahedra)))

    @staticmethod
    def faces(t):
        a, b, c, d = t
        return (b, c, d), (a, d, c), (a, b, d), (a, c, b)

    def boundary(self, kept):
        """Faces of exactly one of these tetrahedra."""
        found = {}
        for t in kept:
            for face in self.faces(self.tetrahedra[t]):
                found.setdefault(tuple(sorted(face)), []).append(face)
        return [faces[0] for faces in found.values() if len(faces) == 1]

    def centre(self, t, axis):
        return sum(self.points[v][axis] for v in self.tetrahedra[t]) / 4

    def text(self):
        lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(self.points))]
        lines += ["%r %r %r 0" % p for p in self.points]
        lines += ["Triangles", str(len(self.triangles))] + ["%d %d %d 1" % tuple(v + 1 for v in t) for t in self.triangles]
        lines += ["Tetrahedra", str(len(self.tetrahedra))]
        lines += ["%d %d %d %d " % tuple(v + 1 for v in t) + str(r) for t, r in zip(self.tetrahedra, self.regions)]
        return "\n".join(lines + ["End"]) + "\n"


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.block = Block(4)
        cls.write("torus.ply", torus(48, 24))
        cls.write("block.mesh", cls.block.text())
        cls.page = cls.make("page.html", "torus.ply", "block.mesh")
        cls.browser = Browser(1000, 700)
        cls.loaded = False
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def write(cls, name, text):
        with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    @classmethod
    def make(cls, name, *inputs):
        done = subprocess.run([CERTA, "view", *inputs, "-o", name], capture_output=True, cwd=cls.folder, timeout=100)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.decode())
        return os.path.join(cls.folder, name)

    def open(self, state="", page=None, anew=False):
        """Shows a state of a page: loads it, or only changes the address where the common page is there already."""
        if page or anew or not self.loaded:
            self.browser.open(page or self.page, state)
            type(self).loaded = page is None
            return self.browser.report()
        return self.do(f"clearTimeout(certa.pending); certa.address = null; history.replaceState(null, '', '#{state}'); certa.arrive()")

    def tearDown(self):
        errors, self.browser.errors = self.browser.errors, []
        self.assertEqual(errors, [])

    def do(self, expression):
        """Runs something in the page and reports."""
        self.browser.evaluate(expression)
        self.browser.settle()
        return self.browser.report()

    def go(self, state):
        """Puts a state into the address, as a link would, and reports when the page has followed."""
        return self.do("new Promise(done => { addEventListener('hashchange', () => done(), { once: true });"
                       f"location.hash = '{state}' }})")

    def press(self, text):
        """The button with this text, as a user would."""
        found = self.browser.evaluate(
            f"(() => {{ const node = [...document.querySelectorAll('button')].find(b => b.textContent === {text!r});"
            "if (!node) return null; node.scrollIntoView({block: 'nearest'}); const box = node.getBoundingClientRect();"
            "return [box.left + box.width / 2, box.top + box.height / 2]; })()")
        self.assertIsNotNone(found, f"no button {text}")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.mouse(kind, *found, button="left", buttons=1, clickCount=1)
        self.browser.settle()
        return self.browser.report()

    def test_a_surface_fills_the_frame_with_its_colours(self):
        report = self.open()
        self.assertEqual(report["triangles"], 48 * 24 * 2)
        self.assertEqual(report["field"], "gaussian")
        self.assertEqual(report["counts"]["vertices"], 48 * 24)
        area = report["width"] * report["height"]
        self.assertGreater(report["covered"], 0.1 * area)
        self.assertLess(report["covered"], 0.6 * area)
        self.assertGreater(report["colours"], 60)
        plain = self.open("color=plain&edges=none")
        self.assertLess(plain["colours"], 40)  # shades of one colour
        self.assertLess(max(plain["mean"]) - min(plain["mean"]), 40)

    def test_the_range_moves_the_colours(self):
        # Gaussian curvature lies in [-4.2, 1.8]: above the range all is the map's red end, below it the blue one.
        red = self.open("color=gaussian&map=tide&range=-99,-50&edges=none")["mean"]
        blue = self.open("color=gaussian&map=tide&range=50,99&edges=none")["mean"]
        self.assertGreater(red[0], red[2] + 30)
        self.assertGreater(blue[2], blue[0] + 30)
        # By hand: numbers typed into the two boxes.
        report = self.open("color=gaussian&edges=none&map=tide")
        for label, value in (("Highest value", 99), ("Lowest value", 50)):
            report = self.do(f"(() => {{ const box = document.querySelector('[aria-label=\"{label}\"]'); box.value = '{value}';"
                             "box.dispatchEvent(new Event('change')); })()")
        self.assertEqual(report["range"], [50, 99])
        self.assertLess(max(abs(a - b) for a, b in zip(report["mean"], blue)), 12)
        legend = self.browser.evaluate("document.getElementById('legend').innerText")
        self.assertIn("gaussian", legend)
        self.assertIn("50", legend)

    def test_directions_are_as_long_as_they_are_certain(self):
        lengths = []
        for confidence in (1, 0.25):
            self.write("sure.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                       "property double dir_max_x\nproperty double dir_max_y\nproperty double dir_max_z\nproperty double confidence\n"
                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                       "".join(f"{x} {y} 0 0 5 0 {confidence}\n" for x, y in ((0, 0), (1, 0), (0, 1))) + "3 0 1 2\n")
            self.open("directions=dir_max", self.make("sure.html", "sure.ply"))
            start, end = (self.browser.evaluate(f"[...certa.stage.directions[1].geometry.getAttribute('{which}').array]") for which in ("start", "end"))
            self.assertEqual(len(start), 9)
            for i in range(3):
                self.assertAlmostEqual(start[3 * i], end[3 * i])  # along y
            lengths.append(end[1] - start[1])
        self.assertAlmostEqual(lengths[1] / lengths[0], 0.25, delta=1e-3)

    def test_directions_are_lines(self):
        none = self.open("color=plain&edges=none")
        both = self.open("color=plain&edges=none&directions=dir_min,dir_max")
        self.assertEqual(none["directions"], 0)
        self.assertGreater(both["directions"], 200)
        self.assertEqual(both["directions"] % 2, 0)
        self.assertGreater(both["colours"], none["colours"] + 20)

    def test_files_are_switched_by_button_and_by_key(self):
        self.assertEqual(self.open()["name"], "torus.ply")
        report = self.press("block.mesh")
        self.assertEqual(report["name"], "block.mesh")
        self.assertTrue(report["solid"])
        self.assertEqual(report["counts"]["tetrahedra"], 384)
        self.browser.key("1")
        self.browser.settle()
        self.assertEqual(self.browser.report()["name"], "torus.ply")
        self.assertIn("torus.ply", self.browser.evaluate("document.title"))

    def test_clipping_keeps_whole_tetrahedra(self):
        whole = self.open("file=2&clip=off&color=plain")
        self.assertEqual(whole["tetrahedra"], 384)
        self.assertEqual(whole["triangles"], len(self.block.triangles))
        for axis, sign in itertools.product("xyz", (1, -1)):
            for at in (0.2, 0.53):
                with self.subTest(axis=axis, sign=sign, at=at):
                    state = f"file=2&color=plain&clip={'-' if sign < 0 else ''}{axis},{at}"
                    report = self.go(state)
                    limit = (2 * at - 1) * 2 * 1.0001
                    kept = [t for t in range(384) if sign * (self.block.centre(t, "xyz".index(axis)) - 2) <= limit]
                    self.assertEqual(report["tetrahedra"], len(kept))
                    self.assertEqual(report["triangles"], len(self.block.boundary(kept)))
                    self.assertGreater(report["covered"], 2000)
        half = self.open("file=2&color=plain&clip=-y,0.5&edges=none")
        # The cut shows the inside in another, warmer colour.
        self.assertGreater(half["mean"][0] - half["mean"][2], whole["mean"][0] - whole["mean"][2] + 10)

    def test_the_slider_clips(self):
        self.open("file=2&color=plain")
        self.press("x")
        counts = [self.do("(() => { const slider = document.querySelector('[aria-label=\"Place of the clipping plane\"]');"
                          f"slider.value = {at}; slider.dispatchEvent(new Event('input')); }})()")["tetrahedra"] for at in (0.1, 0.6, 1)]
        self.assertEqual(counts, sorted(counts))
        self.assertLess(counts[0], counts[1])
        self.assertEqual(counts[2], 384)
        self.assertEqual(self.press("off")["clip"], False)

    def test_regions_have_colours_and_a_legend(self):
        report = self.open("file=2&clip=off&edges=none&view=0,0")
        self.assertEqual(report["field"], "marker")
        legend = self.browser.evaluate("document.getElementById('legend').innerText.split(/\\s+/)")
        self.assertIn("1", legend)
        self.assertIn("2", legend)
        upper, lower = (self.browser.evaluate(
            "(() => { certa.report(); const gl = document.getElementById('stage').getContext('webgl2');"
            "certa.stage.draw(certa.view, 'none'); const pixel = new Uint8Array(4);"
            f"gl.readPixels(368, {y}, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); return [...pixel]; }})()") for y in (450, 250))
        self.assertGreater(upper[0], upper[2])  # region 2 is sand, region 1 blue
        self.assertGreater(lower[2], lower[0])

    def test_surfaces_are_clipped_by_whole_polygons(self):
        whole = self.open("clip=off")
        half = self.open("clip=x,0.5")
        self.assertEqual(whole["triangles"], 2304)
        self.assertLess(abs(half["triangles"] - 1152), 60)

    def test_the_address_keeps_the_state(self):
        self.open("file=2")
        self.press("light" if self.browser.evaluate("document.documentElement.dataset.theme") == "dark" else "dark")
        self.press("facets")
        for kind, x, y in (("mousePressed", 300, 300), ("mouseMoved", 380, 330), ("mouseReleased", 380, 330)):
            self.browser.mouse(kind, x, y, button="left", buttons=1, clickCount=1)
        self.browser.evaluate("new Promise(done => setTimeout(done, 250))")
        before = self.browser.report()
        address = self.browser.evaluate("location.hash")
        self.assertEqual(address, before["hash"])
        for part in ("file=2", "show=facets", "theme=", "view="):
            self.assertIn(part, address)
        after = self.open(address, anew=True)
        self.assertEqual(before, after)
        self.assertNotEqual(before["covered"], self.open("file=2&show=facets")["covered"])

    def test_nonsense_in_the_address_is_ignored(self):
        plain, last = self.open(), self.open("file=2")
        odd = self.open("file=99&color=nothing&range=2,1&clip=q,7&view=a,b&theme=pink&%E0%A4%A&directions=gaussian&map=x")
        self.assertEqual(odd["triangles"], last["triangles"])
        self.assertEqual(self.open("range=2,1&clip=q,7&view=a,b&theme=pink&color=%E0%A4%A&map=x")["mean"], plain["mean"])

    def test_a_click_names_the_element(self):
        self.open("file=2&clip=off&view=0,0")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.mouse(kind, 368, 350, button="left", buttons=1, clickCount=1)
        self.browser.settle()
        rows = self.browser.evaluate("Object.fromEntries([...document.querySelectorAll('#probe dt')].map(n => [n.textContent, n.nextSibling.textContent]))")
        tetrahedron = self.block.tetrahedra[int(rows["tetrahedron"]) - 1]
        corners = {int(v) - 1 for v in rows["vertices"].split(",")}
        self.assertLessEqual(corners, set(tetrahedron))
        self.assertEqual(corners, set(self.block.triangles[int(rows["triangle"]) - 1]))
        self.assertAlmostEqual(float(rows["place"].split(",")[1].replace("−", "-")), 0, delta=1e-5)  # the front is y = 0

    def test_facets_with_holes_and_islands(self):
        """Seen straight on, pixels are areas: rings count only where a hole point says so."""
        rings = ["4 5 6 7 8\n", "4 9 10 11 12\n", "4 13 14 15 16\n"]
        cases = [([], [], 100), (rings, [], 100), (rings, ["1 2 2 0\n"], 100 - 64 + 16), (rings, ["1 2 2 0\n", "2 5 5 0\n"], 100 - 64 + 16 - 4),
                 (rings, ["1 3.5 3.5 0\n"], 100 - 16 + 4), (rings[:2], ["1 5 5 0\n"], 84)]
        covered = []
        for inner, holes, _ in cases:
            self.write("plate.poly", PLATE_RINGS % (1 + len(inner), len(holes), "".join(inner) + "".join(holes)))
            page = self.make("plate.html", "plate.poly")
            covered.append(self.open("view=0,90&edges=none&panel=0", page)["covered"])
        for (_, _, area), pixels in zip(cases, covered):
            self.assertAlmostEqual(pixels / covered[0], area / 100, delta=0.01)

    def test_concave_and_large_polygons(self):
        self.write("l.off", "OFF\n6 1 0\n0 0 0\n4 0 0\n4 2 0\n2 2 0\n2 4 0\n0 4 0\n6 0 1 2 3 4 5\n")
        self.write("square.off", "OFF\n4 1 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n4 0 1 2 3\n")
        self.write("dart.off", "OFF\n5 1 0\n0 0 0\n4 0 0\n1 1 0\n0 4 0\n4 4 0\n4 0 1 2 3\n")
        areas = [self.open("view=0,90&edges=none&panel=0&color=plain", self.make("flat.html", name))["covered"] for name in ("square.off", "l.off", "dart.off")]
        self.assertAlmostEqual(areas[1] / areas[0], 12 / 16, delta=0.01)
        self.assertAlmostEqual(areas[2] / areas[0], 4 / 16, delta=0.01)

    def test_degenerate_documents_do_not_break_the_page(self):
        cases = {"dot.off": "OFF\n1 1 0\n7 7 7\n3 0 0 0\n", "point.off": "OFF\n1 0 0\n7 7 7\n", "flat.off": "OFF\n4 2 0\n0 0 0\n1 0 0\n2 0 0\n1 0 0\n3 0 1 2\n4 0 0 0 0\n",
                 "segments.obj": "v 0 0 0\nv 1 1 1\nv 2 0 1\nl 1 2 3\n"}
        for name, text in cases.items():
            with self.subTest(name=name):
                self.write(name, text)
                report = self.open("points=1" if name == "flat.off" else "", self.make("odd.html", name))
                self.assertGreater(report["points"] + report["segments"], 0)
                self.assertGreater(report["covered"], 10)

    def test_lines_lie_on_the_surface_of_another_file(self):
        """Circles on the torus, 64 sides each: three along its axis circle (one outside, one inside, one on top), two across."""
        points, segments, families = [], [], []
        for family, fixed in ((1, 0), (1, math.pi), (1, math.pi / 2), (2, 0), (2, math.pi)):
            first = len(points)
            for i in range(64):
                u, v = (math.pi * i / 32, fixed) if family == 1 else (fixed, math.pi * i / 32)
                points.append(((1 + 0.4 * math.cos(v)) * math.cos(u), (1 + 0.4 * math.cos(v)) * math.sin(u), 0.4 * math.sin(v)))
                segments.append((first + i, first + (i + 1) % 64))
                families.append(family)
        marks = [0] * len(points) + [1, 1, -1]
        points += [(0, -1.4, 0), (0, -1, 0.4), (1.4, 0, 0)]
        array = lambda kind, name, rows: f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{len(rows[0])}" format="ascii">' + " ".join(
            str(x) for row in rows for x in row) + "</DataArray>"
        one = lambda rows: [(x,) for x in rows]
        self.write("lines.vtu", f'<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
                   f'<UnstructuredGrid><Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(segments)}">'
                   f'<Points>{array("Float64", "Points", points)}</Points><Cells>{array("Int64", "connectivity", one(sum(segments, ())))}'
                   f'{array("Int64", "offsets", one(range(2, 2 * len(segments) + 1, 2)))}{array("UInt8", "types", one([3] * len(segments)))}</Cells>'
                   f'<PointData>{array("Int64", "umbilic_half_turns", one(marks))}</PointData><CellData>{array("Int64", "family", one(families))}</CellData>'
                   '</Piece></UnstructuredGrid></VTKFile>')
        page = self.make("lines.html", "torus.ply", "lines.vtu")
        report = self.open("file=2&theme=light", page)
        self.assertEqual((report["ground"], report["segments"], report["points"]), (2304, 320, 3))
        self.assertEqual((report["field"], report["edges"], report["counts"]["umbilics"]), ("family", "sharp", 3))
        legend = self.browser.evaluate("document.getElementById('legend').innerText")
        for words in ("lines of curvature", "along k_min", "along k_max", "umbilics", "wedge", "trisector", "on torus.ply"):
            self.assertIn(words, legend)
        # Seen from above: the circle on top, one across, the surface beside them; from below the same circle is hidden.
        state = "file=2&theme=light&panel=0&points=0&edges=none&on=1&view="
        blue, red, bare, hidden = (self.pixel(state + view, place) for view, place in (
            ("0,90", (0, 1, 0.4)), ("0,90", (-1.283, 0, 0.283)), ("0,90", (0, -1.28, 0.28)), ("0,-90", (0, 1, 0.4))))
        self.assertGreater(blue[2], blue[0] + 60)
        self.assertGreater(red[0], red[2] + 60)
        for colour in (bare, hidden):
            self.assertLess(max(colour[:3]) - min(colour[:3]), 60)
            self.assertEqual(colour[3], 255)
        # A click names the line, or the umbilic, that it meets; not one behind the torus.
        self.assertEqual(self.clicked(state + "0,90", (-1.283, 0, 0.283))["family"], "along k_max")
        self.assertEqual(self.clicked(state + "0,90", (0, -1, 0.4)), {"vertex": "322", "umbilic_half_turns": "wedge"})
        self.assertIsNone(self.clicked(state + "0,-90", (0, 1, 0.4)))
        alone = self.go("file=2&theme=light&on=none")
        self.assertEqual(alone["ground"], 0)
        self.assertLess(alone["covered"], 0.5 * report["covered"])
        self.browser.evaluate("(() => { const list = document.querySelector('[aria-label=\"Surface underneath\"]'); list.value = '1'; list.dispatchEvent(new Event('change')); })()")
        self.assertEqual(self.press("glass")["ground"], 2304)
        self.browser.evaluate("new Promise(done => setTimeout(done, 250))")
        self.assertIn("on=1&ground=glass", self.browser.evaluate("location.hash"))

    def seen_at(self, state, place):
        """Where a place in space is drawn, from -1 to 1, rightwards and upwards."""
        self.do(f"clearTimeout(certa.pending); certa.address = null; history.replaceState(null, '', '#{state}'); certa.arrive()")
        return self.browser.evaluate(
            "(() => { const { scale, origin } = certa.choice.model.entry, { camera } = certa.view;"
            "const times = (m, p) => [0, 1, 2, 3].map(i => p.reduce((sum, x, k) => sum + m.elements[4 * k + i] * x, 0));"
            f"const p = times(camera.projectionMatrix, times(camera.matrixWorldInverse, [...{list(place)}.map((x, i) => (x - origin[i]) / scale), 1]));"
            "return [p[0] / p[3], p[1] / p[3]]; })()")

    def pixel(self, state, place):
        x, y = self.seen_at(state, place)
        return self.browser.evaluate(
            "(() => { certa.report(); const gl = document.getElementById('stage').getContext('webgl2'); const pixel = new Uint8Array(4);"
            f"const at = [gl.drawingBufferWidth, gl.drawingBufferHeight].map((size, i) => Math.floor(([{x}, {y}][i] + 1) / 2 * size));"
            "gl.readPixels(...at, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); return [...pixel]; })()")

    def clicked(self, state, place):
        """What a click there names, but for its place; None if nothing."""
        x, y = self.seen_at(state, place)
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.mouse(kind, 500 * (1 + x), 350 * (1 - y), button="left", buttons=1, clickCount=1)
        self.browser.settle()
        return self.browser.evaluate("(() => { const probe = document.getElementById('probe'); if (probe.hidden) return null; const rows = Object.fromEntries("
                                     "[...probe.querySelectorAll('dt')].map(n => [n.textContent, n.nextSibling.textContent])); delete rows.place; return rows; })()")

    def test_boxes_in_glass(self):
        self.write("torus.json", '{"command":"implicit","box":{"low":[-2,-2,-2],"high":[2,2,2]},"obstacles":[{"reason":"singular","low":[-0.2,-0.2,-0.2],"high":[0.2,0.2,0.2]},'
                   '{"reason":"budget","low":[1,0,0],"high":[1.000001,0.000001,0.000001]}]}')
        page = self.make("boxes.html", "block.mesh", "torus.ply", "torus.json")
        report = self.open("file=3", page)
        self.assertEqual((report["triangles"], report["ground"], report["points"], report["field"]), (24, 2304, 2, "reason"))
        legend = self.browser.evaluate("document.getElementById('legend').innerText")
        for words in ("undecided boxes", "singular", "budget", "on torus.ply"):  # the file of the same name
            self.assertIn(words, legend)
        self.assertGreater(report["covered"], 500)
        self.assertGreater(self.press("solid")["covered"], 3 * report["covered"])
        self.assertGreater(self.open("file=3&on=none&segments=1", page)["segments"], 11)

    def test_protecting_balls_are_drawn(self):
        self.write("wedge.off", "OFF\n6 2 0\n0 0 0\n0 0 1\n3 0 0.2\n3 0 0.9\n3 0.4 0.1\n3 0.4 0.8\n4 0 2 3 1\n4 0 4 5 1\n")
        if subprocess.run([CERTA, "conform", "wedge.off", "--protect", "all", "-o", "wedge.vtu"], capture_output=True, cwd=self.folder).returncode == 2:
            self.skipTest("this certa has no conform")
        page = self.make("wedge.html", "wedge.vtu")
        report = self.open("show=facets&edges=none", page)
        self.assertEqual((report["balls"], report["shields"]), (report["counts"]["balls"], report["counts"]["shields"]))
        self.assertGreater(report["balls"], 10)
        self.assertIn("shield edge", self.browser.evaluate("document.getElementById('legend').innerText"))
        without = self.do("[...document.querySelectorAll('label')].find(one => one.textContent === 'Protecting balls').click()")
        self.assertEqual((without["balls"], without["shields"]), (0, 0))
        self.assertGreater(report["covered"], without["covered"] + 1000)

    def test_names_are_shown_as_they_are(self):
        name = "<b>&'\" é.off"
        self.write(name, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.open(page=self.make("named.html", name))
        self.assertEqual(self.browser.evaluate("document.getElementById('files').innerText"), name)

    def test_a_damaged_page_says_so(self):
        with open(self.page, encoding="utf-8") as file:
            text = file.read()
        at = text.index('id="certa-array-0">') + 40
        self.write("damaged.html", text[:at] + text[at + 8:])
        type(self).loaded = False
        self.browser.open(os.path.join(self.folder, "damaged.html"))
        message = self.browser.evaluate("document.getElementById('message').innerText")
        self.assertIn("damaged", message)

    def test_without_webgl_there_is_a_plain_message(self):
        script = self.browser.call("Page.addScriptToEvaluateOnNewDocument", {"source": "HTMLCanvasElement.prototype.getContext = () => null;"})["identifier"]
        type(self).loaded = False
        try:
            self.browser.open(self.page)
        finally:
            self.browser.call("Page.removeScriptToEvaluateOnNewDocument", {"identifier": script})
        self.assertIn("WebGL", self.browser.evaluate("document.getElementById('message').innerText"))
        self.assertTrue(self.browser.evaluate("getComputedStyle(document.getElementById('message')).display !== 'none'"))
        self.assertTrue(self.browser.evaluate("document.getElementById('panel').hidden"))

    def test_the_gallery_shows_pages_in_a_frame(self):
        tools = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools")
        script = ('set -euo pipefail; results=.; source "$0"; section Tests; commands="certa view torus.ply <a&b>"; entry torus "2 304 triangles" page.html "file=1";'
                  'commands="certa view block.mesh"; entry block tetrahedra page.html "file=2&clip=x,0.5"; write_gallery')
        subprocess.run(["bash", "-c", script, os.path.join(tools, "gallery.sh")], check=True, stdout=subprocess.DEVNULL, cwd=self.folder)
        type(self).loaded = False
        self.browser.call("Page.navigate", {"url": "file://" + os.path.join(self.folder, "gallery.html")})
        shown = lambda: [frame["frame"]["url"] + frame["frame"].get("urlFragment", "")
                         for frame in self.browser.call("Page.getFrameTree")["frameTree"].get("childFrames", [])]
        self.wait(lambda: shown() and shown()[0].endswith("page.html#file=1"))
        commands = "document.querySelector('pre').textContent"
        self.assertEqual(self.browser.evaluate(commands), "certa view torus.ply <a&b>")
        self.browser.evaluate("document.querySelectorAll('nav a')[1].click()")
        self.wait(lambda: shown()[0].endswith("page.html#file=2&clip=x,0.5"))
        self.assertEqual(self.browser.evaluate(commands), "certa view block.mesh")
        self.assertEqual(self.browser.evaluate("[...document.querySelectorAll('nav a.on b')].map(one => one.textContent)"), ["block"])

    def wait(self, condition):
        deadline = time.monotonic() + 240
        while not condition():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def test_keys_do_what_the_panel_says(self):
        state = lambda: self.browser.evaluate("[certa.view.yaw, certa.view.pitch, certa.view.distance]")

        def press(key):
            self.browser.key(key)
            self.browser.settle()
            return self.browser.report(), state()

        self.open("file=2&clip=off&edges=all&theme=light")
        start = state()
        turned = press("ArrowLeft")[1]
        self.assertNotEqual(turned[0], start[0])
        self.assertNotEqual(press("ArrowUp")[1][1], turned[1])
        closer = press("+")[1]
        self.assertLess(closer[2], start[2])
        self.assertAlmostEqual(press("-")[1][2], start[2])
        self.assertEqual(press("r")[1], start)
        self.assertEqual(press("x")[1][:2], [90, 0])
        self.assertEqual(press("z")[1][:2], [0, 90])
        self.assertEqual([press("e")[0]["edges"] for _ in range(3)], ["none", "sharp", "all"])
        whole = self.browser.report()["tetrahedra"]
        self.assertLess(press("c")[0]["tetrahedra"], whole)
        self.assertEqual(press("c")[0]["tetrahedra"], whole)
        bright = self.browser.evaluate("getComputedStyle(document.body).backgroundColor + document.documentElement.dataset.theme")
        press("d")
        self.assertNotEqual(self.browser.evaluate("getComputedStyle(document.body).backgroundColor + document.documentElement.dataset.theme"), bright)
        shown = lambda: self.browser.evaluate("document.getElementById('panel').getBoundingClientRect().height > 100")
        self.assertTrue(shown())
        press("h")
        self.assertFalse(shown())
        press("h")
        self.assertTrue(shown())
        self.assertEqual(press("n")[0]["name"], "torus.ply")
        self.assertEqual(press("2")[0]["name"], "block.mesh")

    def test_more_than_200000_triangles_are_followed(self):
        """What scripts take of a frame; the drawing itself is the graphics card's, here the processor's, and not judged."""
        self.write("large.ply", torus(460, 220))
        self.browser.resize(660, 400)
        self.addCleanup(self.browser.resize, 1000, 700)
        report = self.open("", self.make("large.html", "large.ply"))
        self.assertEqual(report["triangles"], 202400)
        self.assertEqual(report["edges"], "sharp")  # all edges would hide the surface
        before = self.browser.evaluate("certa.view.yaw")
        for kind, x, y in (("mousePressed", 200, 200), ("mouseMoved", 280, 230), ("mouseReleased", 280, 230)):
            self.browser.mouse(kind, x, y, button="left", buttons=1, clickCount=1)
        self.browser.settle()
        self.assertNotEqual(self.browser.evaluate("certa.view.yaw"), before)
        self.assertGreater(self.browser.report()["covered"], 15000)
        times = self.browser.evaluate("(() => { const times = []; for (let i = 0; i < 3; ++i) { const start = performance.now();"
                                      "certa.view.turn(1, 0); certa.stage.draw(certa.view, 'sharp'); times.push(performance.now() - start); } return times.sort((a, b) => a - b); })()")
        print(f"202,400 triangles: scripts take {times[1]:.2f} ms a frame (median of 3)")
        self.assertLess(times[1], 50)  # some 0.2 ms on an idle machine: nothing is computed anew for a frame
        clipped = self.go("clip=x,0.5")
        self.assertLess(abs(clipped["triangles"] - 101200), 2000)

    def test_a_link_is_followed_while_the_address_waits_to_be_written(self):
        self.open("file=2&clip=off")
        # The timer that writes the address after a turn fires between the link's click and the page's hearing of it.
        report = self.do("new Promise(done => { addEventListener('hashchange', () => done(), { once: true });"
                         "const later = window.setTimeout; let write; window.setTimeout = (task) => { write = task; };"
                         "certa.view.turn(20, 0); window.setTimeout = later; location.hash = 'file=2&clip=x,0.5'; write(); })")
        self.assertEqual(report["clip"], {"axis": "x", "at": 0.5})

    def test_a_notebook_shows_the_page_inline(self):
        """What Jupyter puts into the output of a cell: the page in a sandboxed frame that has no origin and no address."""
        if MODULE is None:
            self.skipTest("the Python module is not built")
        done = subprocess.run([sys.executable, "-c", "import certa, sys; print(certa.view('torus.ply', 'block.mesh', height=500)._repr_html_())"],
                              capture_output=True, text=True, cwd=self.folder, env=dict(os.environ, PYTHONPATH=MODULE))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.write("notebook.html", '<!DOCTYPE html><meta charset="utf-8"><body style="margin: 0"><p>In [1]: certa.view(...)</p><div class="jp-RenderedHTMLCommon">'
                   + done.stdout + "</div><p>In [2]:</p></body>")
        type(self).loaded = False
        session = self.browser.session
        self.browser.call("Page.navigate", {"url": "file://" + os.path.join(self.folder, "notebook.html")})
        try:
            self.browser.enter_frame()
            self.wait(lambda: self.browser.evaluate("Boolean(window.certa)"))
            self.browser.settle()
            report = self.browser.report()
            self.assertEqual((report["triangles"], report["height"]), (2304, 500))
            self.assertGreater(report["covered"], 20000)
            self.assertEqual(self.press("block.mesh")["counts"]["tetrahedra"], 384)
            self.browser.key("1")
            self.browser.settle()
            self.assertEqual(self.browser.report()["name"], "torus.ply")
            self.browser.evaluate("new Promise(done => setTimeout(done, 250))")  # an error when it writes the address would come now
        finally:
            self.browser.session = session

    def test_small_screens_and_touch(self):
        self.browser.resize(390, 780, 2)
        try:
            report = self.open()
            self.assertEqual((report["width"], report["height"]), (780, 1560))
            self.assertGreater(report["covered"], 50000)
            before = self.browser.evaluate("[certa.view.distance, certa.view.yaw]")
            touch = lambda kind, *points: self.browser.call("Input.dispatchTouchEvent", {
                "type": kind, "touchPoints": [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]})
            touch("touchStart", (150, 400))
            touch("touchMove", (200, 400))
            touch("touchEnd")
            self.assertNotEqual(self.browser.evaluate("certa.view.yaw"), before[1])
            touch("touchStart", (150, 400), (200, 400))
            touch("touchMove", (100, 400), (250, 400))
            touch("touchEnd")
            self.assertLess(self.browser.evaluate("certa.view.distance"), before[0] * 0.7)
        finally:
            self.browser.resize(1000, 700)


if __name__ == "__main__":
    if find_chromium() is None:
        print("certa-test-skipped: no Chromium here (Debian: apt-get install --no-install-recommends chromium)")
        sys.exit(0)
    unittest.main()
