"""The gallery: every scene that comes with glrt, as pictures and a page of them."""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from bench.contact_sheet import check_sheet, save_sheet
from glrt.core import files
from glrt.core.errors import GlrtError, RenderError, UsageError
from glrt.core.text import unknown
from glrt.core.version import VERSION
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scenefile.catalog import scene_names


@dataclass(frozen=True)
class Picture:
    """A rendered scene with the figures for the page; `size` in pixels."""

    name: str
    title: str
    file: Path
    size: tuple[int, int]
    samples: int
    seconds: float  # of rendering, without opening OpenGL and compilation
    error: float | None
    driver: str

    @property
    def rate(self) -> float:
        """Pixel samples per second."""
        return self.samples * self.size[0] * self.size[1] / max(self.seconds, 1e-9)


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.gallery`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    try:
        _run(parsed)
    except GlrtError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        return _fail("interrupted; the pictures that are done are saved", 130)
    except (OSError, MemoryError) as error:
        return _fail(f"the render failed: {error or 'out of memory'}", RenderError.exit_code)
    return 0


def render_gallery(
    folder: Path, names: Sequence[str], context: Context | None = None, **settings: Any
) -> list[Picture]:
    """Render scenes into FOLDER/NAME.png and write FOLDER/index.html; progress goes to stderr.

    `names` may be files too; `settings` are fields of Settings that replace those of the scenes.
    Raises `UsageError` for a folder that cannot be written or a bad setting, `SceneError` for a
    scene that does not exist.
    """
    files.make_folder(folder, "index.html")
    gl = context or open_context()
    pictures = []
    for number, name in enumerate(names, start=1):
        with _progress(f"[{number}/{len(names)}] {name}: "):
            pictures.append(_render(folder, name, gl, settings))
        print(_figures(pictures[-1]), file=sys.stderr)
    page = _page(pictures)
    files.write_whole(folder / "index.html", lambda path: _write(path, page))
    return pictures


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m bench.gallery",
        description="Render the scenes that come with glrt into a folder, with a page of them.",
    )
    add = parser.add_argument
    add("-o", dest="folder", type=Path, default=Path("gallery"), help="folder (default: gallery)")
    add("--samples", type=int, help="samples of each pixel (default: each scene's own)")
    add("--only", nargs="+", metavar="NAME", help="scenes to render (default: all)")
    add("--sheet", type=Path, metavar="FILE", help="contact sheet to write, .jpg or .png")
    return parser


def _run(arguments: argparse.Namespace) -> None:
    names = _known(arguments.only or scene_names())
    files.make_folder(arguments.folder, "index.html")
    if arguments.sheet:
        check_sheet(arguments.sheet)
    settings = {} if arguments.samples is None else {"samples": arguments.samples}
    pictures = render_gallery(arguments.folder, names, **settings)
    if arguments.sheet:
        save_sheet([picture.file for picture in pictures], arguments.sheet)


def _known(names: Sequence[str]) -> list[str]:
    """The names without repetitions; raises `UsageError` for one that is not of a scene."""
    scenes = scene_names()
    for name in names:
        if name not in scenes:
            raise UsageError(
                f"--only: {unknown('scene', name, scenes, 'Scenes that come with glrt')}"
            )
    return list(dict.fromkeys(names))


def _render(folder: Path, name: str, context: Context, settings: dict[str, Any]) -> Picture:
    scene = load(name)
    renderer = Renderer(scene, context=context, tier="complete", **settings)
    try:
        start = time.perf_counter()
        image = renderer.render().image()
        seconds = time.perf_counter() - start
        size = renderer.size
    finally:
        renderer.release()
    known_as = Path(name).stem
    file = folder / f"{known_as}.png"
    image.save(file)
    title = scene.title or known_as
    driver = context.renderer
    return Picture(known_as, title, file, size, image.samples, seconds, image.error, driver)


@contextmanager
def _progress(text: str) -> Iterator[None]:
    """Begin a line on stderr; end it on an error, so that the message has a line of its own."""
    print(text, end="", file=sys.stderr, flush=True)
    try:
        yield
    except BaseException:
        print(file=sys.stderr)
        raise


def _figures(picture: Picture) -> str:
    """Size, samples, time, speed and error in one line."""
    width, height = picture.size
    error = "" if picture.error is None else f", estimated error {100 * picture.error:.2g} %"
    return (
        f"{width} x {height}, {picture.samples} samples in {picture.seconds:.1f} s "
        f"({picture.rate / 1e6:.2f} million samples/s){error}"
    )


def _fail(message: str, code: int) -> int:
    print(f"glrt: {' '.join(message.split())}", file=sys.stderr)
    return code


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


# --- the page ------------------------------------------------------------------------------

_HEAD = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>glrt: gallery</title>
<style>
:root { color-scheme: light dark;
  --ink: #1d1d20; --dim: #5c5c66; --page: #fcfcfd; --chip: #ececf0; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e6ea; --dim: #a2a2ad; --page: #18181b; --chip: #2a2a2f; }
}
body { max-width: 80rem; margin: 0 auto; padding: 2rem 1.25rem;
  font: 1rem/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); }
h1 { margin: 0 0 1.5rem; font-size: 1.5rem; }
main { display: grid; gap: 2.5rem 2rem; align-items: start;
  grid-template-columns: repeat(auto-fill, minmax(min(23rem, 100%), 1fr)); }
figure, figcaption p { margin: 0; }
figcaption { margin-top: .6rem; }
img { display: block; width: 100%; height: auto; border-radius: 4px; }
small, footer { color: var(--dim); font-size: .85rem; }
code { font: .85rem ui-monospace, monospace; padding: .1rem .35rem; border-radius: 3px;
  background: var(--chip); }
footer { margin-top: 3rem; }
</style>
<h1>Scenes of glrt</h1>
<main>
"""


def _page(pictures: Sequence[Picture]) -> str:
    """The gallery as one HTML file next to its pictures."""
    drivers = ", ".join(dict.fromkeys(picture.driver for picture in pictures))
    foot = f"</main>\n<footer>Rendered by glrt {VERSION} on {escape(drivers)}.</footer>\n</html>\n"
    return _HEAD + "".join(map(_figure, pictures)) + foot


def _figure(picture: Picture) -> str:
    name, title = escape(picture.name), escape(picture.title)
    width, height = picture.size
    return f"""\
<figure id="{name}">
<a href="{name}.png"><img src="{name}.png" width="{width}" height="{height}" alt="{title}"></a>
<figcaption>
<p>{title}</p>
<p><small>{_figures(picture)}</small></p>
<p><code>glrt render {name} -o {name}.png</code></p>
</figcaption>
</figure>
"""


if __name__ == "__main__":
    sys.exit(main())
