"""Configurations behind corners: nodes over the ranges of a study, each reached from a solved one next to it."""
