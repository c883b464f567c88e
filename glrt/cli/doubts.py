"""What the commands say of a picture that is not to be believed."""

from glrt.image.image import Image
from glrt.text import counted

_LESS_SURE = {"naive", "nee"}  # methods by which more light is found by luck than by `mis`


def doubt(image: Image) -> str:
    """A paragraph where the estimated error of a picture is not to be believed; else ""."""
    if not image.error_doubtful:
        return ""
    assert image.error is not None
    assert image.recipe
    is_less_sure = image.recipe.settings.method in _LESS_SURE
    other = " or --method mis, which finds more of it" if is_less_sure else ""
    return (
        f"the estimated error, {100 * image.error:.2g} %, is not to be believed: much of it stands "
        "in pixels that one or two bright samples have lit, and the true error may be several "
        f"times as large. Use more --samples{other}."
    )


def clipped(particles: int) -> str:
    """A paragraph where particles brought more light than was kept; else ""."""
    if not particles:
        return ""
    return (
        f"{counted(particles, 'particle')} brought more light than a pixel takes at once: it is "
        "too dark there. Use --caustics off."
    )
