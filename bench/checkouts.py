"""The files of another commit of this repository in a temporary folder."""

import subprocess
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from bench.processes import ROOT
from glrt.core.errors import RenderError, UsageError


def commit_of(name: str, repository: Path = ROOT) -> str:
    """The short hash of a commit; raises UsageError if there is none by that name."""
    command = ["rev-parse", "--verify", "--quiet", "--short", "--end-of-options"]
    done = _git(repository, *command, f"{name}^{{commit}}")
    if done.returncode:
        raise UsageError(f"there is no commit {name!r} in {repository}: `git log` lists them.")
    return done.stdout.strip()


def state_of(repository: Path = ROOT) -> str:
    """The short hash of the commit of a checkout, with a note if files differ from it."""
    has_changes = bool(_git(repository, "status", "--porcelain").stdout.strip())
    return commit_of("HEAD", repository) + (" with changes" if has_changes else "")


@contextmanager
def exported(commit: str, repository: Path = ROOT) -> Iterator[Path]:
    """Export a commit into a temporary folder, which is removed afterwards.

    It is not a worktree, which git would still list after a crash.
    """
    with tempfile.TemporaryDirectory(prefix="glrt-commit-") as folder:
        archive = Path(folder, "archive.zip")
        done = _git(repository, "archive", f"--output={archive}", commit)
        if done.returncode:
            raise RenderError(f"git cannot export {commit}: {done.stderr.strip()}")
        with zipfile.ZipFile(archive) as files:
            files.extractall(folder)
        archive.unlink()
        yield Path(folder)


def _git(repository: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    try:
        return subprocess.run(
            ["git", "-C", str(repository), *arguments], capture_output=True, text=True
        )
    except FileNotFoundError:
        raise UsageError("the program git is needed, and not installed.") from None
