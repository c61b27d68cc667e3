#!/usr/bin/python3
"""The contract of the command line: exit codes, streams, reports, whole files, signals.

Run by ctest as `contract_test.py CERTA`; needs nothing but Python's own library. CERTA_SANITIZED=1 leaves out what a
sanitizer makes impossible (limits on the address space).
"""

import json
import math
import os
import pty
import re
import resource
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest

CERTA = sys.argv.pop(1) if len(sys.argv) > 1 else "certa"
SANITIZED = os.environ.get("CERTA_SANITIZED") == "1"

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

CROSSING = """OFF
6 2 0
0 0 0
2 0 0
0 2 0
0.5 0.5 -1
0.5 0.5 1
1.2 1.2 1
3 0 1 2
3 3 4 5
"""


def terrain(side):
    """A height field of 2 * side^2 triangles: valid, and enough work to be interrupted."""
    count = side + 1
    lines = ["OFF", f"{count * count} {2 * side * side} 0"]
    for i in range(count):
        for j in range(count):
            height = ((i * 7919 + j * 104729) % 1000) / 900.0
            lines.append(f"{i} {j} {height}")
    for i in range(side):
        for j in range(side):
            a, b, c, d = i * count + j, (i + 1) * count + j, (i + 1) * count + j + 1, i * count + j + 1
            lines.append(f"3 {a} {b} {c}")
            lines.append(f"3 {a} {c} {d}")
    return "\n".join(lines) + "\n"


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.cube = self.write("cube.off", CUBE)
        self.crossing = self.write("crossing.off", CROSSING)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def run_certa(self, *arguments, **options):
        options.setdefault("stdin", subprocess.DEVNULL if "input" not in options else None)
        if "input" in options:
            options.pop("stdin")
        return subprocess.run([CERTA, *arguments], capture_output=True, cwd=self.folder, timeout=300, **options)

    def expect(self, code, *arguments, **options):
        """Runs and checks the exit code; returns standard error as text."""
        done = self.run_certa(*arguments, **options)
        text = done.stderr.decode()
        self.assertEqual(done.returncode, code, f"{arguments}\n{text}")
        return text

    def report(self, code, *arguments, **options):
        done = self.run_certa(*arguments, "--json", "-", **options)
        self.assertEqual(done.returncode, code, done.stderr.decode())
        report = json.loads(done.stdout)
        self.assertEqual(report["exit_code"], code)
        return report

    def expect_no_strays(self, *expected):
        """No file but the inputs and `expected`: no temporaries, no half results."""
        inputs = {"cube.off", "crossing.off"}
        self.assertEqual(set(os.listdir(self.folder)) - inputs, set(expected))


