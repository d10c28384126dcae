"""Kernels as source code: what C and Python have in common, and a package for each language."""
