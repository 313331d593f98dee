rule run_printed_digits:
    """Simulate one chunk of the sliders whose inputs round to the printed digits."""
    output:
        members="results/ensembles/digits_members/{chunk}.csv",
    log:
        "results/logs/run_printed_digits/{chunk}.log",
    resources:
        seconds=2,
    params:
        sliders=SLIDERS,
        duration=config["duration"],
        settings=config["printed_digits"],
        code=digest("run_printed_digits"),
    script:
        "run_printed_digits.py"


rule tabulate_printed_digits:
    """Join the chunks, and count the sliders that give the paper's numbers."""
    input:
        chunks=collect("results/ensembles/digits_members/{chunk}.csv", chunk=CHUNKS),
    output:
        digits=report("results/tables/digits.csv", category="Tables"),
        digits_members="results/tables/digits_members.csv",
    log:
        "results/logs/tabulate_printed_digits.log",
    localrule: True
    params:
        paper={scene: printed.SCENES.get(scene, {}) for scene in FIG13},
        code=digest("tabulate_printed_digits"),
    script:
        "tabulate_printed_digits.py"


if IS_PAPER_SLIDER:

    rule draw_printed_digits:
        """Draw the paper's six numbers, and how often runs with noise or other digits give the same counts."""
        input:
            slips=SLIPS,
            noise="results/tables/noise_members.csv",
            members="results/tables/digits_members.csv",
            shares="results/tables/digits.csv",
        output:
            report(
                "results/figures/hero.svg",
                caption="caption.rst",
                category="Sensitivity",
                labels={
                    "figure": "hero: the paper's six numbers, and how often the counts survive noise and other digits"
                },
            ),
            collect("results/figures/hero.{kind}", kind=MORE_FORMATS),
        log:
            "results/logs/draw_printed_digits.log",
        localrule: True
        params:
            code=digest("draw_printed_digits"),
        script:
            "draw_printed_digits.py"


rule printed_digits:
    """Sensitivity to digits that the paper does not print."""
    input:
        rules.tabulate_printed_digits.input,  # so that a deleted chunk is made again
        rules.tabulate_printed_digits.output,
        rules.draw_printed_digits.output if IS_PAPER_SLIDER else [],
    localrule: True


RESULTS.append(rules.printed_digits.input)  # files that `all` makes
