# mu_sapp over any two values of the chain

from maegawa2010.studies.grid.axes import check_axes, values_on

check_axes(config["chain"], config["grid"])


rule run_grid:
    """Run a chunk of the grid of chains."""
    output:
        chunk="results/ensembles/grid/{chunk}.csv",
    log:
        "results/logs/run_grid/{chunk}.log",
    resources:
        seconds=2,
    params:
        slider=config["chain"],
        axes=config["grid"],
        code=digest("run_grid"),
    message:
        "grid: running chunk {wildcards.chunk} of its chains"
    script:
        "../scripts/run_grid.py"


rule draw_grid:
    """Gather the runs of the grid, and draw mu_sapp over two values of the chain."""
    input:
        chunks=collect("results/ensembles/grid/{chunk}.csv", chunk=CHUNKS),
    output:
        table="results/tables/grid.csv",
        figures=[
            report(
                "results/figures/grid.svg",
                caption="../report/grid.rst",
                category="Sensitivity",
                labels={
                    "figure": f"grid: mu_sapp over {' and '.join(axis['key'] for axis in config['grid'])}"
                },
            ),
            *collect("results/figures/grid.{kind}", kind=MORE_FORMATS),
        ],
    log:
        "results/logs/draw_grid.log",
    localrule: True
    params:
        axes=config["grid"],
        scenes=[values_on(config["grid"], slider) for slider in SLIDERS.values()],
        code=digest("draw_grid"),
    message:
        "drawing mu_sapp over two values of the chain"
    script:
        "../scripts/draw_grid.py"


rule grid:
    """mu_sapp over any two values of the chain."""
    input:
        rules.draw_grid.input,
        rules.draw_grid.output,
    localrule: True


RESULTS.append(rules.grid.input)
