"""Random but sensible systems through the whole command, and a witness of the numbers that shares none of its code.

Nothing in symgen depends on this package, and it depends on symgen through the command line only: a model file goes in
as text, exit code, messages and generated files come out.
"""
