"""The scene `gloss` under a studio map: `python -m bench.studio -o studio.png`.

The map, like `--map` sunset or city, is one of Blender's (CC0), read from Debian's package
blender-data, which apt downloads (31 MB) and nothing installs.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from bench.program import exit_code_of, parser_of
from glrt.core.errors import UsageError
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

PACKAGE = "blender-data"
MAPS = "./usr/share/blender/datafiles/studiolights/world"
NAMES = ("city", "courtyard", "forest", "interior", "night", "studio", "sunrise", "sunset")


def main(arguments: list[str] | None = None) -> int:
    """Render a picture; returns the exit code."""
    parser = parser_of("studio", __doc__)
    parser.add_argument(
        "-o", dest="picture", default="studio.png", metavar="FILE", help="a picture"
    )
    parser.add_argument("--map", choices=NAMES, default="studio", help="default: studio")
    parser.add_argument("--samples", type=int, default=256, metavar="N", help="default: 256")
    given = parser.parse_args(arguments)

    def render() -> None:
        with tempfile.TemporaryDirectory() as folder:
            fetch(given.map, Path(folder))
            scene = under(Path(folder), given.map)
            renderer = Renderer(scene, samples=given.samples)
            renderer.render().image().save(given.picture)
            renderer.release()
        print(f"Wrote {given.picture}")

    return exit_code_of(render)


def fetch(name: str, folder: Path) -> None:
    """The file NAME.exr in a folder. Raises UsageError where apt has no such package."""
    try:
        subprocess.run(
            ["apt-get", "download", PACKAGE], cwd=folder, check=True, capture_output=True
        )
        (package,) = folder.glob("*.deb")
        content = subprocess.run(
            ["dpkg-deb", "--fsys-tarfile", str(package)], check=True, capture_output=True
        ).stdout
        picked = ["tar", "-x", "--strip-components=7", "-C", str(folder), f"{MAPS}/{name}.exr"]
        subprocess.run(picked, input=content, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError, ValueError) as error:
        raise UsageError(f"Debian's package {PACKAGE} could not be read by apt: {error}") from None


def under(folder: Path, name: str) -> Scene:
    """The balls of `gloss` and their floor in the light of a map alone."""
    scene = load("gloss")
    objects = [thing for thing in scene.objects if not scene.materials[thing.material].emits]
    used = {thing.material for thing in objects}
    return Scene.build(
        scene.camera,
        objects,
        materials={key: value for key, value in scene.materials.items() if key in used},
        background={"image": f"{name}.exr"},
        render=scene.render,
        folder=folder,
    )


if __name__ == "__main__":
    sys.exit(main())
