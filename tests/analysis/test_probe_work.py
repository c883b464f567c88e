"""The work of probes is counted: their rays, for the picture and for each block of samples."""

from dataclasses import replace
from typing import Any

import pytest

from glrt.analysis.chart.rays import Rays, rays_of
from glrt.analysis.method_choice.candidate import OfProbes
from glrt.analysis.method_choice.search import WITHOUT_PROBES
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.methods import traits_of
from glrt.rendering.probe_tracer import LOOKS, PUSHED, RAYS, UPDATES
from glrt.settings import Settings, settings_for
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.verdicts import candidate, of_bias, verdict_on

WAY: dict[str, Any] = {
    "width": 32,
    "height": 32,
    "sampler": "sobol",
    "method": "ddgi",
    "bounces": 3,
}
PIXELS = 32 * 32
CAMERA = {"position": [0.31, -0.17, 0.23], "look_at": [-0.6, 0.5, -1.0], "fov": 90}


@pytest.mark.slow
def test_rays_of_probes_are_counted(context: Context) -> None:
    """In a dark closed room each path of a probe asks probes at the first wall, as paths of pixels
    do. It ends with the ray that would find a lamp there. Visibility takes one ray.
    """
    dark = scene_of([sphere([0, 0, 0], 1, "wall")], {"wall": MATTE}, CAMERA)
    rays = rays_of(dark, settings_for(dark.render, **WAY, probes=2), context)
    assert rays.sample == 2.0
    assert rays.block == 16
    assert rays.set * PIXELS == 2 * UPDATES * RAYS * 8
    assert rays.once * PIXELS == (PUSHED + 1 + LOOKS) * RAYS * 8
    without = rays_of(dark, settings_for(dark.render, **{**WAY, "method": "mis"}), context)
    assert (without.set, without.once) == (0.0, 0.0)


def test_sets_are_counted_by_blocks() -> None:
    rays = Rays(2.0, 16, 100.0, 30.0)
    assert [rays.of(samples) for samples in (1, 16, 17, 64)] == [132, 162, 264, 558]
    assert Rays(2.0).of(10) == 20


def test_work_of_probes_is_shared_by_pixels_and_blocks() -> None:
    """The work of 100 and of 400 samples, in one pixel and in 1,024."""
    plain = of_bias(0.0)
    settings = settings_for(plain.settings, sampler="sobol", width=32, height=32)
    many = replace(plain, settings=settings, probes=OfProbes(1024.0, 3.0, 2048.0, 5.0))
    assert many.work_to(0.1) == 112 + 7 + 2
    assert many.work_to(0.05) == 400 + 25 + 2
    assert many.seconds_of(17) == 17 + 2 * 3 + 5
    one = replace(many, settings=settings_for(settings, width=1, height=1))
    assert one.work_to(0.1) == 112 + 7 * 1024 + 2048


@pytest.mark.slow
def test_probes_are_tried_where_that_is_asked_for(context: Context) -> None:
    """In a small picture their sets are most of the work, in a large one hardly any."""
    scene = load("methods/white")
    verdict = verdict_on(scene, 0.25, context, methods=("mis", "ddgi"))
    small = candidate(verdict, "ddgi")
    assert small.bias.most < 0.25
    assert small.probes.work_of_set > 1e6
    assert small.probes.seconds_of_set > 0.0
    large = replace(small, settings=settings_for(small.settings, width=1024, height=1024))
    assert large.work_to(0.25) < small.work_to(0.25) / 4
    assert large.work_to(0.25) < candidate(verdict, "mis").work_to(0.25)


def test_what_chooses_by_itself_leaves_probes_out(context: Context) -> None:
    """An estimated error does not include what probes blur."""
    assert not any(traits_of(Settings(method=name)).has_probes for name in WITHOUT_PROBES)
    found = verdict_on(load("methods/open"), 0.3, context).candidates
    assert not any(traits_of(each.settings).has_probes for each in found)
