"""Growing: postures, response and blades of one kind of grass."""
