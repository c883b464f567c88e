"""Pictures of models that packages carry: `python -m bench.real_models -o gallery/models`.

They are downloaded by `npm pack` (108 MB) and nothing is installed: the Stanford bunny, Blender's
Suzanne and a logo of @pmndrs/assets (CC0), and three textured controllers of
@webxr-input-profiles/assets (MIT, Amazon). Needs DracoPy, which the tests need too.
"""

import base64
import re
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bench.gallery import render_gallery
from bench.program import exit_code_of, parser_of
from glrt.core.errors import UsageError
from glrt.scene.schema.tables import toml_lines

Table = dict[str, Any]

POLYGONS, CONTROLLERS = "@pmndrs/assets@1.7.0", "@webxr-input-profiles/assets@1.0.20"
MODELS: Mapping[str, tuple[str, str]] = {  # package and path there, by the name in the scenes
    "bunny.glb": (POLYGONS, "models/bunny.glb.js"),
    "suzanne.glb": (POLYGONS, "models/suzi.glb.js"),
    "logo.glb": (POLYGONS, "models/pmndrs.glb.js"),
    "hp.glb": (CONTROLLERS, "dist/profiles/hp-mixed-reality/left.glb"),
    "cosmos.glb": (CONTROLLERS, "dist/profiles/htc-vive-cosmos/left.glb"),
    "galaxy.glb": (CONTROLLERS, "dist/profiles/samsung-galaxyxr/left.glb"),
}
_DATA = re.compile(rb"base64,([A-Za-z0-9+/=]+)")


def main(arguments: list[str] | None = None) -> int:
    """Download, render and write pictures with a page of them; returns the exit code."""
    parser = parser_of("real_models", __doc__)
    add = parser.add_argument
    add("-o", dest="folder", type=Path, default=Path("gallery/models"), help="folder of pictures")
    add("--only", nargs="+", choices=list(SCENES), metavar="NAME", help="default: all scenes")
    add("--samples", type=int, default=256, metavar="N", help="default: 256")
    given = parser.parse_args(arguments)

    def render() -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            fetch(folder)
            scenes = [write(folder, scene) for scene in given.only or SCENES]
            render_gallery(given.folder, scenes, samples=given.samples)
        print(f"Wrote {given.folder}/index.html")

    return exit_code_of(render)


def fetch(folder: Path) -> None:
    """The models in a folder. Raises UsageError where npm does not give them."""
    for package in (POLYGONS, CONTROLLERS):
        try:
            packed = subprocess.run(
                ["npm", "pack", "--silent", package],
                cwd=folder,
                check=True,
                capture_output=True,
                text=True,
            )
        except (OSError, subprocess.CalledProcessError) as error:
            raise UsageError(f"npm could not download {package}: {error}") from None
        archive = folder / packed.stdout.split()[-1]
        with tarfile.open(archive) as content:
            for name, (owner, path) in MODELS.items():
                if owner == package:
                    _extract(content, f"package/{path}", folder / name)
        archive.unlink()


def _extract(content: tarfile.TarFile, path: str, file: Path) -> None:
    """A model, which stands in base64 in some files."""
    try:
        member = content.extractfile(path)
    except KeyError:
        member = None
    if member is None:
        raise UsageError(f"the package has no file {path}.")
    found = member.read()
    if path.endswith(".js"):
        match = _DATA.search(found)
        found = base64.b64decode(match[1]) if match else b""
    file.write_bytes(found)


def write(folder: Path, name: str) -> str:
    """The scene file of a scene, beside the models."""
    file = folder / f"{name}.toml"
    file.write_text("\n".join(toml_lines(SCENES[name])), encoding="utf-8")
    return str(file)


def thing(file: str, place: Any, scale: float, turn: Any = (0, 0, 0), **more: Any) -> Table:
    """A model; without `material` it has its own."""
    rest = {"translate": list(place), "scale": scale, "rotate": list(turn)}
    return {"shape": "mesh", "file": file, **rest, **more}


def matte(*color: float) -> Table:
    """A matte material."""
    return {"type": "lambertian", "color": list(color)}


