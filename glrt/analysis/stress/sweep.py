"""What a case of `glrt stress` is, what it finds, and whether a guarantee is broken."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from glrt.analysis.plot import Chart, Curve
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.evaluation import evaluate
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]

SIGMAS = 5.33  # standard errors that a mean may be off: chance goes beyond once in 10 million


@dataclass(frozen=True)
class Sweep:
    """Errors over one stress parameter: `chosen` is what glrt does, the others stand beside it.

    The guarantee: `chosen` is at most `bound` wherever `guaranteed` says so. Where there is no
    bound to give, `wrong` alone says what failed.
    """

    parameter: str  # with its unit
    measure: str  # what the curves show, with its unit
    x: Sequence[float]
    chosen: tuple[str, Sequence[float]]
    others: Mapping[str, Sequence[float]]
    promise: str  # the guarantee in words
    bound: Sequence[float] | None = None
    guaranteed: Sequence[bool] | None = None  # everywhere, if None
    wrong: Sequence[float] = ()  # values of the parameter at which something else failed

    def broken(self) -> list[float]:
        """The values of the parameter at which the guarantee is broken; NaN breaks it too."""
        if self.bound is None:
            return list(self.wrong)
        rows = zip(self.x, self.chosen[1], self.bound, self.covered(), strict=True)
        above = {x for x, y, bound, covered in rows if covered and not y <= bound}
        return sorted(above | set(self.wrong))

    def covered(self) -> Sequence[bool]:
        """Where the guarantee holds."""
        if self.bound is None:
            return [False] * len(self.x)
        return [True] * len(self.x) if self.guaranteed is None else self.guaranteed

    def limit(self) -> float | None:
        """The last value of the parameter under the guarantee, if there are some beyond."""
        covered = self.covered()
        edges = [i for i in range(1, len(self.x)) if covered[i] != covered[i - 1]]
        return None if not edges else self.x[edges[0] - (not covered[edges[0]])]


@dataclass(frozen=True)
class Lab:
    """Where cases run: an open context, and how much work they may do."""

    context: Context
    scale: float = 1.0  # of samples and rows; 1 is the full size

    def count(self, full: int, least: int = 16) -> int:
        """So many rows or samples of `full` as the size of this run grants."""
        return max(least, int(full * self.scale))

    def path(
        self,
        expression: str,
        inputs: Mapping[str, Any],
        returns: str = "float",
        scene: Scene | None = None,
        setup: str = "",
        functions: str = "",
    ) -> Array:
        """An expression over arrays, of the functions that trace paths (`Probe` says more).

        They see `scene`, or nothing. Every feature is compiled in, and lamps are chosen as there.
        """
        with self.context.gl as gl:
            return evaluate(gl, expression, inputs, returns, setup, functions, scene)

    def render(
        self, scene: Scene, samples: int, variant: Variant = PLAIN, **settings: Any
    ) -> Image:
        """A picture, by the tier that `glrt render` uses."""
        with self.rendering(scene, variant, **settings) as renderer:
            return renderer.render(samples).image()

    @contextmanager
    def rendering(
        self, scene: Scene, variant: Variant = PLAIN, **settings: Any
    ) -> Iterator[Renderer]:
        """A renderer, by the tier that `glrt render` uses, whose samples each tell of the noise."""
        wanted = {"sampler": "independent", **settings}
        renderer = Renderer(scene, context=self.context, tier="baked", variant=variant, **wanted)
        try:
            yield renderer
        finally:
            renderer.release()


def mean_of(image: Image) -> tuple[float, float]:
    """Mean over the picture, and its standard error."""
    spread = np.square(image.stderr, dtype=np.float64).sum()
    mean = float(image.radiance.mean(dtype=np.float64))
    return mean, float(np.sqrt(spread) / image.radiance.size)


@dataclass(frozen=True)
class Case:
    """One thing that goes wrong in path tracers."""

    name: str
    title: str
    run: Callable[[Lab], Sweep]


@dataclass(frozen=True)
class Finding:
    """A case and what it found."""

    case: Case
    sweep: Sweep
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether no guarantee is broken."""
        return not self.sweep.broken()

    @property
    def verdict(self) -> str:
        """In a few words."""
        broken = self.sweep.broken()
        if not broken:
            return "holds"
        more = f" and {len(broken) - 3} more" if len(broken) > 3 else ""
        return f"BROKEN at {', '.join(f'{x:.3g}' for x in broken[:3])}{more}"

    def chart(self) -> Chart:
        """The curves, the bound where it is guaranteed, and the limit of that."""
        s = self.sweep
        named = [s.chosen, *s.others.items()]
        curves = [Curve(name, s.x, y) for name, y in named]
        covered = [i for i, inside in enumerate(s.covered()) if inside]
        if s.bound is not None:
            bound = [s.bound[i] for i in covered]
            line = Curve("guaranteed: not above", [s.x[i] for i in covered], bound, is_bound=True)
            curves.append(line)
        return Chart(
            title=self.case.title,
            note=f"{s.promise}: {self.verdict}",
            x_label=s.parameter,
            y_label=s.measure,
            curves=curves,
            limit=s.limit(),
            limit_label="limit of the guarantee",
        )

    def small_chart(self) -> Chart:
        """The chart for the overview: named as on the command line, without its promise."""
        return replace(self.chart(), title=self.case.name, note=self.verdict)