class Usage(CommandTest):
    def test_wrong_usage_exits_2_and_points_to_help(self):
        for arguments in (
            [],
            ["frobnicate"],
            ["conform"],
            ["conform", "cube.off", "--frobnicate"],
            ["conform", "cube.off", "extra.off"],
            ["conform", "cube.off", "--alpha"],
            ["conform", "cube.off", "--alpha", "0.5"],
            ["conform", "cube.off", "--alpha", "-0.1"],
            ["conform", "cube.off", "--alpha", "nan"],
            ["conform", "cube.off", "--alpha", "0,4"],
            ["conform", "cube.off", "--protect", "some"],
            ["conform", "cube.off", "--max-points", "0"],
            ["conform", "cube.off", "--max-points", "1.5"],
            ["conform", "cube.off", "--planarity", "1 %"],
            ["conform", "cube.off", "--planarity", "-1%"],
            ["conform", "cube.off", "--threads", "0"],
            ["conform", "cube.off", "--gabriel=maybe"],
            ["conform", "cube.off", "--input-format", "dwg"],
            ["conform", "cube.off", "-o", "out.off"],
            ["conform", "cube.off", "-o", "out.unknown"],
            ["conform", "cube.off", "-o", "-"],
            ["conform", "cube.off", "-o", "-", "--output-format", "medit", "--json", "-"],
            ["conform", "cube.off", "-o", "same.mesh", "--json", "same.mesh"],
            ["check", "cube.off"],
            ["convert", "cube.off"],
        ):
            with self.subTest(arguments=arguments):
                self.assertTrue(self.expect(2, *arguments).strip())
        self.expect_no_strays()

    def test_misspelt_names_are_recognised(self):
        for arguments, words in (
            (["confrom", "cube.off"], "did you mean 'conform'?"),
            (["frobnicate"], "'frobnicate' is no command"),
            (["conform", "cube.off", "--gabrial"], "did you mean '--gabriel'?"),
            (["conform", "cube.off", "--alfa=0.3"], "did you mean '--alpha'?"),
            (["implicit", "-x"], "goes after --"),
        ):
            with self.subTest(arguments=arguments):
                self.assertIn(words, self.expect(2, *arguments))
        self.assertIn("no file of this name", self.expect(3, "implicit", "torus.txt"))
        self.assertIn("a file goes after -o", self.expect(2, "remesh", "cube.off", "--output", "few.obj"))
        self.expect(0, "conform", "cube.off", "-o", "cube.mesh")
        self.assertIn("surface meshes are checked against functions",
                      self.expect(2, "check", "cube.mesh", "--against", "x^2+y^2+z^2-1"))

    def test_help_has_an_example_and_every_option_a_line(self):
        for command in ("conform", "implicit", "check", "info", "convert"):
            done = self.run_certa(command, "--help")
            self.assertEqual(done.returncode, 0)
            self.assertIn(f"Example:\n  certa {command} ", done.stdout.decode())
            self.assertEqual(done.stderr, b"")
        text = self.run_certa("conform", "--help").stdout.decode()
        for option in ("--protect needed|sharp|all", "--planarity LENGTH", "default 0.4", "--reference id|marker"):
            self.assertIn(option, text)

    def test_manual_and_completion_name_every_option(self):
        manual = self.run_certa("manual").stdout.decode()
        completion = self.run_certa("completion").stdout.decode()
        for command in ("conform", "curvature", "remesh", "implicit", "check", "info", "convert", "view"):
            options = re.findall(r"--[a-z][a-z-]+", self.run_certa(command, "--help").stdout.decode())
            self.assertGreater(len(options), 3)
            for option in set(options) - {"--help"}:
                self.assertIn(option.replace("-", "\\-"), manual)
                self.assertIn(option, completion)

    def test_completion_offers_a_name_with_a_blank_as_one(self):
        self.write("words.bash", self.run_certa("completion").stdout.decode())
        self.write("my part.off", CUBE)
        ask = 'source words.bash; COMP_WORDS=(certa info my); COMP_CWORD=2; _certa; printf "<%s>" "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "-c", ask], cwd=self.path("."), capture_output=True, text=True)
        self.assertEqual(done.stdout, "<my part.off>", done.stderr)

    def test_version_names_commit_and_libraries(self):
        done = self.run_certa("--version")
        self.assertEqual(done.returncode, 0)
        for word in ("certa ", "commit", "CGAL", "oneTBB", "GMP"):
            self.assertIn(word, done.stdout.decode())


