"""What the project is exposed to on purpose: hostile input, kills, full disks, damaged files, other machines.

`python -m faults` in tests/ (`make test-faults`) tries all of it and prints one row for each fault.
"""
