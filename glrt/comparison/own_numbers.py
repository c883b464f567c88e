"""The part of a picture whose pixels err independently of each other."""

from dataclasses import replace

from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.image.shared_numbers import own_part


def independent(image: Image) -> Image:
    """Return the picture, or the part of its samples whose random numbers pixels do not share.

    Raises UsageError if these are not known.
    """
    if not (image.recipe and image.recipe.settings.division.is_shared):
        return image
    if not image.film_state:
        raise UsageError(
            "pixels of a picture by --sampler shared err alike: glrt compare needs its .exr as "
            "glrt wrote it, which has the means of all groups of samples."
        )
    own = own_part(image.film_state.net)
    return replace(image, **own._asdict(), samples=image.samples // 2)
