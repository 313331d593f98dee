"""The pages of docs/ beside the interface, for `make docs`.

.. include:: customise.md
.. include:: example.md
.. include:: numbers.md
.. include:: adding.md
.. include:: models.md
.. include:: field.md
.. include:: benchmark.md
.. include:: performance.md
.. include:: reliability.md
.. include:: troubleshooting.md
"""
