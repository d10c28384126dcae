"""The ring of sines and cosines and its fractions: normal forms, minors, common factors."""
