"""Readers of accelerogram files: PEER AT2, ESM ASCII, K-NET, columns of numbers, SAC and miniSEED through obspy."""
