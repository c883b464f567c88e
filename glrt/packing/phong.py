"""Constants of Phong's model as fields of the frame."""

from glrt.phong import Phong

AS_MATERIAL = -1  # stands for a constant that is left out


def phong_fields(phong: Phong | None) -> dict[str, object]:
    """Return the frame fields of the constants; below 0 for each that materials give."""
    given = dict(phong or Phong())
    told = {name: AS_MATERIAL if value is None else value for name, value in given.items()}
    return {f"phong_{name}": value for name, value in told.items()}
