"""A made-up renderer of contests, whose noise and speed are known."""

import sys
from pathlib import Path

PROGRAM = """
import os, sys
from pathlib import Path
import numpy as np
from glrt import Image
from bench.peer import serve

name, cost, slower, turns = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), Path(sys.argv[4])

def render(request):
    own = str(os.getpid())
    after_other = turns.exists() and turns.read_text() != own
    turns.write_text(own)
    shape = request.height, request.width, 3
    draw = np.random.default_rng([request.seed, request.samples])
    radiance = draw.normal(1, request.samples**-0.5, shape).astype(np.float32)
    seconds = cost * request.samples * (slower if after_other else 1)
    return Image(radiance, radiance, request.samples), seconds

serve(name, render)
"""


def painter(name: str, seconds: float, turns: Path, slower: float = 1.0) -> list[str]:
    """The command of a renderer that claims `seconds` a sample, of relative variance 1.

    `turns` is a file that all painters share: after a render of another, one takes `slower` times
    as long.
    """
    return [sys.executable, "-c", PROGRAM, name, str(seconds), str(slower), str(turns)]
