"""`glrt film --cluster`: the bits of a local film, whatever ends on the way."""

import json
import os
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from glrt.cli.commands import run
from glrt.cluster import crew, worker
from glrt.core import files
from glrt.core.errors import RenderError, UsageError
from tests.support.clusters import small_cluster
from tests.support.moving_ball import MOVING_BALL

SMALL = ("--width", "24", "--height", "16", "--samples", "16", "--context", "auto")
Printed = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """A cluster of one worker."""
    with small_cluster() as found:
        yield found


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A ball that crosses the picture in four frames."""
    path = tmp_path / "ball.toml"
    path.write_text(MOVING_BALL)
    return path


def film(scene: Path, folder: Path, *more: str) -> int:
    words = ["film", str(scene), "-o", str(folder / "%d.exr"), *SMALL, "--json", *more]
    return run(words)


def frames(printed: Printed) -> list[dict[str, Any]]:
    lines = [json.loads(line) for line in printed.readouterr().out.splitlines()]
    return sorted((line for line in lines if "frame" in line), key=lambda line: int(line["frame"]))


def test_frames_have_the_bits_of_a_local_film(
    cluster: Any, scene: Path, tmp_path: Path, capsys: Printed
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    where = ("--cluster", cluster.scheduler_address)
    assert film(scene, here) == 0
    assert film(scene, there, *where, "--frames", "1-2") == 0
    capsys.readouterr()
    assert film(scene, there, *where) == 0
    assert [line["kept"] for line in frames(capsys)] == [False, True, True, False]
    for number in range(4):
        pair = [(folder / f"{number}.exr").read_bytes() for folder in (here, there)]
        assert pair[0] == pair[1]


def test_a_frame_that_fails_leaves_the_others(
    cluster: Any, scene: Path, tmp_path: Path, capsys: Printed
) -> None:
    track = 'target = "camera.fov", times = [0, 1, 2], values = [1, 1, 170]'
    curve = f'{{ {track}, interpolation = "cubic" }}]'
    scene.write_text(MOVING_BALL.replace("fps = 3", "fps = 2").replace("] }]", f"] }}, {curve}"))
    assert film(scene, tmp_path / "f", "--cluster", cluster.scheduler_address) == 4
    error = capsys.readouterr().err
    assert "frame 1 failed: frame 1: camera: fov must be greater than 0" in error
    assert sorted(f.name for f in (tmp_path / "f").iterdir()) == [f"{n}.exr" for n in (0, 2, 3, 4)]


def test_a_worker_of_another_version_is_refused_by_name(
    cluster: Any, scene: Path, tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(crew, "VERSION", "99.0")
    with pytest.raises(RenderError, match=r"no worker of tcp://.* can render"):
        film(scene, tmp_path / "f", "--cluster", cluster.scheduler_address)
    (name,) = cluster.scheduler_info["workers"]
    told = capsys.readouterr().err
    assert name in told
    assert "it has glrt" in told
    assert "install glrt 99.0 there" in told
    assert not list((tmp_path / "f").iterdir())


def test_a_worker_whose_driver_differs_renders_nothing(
    cluster: Any, scene: Path, tmp_path: Path, capsys: Printed, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It joined late: workers were asked for their drivers before."""

    def chosen(self: crew.Crew) -> bool:
        self.renderer = "another driver"
        return True

    monkeypatch.setattr(crew.Crew, "choose_driver", chosen)
    with pytest.raises(RenderError, match=r"no worker .* is left that can render"):
        film(scene, tmp_path / "f", "--cluster", cluster.scheduler_address)
    told = capsys.readouterr().err
    assert told.count("takes no part: its driver is ") == 1
    assert "another driver are wanted" in told
    assert not list((tmp_path / "f").iterdir())


def test_a_worker_of_two_threads_is_refused_by_name(
    scene: Path, tmp_path: Path, capsys: Printed
) -> None:
    with (
        small_cluster(threads=2) as two,
        pytest.raises(RenderError, match=r"no worker of tcp://.* can render"),
    ):
        film(scene, tmp_path / "f", "--cluster", two.scheduler_address)
    told = capsys.readouterr().err
    assert "takes no part: it has 2 threads, and OpenGL needs one" in told
    assert "--nthreads 1" in told


