"""Figures of a picture as text: samples, error, and a forecast of the error. Nothing here draws."""

import math

from glrt.settings import MAX_SAMPLES
from glrt.view.state.error_history import Look, Progress
from glrt.view.state.session import Session

_DOUBT = ",\nnot to be believed: few samples carry much of the light"


def forecast(progress: Progress, target: float, samples: int) -> str:
    """Return when the error will reach the target, and the samples that it needs if too few."""
    seconds, needed = progress.remaining(target), progress.samples_to(target)
    if seconds is None or needed is None:
        return f"{percent_text(target)}: time not known yet"
    if seconds == 0:
        return f"{percent_text(target)} is reached"
    if needed > MAX_SAMPLES:
        return f"{percent_text(target)} takes more samples than a picture holds"
    more = f": raise samples to {needed:,}" if needed > samples else ""
    return f"{percent_text(target)} in about {_duration(seconds)} more{more}"


def samples_text(done: int, wanted: int) -> str:
    """Return how many samples there are, of the wanted ones."""
    if done > wanted:
        return f"{done} samples, {wanted} are wanted"
    return f"{done} of {wanted} samples"


def unknown_text(session: Session) -> str:
    """Return why the error is unknown, and from when on it is known."""
    if session.moving.is_shown(session.renderer, session.settings.samples):
        return "unknown while history of earlier views is shown"
    if session.is_passing and not session.is_preview:
        return "unknown while probes are live"
    if session.samples >= session.known_from and not session.is_preview:
        return "unknown until the picture is read"
    more = f": raise samples to {session.known_from}"
    is_short = session.settings.samples < session.known_from
    return f"unknown, known from {session.known_from} samples on{more if is_short else ''}"


def error_text(look: Look) -> str:
    """Return the error of a look, with a note if it may be far too small."""
    return f"{_banded(look)}{_DOUBT if look.is_doubtful else ''}"


def _banded(look: Look) -> str:
    """Return the error and its confidence band, with enough digits to distinguish its ends."""
    error, low, high = (100 * part for part in look.band)
    if not 0 < high - low < math.inf:
        return f"{error:.2g} %, estimated"
    digits = min(max(0, 1 - math.floor(math.log10(high - low))), 4)
    return f"{error:.{digits}f} % ({low:.{digits}f} to {high:.{digits}f}), estimated"


def percent_text(error: float | None) -> str:
    """Return an error in per cent, with two digits."""
    return "not known yet" if error is None else f"{100 * error:.2g} %"


def _duration(seconds: float) -> str:
    units = (("days", 86400), ("hours", 3600), ("minutes", 60))
    for name, unit in units:
        if seconds >= 2 * unit:
            return f"{seconds / unit:.0f} {name}"
    return f"{seconds:.0f} s"