class Files(CommandTest):
    def test_missing_and_broken_files_exit_3_and_name_the_place(self):
        self.assertIn("nowhere.off", self.expect(3, "info", "nowhere.off"))
        truncated = CUBE.splitlines()[:7]
        self.write("truncated.off", "\n".join(truncated) + "\n")
        self.assertRegex(self.expect(3, "info", "truncated.off"), r"truncated\.off:\d+: ")
        self.write("nan.off", CUBE.replace("1 1 0\n", "1 nan 0\n", 1))
        self.assertRegex(self.expect(3, "conform", "nan.off"), r"nan\.off:5: ")
        self.write("index.off", CUBE.replace("4 0 3 2 1", "4 0 3 2 8"))
        self.assertRegex(self.expect(3, "convert", "index.off", "out.ply"), r"index\.off:11: ")
        report = self.report(3, "info", "index.off")
        self.assertEqual(report["error"]["channel"], "io")
        self.assertEqual(report["error"]["line"], 11)
        self.expect_no_strays("truncated.off", "nan.off", "index.off")

    def test_unwritable_output_exits_3_and_leaves_nothing(self):
        self.assertIn("there is no folder no/such/folder; make it first",
                      self.expect(3, "conform", "cube.off", "-o", "no/such/folder/out.mesh"))
        os.mkdir(self.path("taken.mesh"))
        self.expect(3, "conform", "cube.off", "-o", "taken.mesh")
        self.expect(3, "conform", "cube.off", "-o", "/dev/full", "--output-format", "medit")
        self.expect(3, "convert", "cube.off", "/dev/full", "--output-format", "ply")
        self.expect(3, "info", "cube.off", "--json", "no/such/folder/report.json")
        text = self.expect(3, "conform", "cube.off", "-o", "out.mesh", "--json", "no/such/folder/report.json")
        self.assertIn("the report: no/such/folder/report.json: there is no folder no/such/folder", text)
        self.expect_no_strays("taken.mesh")  # told before the work

    def test_a_failing_run_keeps_the_old_file(self):
        self.write("out.mesh", "precious")
        self.expect(3, "conform", "crossing.off", "-o", "out.mesh")
        self.expect(4, "conform", "cube.off", "--max-points", "3", "-o", "out.mesh")
        self.assertEqual(self.read("out.mesh"), b"precious")
        self.expect_no_strays("out.mesh")

    def test_convert_keeps_every_bit_and_refuses_to_lose_anything(self):
        self.write("odd.off", CUBE.replace("1 1 1\n", "0.1 1e-300 123456789.12345679\n", 1))
        self.expect(0, "convert", "odd.off", "odd.ply")
        self.expect(0, "convert", "odd.ply", "odd.obj")
        self.expect(0, "convert", "odd.obj", "back.off")
        self.expect(0, "convert", "odd.off", "straight.off")
        self.assertEqual(self.read("back.off"), self.read("straight.off"))
        self.expect(0, "conform", "cube.off", "-o", "cube.mesh")
        text = self.expect(3, "convert", "cube.mesh", "cube.ply")
        self.assertRegex(text, r"tetrahedra")
        self.assertFalse(os.path.exists(self.path("cube.ply")))


class Streams(CommandTest):
    def test_standard_input_and_output(self):
        self.expect(0, "conform", "cube.off", "-o", "cube.mesh")
        done = self.run_certa("conform", "-", "--input-format", "off", "-o", "-", "--output-format", "medit",
                              input=CUBE.encode())
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        self.assertEqual(done.stdout, self.read("cube.mesh"))
        done = self.run_certa("convert", "-", "-", "--input-format", "off", "--output-format", "off", input=CUBE.encode())
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout.split()[0], b"OFF")

    def test_nothing_on_standard_output_unasked_and_no_side_files(self):
        for arguments in (["conform", "cube.off"], ["info", "cube.off"], ["conform", "cube.off", "-o", "out.mesh"]):
            self.assertEqual(self.run_certa(*arguments).stdout, b"")
        self.expect_no_strays("out.mesh")

    def test_quiet_is_quiet_and_pipes_get_no_progress_bar(self):
        self.assertEqual(self.expect(0, "conform", "cube.off", "--quiet"), "")
        self.assertEqual(self.expect(0, "info", "cube.off", "--quiet"), "")
        self.assertNotIn("\r", self.expect(0, "conform", "cube.off", "--verbose"))
        self.assertTrue(self.expect(3, "conform", "crossing.off", "--quiet"))

    def test_terminals_get_a_progress_bar(self):
        self.write("terrain.off", terrain(60))
        leader, follower = pty.openpty()
        process = subprocess.Popen([CERTA, "conform", "terrain.off"], cwd=self.folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=follower, env={**os.environ, "TERM": "xterm"})
        os.close(follower)
        text = b""
        while True:
            try:
                part = os.read(leader, 4096)
            except OSError:
                break
            if not part:
                break
            text += part
        os.close(leader)
        self.assertEqual(process.wait(timeout=300), 0, text.decode())
        self.assertIn(b"\r", text)
        self.assertIn(b"%", text)


