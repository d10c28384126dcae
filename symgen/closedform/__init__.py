"""Exact closed forms of a model, and published formulas decided."""
