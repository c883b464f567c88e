"""The first surface under simple light: what the shader draws is what numpy makes of the AOVs."""

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.packing.scene_arrays import pack_camera
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.surface_view import NEEDED, SurfaceView
from tests.support.mixed_scene import everything

SIZE = (24, 16)


def test_albedo_is_shaded_by_the_angle_to_the_eye(context: Context) -> None:
    scene = everything()
    renderer = Renderer(scene, None, context, width=SIZE[0], height=SIZE[1], aov=NEEDED)
    renderer.render(16)
    aovs = renderer.image().aovs
    albedo, normal = map(renderer.aov_mean, NEEDED)
    assert albedo
    assert normal
    with context.gl:
        view, target = SurfaceView(context.gl), context.gl.simple_framebuffer(SIZE, 3)
        with context.gl.scope(target):
            view.draw(albedo.texture, normal.texture, scene.camera)
        codes = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        view.release()
        target.release()
    seen = codes.reshape(SIZE[1], SIZE[0], 3)[::-1] / 255
    light = shaded(aovs["albedo"].value, aovs["normal"].value, pack_camera(scene.camera, 1.5))
    met = (aovs["normal"].value != 0).any(axis=2)
    assert met.any()
    assert not met.all()
    assert seen[met] == pytest.approx(light[met], abs=2.5 / 255)
    assert (seen[~met] == seen[~met][0]).all()
    renderer.release()


def shaded(albedo: np.ndarray, normal: np.ndarray, camera: dict[str, object]) -> np.ndarray:
    """The shaded picture as sRGB, (H, W, 3)."""
    x, y = ((np.arange(side) + 0.5) / side * 2 - 1 for side in SIZE)
    right, up, forward = (np.asarray(camera[n], float) for n in ("right", "up", "forward"))
    tan_x, tan_y = (float(str(camera[n])) for n in ("tan_x", "tan_y"))
    direction = forward + x[None, :, None] * tan_x * right - y[:, None, None] * tan_y * up
    direction /= np.linalg.norm(direction, axis=2, keepdims=True)
    facing = np.clip(-(normal * direction).sum(axis=2, keepdims=True), 0, None)
    light = np.clip(albedo * (0.3 + 0.7 * facing), 0, 1)
    bright = 1.055 * light ** (1 / 2.4) - 0.055
    codes: np.ndarray = np.where(light <= 0.0031308, 12.92 * light, bright)
    return codes
