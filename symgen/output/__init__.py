"""The only writer of files: a folder changes as a whole or not at all."""
