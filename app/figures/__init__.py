"""The paper's figures, as this system draws them: `tallgrass figures`."""
