"""examples/batch: a failing file stops nothing, a second start repeats nothing, the table has a row per file."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

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


def main():
    certa, batch = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    if shutil.which("parallel") is None:
        print("certa-test-skipped: GNU parallel is not installed")
        return
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "in put").mkdir()
        names = [f"in put/{i}.off" for i in range(6)] + ["broken.off"]
        for name in names[:-1]:
            (root / name).write_text(CUBE)
        (root / "broken.off").write_text("OFF\n8 6")
        environment = dict(os.environ, CERTA=certa, JOBS="2")

        def start(script, *arguments, listed=names, **more):
            return subprocess.run([batch / script, *arguments], input="\n".join(listed) + "\n", text=True, cwd=root,
                                  env={**environment, **more}, capture_output=True)

        def table(out):
            with open(root / out / "table.csv", newline="") as rows:
                return {row["file"]: row for row in csv.DictReader(rows)}

        # Stopped after two files, then started again: nothing is done twice.
        start("batch.sh", "out", "mesh", "conform", "--keep-outside", listed=names[:2])
        before = (root / "out" / "in put%2F0.off.mesh").stat().st_mtime_ns
        done = start("batch.sh", "out", "mesh", "conform", "--keep-outside")
        assert done.returncode == 1, done
        assert (root / "out" / "in put%2F0.off.mesh").stat().st_mtime_ns == before
        rows = table("out")
        assert sorted(rows) == sorted(names), rows
        assert all(rows[name]["exit"] == "0" and rows[name]["vertices"] == "8" for name in names[:-1]), rows
        assert rows["broken.off"]["exit"] == "3" and "broken.off:2" in rows["broken.off"]["message"], rows
        reports = [json.loads(line) for line in (root / "out" / "reports.jsonl").read_text().splitlines()]
        assert len(reports) == len(names) and sum(report.get("outcome") == "done" for report in reports) == 6
        # A start that has nothing left to do tells of the failure too.
        assert start("batch.sh", "out", "mesh", "conform", "--keep-outside").returncode == 1
        # Results of files in a folder above are not hidden.
        assert start("batch.sh", "above", "mesh", "conform", listed=["./" + names[0]]).returncode == 0
        assert (root / "above" / "%2E%2Fin put%2F0.off.mesh").exists(), os.listdir(root / "above")
        assert start("batch.sh", "none", "mesh", "conform", CERTA="no-such-command").returncode == 2
        assert not (root / "none").exists()
        # Only what failed is repeated.
        (root / "broken.off").write_text(CUBE)
        assert start("batch.sh", "out", "mesh", "conform", "--keep-outside", RETRY="1").returncode == 0
        assert (root / "out" / "in put%2F0.off.mesh").stat().st_mtime_ns == before
        assert all(row["exit"] == "0" for row in table("out").values())
        # The tasks of an array share the list.
        (root / "list").write_text("\n".join(names) + "\n")
        for task in range(3):
            done = start("slurm.sh", "list", "array", "mesh", "conform", SLURM_ARRAY_TASK_ID=str(4 + 2 * task),
                         SLURM_ARRAY_TASK_COUNT="3", SLURM_ARRAY_TASK_MIN="4", SLURM_ARRAY_TASK_STEP="2",
                         SLURM_CPUS_PER_TASK="2", SLURM_SUBMIT_DIR=str(batch))
            assert done.returncode == 0, done
        subprocess.run([batch / "merge.py", "array"], cwd=root, check=True, capture_output=True)
        assert sorted(table("array")) == sorted(names)


if __name__ == "__main__":
    main()
