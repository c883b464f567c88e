"""All pictures in docs/pictures: `python -m bench.pictures [NAME...]`, or `make pictures`.

Each picture has a recipe: command lines or a function. All of them take about an hour on two
cores. A name such as `drink` makes one picture; `--list` prints all names and command lines.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from bench.composites import (
    DOCS,
    One,
    blur,
    denoised,
    drink,
    gather,
    glossy,
    leaks,
    models,
    reuse,
)
from bench.notebook_page import notebook
from bench.program import exit_code_of, parser_of
from bench.screen_sheets import aovs, probe_balls
from bench.sheets import write_sheet
from glrt.core.errors import GlrtError, RenderError, UsageError
from glrt.core.files import check_writable
from glrt.core.text import counted, unknown

Command = tuple[str, ...]  # arguments of Python; {file} and {folder} stand for the picture's own
Recipe = Callable[[Path], None] | Command

GALLERY = (
    *("cornell", "courtyard", "weekend", "spot", "drink", "frosted", "stage", "gloss"),
    *("lens", "metals", "alloys", "lamps"),
)
LARGER = 1.5  # times that pictures of volumes are enlarged, since they have 128 x 96 pixels
IN_VOLUMES = (
    *("bench.redraw", "psnr", "--scene", "fog", "smoke", "--samples", "4"),
    *("--mode", "reset", "reproject", "taa", "wrls", "wrls delayed", "--by", "oidn"),
)


def volumes(file: Path) -> None:
    """Fog above smoke on an orbit, by modes of history, denoised, and converged."""
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        run(("-m", *IN_VOLUMES, "--pictures", folder))
        rows = []
        for scene in ("fog", "smoke"):
            with Image.open(Path(folder) / f"{scene} orbit.png") as row:
                width, height = (round(LARGER * it) for it in row.size)
                rows.append(np.asarray(row.resize((width, height), Image.Resampling.LANCZOS)))
    write_sheet(file, np.concatenate(rows))


def run(command: Sequence[str]) -> None:
    """Run Python with these arguments; RenderError if it fails."""
    if code := subprocess.run([sys.executable, *command], cwd=DOCS.parent, check=False).returncode:
        raise RenderError(f"python {' '.join(command)} failed with exit code {code}.")


def _bench(*words: str) -> Command:
    return "-m", *(f"bench.{words[0]}", *words[1:])


def _glrt(*words: str) -> Command:
    return "-m", "glrt", *words


_OUT = ("-o", "{file}")
_PRINCIPLED = "explanation/principled.md"
_MEDIA = "how-to/media.md"
_CLEAN = {"samples": 512, "denoise": "auto"}
_SPHERES = {"width": 480, "height": 240}
_PHONG = (
    *("film", "shading", "--method", "blinn", *_OUT, "--width", "240", "--height", "120"),
    *("--sweep", "render.phong.specular=0:0.8:3", "--sweep", "render.phong.exponent=5:75:3"),
)
_MODES = ("--mode", "reset", "reproject", "taa", "ataa", "wrls")
_STRESS = _bench("stress_sheets", "-o", "{folder}")  # writes all three

RECIPES: dict[str, Recipe] = {
    "adaptive.jpg": _bench("adaptive", "cornell", "--size", "192", *_OUT),
    "aovs.jpg": aovs,
    "blur.jpg": blur,
    "brushed.jpg": One(_PRINCIPLED, "# brushed.toml", _SPHERES),
    "cradle.webp": _glrt("film", "cradle", *_OUT, "--width", "240", "--height", "160"),
    "denoised.jpg": denoised,
    "dispersion.jpg": One(
        *("explanation/glass.md", "# dispersion.toml"),
        {"width": 720, "height": 300, "samples": 768},
    ),
    "drink.jpg": drink,
    "editor.webp": _bench("window_films", "editor", "-o", "{folder}"),
    "effects.jpg": _bench("effects", *_OUT, "--size", "160"),
    "films.jpg": One(_PRINCIPLED, "# films.toml", _SPHERES),
    "fog.jpg": One("fog", "", {"width": 720, "height": 480, **_CLEAN}),
    "gallery.jpg": _bench("gallery", "-o", "{scratch}", "--sheet", "{file}", "--only", *GALLERY),
    "gather.jpg": gather,
    "glossy.jpg": glossy,
    "leaks.png": leaks,
    "leaves.jpg": One(_PRINCIPLED, "# leaves.toml", {**_SPHERES, "samples": 512}),
    "materialx.jpg": One(
        "how-to/materialx.md", "<materialx ", {"width": 720, "height": 500, "samples": 512}
    ),
    "models.jpg": models,
    "notebook.webp": notebook,
    "orbital.jpg": One(
        *(_MEDIA, '"orbital.png"'),
        {"width": 480, "height": 480, "samples": 256, "bounces": 0},
    ),
    "painted.jpg": One("painted", "", {"width": 600, "height": 400}),
    "pair.webp": _bench("window_films", "pair", "-o", "{folder}"),
    "panes.jpg": One(
        *("explanation/glass.md", "# panes.toml"),
        {"width": 720, "height": 300, "samples": 384},
    ),
    "paths.webp": _bench("window_films", "paths", "-o", "{folder}"),
    "phong.png": _glrt(*_PHONG),
    "probe-balls.jpg": probe_balls,
    "redraw.webp": _bench("redraw", "film", "{file}"),
    "reuse.jpg": reuse,
    "shared.jpg": _bench("shared", "methods/diffuse", "--size", "192", "--rounds", "2", *_OUT),
    "sheen.jpg": One(_PRINCIPLED, "# sheen.toml", _SPHERES),
    "smoke.jpg": One("smoke", "", {"width": 420, "height": 560, **_CLEAN}),
    "steps.jpg": _bench("steps", "--samples", "256", *_OUT),
    "stress-more.png": _STRESS,
    "stress-third.png": _STRESS,
    "stress.png": _STRESS,
    "tea.jpg": One(
        *(_MEDIA, '"drinks.png"'),
        {"width": 330, "height": 220, "samples": 256, "bounces": 200, "denoise": "auto"},
    ),
    "temporal.webp": _bench("redraw", "film", "{file}", *_MODES),
    "terms.jpg": _bench("terms", *_OUT, "--size", "160", "--samples", "256"),
    "upsample.jpg": _bench("upsampling", "--picture", "{file}", "--size", "192", "144"),
    "volumes.jpg": volumes,
    "window.webp": _bench("window_films", "window", "-o", "{folder}"),
}


def main(arguments: list[str] | None = None) -> int:
    """Make pictures; returns the exit code."""
    parser = parser_of("pictures", __doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="without suffix; default: all")
    parser.add_argument("-o", dest="folder", type=Path, default=DOCS / "pictures", metavar="DIR")
    parser.add_argument("--list", action="store_true", help="print the recipes, and make nothing")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    files = _files(parsed.names)
    if parsed.list:
        print("\n".join(f"{file:<18} {_described(RECIPES[file])}" for file in files))
        return
    folder, done, failed = parsed.folder.resolve(), set(), []
    for file in files:
        check_writable(folder / file)
    for number, file in enumerate(files, 1):
        recipe, start = RECIPES[file], time.perf_counter()
        try:
            if recipe not in done:
                make(recipe, folder / file)
        except GlrtError as error:
            failed.append(f"{file}: {error}")
        done.add(recipe)
        seconds = time.perf_counter() - start
        print(f"[{number}/{len(files)}] {file}: {seconds:.0f} s", file=sys.stderr, flush=True)
    if failed:
        raise RenderError(f"{counted(len(failed), 'picture')} not made. {' '.join(failed)}")
    print(f"{counted(len(files), 'picture')} in {folder}")


def make(recipe: Recipe, file: Path) -> None:
    """Make a picture; RenderError if a command fails or writes no such file."""
    if not isinstance(recipe, tuple):
        recipe(file)
        return
    with tempfile.TemporaryDirectory() as scratch:
        places = {"file": file, "folder": file.parent, "scratch": scratch}
        run([word.format(**places) for word in recipe])
    if not file.exists():
        raise RenderError(f"python {' '.join(recipe)} did not write it.")


def _files(names: Sequence[str]) -> list[str]:
    """The files of these names, each once, or all; UsageError for an unknown one."""
    known = {Path(file).stem: file for file in RECIPES}
    for name in names:
        if name not in known:
            raise UsageError(unknown("picture", name, [*known], "Pictures"))
    return [known[name] for name in dict.fromkeys(names)] or [*RECIPES]


def _described(recipe: Recipe) -> str:
    if isinstance(recipe, tuple):
        return "python " + " ".join(f'"{word}"' if " " in word else word for word in recipe)
    return str(recipe) if isinstance(recipe, One) else str(recipe.__doc__)


if __name__ == "__main__":
    sys.exit(main())
