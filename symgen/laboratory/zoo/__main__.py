"""`python -m symgen.laboratory.zoo`."""

import sys

from symgen.laboratory.zoo.command import main

sys.exit(main())
