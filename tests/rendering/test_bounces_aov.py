"""How often paths scatter before they end: in closed form, and by the records of paths."""

from typing import Any

import numpy as np
import pytest

from glrt.core.errors import SceneError
from glrt.gpu.context import Context
from glrt.image.aovs import AovImage
from glrt.image.sources import load
from glrt.rendering.passes import Resolved
from glrt.rendering.paths.replay import pixel_paths
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.aov_view import MOST_BOUNCES, scale_of_bounces
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from glrt.view.viewport.views import ticks_of
from tests.support.alarms import assert_near
from tests.support.aov_scenes import heap
from tests.support.builders import MATTE, plane, quad, scene_of, sphere
from tests.support.first_hits import ALL, same_aov
from tests.support.images import same_bits
from tests.support.relit_room import layered, room
from tests.support.renders import same

SIZE: dict[str, Any] = {"width": 8, "height": 8}
FURNACE = scene_of(
    [sphere([0, 0, 0], 5.0, "wall")],
    {"wall": {"type": "light", "emission": [1, 1, 1], "color": [0.5, 0.5, 0.5]}},
)


def counted(scene: Scene, context: Context, samples: int = 16, **settings: Any) -> AovImage:
    """The AOV of a render of 8 x 8 pixels, or as `settings` say."""
    ways = {name: settings.pop(name) for name in ("tier", "pipeline") if name in settings}
    options: dict[str, Any] = {**SIZE, "aov": ("bounces",), **settings}
    renderer = Renderer(scene, None, context, **ways, **options)
    image = renderer.render(samples).image()
    renderer.release()
    return image.aovs["bounces"]


@pytest.mark.parametrize("bounces", [0, 1, 7])
def test_no_path_ends_early_in_a_closed_room_without_roulette(
    context: Context, bounces: int
) -> None:
    found = counted(FURNACE, context, 32, bounces=bounces, roulette=False)
    assert (found.value == bounces).all()
    assert found.stderr is not None
    assert found.count is not None
    assert (found.stderr == 0).all()
    assert (found.count == 32).all()


def test_a_path_that_meets_nothing_has_not_scattered(context: Context) -> None:
    """A path that meets only the floor scatters once, and leaves."""
    floor = scene_of(
        [plane([0, -1, 0], [0, 1, 0], "matte")],
        {"matte": MATTE},
        camera={"position": [0, 0, 0], "look_at": [0, 0, -1], "fov": 60},
        background={"color": [1, 1, 1]},
    )
    found = counted(floor, context, roulette=False, height=8)
    assert (found.value[:4] == 0).all()
    assert (found.value[4:] == 1).all()


def test_roulette_ends_as_many_as_their_chances_say(context: Context) -> None:
    """Albedo a = 1/8 keeps 4 a = 1/2 of the paths at the first scattering.

    Survivors carry a / (1/2) = 1/4, so that at the second 4 a / 4 = 1/8 of them go on, whose
    throughput is 1/4 again, and so on: the mean is 1/2 + 1/2 1/8 + 1/2 1/64 + ... = 4/7.
    """
    dark = scene_of(
        [sphere([0, 0, 0], 5.0, "wall")],
        {"wall": {"type": "lambertian", "color": [0.125, 0.125, 0.125]}},
        background={"color": [1, 1, 1]},
    )
    found = counted(dark, context, 256, bounces=40, sampler="independent")
    assert found.stderr is not None
    mean = float(found.value.mean(dtype=np.float64))
    error = float(np.sqrt((found.stderr.astype(np.float64) ** 2).mean() / found.value.size))
    assert error < 0.01
    assert_near(mean, 4 / 7, error)


