"""Kernels are those of the C: its statements are the ones inside of the units."""

from __future__ import annotations

from symgen.backends.c.statements import CStatements

__all__ = ["CStatements"]
