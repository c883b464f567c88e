"""Reference images: a closed form, or two independent renders with far less noise than the tested.

If r1 and r2 are independent and unbiased, mean((x - r1) (x - r2)) is an unbiased estimator of the
squared error of a picture x: the noise of the references cancels in the mean, so no noise floor has
to be subtracted. References take their random numbers from another hash function than pictures, so
that they are independent of pictures of every seed, and that a defect of either hash shows as an
error.
"""

import hashlib
import json
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.core import files
from glrt.core.errors import RenderError
from glrt.core.resources import cache_folder, folder
from glrt.core.version import VERSION
from glrt.error.estimate import DARK, estimated_error
from glrt.error.reliability_of_scene import judged
from glrt.gpu.context import Context
from glrt.gpu.driver_checks import usable_rounds
from glrt.gpu.glsl import read, shader_files
from glrt.image.image import Image
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import prepare
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import iterations_per_sample
from glrt.scene.lit_scene import Finish
from glrt.scene.loading.scene_files import hashes_of
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml import scene_to_dict
from glrt.settings import MAX_SAMPLES, Settings, settings_for

Floats = NDArray[np.float64]

SEEDS = (0x52454631, 0x52454632)  # seeds of the two halves; unlikely to be chosen by users or tests
SAMPLER = "independent"  # the simplest one, as others are judged by it
BOUNCES = 256  # practically unlimited: with an albedo of 0.95 they leave out 2e-6 of the light
FIRST_LOOK = 64  # samples per pixel before the error is computed for the first time


@dataclass(frozen=True, eq=False)
class Reference:
    """Two independent estimates of the true radiance, (H, W, 3) each; equal for a closed form."""

    first: Floats
    second: Floats
    samples: int  # per pixel, in each half; 0 for a closed form
    bounces: int  # the limit of the paths
    is_doubtful: bool = False  # whether its own error is not to be believed

    @cached_property
    def radiance(self) -> Floats:
        """The mean of both estimates, (H, W, 3)."""
        return 0.5 * (self.first + self.second)

    @cached_property
    def scale(self) -> Floats:
        """The divisor of squared errors, (H, W, 3): radiance^2 + 0.01 mean(radiance)^2."""
        scale: Floats = np.square(self.radiance) + DARK * self.radiance.mean() ** 2
        return scale

    @cached_property
    def error(self) -> float:
        """The relative RMS error of `radiance` itself, from the difference of its halves."""
        return estimated_error(self.radiance, 0.5 * np.abs(self.first - self.second)) or 0.0

    def squared_error(self, radiance: ArrayLike) -> float:
        """Unbiased estimate of the squared relative RMS error of a picture; it may be negative."""
        picture = np.asarray(radiance, np.float64)
        return self.relative((picture - self.first) * (picture - self.second))

    def relative(self, squares: ArrayLike) -> float:
        """Mean over pixels and channels of `squares`, (H, W, 3), each divided by `scale`."""
        squares = np.asarray(squares, np.float64)
        return float(np.divide(squares, self.scale, out=squares * 0, where=self.scale > 0).mean())


class Budget(NamedTuple):
    """When a reference is good enough, or has taken enough."""

    error: float  # relative RMS error of the reference itself
    seconds: float  # infinite: no clock decides
    samples: int = MAX_SAMPLES


def reference_for(
    scene: Scene,
    settings: Settings,
    context: Context,
    budget: Budget,
    watch: Callable[[float], None] | None = None,
    check: Callable[[Renderer], bool] | None = None,
) -> Reference:
    """Return the reference of a scene in the frame of `settings`, from the cache if it is there.

    The number of samples doubles until the error is that of the budget, or until the next doubling
    would exceed its seconds or samples. `watch` is called with the share of the work that is done;
    `check` is called after each dispatch and may raise to stop.
    """
    radiance = closed_form(scene)
    if radiance is not None:
        width, height = settings.size
        whole = np.full((height, width, 3), radiance)
        return Reference(whole, whole, 0, BOUNCES)
    path = cache_folder("references") / f"{_key(scene, settings, context, budget)}.npz"
    found = _loaded(path)
    if found is None:
        halves = _halves(scene, settings, context)
        try:
            found = _rendered(halves, budget, watch, check)
        finally:
            for half in halves:
                half.release()
        _save(found, path)
    return found


def closed_form(scene: Scene) -> float | None:
    """The radiance of a scene if it is the same everywhere, whatever the geometry; else None.

    Under a uniform background L a surface is invisible if it emits what it absorbs, e + albedo L =
    L (white furnace). Glass, rough metal, smooth and coloured meshes are excluded: radiance is
    scaled inside glass, rough metal loses the light of multiple scattering between microfacets,
    interpolated normals lose some near the silhouette, and colours of vertices are not looked at.
    """
    found = SceneFacts(scene)
    if scene.sun or scene.background.is_pictured or found.is_smooth or found.is_colored:
        return None
    levels = {level for color in scene.background_colors for level in color}
    level = min(levels)
    if level == 0 or len(levels) > 1:
        return None
    return level if all(_is_invisible(scene, it, level) for it in found.finishes) else None


