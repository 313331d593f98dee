"""Every figure, drawn from small tables, is the picture that is kept; `make golden`
replaces the pictures."""

from __future__ import annotations

from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest
from matplotlib import image

from maegawa2010.paper import chain_schematic
from maegawa2010.studies.event_law import figure as event_law
from maegawa2010.studies.failures import figure as failure_gallery
from maegawa2010.studies.grid import figure as grid
from maegawa2010.studies.horizon import figure as horizon
from maegawa2010.studies.larger import figure as larger
from maegawa2010.studies.noise import figure as noise
from maegawa2010.studies.printed_digits import figure as hero
from maegawa2010.studies.resolution import figure as resolution
from maegawa2010.studies.step_sweep import figure as step_sweep
from maegawa2010.studies.theta_window import figure as theta_window
from maegawa2010.studies.work_precision import figure as speed
from precursors.figures import precursor_lengths, scene, style

GOLDEN = Path(__file__).parents[1] / "golden"
SMALL = GOLDEN / "small"
PUBLISHED = GOLDEN.parents[1] / "paper/tables"
PANELS = Path(failure_gallery.__file__).with_name("failure_gallery.csv")
# Of 255: the same release of Matplotlib draws the same picture, but for a few grey
# levels where it smooths.
GREY_LEVELS = 8
SCENES = ("fig11", "fig10", "fig12")
# As a journal wants it: one column, large letters, a font whose symbols differ.
NARROW = style.Look(85.0, 9.0, "DejaVu Serif")
OF_A_JOURNAL = {"scene_crowded", "precursor_lengths_others"}


def read(path: Path) -> pd.DataFrame:
    return pd.read_csv(path)


def slips(name: str = "fig10", **columns: object) -> pd.DataFrame:
    return read(GOLDEN / f"{name}_slips.csv").assign(**columns)


def trace(events: pd.DataFrame, duration: float = 10.0) -> pd.DataFrame:
    """The load at both ends of each event that ends, and of the run."""
    over = events.dropna(subset="end_s")
    times = [0.0, *over[["onset_s", "end_s"]].to_numpy().ravel(), duration]
    loads = [0.0, *over[["load_before_N", "load_after_N"]].to_numpy().ravel(), 150.0]
    table = pd.DataFrame({"time_s": times, "tangential_load_N": loads})
    return table.assign(K_x1_N=80.0 * table["time_s"] - table["tangential_load_N"])


def draw_scene(events: pd.DataFrame, duration: float = 10.0, **how: object):
    return scene.draw(events, trace(events, duration), **how)


def crowded_scene():
    """Many events, one of which the end of the run cuts off, and a measurement below
    zero."""
    first = slips("fig12")
    times = ["onset_s", "end_s"]
    again = first.assign(**(first[times] + 10.0))
    small = first[first["onset_s"] < 2.8].assign(
        **(first[times] + 0.012), is_global=False
    )
    small["load_after_N"] = small["load_before_N"] - np.geomspace(1e-3, 1.0, len(small))
    cut = first.iloc[[0]].assign(
        onset_s=16.0, front=7, end_s=np.nan, load_after_N=np.nan
    )
    events = pd.concat([first, small, again[again["onset_s"] < 15.0], cut]).sort_values(
        "onset_s"
    )
    data = np.array([[0.0, -40.0], [2.0, 120.0], [2.7, 170.0], [9.0, 250.0]])
    return draw_scene(
        events,
        20.0,
        title="as a journal wants it, for a dollar: $5",
        data=data,
        look=NARROW,
    )


def endless_scene():
    """A chain of one block that slides from the start and never stops."""
    event = {
        "onset_s": 0.0,
        "end_s": np.nan,
        "front": 1,
        "n_blocks": 1,
        "is_global": True,
        "length_m": 0.25,
    }
    flat = pd.DataFrame({"time_s": [0.0, 1.0], "tangential_load_N": 0.0, "K_x1_N": 0.0})
    return scene.draw(slips().iloc[[0]].assign(**event), flat)


def partial_scene():
    """No slip is global, though one reaches the leading edge."""
    events = slips(is_global=False).iloc[:16]
    return draw_scene(events, 3.0, title="partial")


def paper_lengths():
    return precursor_lengths.draw(list(map(slips, SCENES)))


def other_lengths():
    """Scenes of one sign, of another slider, without a global slip, without theta and
    without a slip."""
    same_sign = slips("fig12", theta=0.2, normal_load_N=800.0)
    few = slips(n_blocks=12)[lambda table: ~table["is_global"]]
    tables = [
        slips("fig12"),
        same_sign,
        few,
        slips(theta=np.nan).iloc[:1],
        slips().iloc[:0],
    ]
    data = np.array([[50.0, 0.3], [90.0, 0.5]])
    return precursor_lengths.draw(
        tables, data=data, title="costs $5 at most", look=NARROW
    )


def one_length():
    return precursor_lengths.draw([slips()], data=np.array([[50.0, 0.3]]))


def swept_steps():
    points = [
        ("exact", np.nan, 5, 10),
        ("rk4", 1e-5, 7, 3),
        ("rk4", 1e-7, 5, 10),
        ("rk4", 1e-6, 6, 4),
    ]
    rows = pd.DataFrame(
        points, columns=["method", "step_s", "events_counted", "transitions_right"]
    )
    rows = rows.assign(mu_sapp=0.1 * rows["events_counted"], transitions_true=10)
    scenes = [rows.assign(scene=f"{theta}", theta=theta) for theta in (0.5, 0.0)]
    return step_sweep.draw(pd.concat(scenes, ignore_index=True))


