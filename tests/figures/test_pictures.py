"""Figures of a run, drawn from small tables."""

import numpy as np
import pandas as pd
from places import GOLDEN

from precursors.figures import precursor_lengths, scene, style

# A look for a journal: one column, large letters, a font with other symbols.
NARROW = style.Look(85.0, 9.0, "DejaVu Serif")


def slips(name: str = "fig10", **columns: object) -> pd.DataFrame:
    return pd.read_csv(GOLDEN / f"{name}_slips.csv").assign(**columns)


def trace(events: pd.DataFrame, duration: float = 10.0) -> pd.DataFrame:
    """Return the load at both ends of the run and of each complete event."""
    over = events.dropna(subset="end_s")
    times = [0.0, *over[["onset_s", "end_s"]].to_numpy().ravel(), duration]
    loads = [0.0, *over[["load_before_N", "load_after_N"]].to_numpy().ravel(), 150.0]
    return pd.DataFrame({"time_s": times, "tangential_load_N": loads})


def draw_scene(events: pd.DataFrame, duration: float = 10.0, **how: object):
    return scene.draw(events, trace(events, duration), **how)


def crowded_scene():
    """Draw many events, one of them cut off by the end of the run, and a negative
    measured load."""
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
        data=[style.Measured("measured", data)],
        look=NARROW,
    )


def endless_scene():
    """Draw one block that slides from the start and never stops."""
    event = {
        "onset_s": 0.0,
        "end_s": np.nan,
        "front": 1,
        "n_blocks": 1,
        "is_global": True,
        "slider_length_m": 0.25,
    }
    flat = pd.DataFrame({"time_s": [0.0, 1.0], "tangential_load_N": 0.0})
    return scene.draw(slips().iloc[[0]].assign(**event), flat)


def partial_scene():
    """Draw a scene in which a slip reaches the leading edge but none is global."""
    events = slips(is_global=False).iloc[:16]
    return draw_scene(events, 3.0, title="partial")


def other_lengths():
    """Draw scenes of equal sign, of another slider, without a global slip, without theta
    and without a slip."""
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
        tables,
        [style.Measured("measured", data)],
        title="costs $5 at most",
        look=NARROW,
    )


def one_length():
    point = style.Measured("measured", np.array([[50.0, 0.3]]))
    return precursor_lengths.draw([slips()], [point])


PICTURES = {
    "scene_crowded": (crowded_scene, NARROW),
    "scene_endless": endless_scene,
    "scene_partial": partial_scene,
    "scene_calm": lambda: draw_scene(slips().iloc[:0], look=style.Look(85.0)),
    "precursor_lengths_others": (other_lengths, NARROW),
}
