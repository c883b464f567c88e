"""Cautions of the commands, on stderr: about a scene, and about a picture that may be wrong."""

import math
import sys
from collections.abc import Collection, Sequence
from pathlib import Path

import numpy as np

from glrt.core.text import counted
from glrt.image.allotment import floor_of
from glrt.image.image import Image
from glrt.image.tonemap import expose_and_encode
from glrt.plan.facts import SceneFacts
from glrt.plan.idle_settings import idle
from glrt.plan.slow_scenes import slow_because
from glrt.scene.scene import Scene
from glrt.scene.warnings import cautions, is_dark
from glrt.settings import Settings

_BLACK = 3  # 8-bit codes below it look black on a screen
_MOSTLY = 0.99  # share of the pixels
_SHOWN = 0.5  # radiance that is bright and not clipped at exposure 0
_LESS_SURE = {"naive", "nee"}  # methods that find more of the light by chance than `mis`


def warn(scene: Scene, settings: Settings, given: Collection[str], is_quiet: bool) -> None:
    """Print what is known before a render: limits overstepped, and what makes it slow.

    `given`: settings of the command line; those without effect are named. `is_quiet`: leave out
    what makes it slow, which leaves the picture as it is.
    """
    for text in [*idle(settings, given), *cautions(scene, settings)]:
        print(f"glrt: caution: {text}", file=sys.stderr)
    for text in () if is_quiet else slow_because(SceneFacts(scene), settings):
        print(f"glrt: slow: {text}", file=sys.stderr)


def doubt(image: Image) -> str:
    """Return a paragraph if the estimated error of a picture may be far too small; else ""."""
    if not image.error_doubtful:
        return ""
    assert image.error is not None
    assert image.recipe
    is_less_sure = image.recipe.settings.method in _LESS_SURE
    other = " or --method mis, which finds more of it" if is_less_sure else ""
    return (
        f"the estimated error, {100 * image.error:.2g} %, is not to be believed: much of it stands "
        "in pixels that one or two bright samples have lit, and the true error may be several "
        f"times as large. Use more --samples{other}."
    )


def dropped(samples: int) -> str:
    """Return a paragraph if samples or particles were dropped; else ""."""
    if not samples:
        return ""
    found = "1 sample was" if samples == 1 else f"{samples:,} samples were"
    return (
        f"{found} dropped: not finite, or beyond the driver's loop limit. If there are many, the "
        "picture is biased: use fewer bounces."
    )


def even(image: Image) -> str:
    """Return a paragraph if `--adaptive on` has changed nothing; else ""."""
    settings = image.recipe.settings if image.recipe else None
    if settings is None or settings.adaptive == "off" or image.samples > floor_of(settings):
        return ""
    return (
        f"--adaptive on has no effect here: the first {floor_of(settings)} samples are the same "
        "in all pixels. Give more --samples."
    )


def clipped(particles: int) -> str:
    """Return a paragraph if particles brought more light than was kept; else ""."""
    if not particles:
        return ""
    return (
        f"{counted(particles, 'particle')} brought more light than a pixel takes at once: it is "
        "too dark there. Use --caustics off."
    )


def too_dark(image: Image, outputs: Sequence[str]) -> str:
    """Return a paragraph if a PNG file looks black though its scene has light; else ""."""
    if not image.recipe or not any(Path(name).suffix.lower() == ".png" for name in outputs):
        return ""
    settings = image.recipe.settings
    codes = expose_and_encode(image.shown, settings.exposure, settings.tonemap)
    is_black = codes.max(axis=2) < _BLACK
    if is_black.mean() < _MOSTLY or is_dark(image.recipe.scene):
        return ""
    share = f"{100 * math.floor(1000 * is_black.mean()) / 1000:g} % of the picture is black"
    brightest = image.shown.max(axis=2)
    seen = brightest[is_black & (brightest > 0)].astype(np.float64)
    if seen.size < (1 - _MOSTLY) * is_black.size:
        return (
            f"{share} at every exposure: no light reaches what is in view there. Move the camera, "
            "or add a light."
        )
    exposure = min(round(math.log2(_SHOWN / np.quantile(seen, 0.9))), 50)
    return (
        f"{share}: its light is too dim for exposure {settings.exposure:g}. Use --exposure "
        f"{exposure}, or brighter lights."
    )
