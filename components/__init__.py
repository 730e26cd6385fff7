"""Components of entities: data that games read and, where documented, write; no GL and no esper."""
