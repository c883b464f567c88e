"""Examine one OpenGL route: `python -m glrt.doctor.route_process ROUTE DEVICE`.

Each finding is printed as a line of JSON at once, so that a crash of the driver loses only the
later ones. `glrt doctor` reads them.
"""

import json
import sys
import time
from dataclasses import asdict
from typing import Any

import numpy as np

from glrt.core.errors import GlrtError
from glrt.core.text import one_line
from glrt.gpu.context import Context, open_context, open_device
from glrt.gpu.driver_checks import self_test
from glrt.rendering.passes import Resolved
from glrt.rendering.renderer import Renderer
from glrt.scene.scenefile.toml import parse_scene

BOUNCES = 8
_ROOM = {
    "camera": {"position": [0, 0, 0], "look_at": [0, 0, -1]},
    "materials": {"wall": {"type": "light", "emission": [1, 1, 1], "color": [0.5, 0.5, 0.5]}},
    "objects": [
        {"shape": "plane", "material": "wall", "point": [-c for c in normal], "normal": normal}
        for normal in np.concatenate([np.eye(3), -np.eye(3)]).tolist()
    ],
}


def furnace(context: Context, pipeline: Resolved) -> float:
    """Return the largest relative error of a furnace: a room that emits 1 and reflects half of it.

    Its radiance is (1 - a^(B+1)) / (1 - a) in every direction, a = 1/2, B = BOUNCES. This is a sum
    of powers of two, so that the picture is exact to the last bit where arithmetic is.
    """
    scene = parse_scene(_ROOM, "the furnace")
    settings: dict[str, Any] = {"width": 32, "height": 32, "bounces": BOUNCES, "roulette": False}
    renderer = Renderer(scene, context=context, pipeline=pipeline, method="naive", **settings)
    radiance = renderer.render(2).image().radiance
    truth = 2 - 0.5**BOUNCES
    return float(np.abs(radiance / truth - 1).max())


def _examine(context: Context) -> None:
    """Try the fragment pipeline first: it may work where compute shaders crash the driver."""
    _report("fragment", lambda: {"furnace": furnace(context, "fragment")})
    if context.has_compute:
        _report("self_test", lambda: asdict(self_test(context)))
        _report("compute", lambda: {"furnace": furnace(context, "compute")})


def _report(step: str, find: Any) -> None:
    start = time.perf_counter()
    try:
        found = find()
    except GlrtError as error:
        found = {"error": one_line(str(error))}
    print(json.dumps({"step": step, "seconds": time.perf_counter() - start, **found}), flush=True)


def main(route: str, device: int) -> None:
    """Examine a device of a route; for `auto`, only open the context that it chooses."""
    opened: list[Context] = []

    def open_it() -> dict[str, Any]:
        context = open_context() if route == "auto" else open_device(route, device)
        opened.append(context)
        return {
            "route": context.route,
            "device": context.device,
            "renderer": context.renderer,
            "version": context.version,
            "is_software": context.is_software,
            "has_compute": context.has_compute,
        }

    _report("open", open_it)
    if opened and route != "auto":
        _examine(opened[0])
    _report("end", dict)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
