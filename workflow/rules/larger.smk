# Chains with a length

# Only the full study: the figure and the article are made from what is committed of it.
if config["full"]:

    rule tabulate_larger:
        """Run chains with a length to their first global slip."""
        output:
            larger=report("results/tables/larger.csv", category="Tables"),
            larger_nucleation="results/tables/larger_nucleation.csv",
        log:
            "results/logs/tabulate_larger.log",
        threads: 4
        resources:
            seconds=1200,
        params:
            slider=config["chain"],
            settings=config["larger"]["first_slips"],
            code=digest("tabulate_larger"),
        message:
            "running chains with a length to their first global slip"
        script:
            "../scripts/tabulate_larger.py"

    rule run_larger:
        """Run a chunk of the chains with a length until they settle."""
        output:
            chunk="results/ensembles/larger_members/{chunk}.csv",
        log:
            "results/logs/run_larger/{chunk}.log",
        resources:
            seconds=1200,
        params:
            slider=config["chain"],
            settings=config["larger"]["settled"],
            code=digest("run_larger"),
        message:
            "chains with a length: running chunk {wildcards.chunk} until it settles"
        script:
            "../scripts/run_larger.py"

    rule tabulate_settled:
        """Gather the settled runs of chains with a length."""
        input:
            chunks=collect("results/ensembles/larger_members/{chunk}.csv", chunk=CHUNKS),
        output:
            settled=report("results/tables/larger_settled.csv", category="Tables"),
        log:
            "results/logs/tabulate_settled.log",
        localrule: True
        params:
            slider=config["chain"],
            code=digest("tabulate_settled"),
        message:
            "gathering the settled runs of chains with a length, beside their law"
        script:
            "../scripts/tabulate_settled.py"


# Drawn from what is committed, which is about the paper's slider.
if IS_PAPERS:

    rule draw_larger:
        """Draw the settled coefficient of chains with a length."""
        input:
            settled=COMMITTED / "larger_settled_full.csv",
        output:
            report(
                "results/figures/larger.svg",
                caption="../report/larger.rst",
                category="Hierarchy",
                labels={"figure": "larger: the settled coefficient of chains with a length"},
            ),
            collect("results/figures/larger.{kind}", kind=MORE_FORMATS),
        log:
            "results/logs/draw_larger.log",
        localrule: True
        params:
            code=digest("draw_larger"),
        message:
            "drawing the settled coefficient of chains with a length"
        script:
            "../scripts/draw_larger.py"


rule larger:
    """Chains with a length."""
    input:
        rules.tabulate_larger.output if config["full"] else [],
        [rules.tabulate_settled.input, rules.tabulate_settled.output] if config["full"] else [],
        rules.draw_larger.output if IS_PAPERS else [],
    localrule: True


RESULTS.append(rules.larger.input)
