"""Derivatives of u, q_ddot and lambda."""
