"""What an identification comes to, in words: lines of a terminal, notes, charts, a document, a record."""
