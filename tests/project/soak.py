"""`python -m tests.project.soak [--minutes M]`: scenes, sizes and settings change in one process.

The resources of the process must not grow. A stint changes a renderer that lives as long as the
process, as the window does. It opens another, as a script does: of any tier and pipeline, now and
then in a context of its own. Its picture is saved, and read again.
"""

import argparse
import gc
import random
import time
from ctypes.util import find_library
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, get_args

from glrt.gpu.context import Choice, Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.plan.methods import METHODS
from glrt.plan.plan import Layering
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.samplers import DIVISIONS
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.settings import Method
from tests.support.builders import MATTE, lamp, scene_of, sphere
from tests.support.hard_scenes import HARD, hard_scene
from tests.support.images import same_bits
from tests.support.mixed_scene import everything

LARGEST = 160  # pixels along an edge
ALONE = 8  # one stint of so many opens a context of its own
PAGE = 4096  # bytes


class Look(NamedTuple):
    """The resources that the process holds after so many stints."""

    seconds: float
    stints: int
    megabytes: float


def crowd(count: int) -> Scene:
    """Balls in rows under a lamp: enough of them want a tree, and more than a uniform block."""
    balls = [sphere([i % 30 - 15, i // 30 - 15, -40], 0.4, "white") for i in range(count)]
    materials = {"white": MATTE, "lamp": lamp(20.0)}
    return scene_of([*balls, sphere([0, 20, -20], 3, "lamp")], materials)


def all_scenes() -> list[Scene]:
    """The scenes to change between: scenes that come with glrt, hard ones, and crowds."""
    found = [load(name) for name in scene_names()]
    found += [hard_scene(name) for name in HARD]
    return [*found, everything(), crowd(40), crowd(200), crowd(3000)]


SAMPLERS = [name for name, it in DIVISIONS.items() if not it.is_shared]  # with all methods
TRACING = [name for name, traits in METHODS.items() if not traits.rasters]  # with media, too


def any_settings(chance: random.Random) -> dict[str, Any]:
    """Settings that are valid for every scene."""
    sampler, method = chance.choice(SAMPLERS), chance.choice(TRACING)
    if METHODS[method].has_probes:
        sampler = "sobol"
    return {
        "width": round(LARGEST ** chance.random()),
        "height": round(LARGEST ** chance.random()),
        "bounces": chance.randint(0, 8),
        "method": method,
        "sampler": sampler,
        "roulette": chance.random() < 0.5,
        "seed": chance.randint(0, 99),
        "exposure": chance.uniform(-2, 2),
        "samples": chance.randint(1, 4) * (16 if sampler == "sobol" else 1),
    }


def any_layering(chance: random.Random, method: Method) -> Layering:
    """Any content of layers; none for a method that keeps its light in probes."""
    return "none" if METHODS[method].has_probes else chance.choice(get_args(Layering))


def any_way(chance: random.Random, method: Method) -> dict[str, Any]:
    """How a renderer may go about it."""
    pipelines = ["compute"] if METHODS[method].has_probes else ["compute", "fragment"]
    pipeline = chance.choice(pipelines)
    layering = "none" if pipeline == "fragment" else any_layering(chance, method)
    return {"tier": chance.choice(get_args(Tier)), "pipeline": pipeline, "layering": layering}


def change(renderer: Renderer, scene: Scene, chance: random.Random) -> None:
    """Change as the window does: another scene and settings, some work, and the shown picture."""
    settings = any_settings(chance)
    renderer.update(scene, any_layering(chance, settings["method"]), **settings)
    renderer.advance(0.05)
    if chance.random() < 0.5:
        renderer.bake()
        renderer.advance(0.05)
    if renderer.samples:
        renderer.display()
        renderer.nonfinite()


def open_another(context: Context | None, scene: Scene, chance: random.Random, file: Path) -> None:
    """Open another as a script does, save and read its picture; by default in its own context."""
    routes: list[Choice] = ["egl", "osmesa"] if find_library("OSMesa") else ["egl"]
    route = chance.choice(routes)
    settings = any_settings(chance)
    ways = any_way(chance, settings["method"])
    renderer = Renderer(scene, context=context or route, **ways, **settings)
    image = renderer.render().image()
    renderer.release()
    image.save(file.with_suffix(".png"))
    image.save(file)
    assert same_bits(Image.load(file).radiance, image.radiance)


def held() -> float:
    """Megabytes that the process holds now."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * PAGE / 1e6


def soak(seconds: float, seed: int, period: int | None = None, rounds: int = 1) -> list[Look]:
    """Change for so long, or `rounds` times a period of stints; what was held after each.

    All rounds make the same changes, in one context.
    """
    most, chance = rounds * period if period else None, random.Random(seed)
    scenes, looks, start = all_scenes(), list[Look](), time.perf_counter()
    context = open_context("auto")
    renderer = Renderer(everything(), context=context, width=16, height=16, layering="groups")
    with TemporaryDirectory() as folder:
        while (spent := time.perf_counter() - start) < seconds and len(looks) != most:
            if period and len(looks) % period == 0:
                chance.seed(seed)
            change(renderer, chance.choice(scenes), chance)
            own = chance.random() < 1 / ALONE
            file = Path(folder) / "chance.exr"
            open_another(None if own else context, chance.choice(scenes), chance, file)
            looks.append(Look(spent, len(looks) + 1, held()))
    renderer.release()
    context.gl.release()
    return looks


def around(looks: list[Look], share: float) -> float:
    """Megabytes held there, the median over a tenth of the looks; share 0 is the start."""
    count = max(1, len(looks) // 10)
    first = round(share * (len(looks) - count))
    return median(look.megabytes for look in looks[first : first + count])


def told(looks: list[Look]) -> str:
    """Start, middle and end in words."""
    held_by = ", ".join(
        f"{around(looks, share):.0f} MB {where}"
        for where, share in (("at the start", 0), ("in the middle", 0.5), ("at the end", 1))
    )
    last = looks[-1]
    return f"{2 * last.stints} changes of scene in {last.seconds / 60:.0f} minutes: {held_by}"


def main() -> None:
    """Soak, and print what was held."""
    parser = argparse.ArgumentParser(prog="python -m tests.project.soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    looks = soak(60 * chosen.minutes, chosen.seed)
    for look in looks[:: max(1, len(looks) // 30)]:
        print(f"{look.seconds:6.0f} s {look.stints:6} stints {look.megabytes:6.0f} MB")
    print(told(looks))


if __name__ == "__main__":
    main()
