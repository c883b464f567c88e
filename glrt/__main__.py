"""`python -m glrt`."""

import sys

try:
    from glrt.cli.main import main
except KeyboardInterrupt:
    sys.stderr.write("glrt: interrupted\n")
    sys.exit(130)

sys.exit(main())