@pytest.mark.slow
def test_it_is_the_mean_of_what_recorded_paths_tell(context: Context) -> None:
    scene = load("cornell")
    settings: dict[str, Any] = {"width": 8, "height": 8, "bounces": 6}
    found = counted(scene, context, 16, **settings)
    wanted = settings_for(scene.render, **settings, samples=16)
    for pixel in ((1, 2), (5, 6)):
        paths = pixel_paths(scene, wanted, pixel, context=context).paths
        depths = [
            sum(vertex.event != "passes a hole" for vertex in path.vertices) for path in paths
        ]
        ended = [path.end == "left the scene" for path in paths]
        counts = [d - 1 if left else d - 2 for d, left in zip(depths, ended, strict=True)]
        assert found.value[pixel[1], pixel[0]] == pytest.approx(np.mean(counts), rel=1e-5)


WAYS: list[tuple[Tier, Resolved]] = [("generic", "fragment"), ("complete", "compute")]


@pytest.mark.slow_cases("generic-fragment-sobol")
@pytest.mark.parametrize("sampler", ["sobol", pytest.param("independent", marks=pytest.mark.slow)])
@pytest.mark.parametrize(("tier", "pipeline"), WAYS)
def test_ways_and_company_change_no_bit(
    context: Context, tier: Tier, pipeline: Resolved, sampler: str
) -> None:
    if not context.is_software:
        pytest.skip("bits are promised on software drivers alone")
    own: dict[str, Any] = {"bounces": 3, "sampler": sampler}
    alone = counted(heap(), context, 17, **own)
    other = counted(heap(), context, 17, tier=tier, pipeline=pipeline, **own)
    among = counted(heap(), context, 17, aov=(*ALL, "bounces"), **own)
    assert same_aov(alone, other)
    assert same_aov(alone, among)
    part = counted(heap(), context, 17, crop=(2, 3, 4, 5), **own)
    assert same_bits(part.value, alone.value[3:8, 2:6])
    assert alone.value.std() > 0.1


def test_it_changes_no_bit_of_the_picture(context: Context) -> None:
    images = []
    for aov in ((), ("bounces",)):
        renderer = Renderer(heap(), context=context, aov=aov, bounces=3, **SIZE)
        images.append(renderer.render(17).image())
        renderer.release()
    assert same(*images)
    assert [*images[1].aovs] == ["bounces"]


def test_another_limit_begins_again(context: Context) -> None:
    renderer = Renderer(
        FURNACE, context=context, aov=("bounces",), roulette=False, bounces=2, **SIZE
    )
    renderer.render(16)
    renderer.update(bounces=5)
    assert (renderer.render(16).image().aovs["bounces"].value == 5).all()
    renderer.release()


@pytest.mark.usefixtures("loop_limit")
@pytest.mark.usefixtures("twins_stay")
def test_what_is_beyond_the_loop_limit_is_refused_by_name(context: Context) -> None:
    pile = [quad([0, 0, -3], [1, 0, 0], [0, 1, 0], "matte")] * 10
    scene = scene_of(pile, {"matte": MATTE}, background={"color": [1, 1, 1]})
    told = ""
    try:
        counted(scene, context, bounces=400)
    except SceneError as refusal:
        told = str(refusal)
    assert "--aov bounces is beyond" in told
    assert "16 paths" in told
    assert "fewer bounces" in told
    assert counted(scene, context, 1, bounces=400, sampler="independent").value.max() < 2


def test_colours_reach_from_none_to_the_limit() -> None:
    highs = [scale_of_bounces(limit).high for limit in (0, 4, 16, 1000)]
    assert highs == [1, 4, MOST_BOUNCES, MOST_BOUNCES]
    assert ticks_of("bounces", scale_of_bounces(4)) == {0.0: "0", 2.0: "2", 4.0: "4"}
    assert ticks_of("bounces", scale_of_bounces(99))[16.0] == "16 and more"


@pytest.mark.slow
def test_layers_of_light_change_no_number(context: Context) -> None:
    numbers = []
    for layering in ("none", "groups", "lengths"):
        with layered(room(2), context, layering, aov=("bounces",)) as renderer:
            numbers.append(renderer.render(16).image().aovs["bounces"])
    assert same_aov(numbers[0], numbers[1])
    assert same_aov(numbers[0], numbers[2])
