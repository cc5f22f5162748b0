"""What benchmarks/run.py is made of: one concept per file."""
