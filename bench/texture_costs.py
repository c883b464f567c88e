"""What textures cost: a room and a ball of a principled material with images and without, in turns.

Images are of 1024 x 1024 random pixels, whose means are the numbers that they stand for.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from bench.aovs import seconds_in_turns
from bench.program import exit_code_of, machine, parser_of
from bench.ratios import ratio_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.schema.tables import toml_lines
from tests.support.meshes import icosphere

SIZE, SAMPLES, TEXELS = 256, 32, 1024
PLAIN: dict[str, Any] = {"color": [0.5] * 3, "metallic": 0.5, "roughness": 0.5, "ior": 1.5}
IMAGE, FLAT = {"image": "noise.png"}, {"image": "flat.png"}
CHOICES: dict[str, dict[str, Any]] = {
    "color": {"color": {**IMAGE, "channel": "r"}},
    "checker": {"color": {"checker": [0.3, 0.7], "scale": 8.0}},
    "metallic, roughness": {"metallic": IMAGE, "roughness": {**IMAGE, "channel": "g"}},
    "normal": {"normal": FLAT},
    "alpha": {"alpha": {**IMAGE, "channel": "b"}, "alpha_cutoff": 0.02},
    "all": {
        "color": {**IMAGE, "channel": "r"},
        "metallic": IMAGE,
        "roughness": {**IMAGE, "channel": "g"},
        "normal": FLAT,
    },
}


def scenes(folder: Path) -> dict[str, Scene]:
    """The scene with each choice of images, which it writes into a folder, and "" for none."""
    codes = np.random.default_rng(1).integers(0, 256, (TEXELS, TEXELS, 3), np.uint8)
    Image.fromarray(codes).save(folder / "noise.png")
    flat = np.full((TEXELS, TEXELS, 3), (128, 128, 255), np.uint8)
    Image.fromarray(flat).save(folder / "flat.png")
    points, faces = icosphere(4)
    uv = np.stack([np.arctan2(points[:, 0], points[:, 2]), points[:, 1]], axis=1)
    _write_obj(folder / "ball.obj", points, uv, faces)
    found = dict[str, Scene]()
    for name, keys in {"": {}, **CHOICES}.items():
        file = folder / f"{len(found)}.toml"
        file.write_text("\n".join(toml_lines(_room({"type": "principled", **PLAIN, **keys}))))
        found[name] = load(str(file))
    return found


def _write_obj(file: Path, points: Any, uv: Any, faces: Any) -> None:
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points]
    lines += [f"vt {u:.6f} {v:.6f}" for u, v in uv]
    lines += ["f " + " ".join(f"{k}/{k}" for k in face) for face in faces + 1]
    file.write_text("\n".join(lines) + "\n")


def _room(material: dict[str, Any]) -> dict[str, Any]:
    """An open box with a mesh of 5,120 triangles; all but the lamp is of the material."""
    sides = [
        ([-2, -1, -2], [4, 0, 0], [0, 0, 4]),
        ([-2, -1, -2], [4, 0, 0], [0, 3, 0]),
        ([-2, -1, -2], [0, 0, 4], [0, 3, 0]),
        ([2, -1, -2], [0, 0, 4], [0, 3, 0]),
    ]
    walls = [{"shape": "quad", "corner": c, "edge_u": u, "edge_v": v} for c, u, v in sides]
    ball: dict[str, Any] = {"shape": "mesh", "file": "ball.obj"}
    lamp = {"shape": "sphere", "center": [0, 2.6, 0.5], "radius": 0.4, "material": "lamp"}
    return {
        "camera": {"position": [0, 0.6, 5], "look_at": [0, 0.2, 0], "fov": 45},
        "background": {"color": [0.3, 0.3, 0.35]},
        "materials": {"m": material, "lamp": {"type": "light", "emission": [20.0] * 3}},
        "objects": [*({**thing, "material": "m"} for thing in (*walls, ball)), lamp],
    }


def times_of(context: Context, rounds: int) -> dict[str, list[float]]:
    """Seconds of each round of renders with each choice, "" for none."""
    with tempfile.TemporaryDirectory() as folder:
        renderers = {
            name: Renderer(scene, context=context, width=SIZE, height=SIZE, samples=SAMPLES)
            for name, scene in scenes(Path(folder)).items()
        }
    return seconds_in_turns(renderers, rounds)


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.texture_costs`; returns the exit code."""
    parser = parser_of("texture_costs", __doc__)
    parser.add_argument("--rounds", type=int, default=12, help="renders of each choice")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(given.rounds))


def _print(rounds: int) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {SIZE} x {SIZE} pixels, {SAMPLES} samples, `mis`\n")
    times = times_of(context, rounds)
    print("| images | time over that without |\n|---|---|")
    for name in CHOICES:
        print(f"| {name} | {ratio_of(times[name], times[''])} |")


if __name__ == "__main__":
    sys.exit(main())
