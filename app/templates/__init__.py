"""Templates of the files that `tallgrass new` writes: a game and a wind, for their author to change."""
