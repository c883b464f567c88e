"""How much clearer the picture is while the camera moves: `python -m bench.redraw TASK`.

`orbit` plays the same orbit by several modes and reports the error of the picture on the screen,
and the processor seconds of a frame; `film FILE.webp` shows modes side by side; `bias` reports how
much darker or brighter they show a still camera, `psnr` how much nearer to a reference they and
denoisers are than the film of the last view. There is no window. Seconds are the process's own:
next to other work only their ratios mean something.
"""

import argparse
import itertools
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from bench.program import at_least, exit_code_of, parser_of
from glrt.analysis.motion.playing import Played as Playing
from glrt.analysis.motion.playing import play, screen_of
from glrt.analysis.motion.sequences import orbit
from glrt.analysis.reference import Budget, reference_for
from glrt.denoise.filters import FILTERS
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image as Picture
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.history.temporal import WAYS, Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Method, Settings, settings_for

FRAMES, DEGREES = 48, 0.5
LOOKS = (0, 1, 2, 4, 8, 16, 24, 32, 40, 47)  # frames; errors of others are interpolated
SWING = 12  # frames of the film
REFERENCE = 128  # samples of each half
FILM, SCENES = (176, 132), ("cornell", "lamps")
MOST_BYTES, QUALITIES = 300_000, (30, 20, 14, 8)
MODES = ("reset", "reproject")
Ways = tuple[Way, ...]
Encoded = NDArray[np.uint8]  # (H, W, 3), as on a screen
MOST_SEED = 0xFFFFFFFF
FRAME: dict[str, Any] = {"width": 128, "height": 96, "sampler": "independent"}
TRUTH = 1024  # samples of the reference of `psnr`
MOVES = {"still": 0.0, "orbit": 1.0}  # of the camera, degrees a frame
STILL_VIEWS, STILL_SAMPLES = 40, (1, 4, 16)


class Played(NamedTuple):
    """An orbit by one mode."""

    mode: str  # and predictor
    errors: list[float]  # relative RMS, at LOOKS
    seconds: float  # of the process, a frame
    samples: float  # of a pixel, a frame

    @property
    def mean(self) -> float:
        """Over all frames."""
        return float(np.interp(range(FRAMES), LOOKS, self.errors).mean())


class Compared(NamedTuple):
    """The pictures that `psnr` compares."""

    ways: Ways
    filters: Sequence[str]  # denoisers of the film of the last view
    samples: int  # of a pixel, a frame
    method: Method | None  # None: that of the scene
    folder: Path | None  # for the pictures that are compared


def main(arguments: list[str] | None = None) -> int:
    """Measure orbits, or make the film; returns the exit code."""
    parser = parser_of("redraw", __doc__)
    parser.add_argument("task", choices=["orbit", "film", "bias", "psnr"])
    parser.add_argument("file", nargs="?", type=Path, default=Path("redraw.webp"))
    parser.add_argument("--scene", nargs="+", default=SCENES)
    parser.add_argument("--size", type=int, nargs=2, default=(640, 480), metavar=("W", "H"))
    parser.add_argument(
        "--method", choices=get_args(Method), help="of `psnr`; default: of the scene"
    )
    parser.add_argument("--mode", nargs="+", default=MODES, choices=WAYS)
    parser.add_argument(
        "--samples", type=at_least(1), default=2, metavar="N", help="of a view of `psnr`"
    )
    parser.add_argument(
        "--by",
        nargs="+",
        default=(),
        choices=[*FILTERS],
        help="of `psnr`: denoisers, from 4 samples",
    )
    parser.add_argument("--pictures", type=Path, metavar="DIR", help="folder for those of `psnr`")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    context, ways = open_context(), tuple(WAYS[mode] for mode in parsed.mode)
    if parsed.task == "film":
        make_film(parsed.file, context, ways)
        return
    size = parsed.size[0], parsed.size[1]
    for scene in parsed.scene:
        if parsed.task == "bias":
            print("\n".join(biases(scene, context, ways)))
        elif parsed.task == "psnr":
            by, samples, folder = parsed.by, parsed.samples, parsed.pictures
            compared = Compared(ways, by, samples, parsed.method, folder)
            print("\n".join(ratios(scene, context, compared)), flush=True)
        else:
            print("\n".join(told(scene, measure(scene, size, context, ways))))


def measure(scene: str, size: tuple[int, int], context: Context, ways: Ways) -> list[Played]:
    """Each mode, one sample a frame."""
    opened = load(scene)
    settings = settings_for(opened.render, width=size[0], height=size[1])
    frames = orbit(opened, FRAMES, DEGREES)
    truth = {
        n: reference_for(frames.scenes[n], settings, context, Budget(0.0, math.inf, REFERENCE))
        for n in LOOKS
    }
    found = []
    for way in ways:
        more: list[float] = []
        played = play(frames, Playing(settings, way), context, 1, more)
        errors, start = [], time.process_time()
        looked = 0.0
        for number, picture in enumerate(played):
            if number in truth:
                begun = time.process_time()
                errors.append(math.sqrt(max(truth[number].squared_error(picture), 0.0)))
                looked += time.process_time() - begun
        seconds = (time.process_time() - start - looked) / FRAMES
        found.append(Played(way.name, errors, seconds, 1 + sum(more) / FRAMES))
    return found


