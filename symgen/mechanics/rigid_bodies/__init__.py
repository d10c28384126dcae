"""Rigid bodies on the scalar graph: frames and joints, forces and inertias from frame to frame."""
