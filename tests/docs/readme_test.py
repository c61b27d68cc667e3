#!/usr/bin/python3
"""What README.md says beside the programs and commands that run elsewhere (run_documents.py, test_guide.py,
installed_package.cmake): exit codes, formats, options, packages, targets, presets, pictures, the two scripts.

readme_test.py CERTA BUILD
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CERTA, BUILD = (sys.argv.pop(1), sys.argv.pop(1)) if len(sys.argv) > 2 else ("certa", "build")
ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = ("conform", "curvature", "remesh", "implicit", "check", "info", "convert", "view")
CUBE = ("OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n")


def run(*command, **more):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **more)


class Readme(unittest.TestCase):
    def test_exit_codes_are_those_of_the_help(self):
        said = " ".join(run(CERTA, "--help").stdout.split())
        promised = re.search(r"Exit codes: (.*?130 interrupted)", " ".join(README.split())).group(1)
        promised = re.sub(r" \(.*?\)", "", promised)
        self.assertIn(promised, said)

    def test_formats_are_written_and_read(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "part.off").write_text(CUBE)
            line = re.search(r"Formats: (.*?); see", README, re.DOTALL).group(1)
            surfaces = [name.lower() for name in ("OFF", "OBJ", "PLY", "STL") if name in line] + re.findall(r"(?<=[`/])\.(poly|smesh)", line)
            volumes = [name for name in ("mesh", "vtu", "msh") if re.search(rf"\.{name}`|{name.upper()}", line)] + re.findall(r"/\.(ele)", line)
            self.assertEqual(len(surfaces), 6, surfaces)
            self.assertEqual(len(volumes), 4, volumes)
            for name in surfaces:
                done = run(CERTA, "convert", "part.off", f"out.{name}", cwd=folder)
                triangles = "no triangle" in done.stdout or "corners" in done.stdout  # STL and .smesh say what they cannot carry
                if done.returncode == 0:
                    self.assertEqual(run(CERTA, "info", f"out.{name}", cwd=folder).returncode, 0, name)
                else:
                    self.assertTrue(triangles or "can carry it" in done.stdout, done.stdout)
            for name in volumes:
                name = {"ele": "node"}.get(name, name)
                done = run(CERTA, "conform", "part.off", "-o", f"out.{name}", cwd=folder)
                self.assertEqual(done.returncode, 0, done.stdout)
                self.assertEqual(run(CERTA, "check", f"out.{name}", "--against", "part.off", cwd=folder).returncode, 0, name)

    def test_options_exist(self):
        known = "".join(run(CERTA, command, "--help").stdout for command in COMMANDS) + (ROOT / "test").read_text()
        others = {"--install", "--build", "--target", "--preset", "--prefix", "--config", "--help"}  # CMake's, CPack's
        for option in set(re.findall(r"--[a-z][a-z-]+", README)) - others:
            self.assertIn(option, known)

    def test_packages_are_those_of_the_scripts(self):
        listed = (ROOT / "tools/setup.sh").read_text() + (ROOT / "test").read_text()
        for package in re.findall(r"\b(?:python3-[a-z0-9]+|[a-z0-9]+-dev)\b", README):
            self.assertIn(package, listed)

    def test_targets_and_presets_exist(self):
        targets = run("cmake", "--build", BUILD, "--target", "help").stdout
        for target in re.findall(r"--target ([a-z_]+)", README):
            self.assertRegex(targets, rf"\b{target}\b")
        presets = [preset["name"] for preset in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]]
        for preset in re.findall(r"--preset ([a-z]+)", README):
            self.assertIn(preset, presets)
        self.assertTrue((pathlib.Path(BUILD) / "CPackConfig.cmake").exists())
        for option in re.findall(r"-D(CERTA_[A-Z_]+)=", README):
            self.assertIn(option, (ROOT / "CMakeLists.txt").read_text())

    def test_pictures_are_small_and_every_one_is_shown(self):
        shown = set(re.findall(r"\((docs/pictures/[a-z]+\.png)\)", README))
        self.assertEqual(shown, {str(path.relative_to(ROOT)) for path in (ROOT / "docs/pictures").glob("*.png")})
        for name in shown:
            data = (ROOT / name).read_bytes()
            self.assertTrue(data.startswith(b"\x89PNG") and 5000 < len(data) <= 150_000, name)

    def test_the_two_scripts(self):
        for name in ("demo", "test"):
            self.assertTrue(os.access(ROOT / name, os.X_OK))
            self.assertEqual(run("bash", "-n", str(ROOT / name)).returncode, 0)
        self.assertEqual(run(str(ROOT / "test"), "--help").returncode, 0)
        self.assertEqual(run(str(ROOT / "test"), "--quick").returncode, 2)

    def test_without_root_they_print_the_one_line(self):
        script = "set -euo pipefail; id() { echo 1000; }; source tools/setup.sh; install_missing no-such-package g++-of-the-future; echo went on"
        done = run("bash", "-c", script, cwd=ROOT)
        self.assertEqual(done.returncode, 1)
        self.assertIn("apt-get update && apt-get install --no-install-recommends -y no-such-package g++-of-the-future", done.stdout)
        self.assertNotIn("went on", done.stdout)

    def test_links_to_parts_of_the_page_lead_there(self):
        titles = {re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in re.findall(r"^#+ (.*)$", README, re.MULTILINE)}
        for part in re.findall(r"\]\(#([^)]+)\)", README):
            self.assertIn(part, titles)


if __name__ == "__main__":
    unittest.main()
