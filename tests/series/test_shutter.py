"""Motion blur: times of samples, and pictures of a scene that moves while the shutter is open."""

import copy
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.cli.commands import run
from glrt.core.errors import SceneError, UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.rendering.renderer import Renderer
from glrt.rendering.shutter import pcg_hash, time_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import parse_scene, scene_to_dict
from glrt.scene.scenefile.toml_writer import write_scene
from glrt.scene.summary import summary
from glrt.scene.warnings import cautions
from glrt.series.series import Series
from glrt.settings import Cost, Settings, settings_for
from tests.series.test_frames import MOVING, SMALL
from tests.support.renders import same


def blurred(shutter: float = 0.5, **tables: Any) -> Scene:
    """The scene of frames with an open shutter; it has a frame each quarter of a second."""
    table = {**copy.deepcopy(MOVING), **tables}
    return parse_scene({**table, "camera": {**table["camera"], "shutter": shutter}}, "x")


def exposed(scene: Scene, context: Context, samples: int, opens: bool = True, **more: Any) -> Image:
    renderer = Renderer(scene, SMALL, context, opens_shutter=opens, samples=samples, **more)
    image = renderer.render().image()
    renderer.release()
    return image


# --- times ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("sampler", ["sobol", "sobol64"])
def test_a_block_has_one_time_in_each_of_equal_parts_in_another_order(sampler: str) -> None:
    settings = Settings(sampler=sampler)
    size = settings.block
    times = np.array([time_of(n, settings) for n in range(50 * size)]).reshape(50, size)
    parts = (times * size).astype(int)
    assert (np.sort(parts, axis=1) == np.arange(size)).all()
    assert len({tuple(row) for row in parts}) == 50
    assert not (parts == np.arange(size)).all(axis=1).any()


def test_times_are_uniform_and_those_of_blocks_are_independent() -> None:
    """Each sample of a block alone, too: a render may end within a block."""
    times = np.array([time_of(n, Settings(seed=7)) for n in range(16 * 4000)]).reshape(4000, 16)
    error = np.sqrt(1 / 12 / 4000)
    assert (np.abs(times.mean(axis=0) - 0.5) < 4.5 * error).all()
    within = times * 16 % 1
    spread = np.sqrt(1 / 12 / within.size)
    assert abs(within.mean() - 0.5) < 4.5 * spread
    products = (within[1:] - 0.5) * (within[:-1] - 0.5)
    assert abs(products.mean()) < 4.5 / 12 / np.sqrt(products.size)
    other = np.array([time_of(n, Settings(seed=8)) for n in range(16)])
    assert not np.isin(other, times).any()


def test_the_hash_of_times_is_that_of_shaders() -> None:
    """pcg_hash of 0 and 1, by the published function on 32-bit integers."""
    assert [pcg_hash(0), pcg_hash(1)] == [129708002, 2831084092]


# --- scenes --------------------------------------------------------------------------------------


def test_the_shutter_opens_at_the_moment_of_the_frame() -> None:
    frame = blurred(0.5).at_frame(2)
    still = blurred(0.0).at_frame(2)
    assert (frame.frames, frame.is_blurred, still.is_blurred) == (1, True, False)
    centers = [frame.in_shutter(share).objects[0].model_dump()["center"][0] for share in (0, 1)]
    assert centers == [0.0, 0.25]
    assert frame.objects == still.objects
    assert frame.at_frame(0) == frame
    assert frame.exposed == frame
    assert parse_scene(scene_to_dict(frame), "x") == frame


def test_light_groups_move_with_the_rest() -> None:
    tracks = [{"target": "lights.background", "times": [0, 1], "values": [0, 4]}]
    frame = blurred(1.0, animation={"fps": 4, "tracks": tracks}).at_frame(1)
    found = [frame.in_shutter(share).light_groups["background"] for share in (0.0, 0.5, 1.0)]
    assert found == [1.0, 1.5, 2.0]


def test_a_start_moves_frame_0_and_leaves_the_last_key_where_it_was() -> None:
    scene = blurred(0.0, animation={**MOVING["animation"], "start": 0.5})
    assert scene.frames == 3
    assert scene.at_frame(0) == blurred(0.0).at_frame(2)
    late = blurred(0.0, animation={**MOVING["animation"], "start": 7})
    assert late.frames == 1


def test_a_curve_that_leaves_its_range_within_the_shutter_is_named() -> None:
    track = {
        "target": "objects.ball.radius",
        "times": [0, 0.1, 0.2, 0.3],
        "values": [3, 1e-3, 1e-3, 3],
    }
    tracks = [{**track, "interpolation": "cubic"}]
    frame = blurred(1.0, animation={"fps": 4, "tracks": tracks}).at_frame(0)
    with pytest.raises(SceneError, match=r"with the shutter open: objects.ball: radius must be"):
        frame.in_shutter(0.6)


def test_an_open_shutter_before_a_still_scene_gets_a_caution() -> None:
    still = blurred(0.5).still
    assert any("camera.shutter 0.5 blurs nothing" in text for text in cautions(still, SMALL))
    assert not any("shutter" in text for text in cautions(blurred(0.5), SMALL))
    assert "shutter    open for 0.5 of a frame, 0.125 s: what moves is blurred" in summary(
        blurred(0.5)
    )


def test_turntables_and_sweeps_show_a_moment() -> None:
    series = Series(blurred(), SMALL, turns=4)
    assert not series.still(1).scene.is_blurred
    assert Series(blurred(), SMALL).still(1).scene.is_blurred


