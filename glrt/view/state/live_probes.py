"""Live probes: they are kept from picture to picture, as in real-time renderers."""

from dataclasses import dataclass
from typing import Literal

from glrt.plan.methods import METHODS
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.settings import Settings

When = Literal["off", "moving", "always"]


@dataclass(frozen=True)
class LiveProbes:
    """The user's choice of when probes are live, and how fast they follow the light."""

    when: When = "moving"
    hysteresis: float = HYSTERESIS  # share of their content that an update keeps

    def kept(self, settings: Settings, is_moving: bool) -> float | None:
        """Return the hysteresis for the next picture; None if its probes are not live."""
        is_live = self.when == "always" or (self.when == "moving" and is_moving)
        return self.hysteresis if is_live and METHODS[settings.method].has_probes else None


def told(lag: float) -> str:
    """Return a notice on the share of older light in live probes; "" for 0."""
    if not lag:
        return ""
    return f"live probes: {lag:.0%} of their light over one bounce is from before the last edit"
