"""`python -m glrt`."""

import sys

from glrt.cli.main import main

sys.exit(main())
