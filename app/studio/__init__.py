"""What commands draw with: a take, a studio to draw it in, files to put it into."""
