#!/usr/bin/python3
"""The Debian package in a root of its own: dpkg refuses it without its dependencies, installs it with them, command and
module work there, and after removal nothing is left.

root_test.py BUILD WORK

The root is made offline, of the files of packages that this machine has: the essential ones, then what the package
depends on, then what it recommends for Python. dpkg's own records are copied with them, so that dependencies are judged as
anywhere. Needs root, or user namespaces; without, it skips with a message.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

BUILD, WORK = map(pathlib.Path, sys.argv[1:3])
ROOT = WORK / "root"
INFO = pathlib.Path("/var/lib/dpkg/info")
ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "HOME": "/root", "DEBIAN_FRONTEND": "noninteractive"}


def skip(reason):
    print(f"certa-test-skipped: {reason}")
    sys.exit(0)


def run(*command, expect=0, **more):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, **more)
    if expect is not None and done.returncode != expect:
        sys.exit(f"{' '.join(map(str, command))}\nexits {done.returncode}\n{done.stdout}")
    return done.stdout


def inside(*command, expect=0):
    return run(*ENTER, str(ROOT), *command, expect=expect, env=ENVIRONMENT)


def records():
    """dpkg's record of each installed package, and who provides which name."""
    packages, providers = {}, {}
    for text in pathlib.Path("/var/lib/dpkg/status").read_text(encoding="utf-8").split("\n\n"):
        fields = dict(re.findall(r"^([A-Za-z-]+):[ ]?(.*(?:\n[ \t].*)*)", text, re.MULTILINE))
        if not fields.get("Status", "").endswith(" installed"):
            continue
        name = fields["Package"]
        packages.setdefault(name, (fields, text))
        for word in re.split(r",\s*", fields.get("Provides", "")):
            providers.setdefault(word.split(" ")[0], []).append(name)
    return packages, providers


PACKAGES, PROVIDERS = records()


def chosen(alternatives):
    """The installed package that meets `a (>= 1) | b`, if any."""
    for part in alternatives.split("|"):
        name = re.split(r"[ (:]", part.strip())[0]
        for candidate in [name] if name in PACKAGES else PROVIDERS.get(name, []):
            return candidate
    return None


def closure(wanted):
    """Names of packages with all that they depend on."""
    found, open_names = set(), list(wanted)
    while open_names:
        name = open_names.pop()
        if name in found:
            continue
        found.add(name)
        fields = PACKAGES[name][0]
        for clause in filter(None, re.split(r",\s*", fields.get("Pre-Depends", "") + ", " + fields.get("Depends", ""))):
            package = chosen(clause)
            if package is None:
                skip(f"{name} depends on {clause}, which is not installed here")
            open_names.append(package)
    return found


def records_of(name):
    """Files of dpkg about a package: its lists, scripts and triggers."""
    return [path for path in INFO.glob(f"{name}*") if re.fullmatch(re.escape(name) + r"(:[a-z0-9]+)?\.[a-z0-9]+", path.name)]


def add_packages(names):
    """Copies packages from this machine into the root, with dpkg's records of them."""
    paths = set()
    for name in names:
        for record in records_of(name):
            shutil.copy(record, ROOT / "var/lib/dpkg/info" / record.name)
            if record.suffix == ".list":
                paths.update(line for line in record.read_text().splitlines() if line != "/." and os.path.lexists(line))
    # What scripts of packages make: links into /etc/alternatives beside the files that are copied.
    for folder in ("/usr/bin", "/usr/lib", f"/usr/lib/{os.uname().machine}-linux-gnu"):
        with os.scandir(folder) as entries:
            paths.update(e.path for e in entries if e.is_symlink() and os.readlink(e.path).startswith("/etc/alternatives/"))
    listing = "\0".join(path.lstrip("/") for path in sorted(paths))
    subprocess.run(f"tar -C / --no-recursion --ignore-failed-read --null -T - -cf - 2>/dev/null | tar -C '{ROOT}' --keep-directory-symlink --no-same-owner -xf -",
                   shell=True, input=listing, text=True, check=True)
    with open(ROOT / "var/lib/dpkg/status", "a", encoding="utf-8") as status:
        for name in sorted(names):
            status.write(PACKAGES[name][1].strip("\n") + "\n\n")
    inside("ldconfig")


