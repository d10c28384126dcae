"""Methods to be compared with, longer or less accurate than those that are chosen: (27) with (28), (18), KKT."""
