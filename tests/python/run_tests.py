"""Runs the tests of the Python module: run_tests.py FOLDER_OF_PACKAGE FOLDER_OF_TESTS [PYTEST_ARGUMENT ...].

Nothing is left in the folders of the sources. Skips, with a message that ctest understands, where pytest or hypothesis
is missing.
"""

import os
import sys

sys.dont_write_bytecode = True
package, tests = sys.argv[1:3]
sys.path.insert(0, package)
# Interpreters that tests start find the same package.
os.environ["PYTHONPATH"] = package
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
os.environ["CERTA_EXAMPLES"] = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(tests))), "examples", "python")

try:
    import hypothesis
    import pytest
except ImportError as missing:
    print(f"certa-test-skipped: {missing}; Debian has python3-pytest and python3-hypothesis")
    sys.exit(0)

# The same examples on every run, and no folder of failures in the sources.
hypothesis.settings.register_profile("certa", database=None, derandomize=True, deadline=None)
hypothesis.settings.load_profile("certa")
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", "--durations=5", *sys.argv[3:], tests]))
