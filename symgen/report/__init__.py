"""The derivation report: one document, rendered to HTML with MathML, LaTeX, PDF, and plain text for the terminal."""