def gallery_of_failures():
    """The same curves in all panels."""
    panels = read(PANELS)
    roles = {
        ("exact", "exact"): 1,
        ("dt = 1e-07 s", "failing"): 2,
        ("dt = 1e-07 s", "theory"): 3,
        ("theta = -1", "failing"): 4,
        ("1.2e-10 s", "failing"): 5,
        ("theory", "theory"): 6,
    }
    curves = []
    for mode, scale in zip(panels["mode"], panels["scale"], strict=True):
        y = np.array([0.1, 0.2, 0.4])
        x = y / scale
        curves += [
            pd.DataFrame({"curve": name, "role": role, "x": x, "y": n * y}).assign(
                failure_mode=mode
            )
            for (name, role), n in roles.items()
        ]
    return failure_gallery.draw(pd.concat(curves), panels)


def predicted_errors():
    errors = {"time_s": [0.05, 0.1, 0.15], "predicted_error_s": [1e-16, 1e-12, np.nan]}
    errors |= {"actual_error_s": [1e-17, 1e-13, 1e-10]}
    thetas = {"trailing": -5 / 6, "steep": 0.9}
    tables = [pd.DataFrame(errors).assign(chain=name) for name in thetas]
    exponents = pd.DataFrame({"theta": [-5 / 6, 0.0], "exponent_per_s": [50.0, 0.7]})
    return horizon.draw(pd.concat(tables), exponents, thetas, 1e-9)


def alike_sliders():
    """Three loadings; of one a slider has no global slip."""
    members = pd.DataFrame({"draw": range(30)})
    members["mu_sapp"] = np.linspace(0.46, 0.53, 30) ** 2 * 2
    members.loc[0, "mu_sapp"] = 0.485
    sliders = [
        members.assign(scene=scene, theta=theta)
        for scene, theta in zip(SCENES, (-5 / 6, 0.0, 5 / 6), strict=True)
    ]
    sliders[0].loc[3, "mu_sapp"] = np.nan
    shares = pd.DataFrame({"scene": SCENES, "share": [0.1, 0.25, 0.3], "n": 29})
    shares = shares.assign(q05=0.45, q50=0.48, q95=0.54)
    shares = shares.assign(quantity="mu_sapp", question="as_printed")
    return hero.draw(list(map(slips, SCENES)), pd.concat(sliders), shares)


def window_of_theta():
    members = {
        "scene": "s",
        "theta": [0.5, 0.4, 0.45, 0.5, 0.55, 0.6],
        "point": range(6),
        "events_counted": 4,
    }
    return theta_window.draw(
        pd.DataFrame(members).assign(mu_sapp=[0.5, 0.5, 0.51, 0.51, 0.53, np.nan])
    )


def numbers_by_n():
    foreseen = {
        "scene": "fig10",
        "n_blocks": [2, 4],
        "horizon_s": 2.5,
        "predictable": [True, False],
    }
    table = read(SMALL / "resolution.csv")
    return resolution.draw(table, pd.DataFrame(foreseen), papers_n=12, mu_k=0.45)


def map_of_friction():
    table = read(SMALL / "grid.csv")
    axes = [{"key": "theta"}, {"key": "mu_k/mu_s"}]
    return grid.draw(table.assign(reached=table.index > 0), axes, [(0.25, 0.5)])


# By the names of the modules.
PICTURES = {
    "chain_schematic": chain_schematic.draw,
    "scene": lambda: draw_scene(slips(), title="uniform", key=False),
    "scene_crowded": crowded_scene,
    "scene_endless": endless_scene,
    "scene_partial": partial_scene,
    "scene_calm": lambda: draw_scene(slips().iloc[:0], look=style.Look(85.0)),
    "scene_without_inset": lambda: draw_scene(
        slips("fig11").iloc[:7], 2.6324, inset=False
    ),
    "precursor_lengths": paper_lengths,
    "precursor_lengths_others": other_lengths,
    "precursor_lengths_one": one_length,
    "work_precision": lambda: speed.draw(
        read(PUBLISHED / "work_precision_full.csv"),
        works=["seconds", "evaluations"],
    ),
    "speed": lambda: speed.draw(
        read(PUBLISHED / "work_precision_full.csv"),
        read(PUBLISHED / "beside_heyoka.csv"),
    ),
    "step_sweep": swept_steps,
    "failure_gallery": gallery_of_failures,
    "horizon": predicted_errors,
    "hero": alike_sliders,
    "theta_window": window_of_theta,
    "resolution": numbers_by_n,
    "noise": lambda: noise.draw(read(SMALL / "noise_amplitudes.csv")),
    "event_law": lambda: event_law.draw(read(SMALL / "event_law.csv")),
    "grid": map_of_friction,
    "larger": lambda: larger.draw(
        read(SMALL / "larger_nucleation.csv"),
        read(SMALL / "larger_peaks.csv"),
        read(SMALL / "larger_cycles.csv"),
    ),
}


def save_small(name: str, path: Path) -> None:
    """Write a picture of few pixels."""
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(
            PICTURES[name](), path, NARROW if name in OF_A_JOURNAL else style.LOOK
        )


@pytest.mark.parametrize("name", PICTURES)
def test_a_figure_is_the_picture_that_is_kept(name, tmp_path):
    save_small(name, tmp_path / "found.png")
    found, kept = (
        image.imread(path) for path in (tmp_path / "found.png", SMALL / f"{name}.png")
    )
    assert found.shape == kept.shape
    assert 255 * np.abs(found - kept).max() < GREY_LEVELS
