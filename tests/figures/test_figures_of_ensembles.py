"""Figures of ensembles show every run of their tables, and nothing else."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.patches import Rectangle

from precursors.ensembles.resolution import with_estimates
from precursors.figures import style
from precursors.figures.long_runs import draw_long_runs
from precursors.figures.maps import AXES, draw_map
from precursors.figures.resolution import LABELS, draw_resolution
from precursors.figures.resolution_models import QUANTITIES, draw_resolution_models
from precursors.figures.spread import draw_spread

STIFF = {"youngs_modulus": 2.5e9, "cross_section": 1e-4}


def has_line_at(axes, place):
    """Whether a vertical line stands at a place of the x axis."""
    return any(list(line.get_xdata()) == [place, place] for line in axes.lines)


def spread_members() -> pd.DataFrame:
    alone = {
        "scene": "s",
        "theta": 0.5,
        "events_kept": 4,
        "mu_sapp": 0.5,
        "size": 0.0,
        "perturbation": "none",
    }
    noise = {"perturbation": "normal loads", "question": "loads"}
    changed = [
        {**alone, **noise, "size": size, "events_kept": 4 + k, "mu_sapp": 0.5 + 0.01 * k}
        for size in (1e-4, 1e-2)
        for k in range(3)
    ]
    sweep = [
        {**alone, "question": "theta", "perturbation": "sweep", "size": 0.1, "theta": 0.4 + 0.05 * k}
        for k in range(5)
    ]
    return pd.DataFrame([{**alone, "question": q} for q in ("loads", "theta")] + changed + sweep)


def spread_rows() -> pd.DataFrame:
    """Quantiles that are no quantiles of the members: the figure must draw the table's."""
    row = {"scene": "s", "question": "loads", "perturbation": "normal loads", "quantity": "mu_sapp"}
    quantiles = {"q05": 0.41, "q25": 0.42, "q50": 0.43, "q75": 0.44, "q95": 0.45}
    rows = [{**row, "size": size, **quantiles} for size in (1e-4, 1e-2)]
    return pd.DataFrame([*rows, {**rows[0], "quantity": "events_kept", "q50": 5.0}])


def test_bands_and_shades_are_those_of_the_ensembles():
    figure = draw_spread(spread_members(), spread_rows(), "loads")
    bands, counts = figure.axes[:2]
    [median, *_] = bands.lines
    assert median.get_ydata().tolist() == pytest.approx([0.43, 0.43])
    cells = [patch for patch in counts.patches if isinstance(patch, Rectangle)]
    assert sorted((cell.get_x() + 0.5, cell.get_y() + 0.5) for cell in cells) == [
        (position, count) for position in (0.0, 1.0) for count in (4.0, 5.0, 6.0)
    ]
    assert len({cell.get_facecolor() for cell in cells}) == 1  # a third each


def test_every_run_of_the_sweep_is_a_dot_at_its_change_of_theta():
    dots = draw_spread(spread_members(), spread_rows(), "theta").axes[0].lines[0]
    assert dots.get_xdata().tolist() == pytest.approx([-100, -50, 0, 50, 100])


def test_a_question_without_members_is_refused():
    with pytest.raises(ValueError, match="'start'"):
        draw_spread(spread_members(), spread_rows(), "start")


