"""Null spaces, minors, reflections and factorisations of matrices of scalars, and what they divide by."""