def make_root():
    shutil.rmtree(ROOT, ignore_errors=True)
    for folder in ("var/lib/dpkg/info", "var/lib/dpkg/updates", "var/lib/dpkg/triggers", "var/log", "etc", "tmp", "dev", "proc", "root", "usr"):
        (ROOT / folder).mkdir(parents=True)
    for name in ("bin", "sbin", "lib", "lib32", "lib64", "libx32"):
        if os.path.islink(f"/{name}"):
            (ROOT / "usr" / name).mkdir()
            (ROOT / name).symlink_to(f"usr/{name}")
    for name in ("passwd", "group"):
        shutil.copy(f"/etc/{name}", ROOT / "etc" / name)
    shutil.copytree("/etc/alternatives", ROOT / "etc/alternatives", symlinks=True)
    (ROOT / "dev/null").touch()
    (ROOT / "var/lib/dpkg/status").touch()


def everything():
    """All paths below the root but those that dpkg and the linker keep for themselves."""
    own = ("var/lib/dpkg", "var/log", "etc/ld.so.cache", "var/cache", "root", "tmp")
    return {str(path.relative_to(ROOT)) for path in ROOT.rglob("*") if not str(path.relative_to(ROOT)).startswith(own)}


def try_command():
    torus = "(x^2+y^2+z^2+0.84)^2 - 4*(x^2+y^2)"
    said = inside("bash", "-ec", f"cd /tmp; certa --version; certa implicit '{torus}' --error 1% -o t.off; certa check t.off --against '{torus}';"
                  "certa remesh t.off --vertices 300 --output triangles -o few.off; certa check few.off --against t.off; certa conform few.off -o few.vtu;"
                  "certa check few.vtu --against few.off; certa view t.off few.vtu -o page.html; test -s page.html")
    for word in ("CERTIFIED", "verified: well-formed, delaunay, conforming"):
        if word not in said:
            sys.exit(f"no '{word}' in\n{said}")
    inside("test", "-s", "/usr/share/man/man1/certa.1")


def main():
    if shutil.which("dpkg-deb") is None or shutil.which("cpack") is None or not INFO.is_dir():
        skip("this machine has no dpkg")
    if run(*ENTER, "/", "true", expect=None) != "":
        skip("neither root nor user namespaces: no root can be entered")
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    run("cpack", "--config", str(BUILD / "CPackConfig.cmake"), "-G", "DEB", "-B", str(WORK / "package"))
    package = next((WORK / "package").glob("*.deb"))
    depends = run("dpkg-deb", "--field", str(package), "Depends").strip()
    make_root()
    base = closure([name for name, (fields, _) in PACKAGES.items() if fields.get("Essential") == "yes"])
    add_packages(base)
    shutil.copy(package, ROOT / "tmp/certa.deb")
    refused = inside("dpkg", "-i", "/tmp/certa.deb", expect=None)
    if "libtbb12 is not installed" not in refused and "depends on libtbb12" not in refused:
        sys.exit(f"dpkg does not ask for libtbb12:\n{refused}")
    inside("dpkg", "--purge", "certa")
    wanted = {clause: chosen(clause) for clause in re.split(r",\s*", depends)}
    for clause, name in wanted.items():
        if name is None:
            skip(f"{clause} is not installed here")
    needed = closure(wanted.values())
    add_packages(needed - base)
    has_module = "_certa" in run("dpkg-deb", "--contents", str(package))
    if has_module and "python3-numpy" in PACKAGES:
        add_packages(closure(["python3-numpy"]) - needed - base)
    before = everything()
    print(inside("dpkg", "-i", "/tmp/certa.deb"), end="")
    try_command()
    if has_module and "python3-numpy" in PACKAGES:
        # As root, so that compiled files of Python's appear beside the module, which removal must not trip over.
        print(inside("python3", "-c", "import certa; print(certa.__file__, certa.check(certa.implicit('x^2 + y^2 + z^2 - 1')))"), end="")
    print(inside("dpkg", "--remove", "certa"), end="")
    inside("dpkg", "--purge", "certa")
    left = sorted(path for path in everything() - before if "__pycache__" not in path or "certa" in path)
    if left:
        sys.exit("left behind: " + ", ".join(left[:20]))
    print(f"package: {len(base)} packages as a base, {len(needed - base)} that it depends on; installed, used, removed, nothing left")
    shutil.rmtree(WORK)


ENTER = ("chroot",) if os.geteuid() == 0 else ("unshare", "--map-root-user", "chroot")
if __name__ == "__main__":
    main()
