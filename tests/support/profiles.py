"""Kernels that tests share: what a scene leaves out is compiled in where it changes no bit.

Most of the time of a first run is the driver's compiler, and each scene has a kernel of its own.
Here the constants of a kernel are rounded up to those of a profile, so that many scenes have one
kernel. tests/rendering/test_equal_bits.py proves that pictures keep their bits. The fixture
`exact_kernels` gives a test the kernels that users get.
"""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.gpu import struct_arrays
from glrt.gpu.program import Resource
from glrt.gpu.struct_arrays import Arrays, Layout
from glrt.plan import plan
from glrt.plan.facts import SceneFacts
from glrt.plan.features import Needs, needs_of
from glrt.rendering import aov_tracer, pipelines, schedule
from glrt.rendering.schedule import rounds_of_search
from glrt.scene.shapes.kinds import SAMPLED
from glrt.settings import Settings

Constants = dict[str, bool | int]

OF_SHAPES = {
    kind: f"HAS_{kind.upper()}" for kind in ("sphere", "plane", "quad", "disk", "box", "cylinder")
}
LAMPS = ("HAS_SPHERE_LIGHT", "HAS_QUAD_LIGHT", "HAS_DISK_LIGHT")
LARGE = ("HAS_COINCIDENT", "HAS_MESH", "HAS_TREE", "HAS_SPHERE_TREE")
COMMON = ("HAS_DIELECTRIC", "HAS_MIRROR", "HAS_ROUGH_METAL", "HAS_ATTENUATION")
RARE = ("HAS_ROUGH_GLASS", "HAS_PANE", "HAS_ROUGH_PANE", "HAS_CONDUCTOR")
PRINCIPLED = ("HAS_PRINCIPLED", "HAS_COAT", "HAS_TRANSMISSION")


def rounded_up(constants: Constants) -> Constants:
    """The constants of the smallest profile that has all that a kernel of these needs.

    Left as they are: what draws random numbers, what other features depend on, and all of a kernel
    whose search for surfaces is large: with more in it, it would compile for seconds.
    """
    on = {name for name, value in constants.items() if value}
    if on & {*LARGE}:
        return constants
    more = {*OF_SHAPES.values()}
    if "MODEL" not in on:  # models before path tracing end where they do not follow light
        more |= {*COMMON}
        if on & {*RARE, *PRINCIPLED}:
            more |= {*RARE}
            # A principled surface draws more numbers where some of them are glass in part.
            more |= {*PRINCIPLED} if "HAS_PRINCIPLED" not in on else set()
    if "CLUSTERS" in on:
        more |= {*LAMPS}
        if "WEIGHT_BOTH" in on and "HAS_QUAD_LIGHT" not in on:
            more.add("QUADS_BY_AREA")
    if "HAS_PARTICLES" not in on:  # the sky may send particles
        more.add("HAS_BACKGROUND")
    rounded = {**constants, **dict.fromkeys(more, True)}
    lamps = (f"HAS_{kind.upper()}_LIGHT" for kind in SAMPLED)
    return {**rounded, "LAMP_KINDS": sum(bool(rounded[lamp]) for lamp in lamps)}


class RoundedNeeds(Needs):
    """Needs whose constants are those of a profile."""

    def constants(self) -> Constants:
        """The prelude."""
        return rounded_up(super().constants())


def with_rows(arrays: Arrays) -> Arrays:
    """The arrays, each with at least one row; frame counts stay as they are."""
    return {name: rows if len(rows) else np.zeros(1, rows.dtype) for name, rows in arrays.items()}


def _needs(facts: SceneFacts, settings: Settings) -> Needs:
    return RoundedNeeds(**vars(needs_of(facts, settings)))


def _text(arrays: Arrays, *rest: Any) -> str:
    return struct_arrays.scene_arrays(with_rows(arrays), *rest)


def _upload(gl: moderngl.Context, arrays: Arrays, *rest: Any) -> dict[str, Resource]:
    return dict(struct_arrays.upload(gl, with_rows(arrays), *rest))


def _rounds_of_search(facts: SceneFacts, *rest: Any) -> int:
    """A loop over the shapes of a kind that is not there takes a round, too."""
    kinds = {kind for kind, count in facts.shapes.items() if count} & OF_SHAPES.keys()
    return rounds_of_search(facts, *rest) + len(OF_SHAPES) - len(kinds)


def _layout(arrays: Arrays, tier: str) -> Layout:
    """No array is written into a kernel, so that pictures of both tiers share it."""
    del arrays, tier
    return Layout()


SHARED = (
    (plan, "needs_of", _needs),
    (pipelines, "scene_arrays", _text),
    (pipelines, "struct_arrays", SimpleNamespace(upload=_upload)),
    (pipelines, "_layout", _layout),
    (schedule, "rounds_of_search", _rounds_of_search),
    (aov_tracer, "rounds_of_search", _rounds_of_search),
)
EXACT = tuple((module, name, getattr(module, name)) for module, name, _ in SHARED)


@contextmanager
def _with(parts: Collection[tuple[Any, str, Any]]) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        for part in parts:
            patch.setattr(*part)
        yield


def shared() -> Any:
    """Renderers compile the kernels of profiles."""
    return _with(SHARED)


def exact() -> Any:
    """Renderers compile what users get."""
    return _with(EXACT)
