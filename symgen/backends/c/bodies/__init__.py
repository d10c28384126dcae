"""What stands in C functions: checks, sines and cosines, tables of steps, the test that results are finite."""
