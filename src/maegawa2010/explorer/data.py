"""The data of the explorer, from the configuration and the workflow's tables."""

from collections.abc import Iterable, Mapping
from typing import Any

import pandas as pd

from maegawa2010 import printed
from maegawa2010.studies.horizon.chains import chain_duration
from maegawa2010.studies.members import TOLERANCES
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT
from maegawa2010.support.run_statistics import NOISE
from precursors.analysis.summary import apparent_friction, summary_of
from precursors.model.chain import SLIDER, Chain, parse_theta
from precursors.solver.simulate import simulate

STEP = 0.01  # change of theta after which mu_sapp of the loadings no longer agrees

Slider = Mapping[str, Any]


def explorer_data(
    sliders: Mapping[str, Slider],
    slips: Iterable[pd.DataFrame],
    tables: Mapping[str, pd.DataFrame],
    proved: Mapping[str, Slider],
) -> dict[str, Any]:
    """The data for `write_explorer`, without `duration` and `tolerance`.

    Parameters
    ----------
    sliders, slips
        Arguments of `Chain.from_slider` of each scene, and their slip tables.
    tables
        Tables of the studies: `members` and `shares` of the sliders with the same
        printed inputs, and `resolution`.
    proved
        The section `horizon.proved` of the configuration.
    """
    shares = tables["shares"].query("question == 'all_six'")
    even = min(sliders.values(), key=lambda slider: abs(slider["theta"]))
    return {
        "scenes": [
            scene_data(scene, slider, of_scene, tables)
            for (scene, slider), of_scene in zip(sliders.items(), slips, strict=True)
        ],
        "tilted": tilted(even),
        "all_six": shares[["k", "n"]].iloc[0].tolist() if len(shares) else None,
        "half_a_digit": HALF_A_DIGIT,
        "printed": [printed.MU_SAPP + way * printed.LAST_DIGIT for way in (-1, 1)],
        "noise": 100 * NOISE,
        "proved": [
            {"slider": proved_slider(values), "duration": chain_duration(values)}
            for values in proved.values()
        ],
    }


def scene_data(
    scene: str,
    slider: Slider,
    slips: pd.DataFrame,
    tables: Mapping[str, pd.DataFrame],
) -> dict[str, Any]:
    """One of the `scenes` of `write_explorer`."""
    numbers = summary_of(slips)
    members = tables["members"].query("scene == @scene and draw > 0")
    draws = members["mu_sapp"].dropna()
    agree = (draws - printed.MU_SAPP).abs() <= TOLERANCES["mu_sapp"]
    medians = tables["resolution"].query("scene == @scene and quantity == 'mu_sapp'")
    by_blocks = medians.set_index("n_blocks")["q50"]
    finest = int(by_blocks.index.max())
    return {
        "slider": slider,
        "mu_sapp": numbers.mu_sapp if numbers.reached else None,
        "draws": draws.round(4).tolist(),
        "within": {"k": int(agree.sum()), "n": len(draws)},
        "finest": {"n_blocks": finest, "mu_sapp": by_blocks[finest]},
    }


def tilted(slider: Slider) -> dict[str, float]:
    """theta and mu_sapp of a slider whose theta is larger by `STEP`."""
    theta = slider["theta"] + STEP
    chain = Chain.from_slider(**{**slider, "theta": theta})
    run = simulate(chain, until="global slip")
    return {"theta": theta, "mu_sapp": apparent_friction(run)}


def proved_slider(values: Slider) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a chain of the configuration's
    `horizon.proved`."""
    slider = {
        name: values.get(name, value)
        for name, value in SLIDER.items()
        if name != "weights"
    }
    return slider | {"theta": parse_theta(values.get("theta", 0))}
