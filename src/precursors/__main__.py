"""`python -m precursors`: the command line."""

import sys

from precursors.command_line import main

sys.exit(main())
