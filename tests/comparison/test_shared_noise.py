"""Pictures whose pixels share their noise cannot be compared."""

from dataclasses import replace

import pytest

from glrt.comparison.verdict import compare
from glrt.core.errors import UsageError
from tests.support.images import recipe
from tests.support.noisy_images import noisy


@pytest.mark.parametrize("place", ["image", "reference"])
def test_pictures_whose_pixels_share_their_noise_are_refused(place: str) -> None:
    """Probes share noise: pixels taken for independent would be called different."""
    pair = {"image": noisy("smooth", 64, 1), "reference": noisy("smooth", 64, 2)}
    pair[place] = replace(pair[place], recipe=recipe(method="ddgi"))
    with pytest.raises(UsageError, match=f"the {place} was rendered by ddgi, whose pixels share"):
        compare(pair["image"], pair["reference"])
