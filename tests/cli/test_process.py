"""A command keeps its imports from the garbage collector; `import glrt` changes nothing."""

import gc
import subprocess
import sys


def told(code: str) -> str:
    """The output of a Python process."""
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.strip()


def test_the_command_looks_for_garbage_in_what_comes_after_its_imports() -> None:
    code = (
        "import gc; from glrt.process.command import loading; loaded = loading(); "
        "loaded.__enter__(); "
        "off = not gc.isenabled(); imported = []; loaded.__exit__(None, None, None); later = []; "
        "found = gc.get_objects(); "
        "has = [any(f is each for f in found) for each in (imported, later)]; "
        "print(off, gc.isenabled(), *has)"
    )
    assert told(code) == "True True False True"


def test_a_program_that_runs_a_command_keeps_its_collector_and_its_handlers() -> None:
    code = (
        "import gc, signal; from glrt.cli.main import main; mine = lambda *_: None; "
        "signal.signal(signal.SIGINT, mine); main(['--version']); "
        "print(gc.get_freeze_count(), signal.getsignal(signal.SIGINT) is mine)"
    )
    assert told(code).splitlines()[-1] == "0 True"


def test_a_program_that_imports_glrt_collects_as_it_likes() -> None:
    code = "import gc, glrt; glrt.render, glrt.Scene; print(gc.isenabled(), gc.get_freeze_count())"
    assert told(code) == "True 0"
    assert gc.isenabled()


def test_importing_glrt_loads_nothing_that_is_slow() -> None:
    code = "import sys, glrt; print(sorted({'numpy', 'moderngl', 'pydantic'} & set(sys.modules)))"
    assert told(code) == "[]"
    assert told("import glrt; print(all(hasattr(glrt, name) for name in glrt.__all__))") == "True"
