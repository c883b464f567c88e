"""`python -m glrt`."""

import sys

from glrt.cli import main

sys.exit(main())
