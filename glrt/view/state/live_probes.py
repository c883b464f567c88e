"""Live probes: they are kept from picture to picture, as in real-time renderers."""

from glrt.plan.methods import traits_of
from glrt.rendering.probe_supply import HYSTERESIS
from glrt.settings import Settings


def kept_by_probes(settings: Settings, is_moving: bool) -> float | None:
    """Return the share of their content that probes keep for the next picture; None if not live.

    Probes are live while edits follow one another.
    """
    return HYSTERESIS if is_moving and traits_of(settings).has_probes else None


def notice_of_lag(lag: float) -> str:
    """Return a notice on the share of older light in live probes; "" for 0."""
    if not lag:
        return ""
    return f"live probes: {lag:.0%} of their light over one bounce is from before the last edit"
