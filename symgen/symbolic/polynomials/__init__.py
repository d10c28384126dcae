"""Scalars as polynomials in what they are made of: monomials, content, factors."""
