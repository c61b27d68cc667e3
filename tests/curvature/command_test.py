#!/usr/bin/python3
"""The contract of `certa curvature`: fields, regions, reports, refusals. Run as `command_test.py CERTA`."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

CERTA = sys.argv.pop(1) if len(sys.argv) > 1 else "certa"

# The cube [0, 1]^3 with square faces; face 2 is z = 1.
CUBE = """OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""

SOLIDS = """MeshVersionFormatted 2
Dimension 3
Vertices
5
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
1 1 1 0
Tetrahedra
2
1 2 3 4 1
2 3 4 5 2
End
"""


class Curvature(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.cube = self.write("cube.off", CUBE)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(text)
        return self.path(name)

    def run_certa(self, *arguments, code=0):
        done = subprocess.run([CERTA, "curvature", *arguments], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def report(self, *arguments):
        return json.loads(self.run_certa(*arguments, "--json", "-").stdout)

    def region(self, spec, *arguments):
        return self.report(self.cube, "--region", spec, *arguments)["region"]["measures"]

    def test_totals_and_tube_formula(self):
        total = self.report(self.cube)["total"]
        self.assertAlmostEqual(total["mean"], 6 * math.pi, 12)
        self.assertAlmostEqual(total["gaussian"], 4 * math.pi, 12)
        self.assertAlmostEqual(total["tube_formula"]["quadratic"], 3 * math.pi, 12)

    def test_fields_in_every_format_that_carries_them(self):
        for name in ("out.vtu", "out.ply", "out.csv"):
            self.run_certa(self.cube, "-o", self.path(name), "--tensors", "--measures", "--quiet")
            self.assertGreater(os.path.getsize(self.path(name)), 100)
        with open(self.path("out.csv"), encoding="ascii") as file:
            header, *rows = file.read().split()
        self.assertTrue(header.startswith("area,mean,gaussian,k_min,k_max,dir_min_x,dir_min_y,dir_min_z,dir_max_x"))
        self.assertEqual(len(rows), 8)
        refused = self.run_certa(self.cube, "-o", self.path("out.stl"), code=2)
        self.assertIn(".vtu", refused.stderr)
        self.assertFalse(os.path.exists(self.path("out.stl")))

    def test_fields_replace_those_of_an_earlier_run(self):
        self.run_certa(self.cube, "-o", self.path("one.vtu"), "--quiet")
        self.run_certa(self.path("one.vtu"), "-o", self.path("two.vtu"), "--quiet")
        with open(self.path("one.vtu"), "rb") as one, open(self.path("two.vtu"), "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_threads_do_not_change_a_byte(self):
        for threads in ("1", "2"):
            self.run_certa(self.cube, "-o", self.path(threads + ".vtu"), "--ball", "40%", "--threads", threads, "--quiet")
        with open(self.path("1.vtu"), "rb") as one, open(self.path("2.vtu"), "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_regions(self):
        self.assertAlmostEqual(self.region("ball:0,0,0:0.5")["area"], 3 * math.pi / 16, 12)
        self.assertAlmostEqual(self.region("halfspace:0,0,0.25:0,0,1")["area"], 2, 12)
        self.assertAlmostEqual(self.region("box:-1,-1,-1:0.5,0.5,0.5")["mean"], 1.5 * math.pi / 2, 12)
        self.assertAlmostEqual(self.region("!ball:0,0,0:0.5 & !(halfspace:0,0,0.9:0,0,1 | ball:9,9,9:1)")["area"], 1.4, 12)
        faces = self.write("faces.txt", "2  # the top\n")
        self.assertAlmostEqual(self.region("faces:" + faces)["mean"], math.pi, 12)
        self.assertAlmostEqual(self.region("faces:" + faces, "--rim", "closed")["mean"], 2 * math.pi, 12)
        self.assertAlmostEqual(self.region("faces:" + faces + " & halfspace:0.5,0,0:1,0,0")["area"], 0.5, 12)

    def test_bounds_say_when_nothing_is_proved(self):
        report = self.report(self.cube, "--region", "ball:0,0,0:0.5", "--bounds", "--max-curvature", "1")
        self.assertEqual(report["region"]["bound"]["hypothesis"], "violated")
        self.assertIsNone(report["region"]["bound"]["mean"])
        self.assertEqual(report["region"]["bound"]["max_curvature_from"], "user")

    def test_solids(self):
        solid = self.write("solids.mesh", SOLIDS)
        report = self.report(solid)
        self.assertEqual([s["region"] for s in report["solids"]], [1, 2])
        one = self.report(solid, "--solid", "1")["total"]
        self.assertAlmostEqual(one["area"], 1.5 + math.sqrt(3) / 2, 12)
        self.assertAlmostEqual(one["gaussian"], 4 * math.pi, 12)
        self.run_certa(solid, "--solid", "7", code=3)

    def test_the_automatic_estimator_says_why(self):
        self.assertIn("noise", self.report(self.cube, "--estimator", "auto")["choice"])

    def test_usage(self):
        for wrong in (["--ball", "0"], ["--ball", "x"], ["--rings", "0"], ["--rings", "101"], ["--rim", "none"],
                      ["--weight", "kernel4"], ["--geodesic", "1", "--weight", "kernel2"], ["--ball", "1", "--rings", "2"], ["--ball", "1", "--geodesic", "1"],
                      ["--estimator", "auto", "--ball", "1"], ["--jet-degree", "5"], ["--max-curvature", "-1"],
                      ["--region", "ball:0,0,0"], ["--region", "ball:0,0:1"], ["--region", "sphere:0,0,0:1"],
                      ["--region", "ball:0,0,0:1 &"], ["--region", "(ball:0,0,0:1"], ["--region", "ball:0,0,0:-1"],
                      ["--region", "ball:0,0,0:1", "-o", "x.vtu"]):
            message = self.run_certa(self.cube, *wrong, code=2).stderr
            self.assertTrue(message.startswith("certa curvature: "), message)

    def test_bad_input(self):
        self.run_certa(self.write("empty.off", "OFF\n0 0 0\n"), code=3)
        self.run_certa(self.path("missing.off"), code=3)
        self.run_certa(self.cube, "--region", "faces:" + self.path("missing.txt"), code=3)
        self.run_certa(self.cube, "--region", "faces:" + self.write("far.txt", "7\n"), code=3)
        bad = self.run_certa(self.cube, "--region", "faces:" + self.write("bad.txt", "1\nx\n"), code=3)
        self.assertIn("bad.txt:2", bad.stderr)


if __name__ == "__main__":
    unittest.main()
