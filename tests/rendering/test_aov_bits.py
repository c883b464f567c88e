"""AOVs to the bit: whatever the way that leads to them, and however the scene lies in space."""

import os
import subprocess
import sys
from ctypes.util import find_library
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.image.aovs import AovImage, AovImages
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.plan import facts
from glrt.rendering import renderer as renderer_module
from glrt.rendering import schedule, tracer
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.passes import Resolved
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import HEADLESS, DispatchRange
from glrt.scene.scene import Scene
from glrt.settings import Aov
from tests.support.aov_scenes import heap
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.first_hits import ALL, MEANS, gathered, same_aovs
from tests.support.images import same_bits
from tests.support.mixed_scene import everything
from tests.support.numerics import Array
from tests.support.renders import SAMPLERS, rendering, same
from tests.support.system_packages import needs_osmesa, needs_package

SIZE: dict[str, Any] = {"width": 16, "height": 16}
ROOT = Path(__file__).parents[2]


def stderr_of(aov: AovImage) -> Array:
    assert aov.stderr is not None
    return aov.stderr


def without_position(aovs: AovImages) -> AovImages:
    return {name: aov for name, aov in aovs.items() if name != "position"}


# --- ways to the same picture ----------------------------------------------------------------


def picture(
    scene: Scene, context: Context, tier: Tier = "generic", way: Resolved = "compute", **more: Any
) -> Image:
    """A picture of two observations and one sample, by default with all AOVs.

    They take two dispatches at least: the second one goes on from the films of the first.
    """
    options: dict[str, Any] = {**SIZE, "bounces": 2, "aov": ALL, **more}
    renderer = Renderer(scene, None, context, tier, way, **options)
    block = renderer.settings.block
    image = renderer.render(block).render(2 * block + 1).image()
    renderer.release()
    return image


