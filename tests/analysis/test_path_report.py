"""Paths as text: who brings the light, and why it is as bright."""

from typing import Any

import numpy as np
import pytest

from glrt.analysis.path_report import explanation, report
from glrt.image.recipe import Recipe
from glrt.image.sources import load
from glrt.rendering.paths.values import Contribution, Path, PathVertex, PixelPaths, running_mean
from glrt.settings import Settings


def vertex(name: str, event: Any = "matte", **more: Any) -> PathVertex:
    number = None if name == "camera" else 3
    values: dict[str, Any] = {
        "event": event,
        "position": (0, 0, 0),
        "normal": (0, 1, 0),
        "object": number,
        "shading_normal": (0, 1, 0),
        "name": name,
        "material": "white",
        "distance": 1.5,
        "throughput": (1, 0.5, 0.25),
        "direction": (0, 1, 0),
        "pdf": 0.3,
        "survival": 1.0,
    }
    return PathVertex(**{**values, **more})


def light(strategy: Any, at: int, **more: Any) -> Contribution:
    values: dict[str, Any] = {
        "vertex": at,
        "strategy": strategy,
        "source": "object",
        "object": 7,
        "name": "lamp",
        "radiance": (9, 9, 9),
        "direction": None,
        "distance": None,
        "pdf": 0.25,
        "other_pdf": 4.0,
        "weight": 0.5,
        "added": (2, 1, 1),
        "hidden": False,
    }
    return Contribution(**{**values, **more})


def path(vertices: list[PathVertex], lights: list[Contribution], **more: Any) -> Path:
    radiance: Any = tuple(np.sum([each.added for each in lights] or [(0, 0, 0)], axis=0))
    values: dict[str, Any] = {"sample": 1, "radiance": radiance, "end": "absorbed"}
    return Path(**{**values, "vertices": vertices, "contributions": lights, **more})


def pixel(radiances: Any, paths: tuple[Path, ...] = ()) -> PixelPaths:
    scene = load("cornell")
    settings = Settings(samples=len(radiances))
    recipe = Recipe(scene=scene, settings=settings, samples=1, version="0", renderer="x")
    return PixelPaths(recipe, (4, 5), np.array(radiances, np.float32), paths)


LENS = vertex("camera", "camera")
WAYS: dict[str, tuple[Path, str]] = {
    "sampled": (
        path([LENS, vertex("floor")], [light("light sampling", 1)]),
        "All of it is from lamp, by camera - floor - lamp: sampled there with density 0.25, "
        "weight 0.5.",
    ),
    "met through glass": (
        path(
            [LENS, vertex("ball", "specular transmission"), vertex("lamp")],
            [light("scattering", 2, pdf=0.0, weight=1.0)],
        ),
        "All of it is from lamp, by camera - ball - lamp: met behind a smooth surface, where no "
        "light can be sampled; paths that meet it are rare, and each weighs as much more.",
    ),
    "met and sampled": (
        path([LENS, vertex("floor"), vertex("lamp")], [light("scattering", 2)]),
        "All of it is from lamp, by camera - floor - lamp: met by scattering with density 0.25, "
        "where sampling has 4.",
    ),
    "the sky": (
        path(
            [LENS, vertex("floor")],
            [
                light("scattering", 1, source="background", name="background", other_pdf=0.0),
                light("light sampling", 1, added=(1, 0, 0)),
            ],
        ),
        "80 % of it is from the background, by camera - floor - the background: met by scattering "
        "with density 0.25, which alone finds it.",
    ),
    "seen": (
        path([LENS, vertex("lamp")], [light("camera", 1)]),
        "All of it is from lamp, by camera - lamp: the camera sees it.",
    ),
    "a particle": (
        path([vertex("lamp", "lamp"), vertex("floor")], [light("particle", 1)], particle=5),
        "All of it is from lamp, by lamp - floor - camera: linked to the camera with weight 0.5.",
    ),
    "dark": (path([LENS, vertex("floor")], []), ""),
}


@pytest.mark.parametrize("way", WAYS)
def test_the_way_of_most_light_is_reported(way: str) -> None:
    found, told = WAYS[way]
    assert explanation(found) == told


def test_shares_are_of_what_is_finite() -> None:
    found = pixel([[1, 1, 1], [np.nan, 0, 0], [6, 3, 0], [0, 0, 0], [np.inf, 1, 1]])
    assert found.shares == pytest.approx([0.25, 0, 0.75, 0, 0])
    assert (found.brightest(9), found.lost) == ([2, 0], 2)
    lines = report(found, "room").splitlines()
    assert lines[0] == "room: pixel 4 5 of 512 x 512, 5 samples by mis"
    assert lines[1] == f"mean radiance {7 / 3:.4g} {4 / 3:.4g} {1 / 3:.4g}"
    assert lines[2] == "2 samples lost or not finite, and not in the mean"
    assert lines[4] == "Sample 2 carries 75 % of this pixel's light."
    assert lines[-1] == "  3 samples brought none"


def test_a_dark_pixel_is_reported() -> None:
    told = report(pixel([[0, 0, 0]], (WAYS["dark"][0],)), "room")
    assert "No sample brings any light." in told
    assert told.endswith("no light")


def test_names_of_a_scene_cannot_write_on_the_terminal() -> None:
    evil = path([LENS, vertex("floor\x1b[2J")], [light("light sampling", 1, name="a\nb")])
    told = report(pixel([[1, 1, 1]], (evil,)), "room")
    assert "\x1b" not in told
    assert "floor\\x1b[2J" in told
    assert "a\\nb" in told


def test_the_mean_is_that_of_the_film() -> None:
    """Steps are dithered by less than half a unit in the last place."""
    samples = np.random.default_rng(3).random((1000, 3)).astype(np.float32)
    assert running_mean(samples) == pytest.approx(samples.astype(np.float64).mean(axis=0), rel=1e-5)
    assert (running_mean(samples[:1]) == samples[0]).all()
    assert (running_mean(samples[:0]) == 0).all()
