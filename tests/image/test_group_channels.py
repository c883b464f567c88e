"""Groups of shared numbers: channels of files, and the error that follows from their means."""

import numpy as np
import pytest

from glrt.image.group_channels import from_channels, judged, to_channels
from tests.support.images import same_bits

GROUPS = 8
BLOCK = 16  # two samples in turn are of one group


def test_dropped_samples_come_back_from_channels() -> None:
    random = np.random.default_rng(5)
    groups = random.uniform(0, 9, (GROUPS, 4, 5, 4)).astype(np.float32)
    counts = np.bincount(np.arange(45) // 2 % GROUPS)
    groups[..., 3] = counts[:, None, None] - random.integers(0, 2, (GROUPS, 4, 5))
    channels = to_channels(groups, 45, BLOCK)
    planes = {name: plane for name, plane in channels.items() if plane.ndim == 2}
    for name in channels.keys() - planes.keys():
        planes |= {f"{name}.{c}": channels[name][..., i] for i, c in enumerate("RGB")}
    back = from_channels(planes, (4, 5), 45, GROUPS, BLOCK)
    assert back is not None
    assert same_bits(back, groups)
    del planes["film.group.7.B"]
    assert from_channels(planes, (4, 5), 45, GROUPS, BLOCK) is None


@pytest.mark.parametrize("samples", [2, 5, 9, 16, 21])
def test_the_variance_is_unbiased_for_independent_samples(samples: int) -> None:
    """Some groups have a sample more than others, and the first few alone have any."""
    random = np.random.default_rng(samples)
    draws = random.exponential(size=(samples, 1, 40000))
    groups = np.zeros((GROUPS, 1, 40000, 4))
    for k in range(min(samples, GROUPS)):
        groups[k, ..., :3] = draws[k::GROUPS].mean(axis=0)[..., None]
        groups[k, ..., 3] = len(draws[k::GROUPS])
    variance, held = judged(groups)
    assert (held == min(samples, GROUPS)).all()
    squares = variance[..., 0] / (held - 1)
    assert abs(squares.mean() * samples - 1) < 5 * samples * squares.std() / 200