def _is_invisible(scene: Scene, finish: Finish, level: float) -> bool:
    material = scene.materials[finish.material]
    if not isinstance(material, Lambertian | Light | Metal):
        return False
    if isinstance(material, Metal) and (material.roughness or material.conductor):
        return False
    if finish.group and (material.cone or finish.is_one_sided):
        return False
    color = material.head_on if isinstance(material, Metal) else material.color
    pairs = zip(scene.emission(finish), color, strict=True)
    return all(emitted + albedo * level == level for emitted, albedo in pairs)


# Random numbers from a hash of shifts and products, instead of the PCG hash of other renders.
_OTHER_HASH = read("sampling/other_hash.glsl")
OTHER_NUMBERS = Variant(texts={"sampling/hash.glsl": _OTHER_HASH})


def unlimited(scene: Scene, settings: Settings, context: Context) -> Settings:
    """Settings of a reference: BOUNCES, or as many as the driver's loop limit allows."""
    bounces, rounds = max(BOUNCES, settings.bounces), usable_rounds(context)
    while True:
        wanted = settings_for(settings, method="mis", bounces=bounces, sampler=SAMPLER)
        certain = iterations_per_sample(prepare(scene, wanted), 0)
        if rounds is None or certain <= rounds or bounces <= settings.bounces:
            return wanted
        bounces = max(bounces // 2, settings.bounces)


def _halves(scene: Scene, settings: Settings, context: Context) -> list[Renderer]:
    wanted = unlimited(scene, settings, context)
    return [
        Renderer(scene, wanted, context, "complete", variant=OTHER_NUMBERS, seed=seed)
        for seed in SEEDS
    ]


def _rendered(
    halves: list[Renderer],
    budget: Budget,
    watch: Callable[[float], None] | None,
    check: Callable[[Renderer], bool] | None,
) -> Reference:
    error, seconds, most = budget
    start = time.perf_counter()
    samples = FIRST_LOOK
    while True:
        images = [half.render(samples, check).image() for half in halves]
        first, second = (image.radiance.astype(float) for image in images)
        result = Reference(first, second, samples, halves[0].settings.bounces)
        spent = time.perf_counter() - start
        if watch:
            watch(min(1.0, max(spent / seconds, (error / max(result.error, 1e-9)) ** 2)))
        if result.error <= error or 2 * spent > seconds or 2 * samples > most:
            return replace(result, is_doubtful=_is_doubtful(images))
        samples *= 2


def _is_doubtful(halves: list[Image]) -> bool:
    first, second = halves
    radiance = np.float32(0.5) * (first.radiance + second.radiance)
    stderr = np.float32(0.5) * np.hypot(first.stderr, second.stderr)
    assert first.recipe
    samples = first.samples + second.samples
    return bool(judged(first.recipe.scene, first.recipe.settings, samples, radiance, stderr))


def _key(scene: Scene, settings: Settings, context: Context, budget: Budget) -> str:
    """A hash of everything that the halves depend on, shader sources and driver included."""
    root = folder("shaders_glsl")
    texts = [(file, file.read_text("utf-8")) for file in shader_files()]
    shaders = {file.relative_to(root).as_posix(): text for file, text in texts}
    frame = [settings.width, settings.height, settings.crop]
    paths = [settings.bounces, BOUNCES, settings.roulette]
    ends = [*budget]
    driver = [context.renderer, context.version]
    told = {**scene_to_dict(scene), "assets": hashes_of(scene)}
    parts = [told, frame, paths, SEEDS, SAMPLER, ends, driver, VERSION, shaders]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def _loaded(path: Path) -> Reference | None:
    """The reference in a file of the cache; None if there is none or it cannot be read."""
    try:
        with path.open("rb") as file, np.load(file) as arrays:
            first, second = (arrays[name].astype(float) for name in ("first", "second"))
            samples, bounces, *doubt = map(int, arrays["counts"])
            return Reference(first, second, samples, bounces, any(doubt))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None


def _save(reference: Reference, path: Path) -> None:
    """Write a reference into the cache; failures to write are ignored."""
    first, second = (half.astype(np.float32) for half in (reference.first, reference.second))
    counts = (reference.samples, reference.bounces, reference.is_doubtful)
    with suppress(OSError, RenderError):
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write_whole(
            path, lambda file: np.savez(file, first=first, second=second, counts=counts)
        )
