"""Which tests are slow, and `--slow-share K/N`: of those run K in N, drawn by test and commit.

A test is marked `slow`, or some of its cases are: `slow_cases("everything-*")` names their ids.

Every commit draws another share, and the same commit always the same one; so a failure can be
repeated, and over the commits all slow tests are run, except a test that may take longer than
a share.
"""

import hashlib
import re
import subprocess
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

from tests.support.workers import report, reported_by

DRAWN = pytest.StashKey[str]()
LONGEST = 600  # seconds that a test of a share may take
SHARE = "slow share"  # by this name a worker of pytest-xdist reports what was drawn


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--slow-share", type=share, metavar="K/N", help="run K in N of the tests marked slow"
    )


def share(text: str) -> tuple[int, int]:
    """Read "1/8" as (1, 8)."""
    match = re.fullmatch(r"(\d+)/([1-9]\d*)", text)
    if not match or int(match[1]) > int(match[2]):
        raise ValueError(f"{text!r} is not a share such as 1/8")
    return int(match[1]), int(match[2])


def is_drawn(test: str, commit: str, drawn: int, of: int) -> bool:
    digest = hashlib.sha256(f"{commit} {test}".encode()).digest()
    return int.from_bytes(digest[:8], "big") % of < drawn


def may_be_drawn(item: pytest.Item) -> bool:
    """Whether a test fits into a share: it asks for no more time than others."""
    mark = item.get_closest_marker("timeout")
    return mark is None or mark.args[0] <= LONGEST


def commit_of(folder: Path) -> str:
    """The commit checked out in the folder; "" outside of a repository."""
    try:
        told = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return ""
    return told.stdout.strip()


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark the cases that `slow_cases` names."""
    case = getattr(item, "callspec", None)
    patterns = [it for mark in item.iter_markers("slow_cases") for it in mark.args]
    if case and any(fnmatchcase(case.id, pattern) for pattern in patterns):
        item.add_marker(pytest.mark.slow)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    wanted: tuple[int, int] | None = config.getoption("slow_share")
    if not wanted:
        return
    commit = commit_of(config.rootpath)
    slow = [item for item in items if item.get_closest_marker("slow")]
    left_out = [
        item
        for item in slow
        if not may_be_drawn(item) or not is_drawn(item.nodeid, commit, *wanted)
    ]
    config.hook.pytest_deselected(items=left_out)
    items[:] = [item for item in items if item not in left_out]
    config.stash[DRAWN] = f"{len(slow) - len(left_out)} of {len(slow)} slow tests drawn"


@pytest.hookimpl(wrapper=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """A share without a test is still a share."""
    report(session.config, SHARE, session.config.stash.get(DRAWN, ""))
    yield
    if DRAWN in session.config.stash and session.exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED:
        session.exitstatus = pytest.ExitCode.OK


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """A worker of pytest-xdist has ended: all of them draw the same."""
    if drawn := reported_by(node, SHARE, ""):
        node.config.stash[DRAWN] = drawn


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    drawn = terminalreporter.config.stash.get(DRAWN, "")
    if drawn:
        terminalreporter.write_line(drawn)
