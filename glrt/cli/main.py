"""The command `glrt`: how it starts, and how it ends.

Nothing slow is imported before `main` has installed a handler for Ctrl-C.
"""

import sys

from glrt.process.early import leave_early

SMALLER = "Render a smaller picture or a --crop."


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns its exit code.

    Without `arguments`, run the command line of this process, which is the command `glrt`. With
    `arguments`, run in the process of another program, whose signal handlers and garbage collector
    are unchanged afterwards.
    """
    if arguments is None:
        leave_early()
    from contextlib import nullcontext

    from glrt.process import command

    command.open_missing()
    if arguments is None:
        command.make_patient()
    with command.loading() if arguments is None else nullcontext():
        from glrt.cli import commands

        commands.load(arguments)
    return _run(arguments)


def _run(arguments: list[str] | None) -> int:
    from glrt.cli import commands
    from glrt.core.errors import GlrtError, RenderError
    from glrt.core.files import UNTOLD, reason
    from glrt.process import command, signals
    from glrt.process.command import fail

    try:
        with signals.handled(signals.interrupt):
            code = commands.run(arguments)
            sys.stdout.flush()  # a closed reader is noticed here, not at exit
            return code
    except GlrtError as error:
        return fail(str(error), error.exit_code)
    except KeyboardInterrupt as error:
        return fail(signals.PLAIN, signals.exit_code_of(error))
    except BrokenPipeError:
        command.silence(sys.stdout)
        return 0
    except MemoryError as error:
        return fail(f"out of memory: {reason(error)}. {SMALLER}", RenderError.exit_code)
    except OSError as error:
        command.settle(sys.stdout)
        return fail(f"{_what_failed(error)}: {reason(error, UNTOLD)}", RenderError.exit_code)


def _what_failed(error: OSError) -> str:
    name = getattr(error, "filename", None)
    return f"the command failed at {name}" if name else "the command failed"
