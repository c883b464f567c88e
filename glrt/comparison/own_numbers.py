"""The part of a picture whose pixels err independently of each other."""

from dataclasses import replace

from glrt.core.errors import UsageError
from glrt.image.image import Image
from glrt.image.particle_film import observations_of, summed
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
    radiance, stderr = own_part(image.film_state.groups)
    if image.particles:  # which never share numbers
        film = image.particles._replace(camera=radiance)
        observations = observations_of(image.samples, image.recipe.settings.division.points)
        radiance, stderr = summed(film, stderr, observations)
    return replace(image, radiance=radiance, stderr=stderr, samples=image.samples // 2)
