"""Estimates: columns and inputs of a log, weighted least squares, parameters of the file, what is written."""
