"""Trajectories of a model's `paths`: solving them, and the figures and charts drawn along them."""