WAYS: list[tuple[Tier, Resolved]] = [
    ("generic", "fragment"),
    ("complete", "compute"),
    ("complete", "fragment"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("tier", "way"), WAYS)
def test_both_pipelines_and_tiers_give_the_same_aovs(
    context: Context, tier: Tier, way: Resolved
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    assert same_aovs(picture(heap(), context, tier, way).aovs, picture(heap(), context).aovs)


@pytest.mark.slow
@pytest.mark.parametrize("way", ["compute", "fragment"])
@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("name", ["heap", "everything", "weekend", "lamps"])
def test_other_scenes_have_the_same_aovs_by_every_way(
    context: Context, name: str, sampler: str, way: Resolved
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    ours = {"heap": heap(), "everything": everything()}
    scene = ours.get(name) or load(name)
    by_compute = picture(scene, context, sampler=sampler)
    by_way = picture(scene, context, "complete", way, sampler=sampler)
    assert same_aovs(by_way.aovs, by_compute.aovs)
    assert same(by_way, by_compute)


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_aovs_change_no_bit_of_the_picture(context: Context, sampler: str) -> None:
    with_all, plain = (picture(heap(), context, sampler=sampler, aov=aov) for aov in (ALL, ()))
    assert same(with_all, plain)
    assert with_all.radiance.any()
    assert plain.aovs == {}
    assert [*with_all.aovs] == [*ALL]


@pytest.mark.slow_cases("albedo")
@pytest.mark.parametrize("name", ALL)
def test_an_aov_alone_is_that_among_all(context: Context, name: Aov) -> None:
    alone = picture(heap(), context, aov=(name,)).aovs
    assert same_aovs(alone, {name: picture(heap(), context).aovs[name]})


TWO_ROUTES = """
from glrt.gpu.context import open_context
from tests.support.aov_scenes import heap
from tests.support.first_hits import gathered, same_aovs

egl, osmesa = open_context("egl"), open_context("osmesa")
assert (egl.route, osmesa.route) == ("egl", "osmesa")
found = [gathered(heap(), opened, 33, sampler="sobol") for opened in (egl, osmesa)]
print(egl.is_software, same_aovs(*found))
"""


@pytest.mark.slow
def test_egl_and_osmesa_give_the_same_aovs(tmp_path: Path) -> None:
    needs_package(bool(find_library("EGL")), "libegl1")
    needs_osmesa()
    path = os.pathsep.join([str(ROOT), *sys.path])
    told = subprocess.run(
        [sys.executable, "-W", "error", "-c", TWO_ROUTES],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=120,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert told.returncode == 0, told.stderr
    is_software, is_same = told.stdout.split()
    if is_software == "False":
        pytest.skip("bits are promised on software drivers alone")
    assert is_same == "True"


# --- dispatches ------------------------------------------------------------------------------


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_aovs_that_grow_with_the_picture_are_those_gathered_at_once(
    context: Context, sampler: str
) -> None:
    with rendering(heap(), context, sampler=sampler, bounces=0, aov=ALL, **SIZE) as renderer:
        for samples in (1, 2, 16, 17, 40):
            grown = renderer.render(samples).image().aovs
        renderer.restart()
        renderer.step(40)
        assert same_aovs(renderer.image().aovs, grown)


def test_aovs_in_many_small_dispatches_have_the_same_bits(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each dispatch does one tile and one observation; the frame of odd size has six tiles."""
    odd = {"width": 21, "height": 11, "sampler": "sobol"}
    expected = gathered(heap(), context, 20, **odd)
    parts: list[DispatchRange] = []
    work = DeviceScene.dispatch

    def noted(self: DeviceScene, kernel: Any, film: Any, plan: Any, part: Any, *rest: Any) -> None:
        parts.append(part)
        work(self, kernel, film, plan, part, *rest)

    monkeypatch.setattr(DeviceScene, "dispatch", noted)
    monkeypatch.setattr(schedule, "FIRST_TILES", 1)
    for module in (renderer_module, tracer):
        monkeypatch.setattr(module, "HEADLESS", HEADLESS._replace(limit=1e-12))
    assert same_aovs(gathered(heap(), context, 20, **odd), expected)
    assert parts.count(DispatchRange(16, 3, 1)) == 2 * 3, "of two observations, three passes"


@pytest.mark.slow
def test_a_tree_and_a_loop_find_the_same(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    by_tree = gathered(load("weekend"), context, 2, **SIZE)
    for name in ("TREE_FROM", "SPHERES_FROM"):
        monkeypatch.setattr(facts, name, 1 << 30)
    assert same_aovs(gathered(load("weekend"), context, 2, **SIZE), by_tree)


@pytest.mark.slow
@pytest.mark.usefixtures("twins_stay")
def test_a_dispatch_that_runs_into_the_loop_limit_is_done_again(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Believing that rays run through any tree in no time, dispatches are too large."""
    if usable_rounds(context) is None:
        pytest.skip("this driver has no loop limit")
    pile = [sphere([0.1, 0, -3], 1, "matte")] * 300
    scene = scene_of(pile, {"matte": MATTE}, background={"color": [1, 1, 1]})
    expected = gathered(scene, context, 512)
    monkeypatch.setattr(schedule.rounds_of_search, "__defaults__", (0.0,))
    lost: list[bool] = []
    told = DeviceScene.lost_any

    def noted(self: DeviceScene) -> bool:
        lost.append(told(self))
        return lost[-1]

    monkeypatch.setattr(DeviceScene, "lost_any", noted)
    with rendering(scene, context, width=8, height=8, bounces=0, aov=ALL) as renderer:
        while renderer.samples < 512:
            renderer.step(64)  # AOVs fall behind, and have all to gather at once
        found = renderer.image().aovs
    assert any(lost)
    assert same_aovs(found, expected)
    assert expected["depth"].count is not None
    assert expected["depth"].count.max() == 512


# --- scenes moved and scaled -----------------------------------------------------------------


def test_a_crop_has_the_aovs_of_that_part_of_the_frame(context: Context) -> None:
    whole, part = (gathered(heap(), context, 5, **SIZE, crop=c) for c in (None, (3, 2, 11, 13)))
    place = slice(2, 15), slice(3, 14)
    for name in ALL:
        assert same_bits(part[name].value, whole[name].value[place])
    for name in MEANS:
        assert same_bits(stderr_of(part[name]), stderr_of(whole[name])[place])


@pytest.mark.parametrize("power", [-10, 7])
def test_a_scene_scaled_by_a_power_of_two_scales_distances_alone(
    context: Context, power: int
) -> None:
    scale = np.float32(2.0**power)
    plain, scaled = (gathered(heap(s), context, 16, **SIZE) for s in (1.0, 2.0**power))
    expected = dict(plain)
    distances: tuple[Aov, ...] = ("depth", "position")
    for name in distances:
        aov = plain[name]
        values = aov.value * scale, stderr_of(aov) * scale
        expected[name] = AovImage(*values, aov.count, aov.observations)
    assert same_aovs(scaled, expected)


def test_far_from_the_origin_only_positions_lose_digits(context: Context) -> None:
    """They are moved in float64, and rounded once."""
    offset = (1e7, -1e7, 2.0**20)
    near, far = (gathered(heap(1.0, o), context, 16, **SIZE) for o in ((0, 0, 0), offset))
    assert same_aovs(without_position(far), without_position(near))
    count = near["position"].count
    assert count is not None
    moved = near["position"].value.astype(np.float64) + offset
    apart = np.abs(far["position"].value - moved)[count > 0]
    assert apart.max() <= 0.5 + 1e-6  # floats are 1 apart there
    assert (far["position"].value[count == 0] == 0).all()
    assert same_bits(stderr_of(far["position"]), stderr_of(near["position"]))
