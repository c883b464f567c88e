"""AOVs and denoising with an open shutter: each sample sees the scene at a time of its own."""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.rendering.renderer import Renderer
from glrt.rendering.shutter import time_of
from glrt.scene.scene import Scene
from glrt.settings import Aov
from tests.series.test_frames import SMALL
from tests.series.test_shutter import blurred, exposed
from tests.support.builders import plane, quad, sphere
from tests.support.renders import same
from tests.truths.test_motion_blur import moving

ALL: tuple[Aov, ...] = (
    *("albedo", "normal", "depth", "object", "bounces", "emission", "direct", "indirect"),
)
BLOCK = SMALL.block


def fading_room() -> Scene:
    """A closed room whose walls go from black to white while the shutter is open."""
    track = {"target": "materials.red.color", "times": [0, 0.25], "values": [[0] * 3, [1] * 3]}
    ball = {"shape": "sphere", "name": "ball", "center": [0] * 3, "radius": 9, "material": "red"}
    animation = {"fps": 4, "tracks": [track]}
    return blurred(1.0, objects=[ball], animation=animation).at_frame(0)


def test_albedo_is_the_mean_over_the_times_of_samples(context: Context) -> None:
    """The render ends within an observation, which the standard error leaves out."""
    count, whole = 2 * BLOCK + 5, 2
    albedo = exposed(fading_room(), context, count, aov=("albedo",)).aovs["albedo"]
    times = np.array([time_of(number, SMALL) for number in range(count)])
    np.testing.assert_allclose(albedo.value, times.mean(), rtol=1e-5)
    assert albedo.count is not None
    assert albedo.observations is not None
    assert (albedo.count == count).all()
    assert (albedo.observations == whole).all()
    means = times[: whole * BLOCK].reshape(whole, BLOCK).mean(axis=1)
    assert albedo.stderr is not None
    np.testing.assert_allclose(albedo.stderr, means.std() / np.sqrt(whole - 1), rtol=0.05)


@pytest.mark.slow
def test_pieces_of_a_blurred_picture_have_the_aovs_of_the_whole(context: Context) -> None:
    """Steps, resumed renders, parts, and the fragment pipeline; the picture keeps its bits."""
    frame = blurred().at_frame(1)
    whole = exposed(frame, context, 48, aov=ALL)
    assert same(whole, exposed(frame, context, 48))
    light = sum(whole.aovs[term].value for term in ("emission", "direct", "indirect"))
    np.testing.assert_allclose(light, whole.radiance, rtol=1e-5)
    renderer = Renderer(frame, SMALL, context, opens_shutter=True, samples=48, aov=ALL)
    renderer.step(5)
    begun = renderer.render(20).image()
    assert same_aovs(renderer.render().image(), whole)
    assert same_aovs(renderer.resume(begun).image(), begun)
    assert same_aovs(renderer.resume(begun).render().image(), whole)
    renderer.release()
    parts = [exposed(frame, context, 48, part=(k, 3), aov=ALL) for k in (1, 2, 3)]
    merged = merge(parts)
    for name in set(ALL) - {"object"}:
        np.testing.assert_allclose(
            merged.aovs[name].value, whole.aovs[name].value, rtol=1e-6, atol=1e-6
        )
    assert same_aovs(exposed(frame, context, 48, aov=ALL, pipeline="fragment"), whole)


def same_aovs(one: Image, other: Image) -> bool:
    return one.aovs.keys() == other.aovs.keys() and all(
        np.array_equal(getattr(found, part), getattr(other.aovs[name], part), equal_nan=True)
        for name, found in one.aovs.items()
        for part in ("value", *(["stderr", "count", "observations"] if name != "object" else []))
    )


@pytest.mark.slow
def test_a_kernel_that_changes_between_samples_keeps_their_aovs(context: Context) -> None:
    """A lens that opens compiles another kernel when it leaves 0."""
    track = {"target": "camera.defocus_angle", "times": [0, 0.1, 0.25], "values": [0, 0, 2]}
    frame = blurred(1.0, animation={"fps": 4, "tracks": [track]}).at_frame(0)
    renderer = Renderer(frame, SMALL, context, opens_shutter=True, samples=20, aov=("albedo",))
    kernels = set()
    while renderer.lacks(20):
        renderer.step(1)
        kernels.add(renderer.shaders[-1].whole.text)
    found = renderer.image().aovs["albedo"]
    renderer.release()
    assert len(kernels) > 1
    assert found.count is not None
    assert (found.count == 20).all()
    assert np.ptp(found.value) > 0.5


@pytest.mark.slow
def test_positions_are_known_before_a_camera_at_rest(context: Context) -> None:
    """A wall goes away; its place is the mean over the times of samples."""
    wall = {**plane([0, 0, -1], [0, 0, 1], "red"), "name": "wall"}
    track = {"target": "objects.wall.point", "times": [0, 0.25], "values": [[0, 0, 0], [0, 0, -4]]}
    animation = {"fps": 4, "tracks": [track]}
    frame = blurred(1.0, objects=[wall], animation=animation).at_frame(0)
    position = exposed(frame, context, 32, aov=("position",)).aovs["position"]
    times = np.array([time_of(number, SMALL) for number in range(32)])
    assert position.count is not None
    assert (position.count[12:] == 32).all()
    np.testing.assert_allclose(position.value[12:, :, 2], -4 * times.mean(), rtol=1e-4)


@pytest.mark.slow
def test_a_blurred_picture_is_denoised_nearer_to_the_truth(context: Context) -> None:
    """A ball that passes a wall, against the mean of eight pictures of 512 samples by mis."""
    frame = passing_ball()
    settings: dict[str, Any] = {"width": 64, "height": 48, "bounces": 4, "samples": 64}
    settings["method"] = "naive"
    renderer = Renderer(frame, context=context, opens_shutter=True, **settings)
    renderer.update(denoise="nlm")
    image = renderer.render().image()
    pictures = []
    for seed in range(8):
        renderer.update(denoise="none", method="mis", samples=512, seed=100 + seed)
        pictures.append(renderer.render().image().radiance.astype(float))
    renderer.release()
    truth = np.mean(pictures, axis=0)
    found = image.denoised()
    plain, filtered = (rms(it - truth) for it in (image.radiance, found.radiance))
    assert filtered < 0.6 * plain
    scale = np.square(truth) + 0.01 * truth.mean() ** 2
    error = np.sqrt(np.mean(np.square(found.radiance - truth) / scale))
    assert 0.6 < found.error / error < 1.6


def passing_ball() -> Scene:
    """A ball that goes from left to right before a wall, under a lamp."""
    objects = [
        {**sphere([-1, 0, 0], 0.4, "red"), "name": "ball"},
        plane([0, 0, -1], [0, 0, 1], "red"),
        quad([-0.5, 2, 0], [1, 0, 0], [0, 0, 1], "lamp"),
    ]
    return moving(objects, "objects.ball.center", [[-1, 0, 0], [1, 0, 0]])


def rms(values: np.ndarray[Any, Any]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
