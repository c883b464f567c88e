"""Write docs/reference/ from the program: scene files, commands, Python, what goes with what.

`make reference` runs it; a test compares the files with what it would write.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

# The checkout, whatever version of glrt is installed.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from reference_combinations import combinations_page
from reference_commands import commands
from reference_python import python_api
from reference_scene import scene_file

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "reference"
MAKERS: dict[str, Callable[[], Iterator[str]]] = {
    "scene-file.md": scene_file,
    "commands.md": commands,
    "python-api.md": python_api,
    "combinations.md": combinations_page,
}


def main() -> None:
    """Write all pages."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, text in pages().items():
        (FOLDER / name).write_text(text)
        print(f"wrote {(FOLDER / name).relative_to(ROOT)}")


def pages() -> dict[str, str]:
    """The text of each page by the name of its file."""
    return {name: "\n\n".join(make()) + "\n" for name, make in MAKERS.items()}


if __name__ == "__main__":
    main()
