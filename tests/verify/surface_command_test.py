#!/usr/bin/env python3
"""`certa check OUT --against IN` for surface meshes: exit codes, report, words. Argument: the command."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

CERTA = sys.argv.pop(1) if len(sys.argv) > 1 else "certa"


def box(n, depth=1.0):
    """A closed box 1 x 1 x depth with n by n quads on each side, as OFF; sides have their own vertices merged."""
    ids, points, faces = {}, [], []

    def vertex(p):
        if p not in ids:
            ids[p] = len(points)
            points.append(p)
        return ids[p]

    for axis in range(3):
        for far in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for s, t in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = far, s, t
                        corners.append(vertex(tuple(p)))
                    faces.append(corners if far else corners[::-1])
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x / n} {y / n} {depth * z / n}" for x, y, z in points]
    lines += ["4 " + " ".join(map(str, face)) for face in faces]
    return "\n".join(lines) + "\n"


class SurfaceCheck(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.write("coarse.off", box(1))
        self.write("fine.off", box(5))
        self.write("long.off", box(1, 1.25))

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)

    def run_certa(self, code, *arguments):
        done = subprocess.run([CERTA, *arguments], capture_output=True, cwd=self.folder, timeout=300)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        return done

    def test_a_faithful_mesh_is_verified(self):
        done = self.run_certa(0, "check", "coarse.off", "--against", "fine.off", "--error", "0.01%", "--json", "-")
        report = json.loads(done.stdout)
        self.assertEqual(set(report["proved"]),
                         {"well-formed", "topology", "unfolded", "embedded", "creases", "error"})
        check = report["check"]
        self.assertEqual(check["violation_count"], 0)
        self.assertLess(check["distance"]["hausdorff_bound"], 2e-4)
        self.assertEqual(check["mesh"]["quads"], 6)
        self.assertEqual(check["input"]["components"], [{"genus": 0, "boundary_loops": 0, "euler_characteristic": 2}])
        self.assertEqual(check["creases"]["corners"], 8)
        self.assertIn("verified", done.stderr.decode())

    def test_a_distance_above_the_promise_is_a_violation(self):
        done = self.run_certa(1, "check", "long.off", "--against", "fine.off", "--error", "0.2", "--json", "-")
        check = json.loads(done.stdout)["check"]
        self.assertAlmostEqual(check["distance"]["hausdorff"], 0.25)
        self.assertGreaterEqual(check["distance"]["hausdorff_bound"], 0.25)
        self.assertIn("error", [violation["promise"] for violation in check["violations"]])
        self.assertIn("VIOLATED", done.stderr.decode())
        self.run_certa(0, "check", "long.off", "--against", "fine.off", "--error", "0.26")
        self.run_certa(0, "check", "long.off", "--against", "fine.off")

    def test_a_hole_is_a_violation_with_numbers(self):
        lines = box(2).splitlines()
        lines[1] = "26 23 0"
        self.write("hole.off", "\n".join(lines[:-1]) + "\n")
        text = self.run_certa(1, "check", "hole.off", "--against", "fine.off").stderr.decode()
        self.assertIn("topology: the mesh has 1 component (genus 0, 1 loop)", text)

    def test_same_bytes_for_any_number_of_threads(self):
        reports = []
        for threads in ("1", "2"):
            done = self.run_certa(0, "check", "coarse.off", "--against", "fine.off", "--threads", threads, "--json", "-")
            reports.append(json.loads(done.stdout)["check"])
        self.assertEqual(*reports)

    def test_wrong_usage_and_wrong_files(self):
        self.write("points.off", "OFF\n1 0 0\n0 0 0\n")
        self.write("nan.off", box(1).replace("0.0 0.0 0.0", "nan 0 0", 1))
        self.run_certa(2, "check", "coarse.off")
        self.run_certa(2, "check", "coarse.off", "--against", "fine.off", "--error", "-1")
        self.run_certa(2, "check", "coarse.off", "--against", "fine.off", "--feature-angle", "0")
        self.run_certa(2, "check", "points.off", "--against", "fine.off")
        self.run_certa(3, "check", "nan.off", "--against", "fine.off")
        self.run_certa(3, "check", "coarse.off", "--against", "missing.off")


if __name__ == "__main__":
    unittest.main()
