"""The comparison of methods, as published (`make article`) and of the build."""

import pytest
from colorspacious import cspace_convert
from matplotlib.colors import to_rgb
from places import made

from maegawa2010.studies.work_precision.figure import draw

LEAST_CONTRAST = 4.5  # of words on white (WCAG)


@pytest.mark.parametrize("name", ["speed", "work_precision"])
def test_every_method_as_accurate_as_the_exact_solver_is_slower(name):
    table = made(name)
    assert set(table["scene"]) == {"uniform"}
    is_right = table["transitions_right"].eq(table["transitions_true"])
    (exact,) = table[is_right & table["method"].eq("exact")].to_dict("records")
    whole = table[is_right & table["method"].ne("exact")]
    as_close = whole[whole["time_error_s"] <= exact["time_error_s"]]
    assert (as_close["seconds"] > exact["seconds"]).all()
    assert set(as_close["method"]) <= {"heyoka"}


def test_words_of_the_published_chart_stand_out_from_white():
    (axes,) = draw(made("speed"), compared="heyoka").axes
    words = {text.get_text(): text.get_color() for text in axes.texts}
    assert {"heyoka", "RK4,\nlocated", "11 times"} <= words.keys()
    for color in words.values():
        _, luminance, _ = cspace_convert(to_rgb(color), "sRGB1", "XYZ100")
        assert 1.05 / (luminance / 100 + 0.05) >= LEAST_CONTRAST
