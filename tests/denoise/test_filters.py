"""The filters by name: which is meant, and what is said where one is missing."""

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.core.install import install
from glrt.denoise import oidn
from glrt.denoise.denoising import denoise
from glrt.denoise.filters import FILTERS, with_filter
from glrt.settings import Settings
from tests.denoise.noisy_halves import drawn, truth_with_an_edge
from tests.support.system_packages import needs

HALVES = drawn(np.random.default_rng(0), truth_with_an_edge(32), (16, 16))


def missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oidn, "find_spec", lambda _name: None)


def there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oidn, "find_spec", lambda name: name)


def test_auto_is_oidn_where_it_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    there(monkeypatch)
    assert with_filter(Settings(denoise="auto")).denoise == "oidn"
    missing(monkeypatch)
    assert with_filter(Settings(denoise="auto")).denoise == "nlm"


def test_oidn_that_is_missing_is_asked_for_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    missing(monkeypatch)
    with pytest.raises(UsageError) as told:
        with_filter(Settings(denoise="oidn"))
    assert install("denoise") in str(told.value)
    assert "\n" not in str(told.value)
    with pytest.raises(UsageError, match="pyoidn"):
        oidn.filtered(HALVES.halves[0])


def test_plain_settings_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    missing(monkeypatch)
    settings = Settings(samples=1)
    assert with_filter(settings) is settings


@pytest.mark.parametrize("name", FILTERS)
def test_a_filter_takes_noise_away_and_says_how_much_is_left(name: str) -> None:
    needs(name != "oidn" or oidn.is_installed(), f"the Python package {oidn.PACKAGE}")
    found = denoise(HALVES.halves, name)
    plain = sum(half.share * half.radiance for half in HALVES.halves)
    before, after = (float(np.square(x - HALVES.truth).mean()) for x in (plain, found.radiance))
    assert after < before / 3
    assert found.radiance.dtype == found.error_map.dtype == np.float32
    relative = np.square(found.radiance - HALVES.truth) / (HALVES.truth**2 + 0.0025)
    assert found.error == pytest.approx(np.sqrt(relative.mean()), rel=0.5)


@pytest.mark.parametrize("name", FILTERS)
def test_the_same_halves_give_the_same_bits(name: str) -> None:
    needs(name != "oidn" or oidn.is_installed(), f"the Python package {oidn.PACKAGE}")
    one, other = (denoise(HALVES.halves, name).radiance for _ in range(2))
    assert np.array_equal(one, other)