class Conform(CommandTest):
    def test_report_has_the_promised_keys(self):
        report = self.report(0, "conform", "cube.off", "-o", "cube.vtu")
        for key in ("command", "version", "commit", "threads", "input", "options", "outcome", "mesh", "statistics",
                    "check", "proved", "output", "stage_seconds", "peak_memory_bytes", "exit_code"):
            self.assertIn(key, report)
        self.assertEqual(report["outcome"], "done")
        self.assertEqual(report["proved"], ["delaunay", "conforming", "faithful", "labelled"])
        self.assertEqual(report["mesh"]["vertices"], 8)
        self.assertEqual(report["mesh"]["regions"], 1)
        self.assertEqual(report["input"]["facets"], 6)
        self.assertEqual(report["check"]["violation_count"], 0)
        self.assertGreater(report["peak_memory_bytes"], 1000000)
        options = report["options"]
        self.assertEqual(options["protection"], "needed")
        self.assertEqual(options["alpha"], 0.4)
        self.assertIsNone(options["max_points"])
        self.assertAlmostEqual(options["planarity"], 1e-9 * 3**0.5, delta=1e-15)  # resolved to the input's unit
        for stage in ("read", "conform", "check", "write", "total"):
            self.assertGreaterEqual(report["stage_seconds"][stage], 0)

    def test_lengths_may_be_percentages_of_the_diagonal(self):
        options = self.report(0, "conform", "cube.off", "--planarity", "2%", "--min-feature", "1e-9")["options"]
        self.assertAlmostEqual(options["planarity"], 0.02 * 3**0.5, delta=1e-12)
        self.assertEqual(options["min_feature"], 1e-9)

    def test_the_result_passes_the_check_in_every_volume_format(self):
        for extra in (["cube.mesh"], ["cube.vtu"], ["cube.msh"], ["cube2.msh", "--msh-version", "2.2"], ["cube.node"],
                      ["ascii.vtu", "--encoding", "ascii"]):
            with self.subTest(extra=extra):
                self.expect(0, "conform", "cube.off", "-o", *extra)
                report = self.report(0, "check", extra[0], "--against", "cube.off")
                self.assertIn("conforming", report["proved"])
                self.assertGreater(report["check"]["tetrahedra_checked"], 0)
                alone = self.report(0, "check", extra[0])
                self.assertEqual(alone["proved"], ["well-formed", "delaunay"])

    def test_a_spoiled_mesh_fails_the_check(self):
        self.expect(0, "conform", "cube.off", "-o", "cube.mesh")
        lines = self.read("cube.mesh").decode().splitlines()
        at = lines.index("Tetrahedra")
        count = int(lines[at + 1])
        del lines[at + 2]
        lines[at + 1] = str(count - 1)
        self.write("spoiled.mesh", "\n".join(lines) + "\n")
        report = self.report(1, "check", "spoiled.mesh", "--against", "cube.off")
        self.assertGreater(report["check"]["violation_count"], 0)
        violation = report["check"]["violations"][0]
        self.assertEqual(len(violation["place"]), 3)
        self.assertTrue(violation["message"])
        self.assertIn("VIOLATED", self.expect(1, "check", "spoiled.mesh", "--against", "cube.off"))
        # Another input than the one that the mesh was made from.
        self.write("moved.off", CUBE.replace("1 1 1\n", "1 1 1.5\n", 1))
        self.expect(0, "conform", "moved.off", "--triangulate", "-o", "moved.mesh")
        self.expect(1, "check", "moved.mesh", "--against", "cube.off")

    def test_bad_input_is_refused_with_elements_and_place(self):
        text = self.expect(3, "conform", "crossing.off", "-o", "out.mesh")
        self.assertIn("crossing_facets", text)
        error = self.report(3, "conform", "crossing.off")["error"]
        self.assertEqual(error["channel"], "input")
        defect = error["defects"][0]
        self.assertEqual(defect["kind"], "crossing_facets")
        self.assertEqual(sorted(e["id"] for e in defect["elements"] if e["kind"] == "facet"), [1, 2])
        self.assertEqual(len(defect["place"]), 3)
        self.expect_no_strays()

    def test_budgets_exit_4_and_partial_results_say_so(self):
        report = self.report(4, "conform", "cube.off", "--max-points", "3", "-o", "out.mesh")
        self.assertEqual(report["outcome"], "over_budget")
        self.assertFalse(os.path.exists(self.path("out.mesh")))
        for name in ("out.mesh", "out.vtu", "out.msh", "out.node"):
            self.expect(4, "conform", "cube.off", "--max-points", "3", "-o", name, "--keep-partial")
            self.assertIn(b"partial result", self.read(name))

    def test_same_bytes_for_any_thread_count_and_locale(self):
        self.write("terrain.off", terrain(12))
        self.expect(0, "conform", "terrain.off", "-o", "one.mesh", "--threads", "1")
        self.expect(0, "conform", "terrain.off", "-o", "four.mesh", "--threads", "4")
        self.expect(0, "conform", "terrain.off", "-o", "local.mesh",
                    env={**os.environ, "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"})
        self.assertEqual(self.read("one.mesh"), self.read("four.mesh"))
        self.assertEqual(self.read("one.mesh"), self.read("local.mesh"))

    def test_references_are_ids_or_markers(self):
        poly = ("4 3 0 1\n1 0 0 0 7\n2 1 0 0 7\n3 0 1 0 7\n4 0 0 1 7\n4 1\n1 0 11\n3 1 3 2\n1 0 12\n3 1 2 4\n"
                "1 0 13\n3 2 3 4\n1 0 14\n3 1 4 3\n0\n0\n")
        self.write("tet.poly", poly)
        self.expect(0, "conform", "tet.poly", "-o", "id.mesh")
        self.expect(0, "conform", "tet.poly", "-o", "marker.mesh", "--reference", "marker")

        def triangle_references(name):
            lines = self.read(name).decode().split("\n")
            at = lines.index("Triangles")
            return sorted(int(line.split()[3]) for line in lines[at + 2:at + 2 + int(lines[at + 1])])

        self.assertEqual(triangle_references("id.mesh"), [1, 2, 3, 4])
        self.assertEqual(triangle_references("marker.mesh"), [11, 12, 13, 14])

    @unittest.skipIf(SANITIZED, "sanitizers reserve the address space")
    def test_what_does_not_fit_into_memory_is_refused_before_work(self):
        self.write("terrain.off", terrain(200))

        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (140 << 20, 140 << 20))

        text = self.expect(4, "conform", "terrain.off", "-o", "out.mesh", "--threads", "1", preexec_fn=limit)
        self.assertIn("memory", text)
        self.expect_no_strays("terrain.off")


