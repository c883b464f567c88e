"""The scenes that both glrt and Mitsuba render."""

from pathlib import Path
from typing import Any

import numpy as np

from glrt.scene.files.assets import AssetFolder
from glrt.scene.loading.scene_files import with_files
from glrt.scene.scene import Scene
from tests.support.builders import box, cylinder, disk, glass, lamp, plane, quad, scene_of, sphere
from tests.support.gltf_files import png
from tests.support.meshes import blob, icosphere, mesh, quads
from tests.support.sky_images import random_sky, write_exr

# Each shape and material. One lamp is seen from both sides, and sheared: Mitsuba has rectangles
# only for lamps that are not.
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [0.8, 0.75, 0.7]},
    "glass": glass(1.5),
    "mirror": {"type": "metal", "color": [0.9, 0.7, 0.5]},
    "rough": {"type": "metal", "color": [0.6, 0.8, 0.9], "roughness": 0.5},
    "screen": lamp(4.0, 0.3),
    "bulb": {"type": "light", "emission": [9.0, 6.0, 3.0]},
}
OBJECTS = [
    plane([0, 0, 0], [0, 2, 0], "white"),
    sphere([-1.1, 0.5, 0.2], 0.5, "glass"),
    sphere([0, 0.5, 0.4], 0.5, "rough"),
    sphere([1.1, 0.5, 0.2], 0.5, "mirror"),
    sphere([0.5, 1.5, -0.6], 0.2, "bulb"),
    quad([-1.6, 0.3, -1.0], [1.2, 0.2, 0], [0.2, 1.1, -0.1], "screen"),
]
CAMERA = {"position": [0.3, 1.3, 4.0], "look_at": [0.0, 0.6, 0.0], "defocus_angle": 8.0}
SKY = {"bottom": [0.5, 0.3, 0.1], "top": [0.1, 0.3, 0.6]}

# Shapes that Mitsuba has, too: a cube, a wall without ends, and a disk of one side.
ROUND_LAMP = disk([0.4, 2.2, 0.3], [0.3, 1, 0.2], 0.4, "screen")
GLASS_BOX = box([-1.6, 0.1, -0.3], [-0.6, 1.0, 0.6], "glass", [10, 35, -5])
TUBE = cylinder([0.2, 0.3, 0.6], [0.35, 0.45, 1.3], 0.3, "white", capped=False)
SOLIDS = [
    plane([0, 0, 0], [0, 2, 0], "white"),
    ROUND_LAMP,
    GLASS_BOX,
    TUBE,
    box([-0.3, 0.05, -1.5], [0.6, 1.3, -1.0], "rough", [0, 20, 0]),
    box([1.5, 0.1, 0.6], [1.7, 0.3, 0.8], "bulb"),
    cylinder([0.9, 0.02, 0.1], [0.9, 0.9, 0.1], 0.35, "glass"),
    cylinder([-0.5, 0.3, 1.2], [-0.2, 0.3, 1.3], 0.2, "mirror"),
    cylinder([1.5, 0.1, -0.9], [1.6, 1.0, -0.9], 0.15, "bulb", capped=False),
    disk([-0.9, 1.3, -0.9], [0.4, -0.2, 1], 0.5, "white"),
]


def slanted_room() -> Scene:
    """A lamp between walls that no axis is square to, and the camera before one of them."""
    across, along = np.array([0.73, 0.0, 0.68]), np.array([-0.68, 0.0, 0.73])
    walls = [plane(-3 * side, side, "white") for side in (across, -across, along, -along)]
    floors = [plane([0, 0, 0], [0, 1, 0], "white"), plane([0, 3, 0], [0, -1, 0], "white")]
    objects = [*walls, *floors, sphere([1.5, 1.8, -0.2], 0.05, "bulb")]
    return scene_of(objects, MATERIALS, {"position": [0.3, 1.3, 0.4], "look_at": [3.0, 1.0, 2.8]})


