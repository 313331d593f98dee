"""Write the explorer: one HTML page that solves the chain in the browser."""

from typing import Any

import pandas as pd

from maegawa2010 import printed
from maegawa2010.explorer.page import proved_slider, write_explorer
from maegawa2010.studies.horizon.chains import chain_duration
from maegawa2010.studies.members import TOLERANCES
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT
from maegawa2010.support.job import job
from maegawa2010.support.run_statistics import NOISE
from precursors import Chain, apparent_friction, simulate
from precursors.analysis.summary import summary_of

STEP = 0.01  # of theta, after which the paper's loadings no longer agree


def scene_data(
    scene: str,
    slider: dict[str, Any],
    slips: pd.DataFrame,
    members: pd.DataFrame,
    resolution: pd.DataFrame,
) -> dict[str, Any]:
    """What the page has of a scene: see `write_explorer`."""
    found = summary_of(slips)
    draws = members.query("scene == @scene and draw > 0")["mu_sapp"].dropna()
    agree = (draws - printed.MU_SAPP).abs() <= TOLERANCES["mu_sapp"]
    medians = resolution.query("scene == @scene and quantity == 'mu_sapp'")
    by_blocks = medians.set_index("n_blocks")["q50"]
    finest = int(by_blocks.index.max())
    return {
        "slider": slider,
        "mu_sapp": found.mu_sapp if found.reached else None,
        "draws": draws.round(4).tolist(),
        "within": {"k": int(agree.sum()), "n": len(draws)},
        "finest": {"n_blocks": finest, "mu_sapp": by_blocks[finest]},
    }


def tilted(slider: dict[str, Any]) -> dict[str, float]:
    """mu_sapp of a slider whose theta is larger by `STEP`."""
    theta = slider["theta"] + STEP
    run = simulate(Chain.from_slider(**slider | {"theta": theta}), until="global slip")
    return {"theta": theta, "mu_sapp": apparent_friction(run)}


with job() as snakemake:
    params = snakemake.params
    tables = [pd.read_csv(snakemake.input[name]) for name in ("members", "resolution")]
    slips = map(pd.read_csv, snakemake.input.slips)
    shares = pd.read_csv(snakemake.input.shares).query("question == 'all_six'")
    scenes = [
        scene_data(scene, slider, of_scene, *tables)
        for (scene, slider), of_scene in zip(params.sliders.items(), slips, strict=True)
    ]
    even = min(params.sliders.values(), key=lambda slider: abs(slider["theta"]))
    data = {
        "scenes": scenes,
        "tilted": tilted(even),
        "all_six": shares[["k", "n"]].iloc[0].tolist() if len(shares) else None,
        "half_a_digit": HALF_A_DIGIT,
        "printed": [printed.MU_SAPP + way * printed.LAST_DIGIT for way in (-1, 1)],
        "noise": 100 * NOISE,
        "proved": [
            {"slider": proved_slider(values), "duration": chain_duration(values)}
            for values in params.proved.values()
        ],
    }
    write_explorer(data | params.numbers, snakemake.output.page)
