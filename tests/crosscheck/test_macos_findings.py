"""The symptoms of the thesis on macOS do not appear here: a darker picture, harder shadows and
green dots. Each suspicion, planted into the WGSL version, shows what it can explain, and what not.
"""

import pytest

from tests.wgsl.device import Device
from tests.wgsl.findings import SUSPICIONS, Symptoms, symptoms

DARK = {"darker", "harder shadows"}
SHOWN: dict[str, set[str]] = {
    "colours kept in 8 bits, rounded": set(),
    "colours kept in 8 bits, truncated": DARK,
    "colours kept in 16 bits": set(),
    "textures swapped twice a frame": DARK,
    "samples that are not numbers, in the mean": {"green dots"},
    "samples that are not numbers, dropped as here": set(),
    "random texture not refreshed": DARK,
    "seeds of hash(index + frame)": set(),
    "loops that the driver ends after three rounds": DARK,
    "colours shown without the sRGB curve": DARK,
}


@pytest.fixture(scope="module")
def healthy(webgpu: Device) -> Symptoms:
    return symptoms(webgpu)


def test_the_version_as_it_is_has_soft_shadows_and_no_dots(healthy: Symptoms) -> None:
    assert healthy.green_dots == 0
    assert healthy.brightness == pytest.approx(185, abs=3)
    assert healthy.shadow == pytest.approx(0.74, abs=0.03)


@pytest.mark.parametrize("name", SUSPICIONS)
def test_a_suspicion_shows_what_it_can_explain(
    webgpu: Device, healthy: Symptoms, name: str
) -> None:
    assert symptoms(webgpu, SUSPICIONS[name]).beside(healthy) == SHOWN[name]
