"""Work on many machines, or on all cores of one, distributed by Dask's `distributed`."""
