"""Inputs by definition: which are independent, how redundant ones share the work, what limits leave."""
