"""Running the command as a user does: a process of its own."""

import os
import subprocess
import sys
from pathlib import Path


def glrt(
    *arguments: str | Path, cwd: Path | None = None, **environment: str
) -> "subprocess.CompletedProcess[str]":
    """Run `glrt` to its end."""
    return subprocess.run(
        [sys.executable, "-m", "glrt", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        timeout=250,
        env={**os.environ, **environment},
    )


AT_WORK = """
import sys
from glrt.cli import render as command
from glrt.cli.main import main
from glrt.rendering.renderer import Renderer
work = Renderer._work
def told(renderer, *arguments):
    work(renderer, *arguments)
    if renderer.samples:
        print("at work", flush=True)
        Renderer._work = work
picture = command._picture
def begun(*arguments):  # not what a pilot renders
    Renderer._work = told
    return picture(*arguments)
command._picture = begun
sys.exit(main())
"""


def start_render(*arguments: str | Path) -> "subprocess.Popen[str]":
    """Start `glrt render`, and go on when its picture has a sample."""
    process = subprocess.Popen(
        [sys.executable, "-c", AT_WORK, "render", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout
    process.stdout.readline()  # "" if it ends before
    return process


def start(*arguments: str | Path) -> "subprocess.Popen[str]":
    """Start `glrt` and go on."""
    return subprocess.Popen(
        [sys.executable, "-m", "glrt", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
