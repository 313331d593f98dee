"""The ladder of models: no more model than a question needs, one table."""

from precursors.hierarchy.dynamic import CHAIN, HEAD, INTERFACE, VISCOUS
from precursors.hierarchy.quantities import QUANTITIES, Model, Quantity
from precursors.hierarchy.quasistatic import DAMPED, QUASISTATIC
from precursors.hierarchy.rigid import RIGID
from precursors.hierarchy.statics import LAW, STATICS

# From the smallest to the largest; the name is the word after `model:` in a scene.
MODELS: dict[str, Model] = {
    model.name: model for model in (STATICS, LAW, RIGID, DAMPED, QUASISTATIC, CHAIN, VISCOUS, INTERFACE, HEAD)
}

__all__ = ["MODELS", "QUANTITIES", "Model", "Quantity"]
