"""`glrt compare`: files in, a report and an exit code out."""

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from glrt import files
from glrt.compare import compare
from glrt.compare_noise import BLOCK
from glrt.comparison import CHANNELS, Comparison, Interval, percent
from glrt.errors import UsageError
from glrt.image import Image

DIFFERENT = 1


def compare_files(arguments: argparse.Namespace) -> int:
    """The exit code: 1 for pictures that differ, and with --strict for undecided ones."""
    image = read(arguments.image, arguments.samples, "--samples")
    reference = read(arguments.reference, arguments.reference_samples, "--reference-samples")
    if arguments.picture:
        _check_picture(arguments.picture)
    comparison = compare(image, reference, arguments.alpha, arguments.bias)
    if arguments.picture:
        from glrt.compare_picture import save_picture

        save_picture(comparison, arguments.picture)
    print(json.dumps(figures(comparison)) if arguments.json else report(comparison), flush=True)
    wanted = ("same",) if arguments.strict else ("same", "undecided")
    return 0 if comparison.verdict in wanted else DIFFERENT


def read(path: str, samples: int | None, option: str) -> Image:
    """An EXR or NPY file with its number of samples; UsageError if that is in neither place."""
    image = _read_npy(path) if path.lower().endswith(".npy") else Image.load(path)
    if image.samples and samples not in (None, image.samples):
        raise UsageError(f"{path} has {image.samples} samples a pixel: leave out {option}.")
    if not image.samples and (samples is None or samples < 1):
        raise UsageError(
            f"{path}: this file does not say how many samples a pixel it has. Give {option} N."
        )
    return replace(image, samples=image.samples or samples or 0)


def report(comparison: Comparison) -> str:
    """Verdict and figures, for people."""
    row = "{:<7}{:>11}{:>11}  {:>11}   {}".format
    sure = f"{100 * (1 - comparison.alpha):g} %"
    lines = [
        str(comparison),
        "",
        row("mean", "image", "reference", "difference", f"{sure} interval"),
    ]
    rows = zip(CHANNELS, comparison.means, comparison.differences, strict=True)
    lines += [row(c, *(f"{m:.5g}" for m in means), *_percent(d)) for c, means, d in rows]
    if comparison.factors:
        lines += ["", "weighed by their noise, which shows best a factor between the pictures:"]
        rest = zip(CHANNELS, comparison.factors, strict=True)
        lines += [row(c, "", "", *_percent(factor)) for c, factor in rest]
    else:
        lines += ["", "The methods may differ: each picture is held to its own noise."]
    c = comparison
    return "\n".join(
        [
            *lines,
            "",
            f"{BLOCK} x {BLOCK} blocks: spread {c.spread:.2f} of 1 expected; largest "
            f"{c.largest:+.2f} of {c.limit:.2f} allowed, {c.worst}",
            f"its worst pixel: {c.pixel}",
            f"smallest difference that would have shown: {percent(c.shown)} of the picture",
        ]
    )


def _percent(interval: Interval) -> tuple[str, str]:
    difference, low, high = (percent(value, digits=3, sign="+") for value in interval)
    return difference, f"{low} to {high}"


def figures(comparison: Comparison) -> dict[str, Any]:
    """For scripts: plain values, null for what is infinite or unknown."""
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
        "shown": c.shown,
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
        raise UsageError(f"Cannot write {path}: the name given to --picture ends in .png.")
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
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and told as such
        radiance = pixels.astype(np.float32)
    return Image(radiance, np.full_like(radiance, np.nan), samples=0)
