"""Angles, sines and cosines of the graph: sums, half turns, the unit circle."""
