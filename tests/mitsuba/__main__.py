"""`python -m tests.mitsuba SCENE -o FILE`: the image files of `glrt render`, from Mitsuba."""

import argparse
import json
import sys
import time

from glrt.core.errors import GlrtError
from glrt.image.image import check_writable
from glrt.image.sources import load
from glrt.settings import Settings, settings_for
from tests.mitsuba.convert import Liberties
from tests.mitsuba.engine import Engine, load_mitsuba


def main() -> int:
    """Render as the command line says; returns the exit code of `glrt render`."""
    try:
        return render(_parser().parse_args())
    except GlrtError as error:
        print(f"mitsuba: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code


def render(arguments: argparse.Namespace) -> int:
    """One picture; `--json` prints its figures."""
    check_writable(arguments.output)
    scene = load(arguments.scene)
    given = {name: getattr(arguments, name) for name in _SETTINGS}
    given = {name: value for name, value in given.items() if value is not None}
    settings = settings_for(scene.render, **given)
    mi = load_mitsuba(arguments.variant)
    liberties = Liberties(arguments.one_sided, arguments.finite)
    engine = Engine(mi, scene, settings, liberties, arguments.file)
    start = time.perf_counter()
    image = engine.image(settings.samples, settings.seed)
    seconds = time.perf_counter() - start
    image.save(arguments.output)
    if arguments.json:
        rate = settings.width * settings.height * settings.samples / seconds
        figures = {
            "scene": arguments.scene,
            **settings.model_dump(include=set(_SETTINGS)),
            "renderer": engine.name,
            "seconds": {"render": round(seconds, 6)},
            "samples_per_second": round(rate, 1),
            "error": image.error,
        }
        print(json.dumps(figures))
    return 0


_SETTINGS = ("width", "height", "samples", "bounces", "seed", "roulette")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.mitsuba", description=__doc__)
    add = parser.add_argument
    add("scene", metavar="SCENE", help="a scene of glrt: a file, a name or a picture")
    add("-o", dest="output", metavar="FILE", required=True, help=".exr, .png or .npy")
    for name in _SETTINGS:
        text = Settings.model_fields[name].description
        if name == "roulette":
            add("--roulette", action=argparse.BooleanOptionalAction, help=text)
        else:
            add(f"--{name}", type=int, metavar="N", help=text)
    add("--file", metavar="FILE.xml", help="to which `glrt export` wrote the scene")
    add("--one-sided", action="store_true", help="quads light their front alone")
    add("--finite", action="store_true", help="planes end before the horizon")
    add("--variant", choices=["auto", "llvm", "scalar"], default="auto", help="how Mitsuba runs")
    add("--json", action="store_true", help="one line of figures on stdout")
    return parser


if __name__ == "__main__":
    sys.exit(main())
