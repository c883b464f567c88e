"""Pictures and films to export, as a user typed them, and as the options of a command."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

from glrt.core.errors import UsageError
from glrt.core.files import check_writable
from glrt.core.text import quoted
from glrt.denoise.filters import least_samples
from glrt.series.containers import check_container
from glrt.series.outputs import parse_output
from glrt.settings import Denoise, Settings
from glrt.view.controls import controls_of

Kind = Literal["picture", "film"]
Until = Literal["samples", "error"]
Motion = Literal["animation", "turntable"]

JPEG = (".jpg", ".jpeg")
PICTURES = (".png", ".exr", ".npy", *JPEG)
MOST_FRAMES = 100_000
MOST_RATE = 1000
_SIZES = {c.name: c for c in controls_of(Settings) if c.name in ("width", "height", "samples")}


@dataclass
class Wish:
    """A picture or a film to export; numbers are texts, as they are typed."""

    kind: Kind = "picture"
    width: str = "512"  # pixels
    height: str = "512"
    until: Until = "samples"
    samples: str = "256"
    error: str = "2 %"
    denoise: Denoise = "none"
    motion: Motion = "turntable"
    frames: str = "48"  # of a turntable
    rate: str = "24"  # frames a second
    picture: str = ""  # file of a picture
    film: str = ""  # file of a film
    keeps_shape: bool = True  # whether width and height follow each other

    @property
    def path(self) -> str:
        """File of what is to be exported."""
        return self.picture if self.kind == "picture" else self.film


class Order(NamedTuple):
    """A wish that makes sense: a command, its options, and the file that it is to give."""

    kind: Kind
    path: Path
    options: tuple[str, ...]


def order_of(wish: Wish, settings: Settings) -> Order:
    """Return the order of a wish; `UsageError` names the value that is wrong.

    `settings` are those of the view. Whether the file can be written is not looked at.
    """
    for name in ("width", "height"):
        _whole(name, getattr(wish, name), int(_SIZES[name].low or 1), int(_SIZES[name].high or 0))
    options = ["--width", wish.width.strip(), "--height", wish.height.strip()]
    if wish.until == "samples":
        most = int(_SIZES["samples"].high or 0)
        options += ["--samples", str(_whole("samples", wish.samples, 1, most))]
    else:
        options += ["--error", f"{_share(wish.error):g}"]
    _check_denoiser(wish, settings)
    options += ["--denoise", wish.denoise, "--caustics", settings.caustics]
    path = Path(wish.path.strip()).expanduser()
    if not path.name:
        raise UsageError("The file has no name: type one, such as picture.png.")
    if wish.kind == "film":
        options += _of_film(wish, path)
    elif path.suffix.lower() not in PICTURES:
        raise UsageError(
            f"The file {quoted(path.name)} must end in .png, .exr, .npy or .jpg: that chooses "
            "the format."
        )
    return Order(wish.kind, path, tuple(options))


def check_place(order: Order) -> None:
    """Raise `UsageError` if the file of an order cannot be written."""
    if order.kind == "film":
        output = parse_output(str(order.path))
        check_container(output.path)
        if output.kind == "frames":
            return
    check_writable(order.path)


def _check_denoiser(wish: Wish, settings: Settings) -> None:
    """Raise UsageError for too few samples to know the error of a denoised picture."""
    least = least_samples(settings.block)
    if wish.denoise != "none" and wish.until == "samples" and int(wish.samples) < least:
        raise UsageError(f"denoise: it needs {least} samples or more, to know its error.")


def _of_film(wish: Wish, path: Path) -> list[str]:
    """Return the options of a film alone."""
    parse_output(str(path))
    options = ["--fps", f"{_number('frames a second', wish.rate, MOST_RATE):g}"]
    if wish.motion == "turntable":
        options += ["--turntable", str(_whole("frames", wish.frames, 1, MOST_FRAMES))]
    return options


def _whole(name: str, text: str, least: int, most: int) -> int:
    """Return a text as a whole number in a range; UsageError with the name of the value."""
    word = text.strip()
    if not (word.isascii() and word.isdecimal() and len(word) < 20 and least <= int(word) <= most):
        raise UsageError(f"{name}: {quoted(word)} is no whole number from {least} to {most:,}.")
    return int(word)


def _share(text: str) -> float:
    """Return an error such as "2 %" or "0.02" as a share; UsageError for anything else."""
    word = text.strip()
    try:
        share = float(word.removesuffix("%")) / (100 if word.endswith("%") else 1)
    except ValueError:
        share = 0.0
    if not 0 < share <= 1:
        raise UsageError(f"error: {quoted(word)} is no share such as 2 % or 0.02.")
    return share


def _number(name: str, text: str, most: float) -> float:
    """Return a text as a number above 0; UsageError with the name of the value."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value <= most:
        raise UsageError(f"{name}: {quoted(text.strip())} is no number above 0, at most {most:g}.")
    return value