@pytest.mark.parametrize("name", AXES)
def test_a_cell_of_a_map_is_the_run_at_its_place(name):
    axis = AXES[name]
    seconds, thetas = (1.0, 2.0, 4.0) if axis.logarithmic else (1.0, 2.0, 3.0), (-0.5, 0.5)
    rows = [
        {
            "theta": theta,
            axis.column: second,
            "mu_sapp": 0.1 * second + theta,
            "events_kept": 3,
            "n_global": 1,
        }
        for theta in thetas
        for second in seconds
    ]
    table = pd.DataFrame(rows).assign(n_all_events=4, reached=True)
    table.loc[0, "reached"] = False
    figure = draw_map(table, name)
    kept, mu_sapp, share = (
        np.ma.filled(axes.collections[0].get_array().astype(float), np.nan) for axes in figure.axes[:3]
    )
    expected = [[0.1 * second + theta for theta in thetas] for second in seconds]
    np.testing.assert_allclose(np.reshape(mu_sapp, (3, 2)), expected)
    np.testing.assert_allclose(np.ravel(share), 25.0)
    assert np.isnan(np.ravel(kept)).tolist() == [True] + [False] * 5


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("map_theta_n_blocks", 12),
        ("map_theta_friction_ratio", 0.3),
        ("map_theta_stiffness_ratio", 0.8e6 / 30e6),
        ("map_theta_drive_velocity", 2e-4),
    ],
)
def test_crosses_of_a_map_stand_where_the_scenes_are(name, place):
    slider = {"n_blocks": 12, "mu_s": 0.5, "mu_k": 0.15, "drive_stiffness": 0.8e6, "drive_velocity": 2e-4}
    slider |= {"length": 0.1, **STIFF}
    rows = [
        {"theta": theta, AXES[name].column: second, "mu_sapp": 0.1 * second + theta, "events_kept": 3}
        for theta in (-0.5, 0.5)
        for second in (1.0, 2.0, 4.0)
    ]
    table = pd.DataFrame(rows).assign(n_all_events=4, n_global=1, reached=True)
    figure = draw_map(table, name, [{**slider, "theta": theta} for theta in (-0.4, 0.2)])
    for panel in figure.axes[:3]:
        assert len(panel.lines) == 2
        for crosses in panel.lines:
            assert crosses.get_xdata().tolist() == [-0.4, 0.2]
            assert crosses.get_ydata().tolist() == pytest.approx([place] * 2)


def test_medians_of_the_resolution_are_drawn_in_the_units_of_the_axis():
    n_blocks = np.array([2, 20, 200])
    table = pd.concat(
        pd.DataFrame({"scene": "s", "theta": 0.0, "n_blocks": n_blocks, "quantity": quantity, "q50": 1000.0})
        for quantity in LABELS
    )
    table = table.assign(q05=900.0, q95=1100.0, without_noise=1000.0)
    limits = pd.DataFrame({"scene": ["s"], "quantity": ["mu_sapp"], "a": [0.45], "a_error": [0.01]})
    slider = {"mu_s": 0.7, "mu_k": 0.45, "length": 0.1, "slider_mass": 0.012, **STIFF}
    figure = draw_resolution(with_estimates(table, slider), limits, papers_n=12)
    assert [axes.lines for axes in figure.axes if not has_line_at(axes, 12)] == []
    estimates = {
        line.get_label(): list(line.get_ydata())
        for axes in figure.axes
        for line in axes.lines
        if line.get_linestyle() == "--" and line.get_color() == style.GREEN
    }
    assert estimates == {
        r"$\mu_k + 2(\mu_s-\mu_k)/N$": pytest.approx([0.7, 0.475, 0.4525]),
        r"$c=\sqrt{ESL/M}$": pytest.approx([1.443] * 3, rel=1e-3),
    }
    medians = dict(zip(LABELS, (axes.lines[0].get_ydata().tolist() for axes in figure.axes), strict=True))
    assert medians == {"front_speed_m_per_s": [1.0] * 3} | {
        quantity: [1000.0] * 3 for quantity in LABELS if quantity != "front_speed_m_per_s"
    }


def test_the_histogram_of_a_long_run_leaves_the_first_slip_out():
    slips = pd.DataFrame({"scene": "s", "theta": 0.0, "mu": [0.6, 0.50, 0.51, 0.52, 0.53]})
    numbers = {"mu_first": 0.6, "n": 4, "mean": 0.7, "deviation": 0.02}
    statistics = pd.DataFrame([{"scene": "s", **numbers}])
    above, axes = draw_long_runs(slips, statistics).axes
    [outline] = axes.patches
    assert outline.get_xy()[:, 1].max() == pytest.approx(25.0)
    # The numbers in words are the table's.
    assert axes.get_legend().get_texts()[0].get_text().endswith(": 4 slips")
    assert above.texts[0].get_text() == r"0.700 $\pm$ 0.020"


