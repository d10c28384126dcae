"""Derivatives of u towards places where choices of coordinates or inputs fail, and nothing happens to the mechanism."""
