"""Measured metals: rooms of mirrors, the sky over a rough plate, a colour that says the same."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.materials.conductors import PRESETS
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, lamp, plane, room_of_planes, scene_of, sphere
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, same, whole


def test_a_mirror_shows_the_sky_times_its_reflectance(context: Context) -> None:
    """Head-on, at 60 degrees, and nearly along the surface."""
    for degrees in (0.0, 60.0, 89.0):
        angle = np.radians(degrees)
        camera = {
            "position": [0, float(np.cos(angle)), float(np.sin(angle))],
            "look_at": [0, 0, 0],
            "up": [1, 0, 0],
            "fov": 0.001,
        }
        floor = plane([0, 0, 0], [0, 1, 0], "gold")
        gold = {"type": "metal", "preset": "gold"}
        scene = scene_of([floor], {"gold": gold}, camera, background={"color": [1.0] * 3})
        found = rendered(scene, context, 4).radiance.mean(axis=(0, 1))
        index = np.array(PRESETS["gold"].ior) + 1j * np.array(PRESETS["gold"].k)
        beyond = np.sqrt(index**2 - np.sin(angle) ** 2)
        s = (np.cos(angle) - beyond) / (np.cos(angle) + beyond)
        p = (index**2 * np.cos(angle) - beyond) / (index**2 * np.cos(angle) + beyond)
        assert_allclose(found, (np.abs(s) ** 2 + np.abs(p) ** 2) / 2, atol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_a_metal_that_reflects_nearly_all_is_white(context: Context, method: str) -> None:
    """k of 1000 reflects 1 - 4e-6: the bits differ from those of a white colour by no more."""
    things = [plane([0, 0, 0], [0, 1, 0], "plate"), sphere([0, 2, 0], 0.5, "lamp")]
    camera = {"position": [0, 2, 4], "look_at": [0, 0.5, 0], "fov": 50}
    ways: tuple[dict[str, Any], ...] = (
        {"color": [1.0] * 3},
        {"ior": [1.0] * 3, "k": [1000.0] * 3},
    )
    first, second = (
        rendered(
            scene_of(
                things, {"plate": {"type": "metal", "roughness": 0.4, **way}, "lamp": lamp(3.0)},
                camera, background={"color": [0.5] * 3},
            ),
            context, 64, method=method, bounces=3,
        )
        for way in ways
    )  # fmt: skip
    assert_allclose(first.radiance, second.radiance, rtol=2e-5)


def rough_plate(metal: dict[str, Any], sine: float) -> Scene:
    camera = {
        "position": [0, float(np.sqrt(1 - sine * sine)), sine],
        "look_at": [0, 0, 0],
        "up": [1, 0, 0],
        "fov": 0.01,
    }
    floor = plane([0, 0, 0], [0, 1, 0], "plate")
    return scene_of([floor], {"plate": metal}, camera, background={"color": [1.0] * 3})


@pytest.mark.parametrize("sine", [0.0, 0.9])
def test_a_rough_plate_reflects_its_albedo(context: Context, sine: float) -> None:
    """The sky over it, by quadrature of D G2 F / (4 cos) over half vectors that are visible."""
    alpha = 0.25
    n, k = np.array(PRESETS["copper"].ior), np.array(PRESETS["copper"].k)
    wo = np.array([sine, 0, np.sqrt(1 - sine**2)])
    count = 600
    mu, phi = np.meshgrid((np.arange(count) + 0.5) / count, (np.arange(count) + 0.5) / count)
    z2 = (1 - mu) / (1 + (alpha**2 - 1) * mu)  # GGX: mu of all normals are steeper
    h = np.stack(
        [
            np.sqrt(1 - z2) * np.cos(2 * np.pi * phi),
            np.sqrt(1 - z2) * np.sin(2 * np.pi * phi),
            np.sqrt(z2),
        ],
        axis=-1,
    )
    cosine = np.clip(h @ wo, 0, None)
    wi = 2 * cosine[..., None] * h - wo
    low = (wi[..., 2] <= 0) | (cosine == 0)

    def shadow(z: Any) -> Any:
        tan2 = (1 - z**2) / np.maximum(z, 1e-9) ** 2
        return (-1 + np.sqrt(1 + alpha**2 * tan2)) / 2

    g2 = 1 / (1 + shadow(wo[2]) + shadow(np.clip(wi[..., 2], 1e-9, 1)))
    weight = np.where(low, 0, g2 * cosine / (wo[2] * h[..., 2]))
    index = n + 1j * k
    beyond = np.sqrt(index**2 - 1 + cosine[..., None] ** 2)
    s = (cosine[..., None] - beyond) / (cosine[..., None] + beyond)
    p = (index**2 * cosine[..., None] - beyond) / (index**2 * cosine[..., None] + beyond)
    fresnel = (np.abs(s) ** 2 + np.abs(p) ** 2) / 2
    truth = (weight[..., None] * fresnel).mean(axis=(0, 1))
    metal = {"type": "metal", "preset": "copper", "roughness": alpha**0.5}
    image = rendered(rough_plate(metal, sine), context, 4096, bounces=1)
    assert_mean(whole(image), truth, within=0.01, floor=1e-4)


@pytest.mark.slow
def test_metal_weighs_sampled_light_as_scattered_light(context: Context) -> None:
    """Along the surface, where gold reflects blue as well as red."""
    things = [plane([0, 0, 0], [0, 1, 0], "plate"), sphere([0, 0.4, -2], 0.3, "lamp")]
    materials: dict[str, dict[str, Any]] = {
        "plate": {"type": "metal", "preset": "gold", "roughness": 0.5},
        "lamp": lamp(3.0),
    }
    camera = {"position": [0, 0.4, 2], "look_at": [0, 0, 0], "fov": 10}
    scene = scene_of(things, materials, camera)
    naive, nee = (
        rendered(scene, context, 8192, method=method, seed=seed, bounces=1)
        for seed, method in enumerate(("naive", "nee"))
    )
    assert_agree(nee, naive, 0.03)


@pytest.mark.slow
@pytest.mark.slow_cases("blinn")
@pytest.mark.parametrize("method", ["phong", "blinn"])
def test_models_take_what_is_reflected_head_on(context: Context, method: str) -> None:
    """They use it in their highlights and for the sky, where they have no angle."""
    color = list(PRESETS["copper"].head_on)
    ways: tuple[dict[str, Any], ...] = ({"preset": "copper"}, {"color": color})
    things = [plane([0, 0, 0], [0, 1, 0], "plate"), sphere([0, 2, 0], 0.5, "lamp")]
    camera = {"position": [0, 2, 4], "look_at": [0, 0.5, 0], "fov": 50}
    first, second = (
        rendered(
            scene_of(
                things, {"plate": {"type": "metal", "roughness": 0.4, **way}, "lamp": lamp(3.0)},
                camera, background={"color": [0.5] * 3},
            ),
            context, 16, method=method,
        )
        for way in ways
    )  # fmt: skip
    assert_allclose(first.radiance, second.radiance, rtol=1e-5)


def test_albedo_is_what_is_reflected_head_on(context: Context) -> None:
    balls = [sphere([-1, 0, -4], 0.9, "gold"), sphere([1, 0, -4], 0.9, "plain")]
    materials: dict[str, dict[str, Any]] = {
        "gold": {"type": "metal", "preset": "gold"},
        "plain": {"type": "metal", "color": list(PRESETS["gold"].head_on)},
        "floor": MATTE,
    }
    scene = scene_of(balls, materials, background={"color": [1.0] * 3})
    albedo = rendered(scene, context, 16, aov=("albedo",)).aovs["albedo"].value
    gold, plain = albedo[:, :8].max(axis=(0, 1)), albedo[:, 8:].max(axis=(0, 1))
    assert_allclose(gold, PRESETS["gold"].head_on, atol=1e-6)
    assert_allclose(gold, plain, atol=1e-6)


def test_two_metals_are_distinguished(context: Context) -> None:
    """Each in a room of its own colour, which a metal of a color shares."""
    silver = PRESETS["silver"]
    balls = [sphere([0, 0, -0.5], 0.1, "b"), sphere([0.3, 0, 0], 0.1, "c")]
    rooms = [
        rendered(
            scene_of(
                [*room_of_planes("a"), *balls],
                {
                    "a": {"type": "metal", "color": [0.5] * 3, "emission": [1.0] * 3},
                    "b": {"type": "metal", **first},
                    "c": {"type": "metal", **second},
                },
            ),
            context, 16, bounces=3,
        )
        for first, second in (
            ({"preset": "gold"}, {"preset": "silver"}),
            ({"preset": "gold"}, {"ior": list(silver.ior), "k": list(silver.k)}),
            ({"preset": "gold"}, {"preset": "gold"}),
        )
    ]  # fmt: skip
    assert same(rooms[0], rooms[1])
    assert not same(rooms[0], rooms[2])
