"""Configurations that satisfy the constraints, and the system in numbers there."""
