"""Kernels are held against the reference before they are written; what is rejected is replaced, or bounded."""
