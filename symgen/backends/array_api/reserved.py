"""Words of Python, and the ending of the module in single precision."""

from __future__ import annotations

from dataclasses import replace

from symgen.backends.python import reserved
from symgen.registered import words

WORDS = replace(reserved.WORDS, endings=words("f"))
