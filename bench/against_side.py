"""One side of `bench.against`: a process that renders with the glrt of one checkout.

It is run by path, with PYTHONPATH set to that checkout, which may be much older than this file.
Therefore it imports nothing of bench, and of glrt only public names and the list of tiers.
Requests and answers are lines of JSON, as in `bench.processes`.
"""

import hashlib
import json
import os
import re
import sys
import time
from pathlib import Path
from typing import Any

import glrt


class Side:
    """The requests that the process answers: one method each."""

    def open(self, scene: str, **settings: Any) -> dict[str, Any]:
        """Open a renderer for a scene, with a context of its own."""
        settings = {"width": settings["size"], "height": settings["size"], **settings}
        del settings["size"]
        if settings["tier"] == "fastest":
            settings["tier"] = fastest_tier()
        self._renderer = glrt.Renderer(glrt.load(scene), **settings)
        seconds: Any = getattr(self._renderer, "seconds", None)  # older ones have no table of them
        compiled = seconds["compile"] if seconds else getattr(self._renderer, "compile_seconds", 0)
        return {
            "compile_seconds": compiled,
            "renderer": str(self._renderer.context.renderer),
        }

    def render(self, samples: int, seed: int) -> dict[str, Any]:
        """Render from an empty film; the seed must differ from that of the last picture."""
        start = time.perf_counter()
        self._renderer.update(seed=seed)
        radiance = self._renderer.render(samples).image().radiance
        seconds = time.perf_counter() - start
        return {"seconds": seconds, "sha256": hashlib.sha256(radiance.tobytes()).hexdigest()}

    def close(self) -> dict[str, Any]:
        """Release the renderer."""
        self._renderer.release()
        return {"peak_bytes": peak_bytes()}


def fastest_tier() -> Any:
    """The tier that `glrt render` opens: the last one of the list, which old checkouts lack."""
    try:
        from glrt.rendering.pipelines import TIERS
    except ImportError:
        return "baked"
    return TIERS[-1]


def peak_bytes() -> int:
    """The peak resident memory of this process.

    On Linux from /proc, as getrusage includes the memory of the parent process before exec.
    """
    status = Path("/proc/self/status")
    found = re.search(r"VmHWM:\s*(\d+) kB", status.read_text()) if status.exists() else None
    if found:
        return int(found[1]) * 1024
    import resource  # not on Windows

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def main() -> None:
    """Answer requests until stdin ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # output of libraries must not mix with the answers

    def answer(words: dict[str, Any]) -> None:
        print(json.dumps(words), file=answers, flush=True)

    side = Side()
    answer({"glrt": glrt.__file__})
    for line in sys.stdin:
        words = json.loads(line)
        try:
            answer(getattr(side, words.pop("do"))(**words))
        except Exception as error:  # of any class: those of the other commit are unknown
            answer({"error": f"{type(error).__name__}: {' '.join(str(error).split())}"})


if __name__ == "__main__":
    main()
