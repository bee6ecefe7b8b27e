"""One file for each real board: the only place, besides boot and main, that knows pins."""
