"""What a picture should be: a closed form, or two independent renders much better than the tested.

With r1 and r2 of independent random numbers, mean((x - r1) (x - r2)) is the squared error of x
without bias: the noise of the references averages out of it, and no floor is to be subtracted.
References draw independent numbers from another family of hashes than pictures do: no seed gives
both the same ones, and what one family did wrong would show as an error.
"""

import hashlib
import json
import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt import files
from glrt.error.estimate import DARK
from glrt.errors import RenderError, SceneError
from glrt.gpu.context import Context
from glrt.gpu.glsl import read, shader_files
from glrt.rendering.pipelines import Variant
from glrt.rendering.renderer import Renderer
from glrt.resources import folder
from glrt.scene.materials import Lambertian, Light, Material, Metal
from glrt.scene.scene import Scene
from glrt.scene.toml import scene_to_dict
from glrt.settings import MAX_SAMPLES, Settings, settings_for
from glrt.version import VERSION

Floats = NDArray[np.float64]

SEEDS = (0x52454631, 0x52454632)  # of the halves: far from the seeds that people and tests choose
SAMPLER = "independent"  # the plainest: it judges the others
BOUNCES = 256  # as good as without limit: an albedo of 0.95 leaves 2e-6 beyond them
FIRST_LOOK = 64  # samples


@dataclass(frozen=True, eq=False)
class Reference:
    """Two estimates of the true radiance, (H, W, 3) each; equal ones for a closed form."""

    first: Floats
    second: Floats
    samples: int  # of each half; 0: a closed form
    bounces: int  # limit of the paths

    @cached_property
    def radiance(self) -> Floats:
        """The best estimate, (H, W, 3)."""
        return 0.5 * (self.first + self.second)

    @cached_property
    def scale(self) -> Floats:
        """What squared errors are relative to: radiance^2 + 0.01 mean(radiance)^2."""
        scale: Floats = np.square(self.radiance) + DARK * self.radiance.mean() ** 2
        return scale

    @cached_property
    def error(self) -> float:
        """The relative RMS error of `radiance` itself, from how its halves differ."""
        return float(np.sqrt(self.relative(0.25 * np.square(self.first - self.second))))

    def squared_error(self, radiance: ArrayLike) -> float:
        """The squared relative RMS error of a picture; below 0 by chance near the noise."""
        picture = np.asarray(radiance, np.float64)
        return self.relative((picture - self.first) * (picture - self.second))

    def relative(self, squares: ArrayLike) -> float:
        """Mean over pixels and channels of squares, each relative to its pixel's radiance."""
        squares = np.asarray(squares, np.float64)
        return float(np.divide(squares, self.scale, out=squares * 0, where=self.scale > 0).mean())


def reference_for(
    scene: Scene,
    settings: Settings,
    context: Context,
    error: float,
    seconds: float,
    watch: Callable[[float], None] | None = None,
    check: Callable[[Renderer], bool] | None = None,
) -> Reference:
    """The reference of a scene in the frame of `settings`, from the cache if it is there.

    Its samples double until its own relative RMS error is at most `error`, or until that would
    take longer than `seconds`, or more samples than a picture holds. `watch` is told the share
    that is done; `check` is called after each dispatch, and may raise to give up.
    """
    radiance = closed_form(scene)
    if radiance is not None:
        width, height = settings.size
        whole = np.full((height, width, 3), radiance)
        return Reference(whole, whole, 0, BOUNCES)
    path = _cache_folder() / f"{_key(scene, settings, error, seconds)}.npz"
    found = _loaded(path)
    if found is None:
        halves = _halves(scene, settings, context)
        try:
            found = _rendered(halves, error, seconds, watch, check)
        finally:
            for half in halves:
                half.release()
        _save(found, path)
    return found


