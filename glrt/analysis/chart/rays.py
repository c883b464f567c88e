"""The number of rays of a picture: a measure of cost that does not depend on the machine."""

import math
from typing import NamedTuple

from glrt.gpu.context import Context
from glrt.gpu.glsl import read
from glrt.rendering.pipelines import Variant
from glrt.rendering.probe_tracer import LOOKS, PUSHED, UPDATES
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings

SAMPLES = 32
COUNTING = Variant({"COUNT_RAYS": True})  # renders the number of rays in place of radiance
_FOLLOWED, _SHADOW = "shapes/find_hit.glsl", "textures/holes.glsl"
_PROBES, _LOOKUP = "probes/query.glsl", "ProbeLight found ="
_COUNT = "if (COUNT_RAYS) rays_so_far += 1.0;"


class Rays(NamedTuple):
    """Rays per pixel of a frame, or their weights: camera, scattered and shadow rays."""

    sample: float  # rays of a sample
    block: int = 1  # samples that share a set of probes
    set: float = 0.0  # rays to warm it up
    once: float = 0.0  # rays to place probes and find the distances that they see

    def of(self, samples: int) -> float:
        """Rays of `samples` samples per pixel, including those of probes."""
        sets = math.ceil(samples / self.block) if self.set else 0
        return samples * self.sample + sets * self.set + self.once

    def of_update(self, looks: int = 1) -> float:
        """Rays of an update of live probes: those for their light, and `looks` at distances."""
        return self.set / UPDATES + self.once * looks / (PUSHED + 1 + LOOKS)


def rays_of(scene: Scene, settings: Settings, context: Context) -> Rays:
    """Count the rays of a scene, on average over the whole frame."""
    counter = Renderer(scene, settings, context, tier="complete", variant=COUNTING)
    try:
        return _counted(counter)
    finally:
        counter.release()


def _counted(counter: Renderer) -> Rays:
    sample = float(counter.render(SAMPLES).image().radiance.mean())
    probes = counter.probes.tracer
    if not probes:
        return Rays(sample)
    width, height = counter.size
    with counter.context.gl:
        of_set, once = (rays / (width * height) for rays in probes.count())
    return Rays(sample, counter.settings.block, of_set, once)


def counting_variant(followed: float, shadow: float, lookup: float = 0.0) -> Variant:
    """COUNTING with weights: of camera and scattered rays, of shadow rays, of lookups of probes."""
    start, end = read(_PROBES).split(_LOOKUP)
    texts = {_PROBES: f"{start}rays_so_far += {float(lookup)!r};\n    {_LOOKUP}{end}"}
    for file, weight in ((_FOLLOWED, followed), (_SHADOW, shadow)):
        start, end = read(file).split(_COUNT)
        texts[file] = f"{start}rays_so_far += {float(weight)!r};{end}"
    return COUNTING._replace(texts=texts)
