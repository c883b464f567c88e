"""The cost of tests: programs that the driver compiles, and processor seconds.

A run of the whole fast tier fails if its processes compile more than MOST_PROGRAMS: on a bare
machine most of its time goes there. With `--budget` it fails, too, if a test takes more than
MOST_SECONDS, or all of them more than ALL_SECONDS. Run it where the driver has the programs in its
cache and nothing else runs.
"""

import hashlib
import json
import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import moderngl
import pytest

from tests.support.workers import report, reported_by

MOST_PROGRAMS = 890  # this figure only falls
MOST_SECONDS = 2.0  # of one test
ALL_SECONDS = 420.0
SHOWN = 8  # of the costliest tests
COSTS = "costs"  # by this name a worker of pytest-xdist hands over its counts
_TICKS = os.sysconf("SC_CLK_TCK")

_programs: dict[str, str] = {}  # the first test that compiled each, by its digest
_seconds: dict[str, float] = {}  # of tests that are worth a line
_total = 0.0
_current = ""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--budget", action="store_true", help="judge processor seconds, too")


def pytest_configure() -> None:
    """Count what is compiled from here on."""
    for name in ("compute_shader", "program"):
        _count(name)


def _count(name: str) -> None:
    compile_it = getattr(moderngl.Context, name)

    def counted(self: moderngl.Context, *texts: Any, **named: Any) -> Any:
        program = compile_it(self, *texts, **named)
        shown = repr((name, texts, sorted(named.items())))
        _programs.setdefault(hashlib.sha256(shown.encode()).hexdigest()[:16], _current)
        return program

    setattr(moderngl.Context, name, counted)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Count the seconds of a test, its fixtures and its processes, also of those still running."""
    global _current, _total
    _current, before = item.nodeid, processor_seconds()
    result = yield
    spent = processor_seconds() - before
    _total += spent
    if spent > MOST_SECONDS / 4:
        _seconds[item.nodeid] = spent
    return result


def processor_seconds() -> float:
    """Processor seconds of this process and all that it has started."""
    own = os.times()
    return sum(own[:4]) + sum(_of_process(child) for child in _children(os.getpid()))


def _children(process: int) -> list[int]:
    """Processes that it started and that run; none where the system does not list them."""
    found: list[int] = []
    for tasks in Path(f"/proc/{process}/task").glob("*/children"):
        try:
            direct = [int(child) for child in tasks.read_text().split()]
        except OSError:
            continue
        found += direct + [it for child in direct for it in _children(child)]
    return found


def _of_process(process: int) -> float:
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, fields[11:15])) / _TICKS  # user and system, its own and its children's


@pytest.hookimpl(wrapper=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """Judge the whole run, where it is one of the fast tier."""
    report(session.config, COSTS, json.dumps([_programs, _seconds, _total]))
    yield
    if excess(session.config) and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    """A worker of pytest-xdist has ended."""
    global _total
    programs, seconds, total = json.loads(str(reported_by(node, COSTS, "[{}, {}, 0]")))
    for digest, test in programs.items():
        _programs.setdefault(digest, test)
    _seconds.update(seconds)
    _total += total


def excess(config: pytest.Config) -> list[str]:
    """The limits that a run of the whole fast tier exceeds."""
    is_whole = config.option.markexpr == "not slow" and not config.option.keyword
    if not is_whole or config.args != config.getini("testpaths") or hasattr(config, "workerinput"):
        return []
    found = []
    if len(_programs) > MOST_PROGRAMS:
        found.append(f"more than {MOST_PROGRAMS} programs were compiled")
    if not config.getoption("budget"):
        return found
    if _total > ALL_SECONDS:
        found.append(f"the tests took more than {ALL_SECONDS:.0f} processor seconds")
    for test, spent in _seconds.items():
        if spent > MOST_SECONDS:
            found.append(f"{test} took {spent:.1f} processor seconds")
    return found


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    write = terminalreporter.write_line
    write(f"{len(_programs)} programs were compiled, in {_total:.0f} processor seconds of tests")
    broken = excess(config)
    if broken or config.getoption("budget"):
        by_test = Counter(test.partition("[")[0] for test in _programs.values())
        for test, count in by_test.most_common(SHOWN):
            write(f"{count:5} programs: {test}")
        for test, spent in sorted(_seconds.items(), key=lambda it: -it[1])[:SHOWN]:
            write(f"{spent:5.1f} seconds: {test}")
    for line in broken:
        write(f"over the budget: {line}")
