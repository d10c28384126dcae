"""Mathematics as it is set on a page, and its printers."""