def frosted(roughness: float = 0.6, **pane: Any) -> Scene:
    """A ball and a box of rough glass, a ball with a lamp in it, and a pane before a wall."""
    materials = MATERIALS | {
        "frosted": glass(1.5, roughness=roughness),
        "matt": glass(1.33, roughness=0.3),
        "pane": glass(1.5, thin=True) | pane,
    }
    objects = [
        plane([0, 0, 0], [0, 2, 0], "white"),
        sphere([-1.1, 0.55, 0.2], 0.5, "frosted"),
        box([0.7, 0.1, -0.2], [1.5, 0.9, 0.5], "matt", [0, 30, 0]),
        sphere([0.1, 0.6, 0.5], 0.45, "frosted"),
        sphere([0.1, 0.6, 0.5], 0.2, "bulb"),
        quad([-1.6, 0.9, -1.0], [1.2, 0.2, 0], [0.2, 1.1, -0.1], "screen"),
        quad([-0.3, 0.02, 1.2], [1.5, 0, 0.4], [0, 0.8, 0], "pane"),
    ]
    return scene_of(objects, materials, CAMERA, background=SKY)


def pictured(folder: Path, radiance: float = 200.0, **background: Any) -> Scene:
    """Things under an image of the sky with a small sun, in a file of this folder."""
    pixels = random_sky(32, 16, seed=8)
    pixels[4, 11] = radiance
    write_exr(folder / "sky.exr", pixels)
    things = [item for item in OBJECTS if item["material"] != "bulb"]
    sky = {"image": "sky.exr", "rotation": 20, "color": [0.7, 0.8, 1.0], **background}
    scene = scene_of(things, MATERIALS, CAMERA, background=sky)
    return with_files(scene, AssetFolder(folder), "test")


def sunlit(**sun: Any) -> Scene:
    """Matte and rough things under a clear sky and a sun that is wider than the real one."""
    things = [item for item in OBJECTS if item["material"] in ("white", "rough")]
    things.append(box([-1.2, 0.02, -0.3], [-0.4, 0.9, 0.6], "white", [0, 35, 0]))
    above = {"elevation": 35.0, "azimuth": 120.0, "angle": 4.0, **sun}
    return scene_of(things, MATERIALS, CAMERA, background={"sky": {"scale": 3.0}}, sun=above)


def polished(roughness: float = 0.3) -> Scene:
    """Principled balls of metal: what glTF and Disney's model agree on."""
    metal: dict[str, Any] = {"type": "principled", "metallic": 1.0}
    materials = MATERIALS | {
        "gold": {**metal, "color": [1.0, 0.77, 0.34], "roughness": 0.2},
        "copper": {**metal, "color": [0.95, 0.64, 0.54], "roughness": roughness},
    }
    swapped = {"glass": "gold", "rough": "copper", "mirror": "gold"}
    things = [
        item | {"material": swapped.get(item["material"], item["material"])} for item in OBJECTS
    ]
    return scene_of(things, materials, CAMERA, background=SKY)


def painted(folder: Path, **texture: Any) -> Scene:
    """Meshes under an image, turned and repeated, in a file of this folder."""
    codes = np.random.default_rng(3).integers(0, 256, (5, 7, 3), np.uint8)
    (folder / "paint.png").write_bytes(png(codes))
    image = {"image": "paint.png", "scale": [2.0, 1.5], "rotation": 20, "offset": [0.1, 0.3]}
    materials = MATERIALS | {"paint": {"type": "lambertian", "color": {**image, **texture}}}
    points, faces = blob(3)
    ball = mesh((points, faces), "paint", uv=points[:, :2], scale=0.6, translate=[0, 0.7, 0.3])
    wall = quads([[-1.8, 0.1, -1], [3.6, 0, 0], [0, 1.8, 0]])
    back = mesh(wall, "paint", uv=wall[0][:, :2] / 2, smooth=False)
    floor = plane([0, 0, 0], [0, 2, 0], "white")
    scene = scene_of([floor, ball, back], materials, CAMERA, background=SKY)
    return with_files(scene, AssetFolder(folder), "test")


