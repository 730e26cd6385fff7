"""What `tallgrass new` writes: the files of a game and of a wind, for their author to change."""