class Implicit(CommandTest):
    SPHERE = "x^2 + y^2 + 2*z^2 - 1"
    TORUS = "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"

    def test_certified_meshes_pass_the_check_and_only_theirs(self):
        # The torus takes a sanitized build half a minute.
        function, genus = (self.SPHERE, 0) if SANITIZED else (self.TORUS, 1)
        report = self.report(0, "implicit", function, "-o", "torus.off", "--certificate", "torus.json")
        self.assertEqual(report["verdict"], "certified")
        self.assertEqual([c["genus"] for c in report["components"]], [genus])
        self.assertEqual(report["proved"], ["isotopic"])
        self.expect_no_strays("torus.off", "torus.json")
        check = ("check", "torus.off", "--certificate", "torus.json", "--against")
        self.assertEqual(self.report(0, *check, function)["check"]["genera"], [genus])
        self.write("torus.txt", f"# the same in a file\nf = {function}\nf\n")
        self.assertIn("verified", self.expect(0, *check, "torus.txt"))
        # A nearby function may well have an isotopic zero set; a positive one has none.
        self.assertIn("VIOLATED", self.expect(1, *check, function + " + 100"))
        info = self.report(0, "info", "torus.off")["info"]["surface"]
        self.assertEqual((info["genus"], info["closed"], info["manifold"]), (genus, True, True))

    def test_what_cannot_be_certified_exits_4_with_its_place_and_writes_nothing(self):
        report = self.report(4, "implicit", "x^2+y^2+z^2", "-o", "point.off", "--certificate", "point.json")
        self.assertEqual((report["verdict"], report["obstacles"][0]["reason"]), ("undecided", "singular"))
        self.assertIn("meets the box", self.expect(4, "implicit", "x + y", "-o", "plane.off"))
        self.assertIn("not defined", self.expect(4, "implicit", "log(x)^2 + y^2 + z^2 - 0.1"))
        self.assertIn("--max-cells", self.expect(4, "implicit", self.TORUS, "--max-cells", "100"))
        self.expect_no_strays()

    def test_empty_surfaces_are_a_result(self):
        self.assertEqual(self.report(0, "implicit", "x^2+y^2+z^2+1")["verdict"], "empty")
        self.assertIn("EMPTY", self.expect(0, "implicit", "(x-9)^2+y^2+z^2-1"))

    def test_clipped_surfaces_have_their_loops_certified(self):
        options = ("--box", "-1", "-1", "-1", "1", "1", "1.2", "--clip")
        report = self.report(0, "implicit", "z - 0.1", *options, "-o", "plane.ply", "--certificate", "plane.json")
        self.assertEqual(report["components"], [{"genus": 0, "boundary_loops": 1}])
        self.assertEqual(report["status"], {"type": "certified", "isotopy": "not claimed"})
        self.assertEqual(report["proved"], ["components", "genera", "boundary_loops"])
        text = self.expect(0, "check", "plane.ply", "--against", "z - 0.1", "--certificate", "plane.json")
        self.assertIn("1 loop", text)
        self.expect(1, "check", "plane.ply", "--against", "z - 0.3", "--certificate", "plane.json")
        tangent = self.report(4, "implicit", self.SPHERE, "--box", "-2", "-2", "-2", "1", "2", "2", "--clip")
        self.assertEqual(tangent["obstacles"][0]["reason"], "tangent_to_box")
        self.assertAlmostEqual(tangent["obstacles"][0]["low"][0], 1.0, places=6)

    def test_products_have_two_statuses(self):
        spheres = "((x-1.0005)^2+y^2+z^2-1)*((x+1.0005)^2+y^2+z^2-1)"
        report = self.report(0, "implicit", spheres, "--box", *["-2.5"] * 3, *["2.4"] * 3)
        self.assertEqual(report["status"], {"type": "certified", "isotopy": "not claimed"})
        self.assertEqual([c["genus"] for c in report["components"]], [0, 0])
        self.assertEqual(report["proved"], ["components", "genera"])

    def test_levels_in_texts_and_files(self):
        self.write("shell.txt", "# radius 2\nr = x^2 + y^2 +\n  z^2; r  # no name\n")
        self.write("named.txt", "r = x^2\nf = (r +\n y^2) + z^2 # last = named\n\n")
        for function in ("x^2 + y^2 + z^2", "shell.txt", "named.txt"):
            report = self.report(0, "implicit", function, "--level", "1.21", "-o", "ball.off")
            self.assertEqual(report["verdict"], "certified")
            upper = self.report(0, "info", "ball.off")["info"]["upper"]
            self.assertAlmostEqual(upper[0], 1.1, delta=0.2)
        self.assertEqual(self.report(0, "implicit", "shell.txt", "--level", "-1")["verdict"], "empty")
        self.expect(2, "implicit", "shell.txt", "--level", "x")

    def test_a_guess_is_labelled_and_exits_4(self):
        cone = ("implicit", "x^2 + y^2 - z^2", "-o", "cone.off")
        self.assertIn("NOT CERTIFIED", self.expect(4, *cone, "--uncertified"))
        with open(self.path("cone.off"), encoding="utf-8") as file:
            self.assertIn("NOT CERTIFIED", file.read(300))

    def test_errors_show_the_place(self):
        self.assertIn("  x + * y\n      ^", self.expect(3, "implicit", "x + * y"))
        self.assertIn("smooth_union", self.expect(3, "implicit", "min(x, y)"))
        self.write("f.txt", "a = x\nb = $\nb")
        self.assertIn("f.txt:2: column 5", self.expect(3, "implicit", "f.txt"))
        self.expect(3, "implicit", "x", "--box", "1", "1", "1", "0", "0", "0")
        self.expect(2, "implicit", "x", "--box", "1", "1")
        self.expect(2, "implicit", "x", "-o", "x.mesh")
        self.expect(2, "check", "cube.off", "--certificate", "none.json")
        self.expect(3, "check", "crossing.off", "--certificate", "none.json", "--against", "x^2+y^2+z^2-1")

    def test_same_bytes_for_any_thread_count(self):
        for threads in ("1", "2"):
            self.expect(0, "implicit", self.SPHERE, "-o", f"{threads}.ply", "--certificate", f"{threads}.json", "--threads",
                        threads, "--no-verify")
        self.assertEqual(self.read("1.ply"), self.read("2.ply"))
        self.assertEqual(self.read("1.json"), self.read("2.json"))