def test_no_mark_of_a_long_run_is_on_another_scenes_row():
    slips = pd.DataFrame(
        {"scene": ["s"] * 3 + ["t"] * 3, "theta": [0.0] * 3 + [0.5] * 3, "mu": 2 * [0.48, 0.49, 0.5]}
    )
    numbers = {"mu_first": 0.48, "n": 2, "mean": 0.49, "deviation": 0.02}
    above, _ = draw_long_runs(slips, pd.DataFrame([{"scene": s, **numbers} for s in "st"])).axes
    marks = {
        (line.get_color(), float(line.get_ydata()[0])) for line in above.lines if line.get_marker() == "^"
    }
    assert sorted(row for _, row in marks) == [0.0, 1.0]
    assert len({color for color, _ in marks}) == 2


def resolution_of_models() -> pd.DataFrame:
    values = {
        "plain": (0.0, 0.0, 0.0),
        "slow": (1e-6, 0.0, 0.0),
        "viscous": (0.0, 54.77, 0.0),
        "soft": (0.0, 0.0, 25e6),
        "both": (0.0, 54.77, 25e6),
    }
    columns = ["viscous_time_s", "viscosity_N_s_per_m", "interface_stiffness_N_per_m"]
    return pd.DataFrame(
        [
            {"model": model, "theta": 0.0, **dict(zip(columns, value, strict=True)), "n_blocks": n}
            | {
                "quantity": quantity,
                "q05": 0.9 * n,
                "q50": 1.0 * n,
                "q95": 1.1 * n,
                "n": 12 if n < 100 else 6,
            }
            for model, value in values.items()
            for n in ((2, 10, 100) if model != "soft" else (2, 10))
            for quantity in QUANTITIES
        ]
    )


def runs_of_models() -> pd.DataFrame:
    table = resolution_of_models().drop(columns=["q05", "q50", "q95", "n"])
    return pd.concat([table.assign(value=share * table["n_blocks"]) for share in (0.8, 1.2)])


def test_each_model_is_a_line_in_the_row_of_its_kind_beside_the_papers_chain():
    figure = draw_resolution_models(resolution_of_models(), runs_of_models(), papers_n=10)
    names = [
        [line.get_label() for line in axes.lines if len(line.get_xdata()) > 2 or "K_t" in line.get_label()]
        for axes in figure.axes[::3]
    ]
    paper = "paper's chain"
    assert names == [
        [paper, "$t_v = 1$ µs", r"$\eta = 54.8$ N s/m"],
        [paper, "$K_t = 25$ MN/m"],
        [paper, r"$K_t = 25$ MN/m, $\eta = 54.8$ N s/m"],
    ]


def test_a_model_that_ends_early_has_a_line_that_ends_early():
    figure = draw_resolution_models(resolution_of_models(), runs_of_models(), papers_n=10)
    [soft] = [line for line in figure.axes[3].lines if "K_t" in str(line.get_label())]
    assert list(soft.get_xdata()) == [2, 10]
    assert list(soft.get_ydata()) == [2.0, 10.0]


def test_few_runs_are_dots_and_many_a_band():
    figure = draw_resolution_models(resolution_of_models(), runs_of_models(), papers_n=10)
    events_of_viscous = figure.axes[0]
    dots = [line for line in events_of_viscous.lines if line.get_marker() == "."]
    assert [sorted(zip(*line.get_data(), strict=True)) for line in dots] == [[(100, 80.0), (100, 120.0)]] * 3
    for band in events_of_viscous.collections:
        corners = np.concatenate([path.vertices for path in band.get_paths()])
        assert (corners[:, 0].min(), corners[:, 0].max()) == (2, 10)
