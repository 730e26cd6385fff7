"""What things are: records of data, with no behaviour, no GL and no esper."""
