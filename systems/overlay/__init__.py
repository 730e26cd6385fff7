"""The overlay: masks, messages and levels of detail as coloured marks over the prairie (paper, figures 5, 7 and 10)."""
