"""Kernels are those of the C: its statements are the ones behind the interface."""

from __future__ import annotations

from symgen.backends.c.statements import CStatements

__all__ = ["CStatements"]
