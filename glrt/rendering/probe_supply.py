"""Supply the light probes that the next samples of a picture need."""

import math

import numpy as np

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.gpu.program import Resource
from glrt.plan.methods import traits_of
from glrt.plan.plan import Plan
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.probe_tracer import ProbeTracer

HYSTERESIS = 0.97  # of live probes: after 22.8 updates they hold half of a change of light


class ProbeSupply:
    """Supplies a set of probes for each observation, warmed up before its first sample.

    With a hysteresis, probes continue from the picture before instead. Each picture updates them
    once, or the share `probes.per_update` in turn, and updated ones keep that fraction of their
    content. Such a picture depends on earlier ones, and its error is unknown.
    """

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        before: "ProbeSupply | None" = None,
        hysteresis: float | None = None,
    ) -> None:
        """Take over the maps of `before` if probes continue; RenderError if there is no room."""
        self._plan, self._block = plan, plan.settings.block
        self.hysteresis, self._is_due = hysteresis, True
        self.tracer: ProbeTracer | None = None
        if traits_of(plan.settings).has_probes:
            known, follows = before.tracer if before else None, hysteresis is not None
            self.tracer = ProbeTracer(context, plan, scene, known, follows)
        self._old = np.zeros(self.tracer.grid.probes if self.tracer else 0)  # lag of each probe
        if before and self.tracer and self.tracer.goes_on:
            is_alike = _are_lit_alike(plan, before._plan)
            self._old = before._old if is_alike else np.ones_like(self._old)

    @property
    def resources(self) -> dict[str, Resource]:
        """Textures of the probes for kernels; empty if the method has no probes."""
        return self.tracer.resources if self.tracer else {}

    @property
    def lag(self) -> float:
        """Share of the probes' content from before the last edit of light or objects, 0 to 1."""
        return float(self._old.mean()) if len(self._old) else 0.0

    def check(self) -> None:
        """Raise UsageError if the picture depends on earlier ones and cannot be rendered again."""
        if self.tracer and self.hysteresis is not None:
            raise UsageError(
                "Probes are live: the picture hangs on those before it, and cannot be rendered "
                "again. Let the probes rest first."
            )

    def restart(self) -> None:
        """Begin another picture of the same scene: live probes are due for one more update."""
        self._is_due = True

    def lack(self, sample: int) -> bool:
        """Whether sample number `sample` has to wait for its probes."""
        if self.tracer and self.hysteresis is not None and self.tracer.is_lit:
            return self._is_due and self.tracer.is_used
        return self.tracer is not None and not self.tracer.has_set(sample // self._block)

    def work_on(self, sample: int, seconds: float = math.inf) -> None:
        """Warm up the set of a sample for about `seconds`, or update live probes once."""
        if self.tracer and self.hysteresis is not None and self.tracer.is_lit:
            if self._is_due:
                updated = self.tracer.follow(self.hysteresis)
                self._old[updated.numbers] *= self.hysteresis
                self._is_due = False
        elif self.tracer:
            self.tracer.work_on(sample // self._block, seconds)

    def together(self, sample: int, wanted: int) -> int:
        """How many of `wanted` samples from number `sample` on share one set of probes."""
        return min(wanted, self._block - sample % self._block) if self.tracer else wanted

    def release(self, after: "ProbeSupply | None" = None) -> None:
        """Release all OpenGL resources, except maps that `after` has taken over."""
        if self.tracer:
            self.tracer.release(after.tracer if after else None)


def _are_lit_alike(plan: Plan, before: Plan) -> bool:
    """Whether two plans have equal scenes, apart from camera and probes, and equal bounces."""
    scene = plan.scene
    seen = before.scene.model_copy(update={"camera": scene.camera, "probes": scene.probes})
    return seen == plan.scene and plan.settings.bounces == before.settings.bounces
