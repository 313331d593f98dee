"""`python -m precursors`: the command line."""

import sys

from precursors.cli import main

sys.exit(main())
