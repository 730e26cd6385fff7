"""Bodies that fly over the prairie: their flight and their drawing."""
