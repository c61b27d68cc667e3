"""Runs what the documents show: `sh` and `python` blocks in their order in one folder per document, and compares what a
`sh` block prints (both streams) with the `text` block right under it, where `...` stands for anything. Also: links lead
somewhere.

run_documents.py BIN PYTHONPATH DOCUMENT...   (PYTHONPATH may be empty: then `python` blocks are left out)
run_documents.py --links DOCUMENT...          (runs nothing)
run_documents.py --program DOCUMENT FOLDER    (runs nothing: writes the `cpp` block to main.cpp, the `cmake` block to CMakeLists.txt)
run_documents.py --lines BIN DOCUMENT         (each `certa ...` line of blocks without a language, on made-up files)
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def blocks_of(text):
    """(language, first line, content) of every fenced block."""
    language, content, start = None, [], 0
    for number, line in enumerate(text.splitlines(), 1):
        if language is None:
            if line.startswith("```"):
                language, content, start = line[3:].strip(), [], number
        elif line.strip() == "```":
            yield language, start, "\n".join(content) + "\n"
            language = None
        else:
            content.append(line)


def matches(pattern, printed):
    parts = [re.escape(part) for part in pattern.rstrip("\n").split("...")]
    return re.fullmatch("(?s:.*)".join(parts), printed.rstrip("\n")) is not None


def check_links(document, text):
    failures = []
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", re.sub(r"(?ms)^```.*?^```", "", text)):
        if not re.match(r"[a-z]+:", target) and not (document.parent / target).exists():
            failures.append(f"{document}: no file {target}")
    return failures


def run(document, text, environment, with_python):
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        blocks = list(blocks_of(text))
        for i, (language, line, content) in enumerate(blocks):
            if language == "sh":
                done = subprocess.run(["bash", "-c", content], cwd=folder, env=environment, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
                follows = blocks[i + 1] if i + 1 < len(blocks) and blocks[i + 1][0] == "text" else None
                if follows and not matches(follows[2], done.stdout):
                    failures.append(f"{document}:{line}: printed\n{done.stdout}instead of\n{follows[2]}")
                elif not follows and done.returncode != 0:
                    failures.append(f"{document}:{line}: exit code {done.returncode}\n{done.stdout}")
            elif language == "python" and with_python:
                done = subprocess.run([sys.executable, "-c", content], cwd=folder, env=environment, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                if done.returncode != 0:
                    failures.append(f"{document}:{line}: {done.stdout}")
    return failures


def run_lines(binary, document):
    environment = dict(os.environ, PATH=f"{binary}:{os.environ['PATH']}")
    with tempfile.TemporaryDirectory() as folder:
        def run_line(line):
            done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
            return [] if done.returncode == 0 else [f"{document}: {line}\nexit code {done.returncode}\n{done.stdout}"]

        torus = '"(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"'
        failures = run_line(f"certa implicit {torus} --hausdorff 1% -o any.off && cp any.off part.off && "
                            f"certa convert part.off part.stl && certa implicit {torus} -o scan.ply")
        lines = [line for language, _, content in blocks_of(document.read_text()) if language == ""
                 for line in content.splitlines() if line.startswith("certa ")]
        for line in lines:
            failures += run_line(line)
        return failures, len(lines)


def write_program(document, folder):
    """The only block of each language, as a project."""
    folder.mkdir(parents=True, exist_ok=True)
    for wanted, name in (("cpp", "main.cpp"), ("cmake", "CMakeLists.txt")):
        (content,) = [text for language, _, text in blocks_of(document.read_text()) if language == wanted]
        (folder / name).write_text(content)


def report(failures, count, claim):
    print("\n".join(failures) or f"{count} {claim}")
    sys.exit(bool(failures))


def main():
    if sys.argv[1] == "--links":
        documents = [pathlib.Path(name) for name in sys.argv[2:]]
        report([f for d in documents for f in check_links(d, d.read_text())], len(documents), "documents, all links lead somewhere")
    if sys.argv[1] == "--program":
        write_program(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
        sys.exit(0)
    if sys.argv[1] == "--lines":
        failures, count = run_lines(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
        report(failures or ([] if count else ["no lines found"]), count, "lines, each ends well")
    binary, python_path, documents = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3:]
    environment = dict(os.environ, PATH=f"{binary}:{os.environ['PATH']}", LC_ALL="C.UTF-8")
    if python_path:
        environment["PYTHONPATH"] = python_path
    failures = []
    for name in documents:
        document = pathlib.Path(name)
        text = document.read_text()
        failures += check_links(document, text)
        failures += run(document, text, environment, bool(python_path))
    report(failures, len(documents), "documents: what they show is what happens")


if __name__ == "__main__":
    main()
