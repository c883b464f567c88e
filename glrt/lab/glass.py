"""Glass: an index near 1, a lamp inside glass, the caustic of a small lamp."""

import math
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from glrt.error.estimate import relative_error
from glrt.image.image import Image
from glrt.lab.noisy_scenes import CASES, room
from glrt.lab.noisy_scenes import Case as NoisyCase
from glrt.lab.scenes import glass, lamp, matte, scene_of, sphere
from glrt.lab.sweep import SIGMAS, Array, Lab, Sweep, mean_of
from glrt.scene.scene import Scene

TEXTBOOK = """
float textbook(float cos_i, float eta) {
    float sin2_t = eta * eta * (1.0 - cos_i * cos_i);
    if (sin2_t >= 1.0) return 1.0;
    float cos_t = sqrt(1.0 - sin2_t);
    float rs = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    float rp = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5 * (rs * rs + rp * rp);
}"""


def ior(lab: Lab) -> Sweep:
    """Error of the reflectance of glass with an index near 1, at angles down to 0.006 degrees."""
    x = np.logspace(-6, 0, 25)
    rows = lab.count(1 << 14)
    random = np.random.default_rng(8)
    cosine = (10 ** random.uniform(-4, 0, (len(x), rows))).astype(np.float32).ravel()
    eta = np.repeat(1 / (1 + x), rows).astype(np.float32)
    truth = fresnel(cosine.astype(np.float64), eta.astype(np.float64))
    given = {"cosine": cosine, "eta": eta}
    found = [
        lab.path(f"{formula}(cosine, eta)", given, functions=TEXTBOOK)
        for formula in ("fresnel", "textbook")
    ]
    ours, naive = (np.abs(f - truth).reshape(len(x), -1).max(axis=1).tolist() for f in found)
    return Sweep(
        parameter="index of refraction - 1",
        measure="error of the reflectance (largest)",
        x=x.tolist(),
        chosen=("glrt: (1 - η)(1 + η) + η² cos²", ours),
        others={"textbook: 1 - η² (1 - cos²)": naive},
        promise="at most 1e-5",
        bound=[1e-5] * len(x),
    )


def fresnel(cos_i: Array, eta: Array) -> Array:
    """Unpolarised Fresnel reflectance; `eta` is the index of the incident side over the other."""
    cos2 = (1 - eta) * (1 + eta) + eta * eta * cos_i * cos_i
    cos_t = np.sqrt(np.maximum(cos2, 0))
    rs = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    rp = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    reflectance: Array = np.where(cos2 > 0, 0.5 * (rs * rs + rp * rp), 1.0)
    return reflectance


INDEX, BALL = 1.5, 0.5  # index and radius of the glass; lengths are in radii of the room
WALL = 0.5  # albedo of the room
SIDE = 32  # of a picture, in pixels
MOST_NOISE = 6.0  # of a sample with 8 particles from a lamp in glass, in units of the mean


def bulb(lab: Lab) -> Sweep:
    """Noise of a lamp inside a glass sphere, which light sampling cannot aim through.

    Particles leave the lamp itself, and need not find it.
    """
    x = [0.01, 0.02, 0.04, 0.08, 0.16, 0.32]
    samples = lab.count(1024, 128)
    particles = {"caustics": "on", "particles": 8.0, "linked": 0.0}
    kinds: list[tuple[str, bool, dict[str, Any]]] = [
        ("mis, particles", True, {"method": "mis", **particles}),
        ("mis", True, {"method": "mis"}),
        ("naive", True, {"method": "naive"}),
        ("mis", False, {"method": "mis"}),
    ]
    noise: dict[str, list[float]] = {}
    wrong = []
    size: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 2}
    for (name, in_glass, way), radius in product(kinds, x):
        mean, stderr = mean_of(lab.render(bulb_room(radius, in_glass), samples, **size, **way))
        truth, paths = bulb_light(radius, in_glass), samples * SIDE**2
        top = WALL / INDEX**2 if in_glass else WALL
        is_rare = in_glass and "caustics" not in way
        by_chance = math.sqrt(truth * (top - truth) / paths) if is_rare else stderr
        if not abs(mean - truth) <= SIGMAS * by_chance:
            wrong.append(radius)
        found = noise.setdefault(f"{name}, {'lamp in glass' if in_glass else 'bare lamp'}", [])
        found.append(stderr * math.sqrt(paths) / truth)
    first, *others = noise.items()
    return Sweep(
        parameter="radius of the lamp, in radii of the room",
        measure="relative noise of one sample",
        x=x,
        chosen=first,
        others=dict(others),
        promise=f"at most {MOST_NOISE:g} times the mean, at any size of the lamp, and the mean "
        "within 5.3 standard errors of the closed form",
        bound=[MOST_NOISE] * len(x),
        wrong=sorted(set(wrong)),
    )


def bulb_room(radius: float, in_glass: bool) -> Scene:
    """Return a spherical room with the lamp at its centre; the camera looks at the wall."""
    shapes = [sphere([0, 0, 0], 1, "wall"), sphere([0, 0, 0], radius, "lamp")]
    if in_glass:
        shapes.append(sphere([0, 0, 0], BALL, "glass"))
    materials = {"wall": matte(WALL), "lamp": lamp(1), "glass": glass(INDEX)}
    if not in_glass:
        del materials["glass"]
    return scene_of(shapes, materials, {"position": [0, 0, 0.8], "look_at": [0, 0, 1], "fov": 60})


