"""The generated C as a package for the build systems of firmware, and as single headers."""