def told(scene: str, found: list[Played]) -> Iterator[str]:
    """As a Markdown table.

    At equal time: the error of the first mode falls with the root of the samples that it could take
    in the time of the other.
    """
    base = found[0]
    title = f"{scene}, orbit of {FRAMES} frames"
    yield f"| {title} | mean error | samples | seconds a frame | at equal time |"
    yield "|---|---|---|---|---|"
    for one in found:
        gain = base.mean / math.sqrt(one.seconds / base.seconds) / one.mean
        figures = f"{one.mean:.3f} | {one.samples:.2f} | {one.seconds:.3f}"
        yield f"| {one.mode} | {figures} | {gain:.2f} times lower |"


def biases(scene: str, context: Context, ways: Ways) -> Iterator[str]:
    """By how much the mean of what is shown of views of a still camera differs from that of films.

    Modes by samples of a view; the same random numbers in each mode.
    """
    opened = load(scene)
    settings = settings_for(opened.render, width=64, height=48)
    for way, samples in itertools.product(ways, STILL_SAMPLES):
        renderer, temporal = Renderer(opened, settings, context), Temporal(context.gl, way)
        shown, films = [], []
        for seed in range(STILL_VIEWS):
            temporal.leave(renderer)
            renderer.update(seed=seed)
            temporal.arrive(renderer)
            renderer.render(samples)
            shown.append(screen_of(renderer, temporal).mean())
            films.append(renderer.image().radiance.mean())
        temporal.release()
        renderer.release()
        bias = float(np.mean(shown[10:]) / np.mean(films) - 1)
        yield f"{scene}, {way.name}, {samples} samples a view: {bias:+.2%}"


def ratios(scene: str, context: Context, compared: Compared) -> Iterator[str]:
    """Peak signal-to-noise ratios of the last frame, still and on an orbit, as a Markdown table."""
    opened = load(scene)
    settings = settings_for(opened.render, **FRAME, samples=compared.samples)
    if compared.method:  # probes go with the sampler of Sobol
        settings = settings_for(settings, method=compared.method, sampler="sobol")
    found: dict[str, list[float]] = {}
    for move, degrees in MOVES.items():
        scenes = orbit(opened, 24, degrees).scenes[:18]
        truth = _encoded(_film(scenes[-1], settings, context, TRUTH, MOST_SEED).radiance)
        pictures = {way.name: _shown(scenes, settings, context, way) for way in compared.ways}
        for by in compared.filters:
            given = settings_for(settings, denoise=by)
            film = _film(scenes[-1], given, context, compared.samples, len(scenes) - 1)
            pictures[f"film, {by}"] = _encoded(film.denoised().radiance)
        for name, picture in pictures.items():
            found.setdefault(name, []).append(_ratio(picture, truth))
        if compared.folder:
            save_row({**pictures, "truth": truth}, compared.folder / f"{scene} {move}.png")
    yield f"| {scene} | PSNR, still | gain | PSNR, orbit | gain |"
    yield "|---|---|---|---|---|"
    base = next(iter(found.values()))
    for name, (still, moving) in found.items():
        gains = still - base[0], moving - base[1]
        yield f"| {name} | {still:.1f} | {gains[0]:+.1f} | {moving:.1f} | {gains[1]:+.1f} |"


def _film(scene: Scene, settings: Settings, context: Context, samples: int, seed: int) -> Picture:
    renderer = Renderer(scene, settings, context, seed=seed, samples=samples)
    image = renderer.render().image()
    renderer.release()
    return image


def _shown(scenes: tuple[Scene, ...], settings: Settings, context: Context, way: Way) -> Encoded:
    """The last picture on the screen; views of a still camera differ by their random numbers."""
    renderer, temporal = Renderer(scenes[0], settings, context), Temporal(context.gl, way)
    for number, scene in enumerate(scenes):
        temporal.leave(renderer)
        renderer.update(scene, seed=number)
        temporal.arrive(renderer)
        renderer.render(settings.samples)
    shown = _encoded(screen_of(renderer, temporal))
    temporal.release()
    renderer.release()
    return shown


def _encoded(radiance: NDArray[np.float32]) -> Encoded:
    return expose_and_encode(radiance, 0.0, "none")


def _ratio(picture: Encoded, truth: Encoded) -> float:
    """In dB."""
    off = (picture.astype(float) - truth) / 255
    return -10 * math.log10(float(np.square(off).mean()))


def save_row(pictures: Mapping[str, Encoded], file: Path) -> None:
    """Write pictures of one size next to each other, in their order."""
    file.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(np.hstack([*pictures.values()])).save(file)


def make_film(file: Path, context: Context, ways: Ways) -> None:
    """Modes side by side, a scene below the other; RuntimeError if the file is too large."""
    rows = [_frames_of(scene, context, ways) for scene in SCENES]
    frames = [Image.fromarray(np.vstack(parts)) for parts in zip(*rows, strict=True)]
    options: dict[str, Any] = {"duration": 120, "loop": 0, "method": 6}
    for quality in QUALITIES:
        frames[0].save(file, save_all=True, append_images=frames[1:], quality=quality, **options)
        if file.stat().st_size <= MOST_BYTES:
            return
    raise RuntimeError(f"{file} has more than {MOST_BYTES} bytes")


def _frames_of(scene: str, context: Context, ways: Ways) -> list[NDArray[np.uint8]]:
    opened = load(scene)
    settings = settings_for(opened.render, width=FILM[0], height=FILM[1])
    swing = orbit(opened, SWING, 1.5)
    played = [play(swing, Playing(settings, way), context) for way in ways]
    return [
        np.hstack([expose_and_encode(one, 0.0, settings.tonemap) for one in row])
        for row in zip(*played, strict=True)
    ]


if __name__ == "__main__":
    raise SystemExit(main())
