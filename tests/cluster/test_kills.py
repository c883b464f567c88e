"""Processes of a cluster that are killed: nothing is lost, and the bits stay the same."""

import json
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from glrt.image.image import Image
from tests.support.processes import glrt, start

SMALL = ("--width", "32", "--height", "32", "--samples", "64", "--caustics", "off")
FRAMES = 8
Process = subprocess.Popen[bytes]


class Cluster:
    """A scheduler and workers, each a process that can be killed."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.file = folder / "scheduler.json"
        self.workers = list[Process]()
        self.scheduler = self._start("scheduler", "--port", "0", "--host", "127.0.0.1")
        while not self.file.exists():
            time.sleep(0.1)

    def add_worker(self) -> None:
        """Start a worker of one thread, without a nanny, so that a kill ends it."""
        self.workers.append(self._start("worker", "--nthreads", "1", "--no-nanny"))

    def _start(self, *words: str) -> Process:
        command = [sys.executable, "-m", "dask", *words, "--no-dashboard"]
        log = subprocess.DEVNULL
        whole = [*command, "--scheduler-file", str(self.file)]
        return subprocess.Popen(whole, stdout=log, stderr=log, cwd=self._folder)

    def end(self) -> None:
        """Kill what is left."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@contextmanager
def running(folder: Path, workers: int) -> Iterator[Cluster]:
    cluster = Cluster(folder)
    try:
        for _ in range(workers):
            cluster.add_worker()
        yield cluster
    finally:
        cluster.end()


def words(output: Path, *more: str) -> tuple[str, ...]:
    span = ("--frames", f"0-{FRAMES - 1}")
    return ("film", "cradle", "-o", str(output / "%d.exr"), *span, *SMALL, *more)


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in sorted(folder.glob("*.exr"))}


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Frames of a film without a cluster."""
    folder = tmp_path_factory.mktemp("whole")
    done = glrt(*words(folder))
    assert done.returncode == 0, done.stderr
    return contents(folder)


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2, 4])
def test_workers_change_no_bit(whole: dict[str, bytes], tmp_path: Path, workers: int) -> None:
    done = glrt(*words(tmp_path, "--quiet", "--cluster", f"local:{workers}"))
    assert (done.returncode, done.stderr) == (0, "")
    assert contents(tmp_path) == whole


@pytest.mark.slow
@pytest.mark.parametrize(
    "options", [(), ("--sampler", "sobol256"), ("--crop", "3", "5", "21", "25")]
)
def test_a_picture_in_bands_has_the_bits_of_one(tmp_path: Path, options: tuple[str, ...]) -> None:
    for name, more in (("one.exr", ()), ("bands.exr", ("--cluster", "local:2"))):
        words = ("render", "spot", "-o", str(tmp_path / name), *SMALL, *options, *more, "--quiet")
        done = glrt(*words)
        assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "one.exr").read_bytes() == (tmp_path / "bands.exr").read_bytes()
    assert Image.load(tmp_path / "bands.exr").recipe


@pytest.mark.slow
def test_workers_killed_at_ten_moments_lose_nothing(
    whole: dict[str, bytes], tmp_path: Path
) -> None:
    draw = random.Random(2)
    with running(tmp_path, 2) as cluster:
        output = tmp_path / "f"
        for kill in range(10):
            for file in list(output.glob("*.exr"))[: draw.randint(1, FRAMES)]:
                file.unlink()
            film = start(*words(output, "--quiet", "--cluster", str(cluster.file)))
            time.sleep(draw.uniform(1.0, 6.0))
            victim = cluster.workers.pop(draw.randrange(len(cluster.workers)))
            victim.send_signal(signal.SIGKILL)
            victim.wait()
            cluster.add_worker()
            _, error = film.communicate(timeout=250)
            assert (film.returncode, error) == (0, ""), kill
            assert contents(output) == whole


@pytest.mark.slow
def test_a_killed_scheduler_ends_the_film_with_one_message_and_keeps_its_frames(
    whole: dict[str, bytes], tmp_path: Path
) -> None:
    draw, output = random.Random(3), tmp_path / "f"
    for attempt in range(3):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        with running(folder, 1) as cluster:
            film = start(*words(output, "--quiet", "--cluster", str(cluster.file)))
            while not output.exists() and film.poll() is None:
                time.sleep(0.1)
            time.sleep(draw.uniform(0.0, 4.0))
            cluster.scheduler.kill()
            _, error = film.communicate(timeout=250)
            if film.returncode:
                assert film.returncode == 4, error
                assert len(error.splitlines()) == 1
                assert "scheduler" in error
                assert "the same command continues" in error or "No scheduler answers" in error
            found = contents(output)
            assert found.items() <= whole.items()
    done = glrt(*words(output, "--json"))
    kept = [line["kept"] for line in map(json.loads, done.stdout.splitlines()) if "kept" in line]
    assert sum(kept) == len(found)
    assert contents(output) == whole


@pytest.mark.slow
def test_a_killed_client_continues(whole: dict[str, bytes], tmp_path: Path) -> None:
    draw, output = random.Random(4), tmp_path / "f"
    with running(tmp_path, 1) as cluster:
        for _ in range(5):
            film = start(*words(output, "--quiet", "--cluster", str(cluster.file)))
            time.sleep(draw.uniform(1.0, 6.0))
            film.kill()
            film.communicate(timeout=250)
            assert contents(output).items() <= whole.items()
        done = glrt(*words(output, "--quiet", "--cluster", str(cluster.file)))
    assert (done.returncode, done.stderr) == (0, "")
    assert contents(output) == whole


@pytest.mark.slow
def test_an_interrupted_film_ends_its_workers_and_continues(tmp_path: Path) -> None:
    long = words(tmp_path, "--samples", "1024")
    film = start(*long, "--cluster", "local:2")
    while not contents(tmp_path) and film.poll() is None:
        time.sleep(0.1)
    film.send_signal(signal.SIGINT)
    _, error = film.communicate(timeout=60)
    assert film.returncode == 130, error
    assert "interrupted; " in error.splitlines()[-1]
    assert "Traceback" not in error
    before = contents(tmp_path)
    done = glrt(*long, "--json")
    kept = [line["kept"] for line in map(json.loads, done.stdout.splitlines()) if "kept" in line]
    assert sum(kept) == len(before)


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGINT])
def test_a_picture_whose_client_ends_continues_with_its_bands(
    tmp_path: Path, end: signal.Signals
) -> None:
    """Some of 32 bands stand; in the end the file has the bits of a render in one piece."""
    out, bands = tmp_path / "out.exr", tmp_path / "out.exr.bands"
    tall = ("--width", "64", "--height", "256", "--samples", "256", "--caustics", "off")
    long = ("render", "cornell", *tall, "-o", str(out), "--quiet")
    first = start(*long, "--cluster", "local:1")
    while len(list(bands.glob("*.exr"))) < 3 and first.poll() is None:
        time.sleep(0.1)
    first.send_signal(end)
    _, error = first.communicate(timeout=60)
    stand = {file.name: file.stat().st_mtime_ns for file in bands.glob("*-*.exr")}
    assert 3 <= len(stand) < 32
    if end == signal.SIGINT:
        assert f"interrupted: {bands} holds {len(stand)} bands, and" in error
    assert glrt(*long, "--cluster", "local:1").returncode == 0
    assert not bands.exists()
    found = out.read_bytes()
    assert glrt(*long).returncode == 0
    assert out.read_bytes() == found