def test_frames_of_a_refused_worker_are_rendered_by_others(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Printed
) -> None:
    from distributed import get_worker

    result, refused = worker.result, set[str]()

    def mixed(parcel: bytes, digest: str, number: int | None, *rest: str) -> dict[str, Any]:
        """The first worker that gets a task has another driver than when it was asked for it."""
        address = get_worker().address
        if number is not None and refused <= {address}:
            refused.add(address)
            return {"unfit": "its driver is another"}
        return result(parcel, digest, number, *rest)

    monkeypatch.setattr(worker, "result", mixed)
    with small_cluster(2) as two:
        assert film(scene, tmp_path / "f", "--cluster", two.scheduler_address) == 0
    printed = capsys.readouterr()
    assert len(refused) == 1
    assert printed.err.count(f"({refused.pop()}) takes no part: its driver is another.") == 1
    assert len(printed.out.splitlines()) == 5  # each frame once, and the film


def test_a_frame_of_a_worker_that_ends_is_rendered_by_another(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Printed
) -> None:
    """The slow tests kill processes."""
    from distributed import get_worker

    result, ended = worker.result, set[str]()

    def mortal(parcel: bytes, digest: str, number: int | None, *rest: str) -> dict[str, Any]:
        if number is not None and not ended:
            me = get_worker()
            ended.add(me.address)
            me.loop.add_callback(me.close, executor_wait=False)
            while me.status.name != "closed":
                time.sleep(0.05)
            return {"unfit": "it answers nobody"}
        return result(parcel, digest, number, *rest)

    monkeypatch.setattr(worker, "result", mortal)
    assert film(scene, tmp_path / "here") == 0
    with small_cluster(2) as two:
        assert film(scene, tmp_path / "there", "--cluster", two.scheduler_address) == 0
    assert len(ended) == 1
    assert len(frames(capsys)) == 2 * 4  # each once
    for number in range(4):
        pair = [(tmp_path / name / f"{number}.exr").read_bytes() for name in ("here", "there")]
        assert pair[0] == pair[1]


def test_a_scheduler_that_ends_is_one_message(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    result, ends = worker.result, threading.Event()

    def slow(parcel: bytes, digest: str, number: int | None, *rest: str) -> dict[str, Any]:
        if number is not None and number > 0:
            ends.set()
            time.sleep(1)
        return result(parcel, digest, number, *rest)

    monkeypatch.setattr(worker, "result", slow)
    with small_cluster() as one:
        end = threading.Thread(target=lambda: (ends.wait(60), one.close()))
        end.start()
        with pytest.raises(RenderError, match=r"The scheduler of tcp://.* ended, .*continues\."):
            film(scene, tmp_path / "f", "--cluster", one.scheduler_address)
        end.join()
    assert {file.name for file in (tmp_path / "f").iterdir()} <= {"0.exr"}


def test_a_full_disk_is_one_message_and_what_was_written_counts(
    cluster: Any, scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Printed
) -> None:
    where = ("--cluster", cluster.scheduler_address)
    rename, count = files._rename, [0]

    def full(old: Path, new: Path) -> None:
        count[0] += new.parent.name == "f"
        if count[0] > 1 and new.parent.name == "f":
            raise OSError(28, os.strerror(28))
        rename(old, new)

    monkeypatch.setattr(files, "_rename", full)
    with pytest.raises(RenderError, match="No space left on device"):
        film(scene, tmp_path / "f", *where)
    monkeypatch.setattr(files, "_rename", rename)
    capsys.readouterr()
    assert film(scene, tmp_path / "f", *where) == 0
    assert sum(line["kept"] for line in frames(capsys)) == 1


def test_a_damaged_scene_is_not_rendered() -> None:
    answer = worker.result(b"damaged", "0" * 64, 0, "", "auto")
    assert answer["problem"][1] == RenderError.exit_code
    assert "arrived damaged" in answer["problem"][0]


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        (("--cluster", "local:0"), "needs a number from 1 to 256"),
        (("--cluster", "http://a:1"), "is not tcp://HOST:PORT"),
        (("--cluster", "tcp://a"), "is not tcp://HOST:PORT"),
        (("--cluster", "nothing.json"), "there is no file 'nothing.json'"),
        (("--cluster", "local:1", "--export", "sh"), "--export and --cluster do not go together"),
    ],
)
def test_wrong_usage_is_refused(
    scene: Path, tmp_path: Path, more: tuple[str, ...], reason: str
) -> None:
    with pytest.raises(UsageError, match=reason):
        film(scene, tmp_path / "f", *more)


def test_a_scheduler_that_does_not_answer_is_named(
    scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("glrt.cluster.clusters.PATIENCE", 1)
    with pytest.raises(RenderError, match=r"No scheduler answers at tcp://127\.0\.0\.1:9"):
        film(scene, tmp_path / "f", "--cluster", "tcp://127.0.0.1:9")
