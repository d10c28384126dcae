"""What goes beside the code so that others can check it: drivers for analysers and fuzzers, rounding bounds."""
