"""While it works: progress, Ctrl-C, other threads, forked processes, and where a package is moved to."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import certa
import numpy
import pytest
from shapes import CUBE, CUBE_FACES, icosphere, torus


def long_job(**options):
    """Takes minutes: a surface with very many handles."""
    return certa.implicit("sin(9*x)*cos(8*y) + sin(9*y)*cos(9*z) + sin(8*z)*cos(9*x)", clip=True, max_cells=10**9, **options)


def test_progress_comes_on_the_calling_thread():
    seen = []

    def progress(stage, fraction):
        assert threading.current_thread() is threading.main_thread()
        seen.append((stage, fraction))

    certa.remesh(*torus(), faces=200, verify=False, progress=progress)
    assert seen and all(isinstance(stage, str) and 0.0 <= fraction <= 1.0 for stage, fraction in seen)


def test_an_exception_in_progress_stops_the_job():
    start = time.monotonic()

    def progress(stage, fraction):
        raise ZeroDivisionError("enough")

    with pytest.raises(ZeroDivisionError, match="enough"):
        long_job(progress=progress)
    assert time.monotonic() - start < 60


def interrupted(job, after):
    """Seconds from Ctrl-C to KeyboardInterrupt."""
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        job()
    timer.join()
    return time.monotonic() - sent[0]


BALL = icosphere(6)
LONG_JOBS = {
    "conform": lambda: [certa.conform(*BALL) for _ in range(99)],
    "curvature": lambda: certa.curvature(*BALL, ball=0.5),
    "remesh": lambda: [certa.remesh(*BALL, vertices=5000) for _ in range(99)],
    "implicit": long_job,
    "hausdorff": lambda: certa.implicit("x^2 + y^2 + z^2 - 1", hausdorff=1e-5),
    "check": lambda: [certa.check(BALL, against=(BALL[0] * 1.001, BALL[1])) for _ in range(99)],
    "view": lambda: [certa.view(BALL) for _ in range(999)],
}


@pytest.mark.parametrize("job", LONG_JOBS)
def test_ctrl_c_interrupts(job):
    # Asked for: a second. A machine that is busy with other tests is given more.
    assert interrupted(LONG_JOBS[job], 0.3) < 10
    assert certa.conform(CUBE, CUBE_FACES).outcome == "done"


def test_other_threads_run_meanwhile():
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    before = counted[0]
    with pytest.raises(KeyboardInterrupt):
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        long_job()
    during = counted[0] - before
    done.set()
    other.join()
    assert during > 20


def test_threads_call_at_the_same_time():
    expected = certa.conform(*icosphere(2)).tetrahedra
    results = [None] * 8

    def work(i):
        if i % 2:
            results[i] = certa.conform(*icosphere(2)).tetrahedra
        else:
            with pytest.raises(certa.InputError):
                certa.conform(CUBE, [[0, 1, 99]])
            results[i] = expected

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(numpy.array_equal(result, expected) for result in results)


def test_forked_processes_work_on():
    expected = certa.curvature(*torus()).k_max
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.write(write_end, certa.curvature(*torus()).k_max.tobytes())
            code = 0
        finally:
            os._exit(code)
    os.close(write_end)
    with os.fdopen(read_end, "rb") as pipe:
        assert pipe.read() == expected.tobytes()
    assert os.waitpid(child, 0)[1] == 0


def test_the_caller_may_flush_small_numbers_to_zero():
    """Packages built with -ffast-math set this for the whole process; proofs must not depend on it."""
    ctypes = pytest.importorskip("ctypes")
    libm = ctypes.CDLL("libm.so.6")
    environment = ctypes.create_string_buffer(64)
    libm.fegetenv(environment)
    changed = ctypes.create_string_buffer(environment.raw, 64)
    control = int.from_bytes(environment.raw[28:32], "little")
    changed[28:32] = (control | 0x8040).to_bytes(4, "little")  # MXCSR: flush to zero, denormals are zero
    tiny = 1e-310
    points = CUBE * tiny
    libm.fesetenv(changed)
    try:
        flushed = tiny * 0.5 == 0.0
        result = certa.curvature(CUBE * 2.0**-1030, CUBE_FACES)
    finally:
        libm.fesetenv(environment)
    if not flushed:
        pytest.skip("this processor does not flush")
    assert points.any()
    assert result.area.tobytes() == certa.curvature(CUBE * 2.0**-1030, CUBE_FACES).area.tobytes()


def test_the_example(tmp_path):
    example = pathlib.Path(os.environ["CERTA_EXAMPLES"]) / "chain.py"
    done = subprocess.run([sys.executable, example, tmp_path], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert "proved: isotopic" in done.stdout and "proved: delaunay, conforming" in done.stdout
    assert "few polygons" in (tmp_path / "chain.html").read_text(encoding="utf-8")
    assert certa.read(tmp_path / "tetrahedra.vtu").tetrahedra.shape[1] == 4
