"""The probes that a picture needs next, if its method has any."""

import math

from glrt.gpu.context import Context
from glrt.gpu.program import Resource
from glrt.methods.light_layers import Plan
from glrt.methods.table import METHODS
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.probe_tracer import ProbeTracer


class ProbeSupply:
    """For each observation a set of probes, warmed up before its first sample."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        scene: DeviceScene,
        before: "ProbeSupply | None" = None,
    ) -> None:
        """By the kernels of `before` where they fit; RenderError if there is no room."""
        self._block = plan.settings.block
        self.tracer: ProbeTracer | None = None
        if METHODS[plan.settings.method].has_probes:
            self.tracer = ProbeTracer(context, plan, scene, before.tracer if before else None)

    @property
    def resources(self) -> dict[str, Resource]:
        """What kernels read of them."""
        return self.tracer.resources if self.tracer else {}

    def lack(self, sample: int) -> bool:
        """Whether a sample, by its number, has to wait for its set."""
        return self.tracer is not None and not self.tracer.has_set(sample // self._block)

    def work_on(self, sample: int, seconds: float = math.inf) -> None:
        """Warm the set of a sample up, for about so long."""
        if self.tracer:
            self.tracer.work_on(sample // self._block, seconds)

    def together(self, sample: int, wanted: int) -> int:
        """Of so many samples from this one on, those that have the same set."""
        return min(wanted, self._block - sample % self._block) if self.tracer else wanted

    def release(self, after: "ProbeSupply | None" = None) -> None:
        """Free what the driver holds, but for kernels that another one has taken over."""
        if self.tracer:
            self.tracer.release(after.tracer if after else None)
