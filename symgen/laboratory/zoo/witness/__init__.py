"""The numbers of the zoo: model files read, differentiated and solved once more; what was made is held to them."""
