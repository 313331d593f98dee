"""Run the command line with `python -m precursors`."""

import sys

from precursors.cli import main

sys.exit(main())
