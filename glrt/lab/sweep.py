"""Cases of `glrt stress`, their results, and whether a guarantee is broken."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np

from glrt.analysis.plot import Chart, Curve
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.rendering.shader_functions import EMPTY, Expression, World, evaluate
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]

SIGMAS = 5.33  # tolerance of means, in standard errors: exceeded by chance once in 10 million


@dataclass(frozen=True)
class Sweep:
    """A measure such as an error over one parameter: by glrt's method, and by others to compare.

    The guarantee is that `chosen` is at most `bound` where `guaranteed` is true. Without a bound,
    it is broken at the values in `wrong` alone.
    """

    parameter: str  # with its unit
    measure: str  # what the curves show, with its unit
    x: Sequence[float]  # values of the parameter
    chosen: tuple[str, Sequence[float]]  # glrt's method: its name, and the measure for each x
    others: Mapping[str, Sequence[float]]  # the same for other methods
    promise: str  # the guarantee in words
    bound: Sequence[float] | None = None  # for each x
    guaranteed: Sequence[bool] | None = None  # for each x; None: everywhere
    wrong: Sequence[float] = ()  # values of the parameter at which another check failed

    def broken(self) -> list[float]:
        """The values of the parameter at which the guarantee is broken; NaN breaks it, too."""
        if self.bound is None:
            return list(self.wrong)
        rows = zip(self.x, self.chosen[1], self.bound, self.covered(), strict=True)
        above = {x for x, y, bound, covered in rows if covered and not y <= bound}
        return sorted(above | set(self.wrong))

    def covered(self) -> Sequence[bool]:
        """For each x, whether it is under the guarantee of `bound`."""
        if self.bound is None:
            return [False] * len(self.x)
        return [True] * len(self.x) if self.guaranteed is None else self.guaranteed

    def limit(self) -> float | None:
        """The last value of the parameter under the guarantee; None if it covers all or none."""
        covered = self.covered()
        edges = [i for i in range(1, len(self.x)) if covered[i] != covered[i - 1]]
        return None if not edges else self.x[edges[0] - (not covered[edges[0]])]


@dataclass(frozen=True)
class Lab:
    """The environment of cases: an open context, and the amount of work."""

    context: Context
    scale: float = 1.0  # factor on the numbers of samples and rows
    rendered: list[Image] | None = None  # receives every picture; None: nobody wants them

    def count(self, full: int, least: int = 16) -> int:
        """The number of rows or samples in a run of this scale, where a full run has `full`."""
        return max(least, int(full * self.scale))

    def path(
        self,
        expression: str,
        inputs: Mapping[str, Any],
        world: World = EMPTY,
        **text: Unpack[Expression],
    ) -> Array:
        """Evaluate a GLSL expression of the path tracing functions over arrays (see `evaluate`)."""
        with self.context.gl as gl:
            return evaluate(gl, expression, inputs, world, **text)

    def render(
        self, scene: Scene, samples: int, variant: Variant = PLAIN, **settings: Any
    ) -> Image:
        """Render a picture, with the tier of `glrt render`."""
        with self.rendering(scene, variant, **settings) as renderer:
            return renderer.render(samples).image()

    @contextmanager
    def rendering(
        self, scene: Scene, variant: Variant = PLAIN, **settings: Any
    ) -> Iterator[Renderer]:
        """Open a renderer with the tier of `glrt render`; its default is independent samples."""
        wanted = {"sampler": "independent", **settings}
        renderer = Renderer(scene, context=self.context, tier="complete", variant=variant, **wanted)
        try:
            yield renderer
            if self.rendered is not None and renderer.samples:
                self.rendered.append(renderer.image())
        finally:
            renderer.release()


def mean_of(image: Image) -> tuple[float, float]:
    """Mean over pixels and channels of a picture, and its standard error."""
    spread = np.square(image.stderr, dtype=np.float64).sum()
    mean = float(image.radiance.mean(dtype=np.float64))
    return mean, float(np.sqrt(spread) / image.radiance.size)


@dataclass(frozen=True)
class Case:
    """One way in which path tracers fail, as a sweep that can be run."""

    name: str
    title: str
    run: Callable[[Lab], Sweep]


@dataclass(frozen=True)
class Finding:
    """A case with its result."""

    case: Case
    sweep: Sweep
    seconds: float
    rendered: Sequence[Image] = ()  # pictures of the case, in its order

    @property
    def holds(self) -> bool:
        """Whether no guarantee is broken."""
        return not self.sweep.broken()

    @property
    def verdict(self) -> str:
        """'holds', or where the guarantee is broken."""
        broken = self.sweep.broken()
        if not broken:
            return "holds"
        more = f" and {len(broken) - 3} more" if len(broken) > 3 else ""
        return f"BROKEN at {', '.join(f'{x:.3g}' for x in broken[:3])}{more}"

    def chart(self) -> Chart:
        """The curves, the bound where it is guaranteed, and the limit of the guarantee."""
        s = self.sweep
        named = [s.chosen, *s.others.items()]
        curves = [Curve(name, s.x, y) for name, y in named]
        covered = [i for i, inside in enumerate(s.covered()) if inside]
        if s.bound is not None:
            bound = [s.bound[i] for i in covered]
            line = Curve("guaranteed upper bound", [s.x[i] for i in covered], bound, is_bound=True)
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
        """The chart for the overview: its title is the name of the case, its note the verdict."""
        return replace(self.chart(), title=self.case.name, note=self.verdict)
