"""Words of Python, and of no language besides."""

from __future__ import annotations

from symgen.backends.python.reserved import WORDS as WORDS
