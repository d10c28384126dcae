"""`python -m symgen.zoo`."""

import sys

from symgen.zoo.command import main

sys.exit(main())
