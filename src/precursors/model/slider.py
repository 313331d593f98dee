"""Arguments of `Chain.from_slider` and their defaults, the paper's."""

from __future__ import annotations

import inspect

from precursors.model.chain import Chain

SLIDER = {name: p.default for name, p in inspect.signature(Chain.from_slider).parameters.items()}
