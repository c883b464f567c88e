"""Simulate the smoke of scenes/smoke.toml and of scenes/methods/smoky.toml.

`python tools/plume.py` writes models/smoke.npy next to both.

Warm smoke rises from a bowl, in air that cannot be compressed (Stam, "Stable Fluids", SIGGRAPH
1999), with vorticity confinement (Fedkiw, Stam and Jensen, "Visual Simulation of Smoke", SIGGRAPH
2001). Lengths are voxels, and times are steps. Space is periodic, so that the pressure is solved
exactly by Fourier transforms.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]

SHAPE = (80, 40, 40)  # voxels upwards, and across
STEPS = 150
BUOYANCY = 0.075  # speed that smoke of density 1 gains in a step
SWIRL = 0.22  # share of the vorticity lost to interpolation that is added again
SOURCE = 0.22  # density that the bowl adds in a step
FADE = 0.997  # share of the density that a step leaves
TOO_THIN = 0.01  # densities that are left out
SCENES = Path(__file__).resolve().parent.parent / "scenes"
FILES = {  # shapes, and where the grids are written
    SHAPE: SCENES / "models" / "smoke.npy",
    (40, 20, 20): SCENES / "methods" / "models" / "smoke.npy",
}


def plume(shape: tuple[int, int, int] = SHAPE, steps: int = STEPS, seed: int = 3) -> Array:
    """Return the density of a plume, (y, z, x)."""
    draw = np.random.default_rng(seed)
    places = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij")).astype(np.float32)
    waves = _waves(shape)
    speed: Array = np.zeros((3, *shape), np.float32)
    density: Array = np.zeros(shape, np.float32)
    aside = np.hypot(places[1] - shape[1] / 2, places[2] - shape[2] / 2) / (0.11 * shape[2])
    source = np.exp(-(aside**2) - ((places[0] - 5) / 3) ** 2).astype(np.float32)
    for _ in range(steps):
        origin = places - speed
        density = np.minimum(FADE * _at(density, origin), np.float32(1.6))
        speed = np.stack([_at(part, origin) for part in speed])
        density += np.float32(SOURCE * (0.8 + 0.4 * draw.random())) * source
        speed[0] += BUOYANCY * density
        speed[1:] += 0.02 * draw.standard_normal((2, 1, 1, 1)).astype(np.float32) * source
        speed = _without_divergence(speed + SWIRL * _swirl(speed), waves)
        speed[:, -10:] *= 0.9  # calms below the ceiling, and at the floor
        speed[:, :2] *= 0.5
        density[-3:], density[:1] = 0, 0
    return np.where(density < TOO_THIN, np.float32(0), density)


def _at(values: Array, places: Array) -> Array:
    """Return values between voxels, interpolated linearly."""
    corner = np.floor(places).astype(np.int32)
    beyond = places - corner
    found: Array = np.zeros_like(values)
    for offset in np.ndindex(2, 2, 2):
        index = [(corner[k] + offset[k]) % values.shape[k] for k in range(3)]
        parts = [beyond[k] if offset[k] else 1 - beyond[k] for k in range(3)]
        found += parts[0] * parts[1] * parts[2] * values[tuple(index)]
    return found


def _swirl(speed: Array) -> Array:
    """Return the push that keeps vortices turning."""
    slope = [np.gradient(part) for part in speed]
    curl = np.stack(
        [slope[2][1] - slope[1][2], slope[0][2] - slope[2][0], slope[1][0] - slope[0][1]]
    )
    rise = np.stack(np.gradient(np.linalg.norm(curl, axis=0)))
    rise /= np.linalg.norm(rise, axis=0) + 1e-5
    return np.cross(rise, curl, axis=0).astype(np.float32)


def _waves(shape: tuple[int, int, int]) -> NDArray[np.float64]:
    """Return wave numbers of the real Fourier transform, (3, ...)."""
    each = [np.fft.fftfreq(shape[0]), np.fft.fftfreq(shape[1]), np.fft.rfftfreq(shape[2])]
    return 2 * np.pi * np.stack(np.meshgrid(*each, indexing="ij"))


def _without_divergence(speed: Array, waves: NDArray[np.float64]) -> Array:
    parts = np.stack([np.fft.rfftn(part) for part in speed])
    square = (waves**2).sum(axis=0)
    square[0, 0, 0] = 1
    parts -= waves * ((waves * parts).sum(axis=0) / square)
    shape = speed.shape[1:]
    return np.stack([np.fft.irfftn(part, shape, axes=(0, 1, 2)) for part in parts]).astype(
        np.float32
    )


if __name__ == "__main__":
    for shape, file in FILES.items():
        steps = STEPS * shape[0] // SHAPE[0]
        np.save(file, plume(shape, steps).transpose(1, 0, 2).astype(np.float16))  # (z, y, x)
        print(f"Wrote {file}")
