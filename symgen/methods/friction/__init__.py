"""Friction that grows with the reactions it changes: what it acts along, its loads, and u with it."""
