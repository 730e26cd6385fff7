"""What entities carry: data that games read and, where it says so, write; no GL and no esper."""