# --- pictures ------------------------------------------------------------------------------------


def test_a_closed_shutter_leaves_bits_and_program_as_they_are(context: Context) -> None:
    """Closed by the file, or for a renderer that shows moments, as that of the window."""
    expected = exposed(parse_scene(MOVING, "x"), context, 16)
    assert same(exposed(blurred(0.0), context, 16), expected)
    assert same(exposed(blurred(0.5), context, 16, opens=False), expected)
    assert not same(exposed(blurred(0.5), context, 16), expected)


def test_each_sample_is_that_of_the_still_at_its_time(context: Context) -> None:
    """The last sample of a picture is its mean times the samples, less the earlier ones'."""
    frame, count = blurred(1.0).at_frame(1), 6
    pictures = [exposed(frame, context, n).radiance.astype(float) for n in range(1, count + 1)]
    sums = [np.zeros_like(pictures[0]), *(n * it for n, it in enumerate(pictures, 1))]
    for sample, (before, after) in enumerate(pairwise(sums)):
        still = frame.in_shutter(time_of(sample, SMALL))
        stills = [
            exposed(still, context, n).radiance.astype(float) for n in (sample, sample + 1) if n
        ]
        own = (sample + 1) * stills[-1] - (sample * stills[0] if sample else 0)
        np.testing.assert_allclose(after - before, own, atol=2e-5)


def test_a_camera_that_moves_with_the_ball_shows_it_sharp(context: Context) -> None:
    """The background is even, so that the picture is that of a still."""
    names = {
        "objects.ball.center": [0, 0, 0],
        "camera.position": [0, 0, 5],
        "camera.look_at": [0] * 3,
    }
    tracks = [
        {"target": name, "times": [0, 1], "values": [at, [at[0] + 4, at[1] - 8, at[2] + 2]]}
        for name, at in names.items()
    ]
    even = {"bottom": [0.5, 0.6, 0.7], "top": [0.5, 0.6, 0.7]}
    frame = blurred(1.0, background=even, animation={"fps": 4, "tracks": tracks}).at_frame(1)
    moving, still = (exposed(frame, context, 16, opens=opens) for opens in (True, False))
    np.testing.assert_allclose(moving.radiance, still.radiance, rtol=1e-5)
    alone = {"fps": 4, "tracks": tracks[:1]}
    smeared = exposed(blurred(1.0, background=even, animation=alone).at_frame(1), context, 16)
    assert np.abs(smeared.radiance - still.radiance).max() > 0.1


def test_parts_resumed_and_repeated_renders_have_the_bits_of_one(context: Context) -> None:
    frame = blurred().at_frame(1)
    whole = exposed(frame, context, 48)
    renderer = Renderer(frame, SMALL, context, opens_shutter=True, samples=48)
    renderer.step(5)
    begun = renderer.render(20).image()
    renderer.restart()
    assert same(renderer.render().image(), whole)
    renderer.update(samples=32)
    renderer.update(samples=48)
    assert same(renderer.resume(begun).render().image(), whole)
    renderer.release()
    parts = [exposed(frame, context, 48, part=(k, 3)) for k in (1, 2, 3)]
    np.testing.assert_allclose(merge(parts).radiance, whole.radiance, rtol=1e-5)
    assert same(merge(parts), merge(parts[::-1]))
    assert whole.recipe
    assert whole.recipe.scene == frame
    assert whole.recipe.tier == "generic"
    assert same(exposed(whole.recipe.scene, context, 48, tier="complete"), whole)


def test_edits_cost_what_they_cost_a_still(context: Context) -> None:
    renderer = Renderer(blurred(), SMALL, context, opens_shutter=True)
    renderer.render(4)
    assert renderer.update(exposure=1.0) is Cost.FREE
    assert renderer.samples == 4
    assert renderer.update(blurred(0.4)) is Cost.RESTART
    assert renderer.update(blurred(0.4).at_frame(0).in_shutter(0.0)) is Cost.RESTART
    renderer.release()


def test_the_command_renders_the_blurred_frame(
    context: Context, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene, out = tmp_path / "moving.toml", tmp_path / "a.exr"
    write_scene(blurred(), scene)
    size = ["--width", "24", "--height", "16", "--samples", "16", "--quiet"]
    assert run(["render", str(scene), "--frame", "1", *size, "-o", str(out)]) == 0
    assert same(Image.load(out), exposed(blurred().at_frame(1), context, 16))
    assert run(["render", str(out), "-o", str(tmp_path / "b.exr"), "--quiet"]) == 0
    assert same(Image.load(tmp_path / "b.exr"), Image.load(out))
    capsys.readouterr()


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"aov": ("position",)}, "the AOV position and a camera that moves"),
        ({"method": "ddgi"}, "probes hold the light of one time"),
        ({"caustics": "on"}, "particles are followed for many samples at once"),
        ({"sampler": "independent"}, "all pixels would err alike"),
    ],
)
def test_what_shows_one_time_is_refused(settings: dict[str, Any], reason: str) -> None:
    wanted = settings_for(SMALL, **settings)
    with pytest.raises(UsageError, match=reason):
        Renderer(blurred(), wanted, opens_shutter=True)


@pytest.mark.slow
def test_paths_are_of_the_moment_when_the_shutter_opens(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "moving.toml"
    write_scene(blurred(), scene)
    size = ["--width", "24", "--height", "16", "--samples", "16"]
    assert run(["paths", str(scene), "--pixel", "12", "8", *size]) == 0
    assert "the shutter is open: paths are traced at the moment" in capsys.readouterr().err
