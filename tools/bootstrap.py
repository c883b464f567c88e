"""Makes what `make render`, `view`, `check`, `test`, `bench` need: `python3 bootstrap.py PURPOSE`.

The system libraries come first, then `.venv` with glrt and its Python packages. A state file in
`.venv` says what was made from what, so that the next call has nothing to do and needs no network.
"""

from __future__ import annotations

import os
import sys

PURPOSES = ("render", "view", "check", "test", "bench")
MINIMUM = (3, 11)
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def main(arguments: list[str]) -> None:
    """Make what one purpose needs, or find that it is there."""
    if len(arguments) != 1 or arguments[0] not in PURPOSES:
        sys.exit(f"usage: bootstrap.py {'|'.join(PURPOSES)}")
    if sys.version_info < MINIMUM:
        sys.exit(_too_old())
    _provide(arguments[0], strict=bool(os.environ.get("CI")))


def _provide(purpose: str, strict: bool) -> None:
    import environment

    if environment.is_ready(ROOT, purpose, strict):
        return
    import system  # loads ctypes, which a set-up that is ready can do without

    with environment.locked(ROOT):
        if not environment.is_ready(ROOT, purpose, strict):
            environment.make(ROOT, purpose, system.provide(purpose, strict))


def _too_old() -> str:
    import shutil

    newer = [name for name in (f"python3.{n}" for n in range(14, 10, -1)) if shutil.which(name)]
    advice = f"type `make PYTHON={newer[0]} ...`" if newer else "install one"
    version = "{}.{}".format(*sys.version_info)
    return f"glrt needs Python 3.11 or newer; {sys.executable} is Python {version}: {advice}."


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except KeyboardInterrupt:
        print("\nInterrupted: the same command goes on from here.", file=sys.stderr)
        sys.exit(130)
    except OSError as error:
        sys.exit(
            f"The set-up stopped at {error.filename}: {error.strerror}. It writes to .venv, which "
            "must be yours: if another user made it, remove it and try again."
        )
