"""Pictures by `sampler = net`: the same bits however samples come, and the light of other samplers.

All but the furnace use one scene, so that they share a kernel.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.analysis.variants import variants_of
from glrt.comparison.verdict import compare
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.net_channels import from_channels, judged, to_channels
from glrt.rendering.renderer import Renderer
from glrt.samplers import NET
from glrt.settings import Settings
from tests.support.builders import MATTE, lamp, quad, room_of_planes, scene_of, sphere
from tests.support.images import same_bits
from tests.support.renders import assert_agree, rendering, same

ROOM = scene_of(
    [sphere([0, 0, -3], 1, "matte"), quad([-1, 2, -4], [2, 0, 0], [0, 0, 2], "lamp")],
    {"matte": MATTE, "lamp": lamp(9.0)},
)
SIZE: dict[str, Any] = {"width": 24, "height": 16, "sampler": "net"}


def taken(context: Context, samples: int, **settings: Any) -> Image:
    """A picture of so many samples."""
    renderer = Renderer(ROOM, context=context, tier="complete", **{**SIZE, **settings})
    image = renderer.render(samples).image()
    renderer.release()
    return image


def test_samples_may_come_in_portions_of_any_size(context: Context) -> None:
    renderer = Renderer(ROOM, context=context, tier="complete", **SIZE)
    for samples in (1, 2, 8, 3, 21, 5):
        renderer.step(samples)
    pieces = renderer.image()
    renderer.release()
    whole = taken(context, 40)
    assert (whole.stderr > 0).any()
    assert same(pieces, whole)


@pytest.mark.parametrize("first", [1, 8, 13, 24])
def test_a_picture_that_is_rendered_on_is_the_file_of_one_render(
    context: Context, tmp_path: Path, first: int
) -> None:
    taken(context, first).save(tmp_path / "first.exr")
    begun = Image.load(tmp_path / "first.exr")
    renderer = Renderer(ROOM, context=context, tier="complete", **SIZE).resume(begun)
    assert same_bits(renderer.image().stderr, begun.stderr)
    renderer.render(39).image().save(tmp_path / "on.exr")
    renderer.release()
    taken(context, 39).save(tmp_path / "whole.exr")
    assert (tmp_path / "on.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()


def test_parts_continue_each_others_nets(context: Context, tmp_path: Path) -> None:
    parts = [taken_part(context, (k, 3)) for k in (1, 2, 3)]
    assert [part.samples for part in parts] == [16, 24, 21]
    found, whole = merge(parts), taken(context, 61)
    np.testing.assert_allclose(found.radiance, whole.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, whole.stderr, rtol=1e-4, atol=1e-6)
    found.save(tmp_path / "whole.exr")
    again = Image.load(tmp_path / "whole.exr")
    assert again.film_state is not None
    assert found.film_state is not None
    assert same_bits(again.film_state.net, found.film_state.net)
    assert np.array_equal(found.film_state.net[..., 3].sum(axis=0), np.full((16, 24), 61.0))


def taken_part(context: Context, part: tuple[int, int]) -> Image:
    renderer = Renderer(ROOM, context=context, tier="complete", part=part, samples=61, **SIZE)
    image = renderer.render().image()
    renderer.release()
    return image


def test_the_mean_is_that_of_the_scrambles(context: Context) -> None:
    image = taken(context, 45)
    assert image.film_state is not None
    net = image.film_state.net.astype(np.float64)
    assert [int(count) for count in net[:, 0, 0, 3]] == [6, 6, 6, 6, 6, 5, 5, 5]
    mean = (net[..., :3] * net[..., 3:]).sum(axis=0) / 45
    np.testing.assert_allclose(image.radiance, mean, rtol=1e-5, atol=1e-6)
    variance, held = judged(net)
    assert (held == NET).all()
    np.testing.assert_allclose(image.stderr, np.sqrt(variance / 7), rtol=1e-3, atol=1e-6)


def test_a_crop_is_that_part_of_the_picture(context: Context) -> None:
    whole, part = taken(context, 20), taken(context, 20, crop=(3, 2, 11, 9))
    assert same_bits(part.radiance, whole.radiance[2:11, 3:14])
    assert same_bits(part.stderr, whole.stderr[2:11, 3:14])


def test_nets_show_the_light_of_other_samplers(context: Context) -> None:
    """Whole means, and the means of blocks, by independent seeds."""
    net, sobol = (taken(context, 2048, seed=k, sampler=s) for k, s in ((1, "net"), (2, "sobol")))
    assert_agree(net, sobol, within=0.02)
    assert net.error is not None
    assert sobol.error is not None
    assert net.error < sobol.error


def test_pictures_of_nets_are_compared(context: Context) -> None:
    """Scrambles are dealt out between two of equal length; others are judged by their errors."""
    one, other, longer = (taken(context, n, seed=seed) for n, seed in ((64, 1), (64, 2), (256, 3)))
    equal, unequal = compare(one, other), compare(longer, other)
    assert equal.alike
    assert not unequal.alike
    assert "different" not in (equal.verdict, unequal.verdict)
    brighter = Image(longer.radiance * np.float32(1.5), longer.stderr, 256, longer.recipe)
    assert compare(brighter, other).verdict == "different"


def test_a_room_without_noise_is_exact(context: Context) -> None:
    scene = scene_of(room_of_planes("glow"), {"glow": lamp(1.0, 0.5)}, {"fov": 90})
    with rendering(scene, context, roulette=False, sampler="net", bounces=1) as renderer:
        image = renderer.render(45).image()
    assert (image.radiance == 1.5).all()
    assert (image.stderr == 0).all()


# --- without rendering -----------------------------------------------------------------------


def test_dropped_samples_come_back_from_channels() -> None:
    random = np.random.default_rng(5)
    net = random.uniform(0, 9, (NET, 4, 5, 4)).astype(np.float32)
    counts = np.array([len(range(k, 45, NET)) for k in range(NET)])
    net[..., 3] = counts[:, None, None] - random.integers(0, 2, (NET, 4, 5))
    channels = to_channels(net, 45, NET)
    planes = {name: plane for name, plane in channels.items() if plane.ndim == 2}
    for name in channels.keys() - planes.keys():
        planes |= {f"{name}.{c}": channels[name][..., i] for i, c in enumerate("RGB")}
    back = from_channels(planes, (4, 5), 45, NET, NET)
    assert back is not None
    assert same_bits(back, net)
    del planes["film.net.7.B"]
    assert from_channels(planes, (4, 5), 45, NET, NET) is None


@pytest.mark.parametrize("samples", [2, 5, 9, 16, 21])
def test_the_variance_is_unbiased_for_independent_samples(samples: int) -> None:
    """Some scrambles have a sample more than others, and the first few alone have any."""
    random = np.random.default_rng(samples)
    draws = random.exponential(size=(samples, 1, 40000))
    net = np.zeros((NET, 1, 40000, 4))
    for k in range(min(samples, NET)):
        net[k, ..., :3] = draws[k::NET].mean(axis=0)[..., None]
        net[k, ..., 3] = len(draws[k::NET])
    variance, held = judged(net)
    assert (held == min(samples, NET)).all()
    squares = variance[..., 0] / (held - 1)
    assert abs(squares.mean() * samples - 1) < 5 * samples * squares.std() / 200


def test_observations_are_scrambles() -> None:
    net = Settings(sampler="net")
    assert [net.division.observations(samples) for samples in (0, 5, 8, 1024)] == [0, 5, 8, 8]
    assert Settings(sampler="sobol").division.observations(40) == 2


def test_what_nets_do_not_go_with_is_refused_by_name(context: Context) -> None:
    for settings in ({"aov": ("albedo",)}, {"denoise": "nlm"}, {"method": "ddgi"}):
        with pytest.raises(UsageError, match=r"--sampler net.* use --sampler sobol"):
            taken(context, 8, **settings)


def test_charts_have_a_variant_with_nets() -> None:
    names = [variant.name for variant in variants_of(ROOM, Settings())]
    assert "mis, net" in names
