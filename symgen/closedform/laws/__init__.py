"""Matrices as laws of short printed factors, and singular sets as determinants, where closed forms get long."""
