"""`glrt compare`: compare two image files; print a report, return an exit code."""

import argparse
import json
import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from glrt.comparison.result import CHANNELS, Comparison
from glrt.comparison.verdict import compare
from glrt.core import files
from glrt.core.errors import UsageError
from glrt.core.web_page import check_page
from glrt.image.image import Image

DESCRIPTION = (
    "Say whether two renders show the same picture up to their noise: same, different, or "
    "undecided for lack of samples."
)
EPILOG = (
    "At most a share ALPHA of equal pictures is called different. Exit codes: 0 same or "
    "undecided, 1 different (with --strict, undecided too), 2 wrong usage or files."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    for name in ("image", "reference"):
        parser.add_argument(name, metavar=name.upper(), help="an .exr or .npy file")
    for name in ("samples", "reference-samples"):
        whose = "REFERENCE" if name.startswith("reference") else "IMAGE"
        text = f"samples of each pixel of {whose}, where its file does not say"
        parser.add_argument(f"--{name}", type=int, metavar="N", help=text)
    parser.add_argument(
        "--alpha",
        type=float,
        default=0.01,
        help="share of false alarms (default: %(default)s)",
    )
    parser.add_argument(
        "--bias",
        type=float,
        default=0.01,
        help='the relative difference that "same" must exclude (default: %(default)s)',
    )
    parser.add_argument(
        "--groups",
        action="store_true",
        help="render each light group of IMAGE alone, to say what change of it would have been "
        "found; needs OpenGL",
    )
    parser.add_argument("--strict", action="store_true", help="exit with 1 if undecided, too")
    parser.add_argument(
        "--picture", metavar="FILE", help="a .png file that shows where they differ"
    )
    parser.add_argument(
        "--html",
        metavar="FILE",
        help="a .html file that shows both, with a wipe, exposure, and the figures",
    )
    parser.add_argument("--json", action="store_true", help="print figures as one line of JSON")


DIFFERENT = 1
GROUP_SAMPLES = 64  # of a render with one light group: its noise hardly matters
GROUP_SETTINGS = {"width", "height", "bounces", "method", "crop", "sampler", "roulette", "seed"}


def run(arguments: argparse.Namespace) -> int:
    """Print the verdict; return 1 if the pictures differ, with --strict also if undecided."""
    image = read(arguments.image, arguments.samples, "--samples")
    reference = read(arguments.reference, arguments.reference_samples, "--reference-samples")
    if arguments.picture:
        _check_picture(arguments.picture)
    if arguments.html:
        check_page(arguments.html, "--html")
    groups = light_groups(image, arguments.image) if arguments.groups else {}
    comparison = compare(image, reference, arguments.alpha, arguments.bias, groups=groups)
    if arguments.picture:
        from glrt.comparison.heatmap import save_picture

        save_picture(comparison, arguments.picture)
    if arguments.html:
        from glrt.comparison.html import Compared, entry_of, save_page

        title = f"{Path(arguments.image).name} and {Path(arguments.reference).name}"
        save_page([entry_of(Compared(title, image, reference, comparison))], arguments.html)
    print(json.dumps(figures(comparison)) if arguments.json else repr(comparison), flush=True)
    wanted = ("same",) if arguments.strict else ("same", "undecided")
    return 0 if comparison.verdict in wanted else DIFFERENT


def read(path: str, samples: int | None, option: str) -> Image:
    """Read an EXR or NPY file; UsageError if it and `samples` give no number, or two numbers."""
    image = _read_npy(path) if path.lower().endswith(".npy") else Image.load(path)
    if image.samples and samples not in (None, image.samples):
        raise UsageError(f"{path} has {image.samples} samples a pixel already: leave out {option}.")
    if not image.samples and (samples is None or samples < 1):
        raise UsageError(
            f"{path}: this file does not say how many samples a pixel it has. Give {option} N."
        )
    return replace(image, samples=image.samples or samples or 0)


def light_groups(image: Image, path: str) -> dict[str, Image]:
    """Render each light group of the picture's scene alone; UsageError if it has no recipe."""
    if image.recipe is None:
        raise UsageError(f"{path}: --groups needs the recipe of a picture that glrt rendered.")
    from glrt.api import render
    from glrt.image.sources import files_read
    from glrt.plan.facts import SceneFacts
    from glrt.scene.scene import with_lights

    scene, settings = files_read(image.recipe, Path(path)).scene, image.recipe.settings
    own = {name: scene.lights.get(name, 1.0) for name in SceneFacts(scene).emissions}
    kept: Any = settings.model_dump(include=GROUP_SETTINGS, exclude_none=True)
    samples = min(image.recipe.samples, GROUP_SAMPLES)
    lit = {name: dict.fromkeys(own, 0.0) | {name: value} for name, value in own.items() if value}
    return {n: render(with_lights(scene, lights), samples, **kept) for n, lights in lit.items()}


def figures(comparison: Comparison) -> dict[str, Any]:
    """Return the figures of a comparison as plain values, None for infinite or unknown ones."""
    c = comparison
    rows = zip(CHANNELS, c.means, c.differences, strict=True)
    channels = {
        name: {"image": means[0], "reference": means[1], **difference._asdict()}
        for name, means, difference in rows
    }
    factors = {name: i._asdict() for name, i in zip(CHANNELS, c.factors, strict=False)}
    table = {
        "verdict": c.verdict,
        "reasons": c.reasons,
        "alpha": c.alpha,
        "bias": c.bias,
        "means": channels,
        "factors": factors or None,
        "spread": c.spread,
        "largest": c.largest,
        "limit": c.limit,
        "block": c.worst._asdict(),
        "pixel": c.pixel._asdict(),
        "sensitivity": asdict(c.sensitivity),
        "heavy_tails": c.heavy_tails and c.heavy_tails._asdict(),
        "needs": c.needs,
        "alike": c.alike,
    }
    return {key: _plain(value) for key, value in table.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(part) for key, part in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _check_picture(path: str) -> None:
    if not path.lower().endswith(".png"):
        raise UsageError(f"Cannot write {path}: the file of --picture must end in .png.")
    files.check_writable(Path(path))


def _read_npy(path: str) -> Image:
    try:
        files.check_regular(Path(path))
        pixels = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise UsageError(
            f"{path}: cannot read this image: {files.reason(error)}. Check name and file."
        ) from None
    if not isinstance(pixels, np.ndarray) or pixels.dtype.kind != "f" or pixels.shape[2:] != (3,):
        raise UsageError(f"{path}: not an image: it must be an array (height, width, 3) of floats.")
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and reported as such
        radiance = pixels.astype(np.float32)
    return Image(radiance, np.full_like(radiance, np.nan), samples=0)
