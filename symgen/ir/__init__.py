"""Straight-line programs over real scalars, their variants, and the interpreter that gives them their meaning."""
