"""The film shows the motion of the run, and friction within Coulomb's law, in a small file."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from precursors import Chain, find_slips, simulate
from precursors.figures.film import (
    FRAMES_PER_SECOND,
    SECONDS_PER_EVENT,
    STILL_FRAMES,
    film_clips,
    friction_over_strength,
    write_film,
)

MOST_BYTES = 3e6
SECONDS = 0.4  # of each event: 6 frames
# A force near 30 N is a difference of two spring forces near 200 N.
ROUNDING = 1e-12
# What friction over strength may change by in 1e-12 s: a force of 30 N turns within some microseconds.
ONE_PICOSECOND = 1e-5
BACKGROUND = 250  # the brightness of paper


@pytest.fixture(scope="module")
def run():
    return simulate(Chain.from_slider(), 3.0)


@pytest.fixture(scope="module")
def clips(run):
    return film_clips(run, SECONDS)


@pytest.fixture(scope="module")
def film(clips, tmp_path_factory):
    path = tmp_path_factory.mktemp("film") / "film.gif"
    write_film(clips, path)
    return path


def test_the_clips_are_the_farthest_precursor_and_the_first_global_slip(run, clips):
    slips = find_slips(run)
    precursor, global_slip = clips
    assert precursor.onset == slips.loc[slips["front"] == 9, "onset"].item()
    assert global_slip.onset == slips.loc[slips["is_global"], "onset"].iloc[0]
    for clip in clips:
        assert clip.velocities[[0, -1]].tolist() == np.zeros((2, 10)).tolist()
    assert (np.abs(precursor.velocities).max(axis=0) > 0).sum() <= 9
    assert (np.abs(global_slip.velocities).max(axis=0) > 0).all()


def test_friction_never_exceeds_strength_and_is_kinetic_where_a_block_slides(clips):
    for clip in clips:
        assert np.abs(clip.friction).max() <= 1 + ROUNDING
        sliding = clip.velocities != 0
        assert sliding.any()
        np.testing.assert_allclose(
            clip.friction[sliding], np.sign(clip.velocities[sliding]) * 0.45 / 0.70, rtol=ROUNDING
        )


def test_dashpots_pull_at_a_stuck_block_too():
    """Just before it is released, a block between neighbours has friction equal to its strength."""
    run = simulate(Chain.from_slider(viscosity=54.77), 3.0)
    releases = run.transitions[(run.transitions["mode"] != 0) & (run.transitions["block"] > 1)]
    times = releases["time"] - 1e-12
    friction = friction_over_strength(run.chain, *run.forces_and_velocities(times))
    at_release = friction[np.arange(len(releases)), releases["block"] - 1]
    stuck = run.at(times)[1][np.arange(len(releases)), releases["block"] - 1] == 0
    assert stuck.sum() > 10
    np.testing.assert_allclose(np.abs(at_release[stuck]), 1.0, atol=ONE_PICOSECOND)


def test_a_chain_whose_stuck_blocks_move_is_refused():
    run = simulate(Chain.from_slider(interface_stiffness=25e6), 1.0)
    with pytest.raises(
        ValueError, match=r"\Ainterface_stiffness = 2500000\.0 \[N/m\]: allowed is 0 in a film[^\n]*\Z"
    ):
        film_clips(run)


def test_block_1_lets_go_at_its_strength(run):
    onset = find_slips(run)["onset"].iloc[0]
    at_rest = np.array([onset - 1e-9])
    friction = friction_over_strength(run.chain, run.spring_forces(at_rest), run.at(at_rest)[1])
    assert friction[0, 0] == pytest.approx(1.0, abs=1e-8)
    assert friction[0, 1:].tolist() == [0.0] * 9


def test_a_block_without_weight_has_no_friction():
    chain = Chain.from_slider(theta=1)
    friction = friction_over_strength(chain, np.zeros((1, 10)), np.ones((1, 10)))
    assert friction[0, 0] == 0.0
    assert (friction[0, 1:] > 0).all()


def test_the_film_moves_and_a_whole_one_is_small(film):
    with Image.open(film) as picture:
        # Pillow shows frames that are alike as one, for longer.
        assert picture.n_frames >= 2 * (SECONDS * FRAMES_PER_SECOND)
        per_frame = film.stat().st_size / picture.n_frames
        frames = []
        for number in range(picture.n_frames):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("L")))
    whole = 2 * (SECONDS_PER_EVENT * FRAMES_PER_SECOND + 1 + STILL_FRAMES)
    assert per_frame * whole < MOST_BYTES
    assert frames[0].max() > BACKGROUND
    assert all((before != after).any() for before, after in pairwise(frames))


def test_the_same_clips_give_the_same_bytes(clips, film, tmp_path):
    write_film(clips, tmp_path / "again.gif")
    assert (tmp_path / "again.gif").read_bytes() == film.read_bytes()


@pytest.mark.parametrize("duration", [2.0, 2.7393])
def test_a_run_without_a_finished_global_slip_is_refused(duration):
    with pytest.raises(ValueError, match="longer"):
        film_clips(simulate(Chain.from_slider(), duration))


def test_another_format_is_refused(clips, tmp_path):
    with pytest.raises(ValueError, match="gif"):
        write_film(clips, tmp_path / "film.avi")
