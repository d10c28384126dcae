"""Rewriting passes: each takes scalars to equal ones that cost less."""
