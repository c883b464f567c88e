"""The command `glrt`: how it starts, and how it ends.

Nothing that takes time is imported before `main` has seen to Ctrl-C.
"""

import sys

from glrt.early import leave_early

SMALLER = "Render a smaller picture or a --crop."


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns its exit code.

    Without `arguments` this is the process of the command `glrt`, whose command line it runs. With
    them it is a program's: signals and the garbage collector are left as they are.
    """
    if arguments is None:
        leave_early()
    from contextlib import nullcontext

    from glrt.cli import process

    process.open_missing()
    if arguments is None:
        process.make_patient()
    with process.loading() if arguments is None else nullcontext():
        from glrt.cli import commands

        commands.load(arguments)
    return _run(arguments)


def _run(arguments: list[str] | None) -> int:
    from glrt import signals
    from glrt.cli import commands, process
    from glrt.cli.process import fail
    from glrt.errors import GlrtError, RenderError
    from glrt.files import reason

    try:
        with signals.handled(signals.interrupt):
            code = commands.run(arguments)
            sys.stdout.flush()  # a reader that has gone is found out here, not at exit
            return code
    except GlrtError as error:
        return fail(str(error), error.exit_code)
    except KeyboardInterrupt as error:
        return fail(signals.PLAIN, signals.exit_code_of(error))
    except BrokenPipeError:
        process.silence(sys.stdout)
        return 0
    except MemoryError as error:
        return fail(f"out of memory: {reason(error)}. {SMALLER}", RenderError.exit_code)
    except OSError as error:
        process.settle(sys.stdout)
        return fail(f"{_what_failed(error)}: {reason(error)}", RenderError.exit_code)


def _what_failed(error: OSError) -> str:
    name = getattr(error, "filename", None)
    return f"the command failed at {name}" if name else "the command failed"
