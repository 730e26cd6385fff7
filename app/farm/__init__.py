"""Work on many machines, or on all cores of one: Dask's `distributed` hands it out, and takes back what was made."""