def bulb_light(radius: float, in_glass: bool) -> float:
    """Radiance of the wall with 2 bounces in closed form; with glass, one of them is a refraction.

    With albedo a, lamp radius r, index n and transmittance T: a ray with impact parameter b hits
    the lamp in glass if b < n r, and its radiance is T(b) / n^2. Integrated over directions that is
    2 a / n^2 times the integral of b T(b) from 0 to n r. Without glass: a r^2 (1 + a (1 - r^2)).
    """
    if not in_glass:
        return WALL * radius**2 * (1 + WALL * (1 - radius**2))
    nodes, weights = np.polynomial.legendre.leggauss(64)
    beside = INDEX * radius * (nodes + 1) / 2
    cosine = np.sqrt(1 - (beside / BALL) ** 2)
    passed = 1 - fresnel(cosine, np.full_like(cosine, 1 / INDEX))
    integral = INDEX * radius / 2 * float(weights @ (beside * passed))
    return 2 * WALL / INDEX**2 * integral


METHODS = ("mis", "nee", "naive")


def caustic(lab: Lab) -> Sweep:
    """Error of a caustic against a render of many samples, by number of samples."""
    x = [4**power for power in range(1, 7) if 4**power <= lab.count(4096, 256)]
    scene = CASES["caustic"].scene
    size: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": CASES["caustic"].bounces}
    reference = lab.render(scene, 4 * x[-1], method="mis", seed=1, **size)
    ways: dict[str, dict[str, Any]] = {method: {"method": method} for method in METHODS}
    ways["mis, particles"] = {"method": "mis", "caustics": "on", "linked": 0.0}
    errors: dict[str, list[float]] = {name: [] for name in ways}
    estimates, wrong = [], []
    for (method, way), found in zip(ways.items(), errors.values(), strict=True):
        with lab.rendering(scene, **way, **size) as renderer:
            for samples in x:
                image = renderer.render(samples).image()
                difference = image.radiance - reference.radiance
                found.append(relative_error(reference.radiance, difference) or 0.0)
                if method == "mis":
                    estimates.append(image.error or 0.0)
        if not _agree(image, reference):
            wrong.append(x[-1])
    return Sweep(
        parameter="samples per pixel",
        measure="relative RMS error",
        x=x,
        chosen=("mis", errors.pop("mis")),
        others={**errors, "mis, estimated error": estimates},
        promise="the means agree within 5.3 standard errors; no bound for the noise",
        wrong=wrong,
    )


def _agree(a: Image, b: Image) -> bool:
    """Whether the means of two pictures differ by at most SIGMAS standard errors."""
    (mean_a, error_a), (mean_b, error_b) = mean_of(a), mean_of(b)
    return abs(mean_a - mean_b) <= SIGMAS * math.hypot(error_a, error_b)


def fireflies(lab: Lab) -> Sweep:
    """Share of the light of a caustic in its brightest samples, by their number."""
    x = np.logspace(-5, 0, 16)
    kinds = {
        "mis, glass sphere": CASES["caustic"],
        "naive, glass sphere": replace(CASES["caustic"], method="naive"),
        "mis, matte sphere": replace(CASES["caustic"], scene=_without_glass()),
    }
    shares: dict[str, list[float]] = {}
    means = []
    for name, case in kinds.items():
        light = _samples(lab, case)
        means.append((light.mean(), light.std() / math.sqrt(len(light))))
        energy = np.cumsum(np.sort(light)[::-1]) / light.sum()
        places = np.maximum(np.rint(x * len(light)).astype(int), 1) - 1
        shares[name] = energy[places].tolist()
    (mis, mis_error), (naive, naive_error), _ = means
    is_wrong = not abs(mis - naive) <= SIGMAS * math.hypot(mis_error, naive_error)  # NaN is
    first, *others = shares.items()
    return Sweep(
        parameter="brightest samples, as a share of all samples",
        measure="share of the light in them",
        x=x.tolist(),
        chosen=first,
        others=dict(others),
        promise="no clamping: mis and naive agree within 5.3 standard errors",
        wrong=[1.0] if is_wrong else [],
    )


def _samples(lab: Lab, case: NoisyCase) -> Array:
    """The radiance of single samples, averaged over channels: one per pixel and seed.

    All values of a frame are NaN if one of its samples was not finite.
    """
    frames = []
    size: dict[str, Any] = {
        "width": 48,
        "height": 48,
        "bounces": case.bounces,
        "method": case.method,
    }
    with lab.rendering(case.scene, **size) as renderer:
        for seed in range(lab.count(256)):
            renderer.update(seed=seed)
            light = renderer.render(1).image().radiance.mean(axis=-1, dtype=np.float64)
            frames.append(np.full_like(light, np.nan) if renderer.nonfinite() else light)
    return np.concatenate(frames).ravel()


def _without_glass() -> Scene:
    """The scene of the caustic with a matte sphere instead of the glass sphere."""
    return room("red", {"center": [0.9, 2.4, 0.6], "radius": 0.1}, 130.0)
