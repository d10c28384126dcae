"""What a study comes to: a summary, pictures, and the page that holds them."""