@unittest.skipIf(SANITIZED, "simplification takes a sanitized build minutes")
class Chain(CommandTest):
    def test_formula_to_certified_mesh_to_polygons_to_tetrahedra(self):
        torus = "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"
        self.assertEqual(self.report(0, "implicit", torus, "--error", "0.004", "-o", "a.off")["proved"], ["isotopic"])
        report = self.report(0, "remesh", "a.off", "--vertices", "400", "-o", "b.obj")
        self.assertIn("topology", report["proved"])
        self.assertIn("embedded", report["proved"])
        self.assertGreater(report["statistics"]["quads"], 0.8 * report["statistics"]["faces"])
        self.assertIn("verified", self.expect(0, "check", "b.obj", "--against", "a.off"))
        self.assertIn("delaunay", self.report(0, "conform", "b.obj", "--triangulate", "-o", "c.mesh")["proved"])
        self.assertIn("verified", self.expect(0, "check", "c.mesh", "--against", "b.obj", "--triangulate"))
        self.expect_no_strays("a.off", "b.obj", "c.mesh")


class Remesh(CommandTest):
    @staticmethod
    def torus_soup():
        """Every triangle with corners of its own, as in STL."""
        def point(i, j):
            u, v = math.pi * (i % 24) / 12, math.pi * (j % 12) / 6
            return (2 + 0.7 * math.cos(v)) * math.cos(u), (2 + 0.7 * math.cos(v)) * math.sin(u), 0.7 * math.sin(v)

        corners = []
        for i in range(24):
            for j in range(12):
                square = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
                corners += [square[0], square[1], square[2], square[0], square[2], square[3]]
        faces = "".join(f"3 {3 * t} {3 * t + 1} {3 * t + 2}\n" for t in range(len(corners) // 3))
        points = "".join("%r %r %r\n" % p for p in corners)
        return f"OFF\n{len(corners)} {len(corners) // 3} 0\n{points}{faces}"

    @unittest.skipIf(SANITIZED, "remeshing is slow there")
    def test_soups_are_merged_and_it_is_said(self):
        self.write("soup.off", self.torus_soup())
        report = self.report(0, "remesh", "soup.off", "--vertices", "120", "-o", "few.obj")
        self.assertEqual(report["statistics"]["merged_points"], 24 * 12 * 6 - 24 * 12)
        self.assertEqual(report["statistics"]["unused_vertices"], 0)
        self.assertEqual(report["options"]["vertices"], 120)
        self.assertIsNone(report["options"]["error"])
        self.assertAlmostEqual(report["options"]["feature_angle_radians"], math.radians(40))
        self.assertIn("topology", report["proved"])
        self.assertTrue(any("merged" in note for note in report["statistics"]["notes"]))

    @unittest.skipIf(SANITIZED, "remeshing is slow there")
    def test_formats_of_triangles_only_are_refused_at_once(self):
        self.write("soup.off", self.torus_soup())
        for name in ("few.stl", "few.mesh"):
            self.assertIn("--output triangles", self.expect(2, "remesh", "soup.off", "-o", name))
            self.expect(0, "remesh", "soup.off", "--vertices", "120", "--output", "triangles", "-o", name)

    def test_what_is_left_out_or_cut_is_said(self):
        self.write("odd.off", "OFF\n6 5 0\n0 0 0\n1 0 0\n1 1 0.2\n0 1 0\n5 5 5\n2 0 0\n"
                              "4 0 1 2 3\n2 0 3\n3 1 5 2\n3 5 1 2\n3 1 1 2\n")
        warnings = str(self.report(0, "remesh", "odd.off", "-o", "few.obj")["warnings"])
        for part in ("1 polygon of fewer than three corners", "1 polygon of the input not planar",
                     "1 point of the input belongs to no triangle", "1 triangle repeats another",
                     "1 triangle names a point twice"):
            self.assertIn(part, warnings)

    def test_creases_must_be_edges(self):
        self.write("across.txt", "1 7\n")
        self.assertIn("tagged edge 1", self.expect(3, "remesh", "cube.off", "--features", "across.txt"))
        self.write("line.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 2\nl 1 3\nl 2 4\n")
        report = self.report(0, "remesh", "line.obj", "--vertices", "10")
        self.assertTrue(any("left out" in w["message"] for w in report["warnings"]))

    def test_lines_need_a_format_that_has_fields(self):
        self.assertIn("--lines", self.expect(2, "remesh", "cube.off", "--lines", "lines.msh"))
        self.expect_no_strays()

    def test_guides_must_be_edges(self):
        self.write("guides.txt", "1 2\n1 99\n")
        self.assertIn("guides.txt", self.expect(3, "remesh", "cube.off", "--guides", "guides.txt"))
        self.write("none.txt", "# nothing but a comment\n\n")
        for option in ("--guides", "--features"):
            self.assertIn("none.txt", self.expect(3, "remesh", "cube.off", option, "none.txt"))


class Info(CommandTest):
    def test_surface(self):
        info = self.report(0, "info", "cube.off")["info"]
        self.assertEqual(info["points"], 8)
        self.assertEqual(info["surface"]["genus"], 0)
        self.assertEqual(info["surface"]["euler_characteristic"], 2)
        self.assertTrue(info["surface"]["closed"] and info["surface"]["manifold"])
        self.assertEqual(info["surface"]["volume"], 1.0)
        self.assertIn("genus 0", self.expect(0, "info", "cube.off"))

    def test_volume(self):
        self.expect(0, "conform", "cube.off", "-o", "cube.mesh")
        info = self.report(0, "info", "cube.mesh")["info"]["tetrahedra"]
        self.assertAlmostEqual(info["volume"], 1.0)
        self.assertEqual(info["flat"] + info["inverted"], 0)

    def test_self_intersections(self):
        self.assertEqual(self.report(0, "info", "cube.off")["info"]["defects"], [])
        defects = self.report(0, "info", "crossing.off")["info"]["defects"]
        self.assertEqual([d["kind"] for d in defects], ["crossing_facets"])


class Signals(CommandTest):
    def start(self, *arguments, **options):
        return subprocess.Popen([CERTA, *arguments], cwd=self.folder, stderr=subprocess.PIPE, **options)

    def wait_for_stage(self, process, stage):
        """Waits until --verbose has said that a stage is over."""
        deadline = time.monotonic() + 120
        text = b""
        while stage not in text and time.monotonic() < deadline:
            if select.select([process.stderr], [], [], 1)[0]:
                part = os.read(process.stderr.fileno(), 4096)
                if not part:
                    break
                text += part
        self.assertIn(stage, text)

    def interrupt_meshing(self, signals):
        self.write("terrain.off", terrain(400))
        self.write("out.mesh", "precious")
        process = self.start("conform", "terrain.off", "-o", "out.mesh", "--verbose", stdin=subprocess.DEVNULL)
        self.wait_for_stage(process, b"read:")
        time.sleep(0.3)
        self.assertIsNone(process.poll(), "the model is too small to interrupt its meshing")
        for number in signals:
            process.send_signal(number)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(self.read("out.mesh"), b"precious")
        self.expect_no_strays("terrain.off", "out.mesh")

    def test_sigint_and_sigterm_end_with_130_and_leave_nothing(self):
        self.interrupt_meshing([signal.SIGINT])
        self.interrupt_meshing([signal.SIGTERM])

    def test_a_second_signal_ends_at_once(self):
        self.interrupt_meshing([signal.SIGINT, signal.SIGTERM])

    def test_long_rounds_of_implicit_end_soon(self):
        self.write("out.off", "precious")
        process = self.start("implicit", "(x^2+y^2+z^2-1)^2-0.0025", "-o", "out.off")
        time.sleep(2.5)
        self.assertIsNone(process.poll(), "the surface is too small to interrupt its meshing")
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=20)[1]
        self.assertEqual(process.returncode, 130)
        self.assertIn(b"interrupted; no output was written", errors)
        self.assertEqual(self.read("out.off"), b"precious")

    def test_waiting_for_input_can_be_interrupted(self):
        process = self.start("conform", "-", "--input-format", "off", stdin=subprocess.PIPE)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 130)
        process.stdin.close()
        process.stderr.close()


if __name__ == "__main__":
    unittest.main(verbosity=2)