def solids(*objects: dict[str, Any]) -> Scene:
    """Disks, boxes and cylinders of several materials."""
    return scene_of(list(objects) or SOLIDS, MATERIALS, CAMERA, background=SKY)


def solids_but(old: dict[str, Any], **changes: Any) -> Scene:
    """The solids with one of them changed."""
    return solids(*(item | changes if item is old else item for item in SOLIDS))


def everything(roughness: float = 0.5, **camera: Any) -> Scene:
    """All of the above, with another roughness or camera."""
    rough = MATERIALS["rough"] | {"roughness": roughness}
    return scene_of(OBJECTS, MATERIALS | {"rough": rough}, CAMERA | camera, background=SKY)


def meshes() -> Scene:
    """A matte ball with facets, a metal one without, a glass one, and a lamp of triangles."""
    fine, coarse = blob(3), icosphere(1)
    return scene_of(
        [
            plane([0, 0, 0], [0, 2, 0], "white"),
            mesh(blob(2), "white", scale=0.5, translate=[0, 0.6, 0.4], smooth=False),
            mesh(
                fine, "rough", scale=[0.5, 0.6, 0.4], translate=[1.1, 0.7, 0.2], rotate=[0, 30, 0]
            ),
            mesh(coarse, "glass", scale=0.5, translate=[-1.1, 0.55, 0.2], smooth=False),
            mesh(coarse, "bulb", scale=[-0.2, 0.3, 0.2], translate=[0.5, 1.5, -0.6], smooth=False),
        ],
        MATERIALS,
        CAMERA,
        background=SKY,
    )


FRONT = {"emission_side": "front"}


def glowing(**changes: Any) -> Scene:
    """Metal and matte balls that emit, lamps of one side, and a ball that is hidden."""
    materials = {
        "iron": MATERIALS["rough"] | {"emission": [0.9, 0.3, 0.1]},
        "moss": MATERIALS["white"] | {"emission": [0.1, 0.4, 0.2]},
    }
    panel = quad([-1.6, 0.3, -1.0], [1.2, 0, 0], [0, 1.1, 0], "screen") | {"group": "panel"}
    sail = quads(
        [[1.2, 0.2, -1], [0.1, 0, 0.6], [0.2, 0.8, 0]], [[1.5, 1.2, -1], [0, 0, 0.5], [0.4, 0, 0]]
    )
    objects = [
        plane([0, 0, 0], [0, 2, 0], "white"),
        sphere([-0.6, 0.5, 0.6], 0.5, "iron"),
        sphere([0.6, 0.4, 0.6], 0.4, "moss"),
        sphere([0, 0.5, 1.6], 0.6, "mirror") | {"hidden": True},
        panel | FRONT | changes,
        disk([0.4, 2.2, 0.3], [0.3, -1, 0.2], 0.4, "bulb") | FRONT,
        mesh(sail, "bulb", smooth=False) | FRONT,
    ]
    return scene_of(
        objects, MATERIALS | materials, CAMERA, background=SKY, lights={"panel": 0.5, "iron": 2.0}
    )


def measured(preset: str = "gold") -> Scene:
    """A smooth and two rough metals by their index of refraction, under a sky."""
    materials: dict[str, dict[str, Any]] = {
        "mirror": {"type": "metal", "preset": preset},
        "rough": {"type": "metal", "preset": "copper", "roughness": 0.5},
        "alloy": {"type": "metal", "ior": [2.0, 0.5, 1.2], "k": [1.5, 3, 0.2], "roughness": 0.7},
    }
    objects = [
        plane([0, 0, 0], [0, 2, 0], "white"),
        sphere([-1.1, 0.5, 0.2], 0.5, "mirror"),
        sphere([0, 0.5, 0.4], 0.5, "rough"),
        sphere([1.1, 0.5, 0.2], 0.5, "alloy"),
        quad([-1.6, 0.3, -1.0], [1.2, 0.2, 0], [0.2, 1.1, -0.1], "screen"),
    ]
    return scene_of(objects, MATERIALS | materials, CAMERA, background=SKY)
