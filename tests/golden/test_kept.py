"""Small pictures are those that are kept; `make golden` replaces them."""

import numpy as np
import pytest
from golden.kept import SMALL, pictures, write_picture
from matplotlib import image

PICTURES = pictures()
# Of 255: the same release of Matplotlib draws the same picture, but for a few grey
# levels where it smooths.
GREY_LEVELS = 8


@pytest.mark.parametrize("name", PICTURES)
def test_a_figure_is_the_picture_that_is_kept(name, tmp_path):
    write_picture(tmp_path / "found.png", PICTURES[name])
    found, as_kept = (
        image.imread(path) for path in (tmp_path / "found.png", SMALL / f"{name}.png")
    )
    assert found.shape == as_kept.shape
    assert 255 * np.abs(found - as_kept).max() < GREY_LEVELS
