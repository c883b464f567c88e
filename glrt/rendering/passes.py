"""Passes over the pixels of a picture, as values.

A pass names a kernel for each of the two pipelines, and the outputs that it adds samples to. An
output has two textures: the kernel reads the last frame, `source_NAME`, and writes the next frame,
`target_NAME`. OpenGL 4.3 promises eight images, so a pass has at most four outputs; more outputs
take another pass. The kernel of paths has a fifth, and reads its layers as a texture.
"""

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from glrt.gpu.glsl import read
from glrt.gpu.structs import read_constants
from glrt.settings import OF_PATHS, TERMS, Aov

Resolved = Literal["compute", "fragment"]
Constants = Mapping[str, bool | int]
NO_CONSTANTS: Constants = {}
NO_REUSE: Constants = {"REUSES_OWN": False, "REUSES_NEAR": 0}
ALL_EFFECTS: Constants = {"EFFECTS": 0}  # what lights probes is traced in full
FROM_PROBES: Constants = {"FROM_PROBES": True, "RESAMPLES": False, **NO_REUSE, **ALL_EFFECTS}

AOV_NUMBERS = read_constants(read("integrators/aov_numbers.glsl"))


class RenderPass(NamedTuple):
    """A kernel over the pixels of a picture."""

    shaders: Mapping[Resolved, tuple[str, ...]]  # entry files
    outputs: tuple[str, ...]
    constants: Constants = NO_CONSTANTS  # in addition to those of the scene


RADIANCE = RenderPass(
    {"compute": ("trace.comp",), "fragment": ("trace.vert", "trace.frag")},
    ("mean", "variance", "block", "layers", "reservoirs"),  # the last three where a film keeps them
)
LISTED = RenderPass({"compute": ("adaptive.comp",)}, ("mean", "variance", "block"))
BOUNCES = RADIANCE._replace(
    outputs=("mean", "variance", "block"),
    constants={"COUNT_BOUNCES": True, "LAYERS": 0, **NO_REUSE},
)
PARTICLES = RenderPass({"compute": ("particles.comp",)}, ("mean", "variance"))
SPLATS = RenderPass(
    {"compute": ("splats.comp",)}, PARTICLES.outputs, {"BLOCK": 1, "IS_SHARED": False}
)
PROBE_RAYS = RenderPass({"compute": ("probe_rays.comp",)}, ("rays",), FROM_PROBES)
PROBE_LIGHT = RenderPass({"compute": ("probe_light.comp",)}, ())
PROBE_DISTANCES = RenderPass({"compute": ("probe_distances.comp",)}, ())
PROBE_PLACES = RenderPass({"compute": ("probe_place.comp",)}, ())
PATHS = RenderPass({"compute": ("paths.comp",)}, (), {"OF_PARTICLES": False})
PARTICLE_PATHS = PATHS._replace(constants={"OF_PARTICLES": True})
SURFACES = RenderPass(
    {"compute": ("surfaces.comp",), "fragment": ("trace.vert", "surfaces.frag")},
    ("position", "normal"),
)
MORE = RenderPass({"compute": ("more.comp",)}, ("more",), {"BLOCK": 1, "LAYERS": 0, **NO_REUSE})
TERM_SHADERS: Mapping[Resolved, tuple[str, ...]] = {
    "compute": ("terms.comp",),
    "fragment": ("trace.vert", "terms.frag"),
}
SLOTS = ("", "second_")  # prefixes of the outputs of the AOVs that a pass fills


def aov_number(aov: Aov) -> int:
    """The number of an AOV in the shaders."""
    return AOV_NUMBERS[aov.upper()]


def aov_pass(aovs: Sequence[Aov], in_pieces: bool = False) -> RenderPass:
    """The pass that gathers one or two AOVs of surfaces, terms of light, or bounces.

    Terms lie side by side in its outputs, in the order of `TERMS`. A pass `in_pieces` adds any
    number of samples, not whole observations alone; it gathers one AOV of surfaces.
    """
    pieces = {"IN_PIECES": in_pieces}
    if kept := [TERMS.index(aov) for aov in aovs if aov in TERMS]:
        constants = {"LIGHT_TERMS": sum(1 << term for term in kept), "LAYERS": 0, **NO_REUSE}
        outputs = ("mean", "variance", *["block"] * in_pieces)
        return RenderPass(TERM_SHADERS, outputs, constants | pieces)
    if aovs[0] in OF_PATHS:
        return BOUNCES
    numbers = [*map(aov_number, aovs), AOV_NUMBERS["NO_AOV"]]
    names = [f"{slot}{name}" for slot in SLOTS[: len(aovs)] for name in ("mean", "variance")]
    return RenderPass(
        {"compute": ("aov.comp",), "fragment": ("trace.vert", "aov.frag")},
        (*names, *["second_mean"] * in_pieces),  # where the observation that has begun lies
        {"FIRST_AOV": numbers[0], "SECOND_AOV": numbers[1], **pieces},
    )