def closed_form(scene: Scene) -> float | None:
    """The radiance of a scene that has the same everywhere, whatever its geometry; else None.

    Under an even background L, a surface that gives back what it lacks of L by its own emission,
    e + albedo L = L, is invisible. Glass and rough metal are left to rendering: glass scales
    radiance inside it, and rough metal loses what would scatter twice.
    """
    low, high = scene.background_colors
    level = low[0]
    if level == 0 or len({*low, *high}) > 1:
        return None
    parts = [(scene.materials[shape.material], shape.material) for shape in scene.objects]
    hidden = all(_gives_back(material, scene.emission(name), level) for material, name in parts)
    return level if hidden else None


def _gives_back(material: Material, emission: tuple[float, ...], level: float) -> bool:
    if not isinstance(material, Lambertian | Light | Metal):
        return False
    if isinstance(material, Metal) and material.roughness:
        return False
    pairs = zip(emission, material.color, strict=True)
    return all(emitted + albedo * level == level for emitted, albedo in pairs)


# Random numbers from a hash by shifts and products, where others have PCG's.
_OTHER_HASH = read("sampling/other_hash.glsl")
OTHER_NUMBERS = Variant(texts={"sampling/hash.glsl": _OTHER_HASH})


def _halves(scene: Scene, settings: Settings, context: Context) -> list[Renderer]:
    """Renderers of BOUNCES, or of as many as the driver's loop limit leaves."""
    bounces = max(BOUNCES, settings.bounces)
    while True:
        try:
            wanted = settings_for(settings, method="mis", bounces=bounces, sampler=SAMPLER)
            return [
                Renderer(scene, wanted, context, "baked", variant=OTHER_NUMBERS, seed=seed)
                for seed in SEEDS
            ]
        except SceneError:
            if bounces <= settings.bounces:
                raise
            bounces = max(bounces // 2, settings.bounces)


def _rendered(
    halves: list[Renderer],
    error: float,
    seconds: float,
    watch: Callable[[float], None] | None,
    check: Callable[[Renderer], bool] | None,
) -> Reference:
    start = time.perf_counter()
    samples = FIRST_LOOK
    while True:
        images = [half.render(samples, check).image() for half in halves]
        first, second = (image.radiance.astype(float) for image in images)
        result = Reference(first, second, samples, halves[0].settings.bounces)
        spent = time.perf_counter() - start
        if watch:
            watch(min(1.0, max(spent / seconds, (error / max(result.error, 1e-9)) ** 2)))
        if result.error <= error or 2 * spent > seconds or 2 * samples > MAX_SAMPLES:
            return result
        samples *= 2


def _cache_folder() -> Path:
    """The user's cache, by the XDG base directory specification."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "glrt" / "references"


def _key(scene: Scene, settings: Settings, error: float, seconds: float) -> str:
    """Names all that the halves depend on, the text of the kernel included."""
    root = folder("shaders_glsl")
    texts = [(file, file.read_text("utf-8")) for file in shader_files()]
    shaders = {file.relative_to(root).as_posix(): text for file, text in texts}
    frame = [settings.width, settings.height, settings.crop, settings.bounces, BOUNCES]
    numbers = [SEEDS, SAMPLER]
    parts = [scene_to_dict(scene), frame, numbers, error, seconds, VERSION, shaders]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:32]


def _loaded(path: Path) -> Reference | None:
    """What the cache holds; None if that is nothing, or not readable."""
    try:
        with path.open("rb") as file, np.load(file) as arrays:
            first, second = (arrays[name].astype(float) for name in ("first", "second"))
            return Reference(first, second, *map(int, arrays["counts"]))
    except (OSError, ValueError, KeyError, EOFError, BadZipFile):
        return None


def _save(reference: Reference, path: Path) -> None:
    """Keep it for the next time; a cache that cannot be written is not needed."""
    first, second = (half.astype(np.float32) for half in (reference.first, reference.second))
    counts = (reference.samples, reference.bounces)
    with suppress(OSError, RenderError):
        path.parent.mkdir(parents=True, exist_ok=True)
        files.write_whole(
            path, lambda file: np.savez(file, first=first, second=second, counts=counts)
        )
