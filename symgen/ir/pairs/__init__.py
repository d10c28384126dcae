"""Twice the digits: numbers as pairs of numbers of their type."""
