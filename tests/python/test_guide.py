"""The programs of the guide and of the README run, one after another."""

import os
import pathlib
import re

ROOT = pathlib.Path(os.environ["CERTA_EXAMPLES"]).parents[1]


def run_programs(page, folder, monkeypatch):
    monkeypatch.chdir(folder)
    programs = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert programs
    names = {}
    for program in programs:
        exec(compile(program, str(page), "exec"), names)
    return names


def check_comments(page, printed):
    """What stands behind a `print` as a comment is what it prints."""
    for line in re.findall(r"print\(.*\)\s+# ([<\[(].*)", page.read_text(encoding="utf-8")):
        assert line in printed


def test_the_guide(tmp_path, monkeypatch, capsys):
    guide = ROOT / "docs" / "python.md"
    names = run_programs(guide, tmp_path, monkeypatch)
    printed = capsys.readouterr().out
    check_comments(guide, printed)
    assert [component.genus for component in names["surface"].components] == [0]
    assert "certified" in printed and "smooth_intersection" in printed and names["stages"]
    assert (tmp_path / "meshes.html").exists()


def test_the_readme(tmp_path, monkeypatch, capsys):
    names = run_programs(ROOT / "README.md", tmp_path, monkeypatch)
    check_comments(ROOT / "README.md", capsys.readouterr().out)
    assert names["surface"].proved == ["isotopic"] and names["few"].check.ok and "delaunay" in names["mesh"].proved
    assert (tmp_path / "page.html").exists()
