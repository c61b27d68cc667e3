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


def test_the_guide(tmp_path, monkeypatch, capsys):
    guide = ROOT / "docs" / "python.md"
    names = run_programs(guide, tmp_path, monkeypatch)
    printed = capsys.readouterr().out
    for line in re.findall(r"print\(.*\)\s+# ([<\[(].*)", guide.read_text(encoding="utf-8")):
        assert line in printed
    assert [component.genus for component in names["surface"].components] == [0]
    assert "certified" in printed and "smooth_intersection" in printed and names["stages"]
    assert (tmp_path / "meshes.html").exists()


def test_the_readme(tmp_path, monkeypatch):
    names = run_programs(ROOT / "README.md", tmp_path, monkeypatch)
    assert names["surface"].proved == ["isotopic"] and names["few"].check.ok and "delaunay" in names["mesh"].proved
    assert (tmp_path / "page.html").exists()
