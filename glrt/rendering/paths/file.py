"""Store paths of a pixel as JSON, with the recipe to trace them again, and compare two paths."""

import json
import math
from collections.abc import Iterator, Sequence
from typing import Any, Literal, NamedTuple

from pydantic import Field, ValidationError

from glrt.core.errors import SceneError
from glrt.image.recipe import Recipe
from glrt.rendering.paths.values import Path, PixelParticles, PixelPaths
from glrt.settings import Frozen

FORMAT: Literal[1] = 1
LARGEST = 256 << 20  # bytes of the largest file that is read
LISTED = 16  # samples whose share of the light is stored
TOLERANCE = 1e-3  # relative, of numbers from another driver: they grow apart with each bounce


class StoredPaths(NamedTuple):
    """The content of a file of paths."""

    recipe: Recipe
    pixel: tuple[int, int]
    paths: tuple[Path, ...]
    particles: tuple[Path, ...]


class _Listed(Frozen):
    sample: int
    share: float


class _Particles(Frozen):
    """The keys about particles in a file of paths."""

    samples: int = Field(ge=1)
    arriving: int = Field(ge=0)
    mean: tuple[float, float, float]
    paths: tuple[Path, ...]


class _File(Frozen):
    """The keys of a file of paths, except its recipe."""

    glrt_paths: Literal[1]
    pixel: tuple[int, int]
    samples: int = Field(ge=1)
    lost: int = Field(ge=0)
    mean: tuple[float, float, float]
    brightest: tuple[_Listed, ...]
    paths: tuple[Path, ...]
    particles: _Particles | None


def paths_to_json(found: PixelPaths) -> str:
    """The paths as one line of ASCII, which `paths_from_json` reads without loss."""
    shares = found.shares
    table = {
        "glrt_paths": FORMAT,
        "pixel": found.pixel,
        "samples": len(found.radiances),
        "lost": found.lost,
        "mean": [float(value) for value in found.mean],
        "brightest": [{"sample": n, "share": float(shares[n])} for n in found.brightest(LISTED)],
        "paths": [json.loads(path.model_dump_json()) for path in found.paths],
        "particles": _particles_table(found.particles) if found.particles else None,
        "recipe": json.loads(found.recipe.to_json()),
    }
    return json.dumps(table, allow_nan=False)


def _particles_table(found: PixelParticles) -> dict[str, Any]:
    return {
        "samples": found.samples,
        "arriving": len(found.numbers),
        "mean": [float(value) for value in found.mean],
        "paths": [json.loads(path.model_dump_json()) for path in found.paths],
    }


def paths_from_json(text: str, source: str) -> StoredPaths:
    """Read the text of `paths_to_json`; messages call the file `source`.

    Raises SceneError with one paragraph for any other text.
    """
    table = _table(text, source)
    recipe = table.pop("recipe", None)
    try:
        file = _File.model_validate(table)
    except ValidationError as error:
        problem = error.errors(include_url=False, include_context=False, include_input=False)[0]
        key = ".".join(map(str, problem["loc"]))
        raise _damaged(source, f"{key}: {problem['msg'][:1].lower()}{problem['msg'][1:]}") from None
    if not isinstance(recipe, dict):
        raise _damaged(source, "recipe: it is missing")
    particles = file.particles.paths if file.particles else ()
    if any(path.particle is None for path in particles):
        raise _damaged(source, "particles.paths: one has no number")
    recipe = Recipe.from_json(json.dumps(recipe), source)
    return StoredPaths(recipe, file.pixel, file.paths, particles)


def _table(text: str, source: str) -> dict[str, Any]:
    try:
        table = json.loads(text)
    except (ValueError, RecursionError):
        raise _damaged(source, "it is not valid JSON") from None
    if not isinstance(table, dict) or "glrt_paths" not in table:
        raise _damaged(source, "it has no key glrt_paths")
    if table["glrt_paths"] != FORMAT:
        raise SceneError(
            f"{source}: its format is {table['glrt_paths']!r}, and this version of glrt reads "
            f"{FORMAT}. Use the version that wrote it, or store the paths again."
        )
    return table


def _damaged(source: str, problem: str) -> SceneError:
    return SceneError(
        f"{source}: this is no file of paths that glrt has stored, or it is damaged: {problem}. "
        "Store the paths again with `glrt paths SCENE --pixel X Y -o FILE.json`."
    )


def first_difference(stored: Path, found: Path | None, tolerance: float) -> str | None:
    """Where a path first differs from a stored one of the same sample, in words; None: nowhere.

    Numbers may differ by `tolerance` relative to the larger one, vectors by their lengths. With a
    `tolerance` of 0, no bit may differ.
    """
    if found is None:
        return f"particle {stored.particle} does not reach the pixel"
    return next(_differences(stored, found, tolerance), None)


def _differences(stored: Path, found: Path, tolerance: float) -> Iterator[str]:
    for kind, name in (("vertices", "vertex"), ("contributions", "light")):
        before, now = getattr(stored, kind), getattr(found, kind)
        for number, pair in enumerate(zip(before, now, strict=False)):
            for field in type(pair[0]).model_fields:
                values = [getattr(value, field) for value in pair]
                if not _agree(values[0], values[1], tolerance):
                    yield f"{name} {number} ({pair[0].name}): {field} {_change(*values)}"
        if len(before) != len(now):
            yield f"its number of {kind} {_change(len(before), len(now))}"
    for field in ("end", "radiance"):
        values = [getattr(value, field) for value in (stored, found)]
        if not _agree(values[0], values[1], tolerance):
            yield f"its {field} {_change(*values)}"


def _change(before: object, now: object) -> str:
    return f"was {_shown(before)}, and is {_shown(now)}"


def _shown(value: object) -> str:
    if isinstance(value, tuple):
        return " ".join(map(_shown, value))
    return repr(value)


def _agree(before: Any, now: Any, tolerance: float) -> bool:
    if isinstance(before, tuple) and isinstance(now, tuple):
        return _are_near(before, now, tolerance)
    if isinstance(before, float) and isinstance(now, float):
        return _are_near((before,), (now,), tolerance)
    return bool(before == now)


def _are_near(before: Sequence[float], now: Sequence[float], tolerance: float) -> bool:
    if all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(before, now, strict=True)):
        return True
    apart = math.dist(before, now)
    return apart <= tolerance * max(math.hypot(*before), math.hypot(*now))
