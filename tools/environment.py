"""The Python environment `.venv`: made, brought up to date, or found to be ready.

Its state file is there from the first moment and says `unfinished` while something changes, so
that an interrupted environment is made again. An environment without a state file was made by hand:
it is taken over if it works.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import steps

State = dict[str, Any]
UNFINISHED: State = {"unfinished": True}
STATE_FILE = "glrt-setup.json"
EXTRAS = {
    "bench": "[dev,mitsuba,jupyter]",
    "check": "[dev]",
    "render": "",
    "test": "[dev]",
    "view": "[view]",
}
BRINGS = {
    "": [""],
    "[view]": ["", "[view]"],
    "[dev]": ["", "[view]", "[dev]"],
    "[dev,mitsuba,jupyter]": ["", "[view]", "[dev]", "[dev,mitsuba,jupyter]"],
}
COVERS = {  # by system libraries
    "bench": ("check", "render", "test", "view"),
    "check": (),
    "render": ("check",),
    "test": ("check", "render", "view"),
    "view": ("check", "render"),
}
TELL_PYTHON = "import sys, pip; print('%d.%d.%d' % sys.version_info[:3], sys.base_prefix)"


def is_ready(root: str, purpose: str, strict: bool) -> bool:
    """Is everything there already? Reads two files and starts nothing.

    `strict` is not content with a set-up that had to do without something.
    """
    state = _read(root)
    missing = state.get("missing", {}).get(purpose)
    return missing is not None and not (strict and missing) and _is_current(root, state, purpose)


def make(root: str, purpose: str, missing: list[str]) -> None:
    """Make or update the environment; `missing` names what the system could not provide."""
    state = _read(root)
    if not _is_current(root, state, purpose):
        reusable = _is_reusable(root, state)
        _write(root, UNFINISHED)
        if not reusable:
            _create(root)
        _install(root, purpose, state if reusable else UNFINISHED)
        state = {**_origin(root), "extras": BRINGS[EXTRAS[purpose]], "missing": _known(state)}
    state["missing"] |= {covered: [] for covered in COVERS[purpose]} | {purpose: missing}
    _write(root, state)


@contextmanager
def locked(root: str) -> Iterator[None]:
    """Keep other set-ups of this checkout waiting: `make -j2 render test` starts two at once."""
    import fcntl

    with open(os.path.join(root, "pyproject.toml")) as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX)
        except OSError:
            steps.say("No locks on this file system: let one make run at a time.")
        yield


def _path(root: str, *parts: str) -> str:
    return os.path.join(root, ".venv", *parts)


def _read(root: str) -> State:
    try:
        with open(_path(root, STATE_FILE), encoding="utf-8") as file:
            state = json.load(file)
    except FileNotFoundError:
        return {}
    except ValueError:
        return UNFINISHED
    return state if isinstance(state, dict) else UNFINISHED


def _write(root: str, state: State) -> None:
    os.makedirs(_path(root), exist_ok=True)
    with open(_path(root, STATE_FILE), "w", encoding="utf-8") as file:
        json.dump(state, file)


def _known(state: State) -> dict[str, list[str]]:
    return dict(state.get("missing", {}))


def _python() -> str:
    return "{}.{}.{} {}".format(*sys.version_info[:3], sys.base_prefix)


def _origin(root: str) -> State:
    """The sources of an environment; scripts inside it hold the path of the checkout."""
    with open(os.path.join(root, "pyproject.toml"), "rb") as file:
        project = hashlib.sha256(file.read()).hexdigest()
    return {"python": _python(), "root": root, "project": project}


def _is_current(root: str, state: State, purpose: str) -> bool:
    return (
        _origin(root).items() <= state.items()
        and EXTRAS[purpose] in state["extras"]
        and all(os.path.exists(_path(root, "bin", name)) for name in ("python", "glrt"))
    )


def _is_reusable(root: str, state: State) -> bool:
    """Can packages be installed on top of what is there?"""
    if state.get("unfinished") or state.get("root", root) != root:
        return False
    command = [_path(root, "bin", "python"), "-c", TELL_PYTHON]
    try:
        told = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    except OSError:
        return False
    return told.stdout.strip() == _python()


def _create(root: str) -> None:
    for entry in os.scandir(_path(root)):
        if entry.is_dir(follow_symlinks=False):
            shutil.rmtree(entry.path)
        elif entry.name != STATE_FILE:
            os.unlink(entry.path)
    title = f"Python environment .venv, Python {_python().split()[0]}"
    done, printed = steps.run(title, [_base_python(), "-m", "venv", _path(root)])
    if not done:
        steps.fail(f".venv could not be made ({steps.gist(printed)}).")


def _base_python() -> str:
    """This interpreter, outside of any environment: `.venv` itself may run this and was emptied."""
    if sys.prefix == sys.base_prefix:
        return sys.executable
    return os.path.join(sys.base_prefix, "bin", f"python3.{sys.version_info.minor}")


def _install(root: str, purpose: str, state_if_it_fails: State) -> None:
    pip = [_path(root, "bin", "python"), "-m", "pip", "--disable-pip-version-check"]
    options = ["install", "--quiet", "--no-input", "--editable", f"{root}{EXTRAS[purpose]}"]
    title = f"Python packages of glrt{EXTRAS[purpose]}"
    done, printed = steps.run(title, [*pip, *options], PIP_USER="0")
    if not done:
        _write(root, state_if_it_fails)
        steps.fail(
            f"pip could not install the Python packages ({steps.gist(printed)}). This step needs "
            "the network once, to reach PyPI or the package index that pip is configured for. "
            f"When it is reachable, type `make {purpose}` again."
        )
