"""Peers answer over pipes; a peer's fault is reported, and hurts nobody else."""

import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from bench.peer import Peer, Request
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.renders import rendered
from tests.wgsl.device import Device

SERVER = """
import os, sys
import numpy as np
from glrt.core.errors import SceneError
from glrt import Image
from bench.peer import Request, serve

def render(request):
    print("noise of a library")
    if request.seed == 1:
        raise SceneError("no such material")
    if request.seed == 2:
        sys.stderr.write("first\\nthe driver is gone\\n")
        os.abort()
    radiance = np.full((request.height, request.width, 3), request.seed, np.float32)
    radiance[0] = request.parsed().camera.fov
    return Image(radiance, np.zeros_like(radiance), request.samples), 0.25

serve("Painter 2", render)
"""
SKY = {"color": [1.0, 2.0, 3.0]}
SCENE = scene_of([sphere([0, 0, -3], 1, "matte")], {"matte": MATTE}, {"fov": 30.0}, background=SKY)


def request(seed: int) -> Request:
    return Request.of(SCENE, width=4, height=3, bounces=1, samples=8, seed=seed)


@contextmanager
def painter() -> Iterator[Peer]:
    peer = Peer([sys.executable, "-c", SERVER])
    try:
        yield peer
    finally:
        peer.close()


def test_folders_of_killed_processes_are_gone_after_the_next_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folders of peers at work stay, and so do all other folders."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    for name, days in (("glrt-peer-old", 1.1), ("glrt-peer-new", 0.9), ("other-old", 1.1)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "log").touch()
        then = time.time() - days * 24 * 3600
        os.utime(tmp_path / name, (then, then))
    with painter():
        names = {path.name for path in tmp_path.iterdir()}
        assert len(names) == 3, "those that stay, and the peer's own"
        assert names > {"glrt-peer-new", "other-old"}
    assert {path.name for path in tmp_path.iterdir()} == {"glrt-peer-new", "other-old"}


def test_a_peer_renders_the_scene_that_it_is_sent() -> None:
    with painter() as peer:
        assert peer.name == "Painter 2"
        for seed in (3, 4):
            image, seconds = peer.render(request(seed))
            assert seconds == 0.25
            assert image.radiance.shape == (3, 4, 3)
            assert np.all(image.radiance[0] == 30)
            assert np.all(image.radiance[1:] == seed)


def test_a_peer_goes_on_after_a_scene_that_it_refuses() -> None:
    with painter() as peer:
        with pytest.raises(RenderError, match=r"^no such material$"):
            peer.render(request(1))
        assert peer.render(request(3))


def test_the_end_of_a_peer_is_reported_by_its_last_words() -> None:
    with painter() as peer:
        for _ in range(2):
            with pytest.raises(RenderError, match=r"^the driver is gone$"):
                peer.render(request(2))


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ("raise SystemExit('not installed')", "not installed"),
        ("raise SystemExit(7)", "it ended with exit code 7"),
    ],
)
def test_a_peer_that_does_not_start_says_why(program: str, reason: str) -> None:
    with pytest.raises(RenderError, match=f"^{reason}$"):
        Peer([sys.executable, "-c", program])


@pytest.mark.slow
def test_the_wgsl_version_is_a_peer(context: Context, webgpu: Device) -> None:
    assert webgpu
    peer = Peer([sys.executable, "-m", "tests.wgsl.serve"])
    try:
        image, seconds = peer.render(request(5))
    finally:
        peer.close()
    settings = {"method": "naive", "roulette": False, "bounces": 1, "seed": 5}
    ours = rendered(SCENE, context, 8, width=4, height=3, **settings)
    assert peer.name.startswith("WGSL, ")
    assert seconds > 0
    assert image.radiance.std() > 0.1
    assert np.allclose(image.radiance, ours.radiance, rtol=1e-5)
