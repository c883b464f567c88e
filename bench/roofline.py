"""An estimate of the arithmetic throughput of the kernel, relative to the peak of the machine.

The peak is measured with a kernel of independent chains of multiplications and additions on the
same renderer. The operations of a sample are its number of rays, counted by the kernel, times the
operations of a ray, counted in the shader sources: each addition, multiplication, division, square
root, sine and cosine of a component is one. Comparisons, selections and integer operations are not
counted, nor are operations for inactive lanes. Therefore the share of the peak is a lower bound of
the utilisation, accurate to about a factor of two.
"""

import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

from bench.program import add_rounds, exit_code_of, machine, parser_of
from glrt.analysis.chart.rays import rays_of
from glrt.gpu.context import Context, open_context
from glrt.gpu.glsl import Source
from glrt.gpu.program import Kernel
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Method

# Operations of one ray and shape: sphere_, plane_ and quad_distance in shaders_glsl/shapes.
SEARCH = {"sphere": 32, "plane": 14, "quad": 33}
# Other operations of a ray: surface hit (25), its local frame (30), directions to and from it (30),
# scattering or light sampling with densities (35), throughput and weights (20), the mean (10).
AROUND = 150

METHODS: tuple[Method, ...] = ("naive", "mis")
PIXELS, CHAINS, ROUNDS = 512, 16, 2000  # pixels a side; chains and rounds of an invocation
_CHAINS = f"""
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) buffer Data {{ float data[]; }};
void main() {{
    float a = data[0];
    float b = data[1];
    float x[{CHAINS}];
    for (int k = 0; k < {CHAINS}; ++k) x[k] = data[2] * float(k);
    for (int i = 0; i < {ROUNDS}; ++i) {{
        {" ".join(f"x[{k}] = x[{k}] * a + b;" for k in range(CHAINS))}
    }}
    float sum = 0.0;
    for (int k = 0; k < {CHAINS}; ++k) sum += x[k];
    if (sum == 0.5) data[3] = sum;
}}
"""


class Row(NamedTuple):
    """One scene and method; seconds are for one sample of one pixel."""

    scene: str
    method: str
    rays: float  # per sample
    operations: float  # per sample
    seconds: float
    share: float  # of the peak, median over the rounds


class Peak:
    """A kernel that only multiplies and adds, to measure the peak."""

    def __init__(self, context: Context) -> None:
        """Compile it, and run it once."""
        self._gl = context.gl
        with self._gl:
            self._kernel = Kernel(self._gl, Source("peak", texts={"peak": _CHAINS}))
            self._data = self._gl.buffer(bytes(16))
        self.operations_per_second()

    def operations_per_second(self) -> float:
        """Additions and multiplications per second, from one run."""
        with self._gl:
            start = time.perf_counter()
            self._kernel.bind({"Data": self._data}, {})
            self._kernel.run(PIXELS, PIXELS)
            self._gl.finish()
            return 2 * CHAINS * ROUNDS * PIXELS**2 / (time.perf_counter() - start)

    def release(self) -> None:
        """Release the kernel and its buffer."""
        self._kernel.release()
        self._data.release()


def operations_of_ray(scene: Scene) -> int:
    """Operations of one ray that is intersected with every shape of a scene."""
    return AROUND + sum(SEARCH[shape.shape] for shape in scene.objects)


def measure(
    context: Context, scenes: Sequence[str], size: int, rounds: int, samples: int = 32
) -> tuple[float, list[Row]]:
    """The peak in operations per second, and a row for each scene and method; interleaved."""
    peak, jobs = Peak(context), list(product(scenes, METHODS))
    renderers = [
        Renderer(load(n), context=context, tier="complete", method=m, width=size, height=size)
        for n, m in jobs
    ]
    peaks: list[float] = []
    times: list[list[float]] = [[] for _ in jobs]
    for _ in range(rounds):
        peaks.append(peak.operations_per_second())
        for runs, renderer in zip(times, renderers, strict=True):
            runs.append(_seconds(renderer, samples))
    rows = [
        _row(context, name, renderer, runs, peaks)
        for (name, _), renderer, runs in zip(jobs, renderers, times, strict=True)
    ]
    peak.release()
    for renderer in renderers:
        renderer.release()
    return statistics.median(peaks), rows


def _seconds(renderer: Renderer, samples: int) -> float:
    renderer.restart()
    start = time.perf_counter()
    renderer.render(samples)
    width, height = renderer.size
    return (time.perf_counter() - start) / (samples * width * height)


def _row(
    context: Context, name: str, renderer: Renderer, runs: list[float], peaks: list[float]
) -> Row:
    rays = rays_of(renderer.scene, renderer.settings, context).sample
    operations = rays * operations_of_ray(renderer.scene)
    shares = [operations / run / peak for run, peak in zip(runs, peaks, strict=True)]
    seconds, share = statistics.median(runs), statistics.median(shares)
    return Row(name, renderer.settings.method, rays, operations, seconds, share)


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    columns = ["rays per sample", "operations", "million samples/s", "share of the peak"]
    yield f"| scene | method | {' | '.join(columns)} |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        yield (
            f"| {row.scene} | {row.method} | {row.rays:.2f} | {row.operations:.0f} "
            f"| {1e-6 / row.seconds:.2f} | {100 * row.share:.0f} % |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.roofline`; returns the exit code."""
    parser = parser_of("roofline", __doc__)
    scenes = ["cornell", "lamps", "metals"]
    parser.add_argument("--scenes", nargs="+", metavar="NAME", default=scenes)
    add_rounds(parser, size=128, rounds=9)
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.scenes, parsed.size, parsed.rounds))


def _print(scenes: Sequence[str], size: int, rounds: int) -> None:
    context = open_context(pipeline="compute")
    peak, rows = measure(context, scenes, size, rounds)
    print(machine(context.renderer))
    print(f"peak: {peak / 1e9:.1f} billion additions and multiplications per second\n")
    print("\n".join(table(rows)))


if __name__ == "__main__":
    sys.exit(main())
