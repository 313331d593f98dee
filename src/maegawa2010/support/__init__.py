"""Code that the workflow's scripts share: jobs, digests, provenance, timing, statistics."""
