"""The probes that a picture needs next, if its method has any."""

import math

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.gpu.program import Resource
from glrt.plan.methods import METHODS
from glrt.plan.plan import Plan
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.probe_tracer import ProbeTracer

HYSTERESIS = 0.97  # of live probes: half of a step of light is in them after 22.8 updates


class ProbeSupply:
    """For each observation a set of probes, warmed up before its first sample.

    With a hysteresis the probes of the picture before go on instead: one update for each picture
    that begins, of which they keep that share of what they hold. Then the picture hangs on those
    before it, and its error is not known.
    """

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        before: "ProbeSupply | None" = None,
        hysteresis: float | None = None,
    ) -> None:
        """With the maps of `before` where probes go on; RenderError if there is no room."""
        self._plan, self._block = plan, plan.settings.block
        self.hysteresis, self._is_due = hysteresis, True
        self.tracer: ProbeTracer | None = None
        if METHODS[plan.settings.method].has_probes:
            known, follows = before.tracer if before else None, hysteresis is not None
            self.tracer = ProbeTracer(context, plan, scene, known, follows)
        self._lag = 0.0
        if before and self.tracer and self.tracer.goes_on:
            self._lag = before._lag if _are_lit_alike(plan, before._plan) else 1.0

    @property
    def resources(self) -> dict[str, Resource]:
        """What kernels read of them."""
        return self.tracer.resources if self.tracer else {}

    @property
    def lag(self) -> float:
        """The share of what probes hold that is from before the last edit of light or objects."""
        return self._lag

    def check(self) -> None:
        """UsageError if the picture cannot be rendered again."""
        if self.tracer and self.hysteresis is not None:
            raise UsageError(
                "Probes are live: the picture hangs on those before it, and cannot be rendered "
                "again. Let the probes rest first."
            )

    def restart(self) -> None:
        """Another picture of the same scene: probes that go on are updated once more."""
        self._is_due = True

    def lack(self, sample: int) -> bool:
        """Whether a sample, by its number, has to wait for its probes."""
        if self.tracer and self.hysteresis is not None and self.tracer.is_lit:
            return self._is_due and self.tracer.is_used
        return self.tracer is not None and not self.tracer.has_set(sample // self._block)

    def work_on(self, sample: int, seconds: float = math.inf) -> None:
        """Warm the set of a sample up, for about so long; or update probes that go on."""
        if self.tracer and self.hysteresis is not None and self.tracer.is_lit:
            if self._is_due:
                self.tracer.follow(self.hysteresis)
                self._lag, self._is_due = self._lag * self.hysteresis, False
        elif self.tracer:
            self.tracer.work_on(sample // self._block, seconds)

    def together(self, sample: int, wanted: int) -> int:
        """Of so many samples from this one on, those that have the same set."""
        return min(wanted, self._block - sample % self._block) if self.tracer else wanted

    def release(self, after: "ProbeSupply | None" = None) -> None:
        """Free what the driver holds, except maps that another one has taken over."""
        if self.tracer:
            self.tracer.release(after.tracer if after else None)


def _are_lit_alike(plan: Plan, before: Plan) -> bool:
    """Whether two scenes have the same light, wherever they are seen from."""
    seen = before.scene.model_copy(update={"camera": plan.scene.camera})
    return seen == plan.scene and plan.settings.bounces == before.settings.bounces
