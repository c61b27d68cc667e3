#!/usr/bin/python3
"""The committed template is what its sources give: by the digest that it carries, and byte for byte where node and the
locked packages are at hand (`npm ci` in viewer)."""

import hashlib
import os
import re
import shutil
import subprocess
import unittest

VIEWER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "viewer")


def read(name):
    with open(os.path.join(VIEWER, name), "rb") as file:
        return file.read()


class Template(unittest.TestCase):
    def test_digest_of_the_sources(self):
        names = [f"src/{name}" for name in sorted(os.listdir(os.path.join(VIEWER, "src")))]
        digest = hashlib.sha256()
        for name in [*names, "build.mjs", "package.json", "package-lock.json"]:
            digest.update(name.encode() + b"\n" + read(name))
        written = re.search(rb"Sources: sha256 ([0-9a-f]{64})", read("template.html"))
        self.assertEqual(written.group(1).decode(), digest.hexdigest(), "run: cd viewer && npm ci && npm run build")

    def test_byte_for_byte(self):
        node = shutil.which("node")
        if node is None or not os.path.isdir(os.path.join(VIEWER, "node_modules", "esbuild")):
            self.skipTest("needs node and viewer/node_modules (npm ci)")
        if int(subprocess.run([node, "--version"], capture_output=True, text=True).stdout[1:].split(".")[0]) < 18:
            self.skipTest("needs node 18 or newer")
        done = subprocess.run([node, "build.mjs", "--check"], cwd=VIEWER, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_nothing_is_fetched_and_the_licence_is_kept(self):
        text = read("template.html").decode()
        self.assertIn("three.js authors", text)
        self.assertIn("Permission is hereby granted, free of charge", text)
        self.assertEqual(re.findall(r"<(?:link|img|iframe|script [^>]*src)\b", text), [])
        lock = read("package-lock.json").decode()
        self.assertNotIn("resolved", lock)


if __name__ == "__main__":
    unittest.main()
