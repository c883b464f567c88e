"""Whether probes go on from picture to picture, as in a renderer of moving pictures."""

from dataclasses import dataclass
from typing import Literal

from glrt.plan.methods import METHODS
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.settings import Settings

When = Literal["off", "moving", "always"]


@dataclass(frozen=True)
class LiveProbes:
    """What users choose of them."""

    when: When = "moving"
    hysteresis: float = HYSTERESIS  # share of what they hold that an update keeps

    def kept(self, settings: Settings, is_moving: bool) -> float | None:
        """That share, for the next picture; None: it has probes of its own, if any."""
        is_live = self.when == "always" or (self.when == "moving" and is_moving)
        return self.hysteresis if is_live and METHODS[settings.method].has_probes else None


def told(lag: float) -> str:
    """How far live probes are behind, by the share of older light in them; "" for 0."""
    if not lag:
        return ""
    return f"live probes: {lag:.0%} of their light over one bounce is from before the last edit"
