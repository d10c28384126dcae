"""Rows of constraints in a form that is cheaper, or loses fewer digits, before anything is solved."""