FLOOR = {"shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "material": "floor"}
LAMP = {
    "shape": "quad",
    "corner": [-2.5, 3.0, 0.5],
    "edge_u": [2.0, 0.0, 0.0],
    "edge_v": [0.0, 1.0, 1.5],
    "material": "lamp",
}
SKY = {"bottom": [0.2, 0.2, 0.2], "horizon": [0.45, 0.45, 0.45], "top": [0.75, 0.8, 0.9]}
MATERIALS: Table = {
    "floor": matte(0.6, 0.58, 0.55),
    "clay": matte(0.72, 0.42, 0.3),
    "white": matte(0.75, 0.75, 0.75),
    "red": matte(0.65, 0.08, 0.06),
    "green": matte(0.12, 0.5, 0.15),
    "blue": matte(0.1, 0.2, 0.6),
    "glass": {"type": "dielectric", "ior": 1.5},
    "gold": {"type": "metal", "preset": "gold", "roughness": 0.25},
    "steel": {"type": "metal", "color": [0.6, 0.6, 0.62], "roughness": 0.15},
    "plastic": {"type": "principled", "color": [0.1, 0.35, 0.6], "roughness": 0.2},
    "lamp": {"type": "light", "emission": [12.0, 11.0, 10.0]},
    "ceiling lamp": {"type": "light", "emission": [14.0, 13.0, 11.5]},
}
_ORDER = ("clay", "gold", "plastic", "white", "steel", "red", "blue", "green")


def _scene(title: str, camera: Table, objects: list[Table], **more: Any) -> Table:
    used = {each.get("material") for each in objects}
    materials = {name: table for name, table in MATERIALS.items() if name in used}
    render = {"width": 640, "height": 480}
    return {
        "title": title,
        "render": render,
        "camera": camera,
        **more,
        "materials": materials,
        "objects": objects,
    }


def _wall(corner: Any, u: Any, v: Any, material: str) -> Table:
    edges = {"corner": list(corner), "edge_u": list(u), "edge_v": list(v)}
    return {"shape": "quad", **edges, "material": material}


def _clutter() -> Table:
    """A closed room: 102,432 triangles, and the quads of its walls."""
    walls = [
        _wall((-2, 0, -3), (4, 0, 0), (0, 0, 6), "floor"),
        _wall((-2, 3, -3), (4, 0, 0), (0, 0, 6), "white"),
        _wall((-2, 0, -3), (4, 0, 0), (0, 3, 0), "white"),
        _wall((-2, 0, 3), (4, 0, 0), (0, 3, 0), "white"),
        _wall((-2, 0, -3), (0, 0, 6), (0, 3, 0), "red"),
        _wall((2, 0, -3), (0, 0, 6), (0, 3, 0), "green"),
        _wall((-0.6, 2.98, -1.6), (1.2, 0, 0), (0, 0, 1.2), "ceiling lamp"),
    ]
    bunnies = [
        thing(
            "bunny.glb",
            (-1.5 + 0.95 * (k % 4), 0.31, -2.3 + 1.25 * (k // 4)),
            0.35,
            (0, 40 * k, 0),
            material=_ORDER[k],
        )
        for k in range(8)
    ]
    others = [
        thing("suzanne.glb", (-0.75, 1.35, -2.2), 0.55, (-20, 15, 0), material="clay"),
        thing("suzanne.glb", (0.95, 1.45, -1.9), 0.5, (-15, -25, 10), material="gold"),
        thing("hp.glb", (-0.95, 0.45, 0.35), 5, (0, 160, 0)),
        thing("cosmos.glb", (0.95, 0.35, 0.3), 5, (0, 200, 0)),
        thing("logo.glb", (0.05, 0.36, 0.2), 0.1, (0, 25, 0)),
        thing("logo.glb", (1.6, 2.4, -2.4), 0.12, (0, -40, 20)),
    ]
    camera = {"position": [0.0, 1.5, 2.9], "look_at": [0.0, 0.95, -1.5], "fov": 52.0}
    return _scene("A room of 102,432 triangles", camera, [*walls, *bunnies, *others])


SCENES: Mapping[str, Table] = {
    "controllers": _scene(
        "Three textured controllers",
        {"position": [0.0, 1.5, 3.6], "look_at": [0.0, 0.5, 0.0], "fov": 36.0},
        [
            FLOOR,
            LAMP,
            thing("hp.glb", (-0.88, 0.6, 0.0), 6.0, (20, 150, 0)),
            thing("cosmos.glb", (0.0, 0.4, 0.2), 6.5, (20, 190, 0)),
            thing("galaxy.glb", (0.95, 0.4, 0.1), 8.5, (20, 215, 0)),
        ],
        background=SKY,
    ),
    "glass_bunny": _scene(
        "A bunny of glass and one of clay",
        {"position": [0.0, 1.3, 4.2], "look_at": [0.0, 0.75, 0.0], "fov": 34.0},
        [
            FLOOR,
            LAMP,
            thing("bunny.glb", (-0.75, 0.71, 0.0), 0.8, (0, 20, 0), material="glass"),
            thing("bunny.glb", (0.95, 0.71, -0.3), 0.8, (0, -30, 0), material="clay"),
        ],
        background=SKY,
    ),
    "clutter": _clutter(),
}


if __name__ == "__main__":
    sys.exit(main())
