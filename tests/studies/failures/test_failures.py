"""Every failure mode is measured: results of the methods are wrong, as theory predicts."""

from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from places import made

from maegawa2010.methods.stability import highest_frequency
from maegawa2010.studies.failures import figure
from maegawa2010.studies.failures.common import Curve
from maegawa2010.studies.failures.tables import FAILURE_MODES
from precursors import Chain

# Between a measured curve and the closed form, which is of first order.
THEORY_TOLERANCE = 0.02


@cache
def measured(name: str) -> list[Curve]:
    return FAILURE_MODES[name]()


def curves(mode: str, role: str) -> dict[str, np.ndarray]:
    """Points of a failure mode's curves with a role, shape (2, n), by name."""
    return {c.name: np.array([c.x, c.y]) for c in measured(mode) if c.role == role}


@pytest.mark.parametrize("mode", ["unstable", "numerical_damping", "creep"])
def test_a_method_fails_as_theory_predicts(mode):
    theory = curves(mode, "theory")
    for name, (x, y) in curves(mode, "failing").items():
        predicted = np.interp(x, *theory[name])
        # Near its limit, the energy of leapfrog oscillates.
        far = slice(-3 if mode == "unstable" else None, None)
        np.testing.assert_allclose(y[far], predicted[far], rtol=THEORY_TOLERANCE)


def test_failing_methods_differ_from_the_exact_solution():
    limit = Chain.from_slider().strength[0]
    assert curves("literal_friction", "exact")["exact"][1].max() > 2.5 * limit
    for _, load in curves("literal_friction", "failing").values():
        assert load.max() == pytest.approx(limit)
    (exact,) = curves("missed_roots", "exact").values()
    (steps,) = curves("missed_roots", "failing").values()
    assert exact[1].min() < 0.0
    assert (steps[1, 1:] > 0.0).all()


def test_rk4_beyond_its_limit_ends_wrong_without_an_error():
    (step, friction), *_ = curves("silent_instability", "failing").values()
    exact = curves("silent_instability", "exact")["exact"][1, 0]
    assert min(friction) < 0.95 * exact
    assert max(friction) > 1.05 * exact
    assert (abs(friction - exact) > 1e-6).all()
    assert len(step) > 20
    limit = 2.0 * np.sqrt(2.0) / highest_frequency(Chain.from_slider())
    assert step[0] == pytest.approx(1.005 * limit)


PANELS = Path(figure.__file__).with_name("failure_gallery.csv")


def gallery_of_failures():
    """The gallery with the curves of the build."""
    return figure.draw(made("failure_curves"), pd.read_csv(PANELS))


PICTURES = {"failure_gallery": gallery_of_failures}


def test_every_failure_mode_has_a_panel():
    assert list(pd.read_csv(PANELS)["mode"]) == list(FAILURE_MODES)
