proved = {
    chain: abs(parse_theta(config["horizon"]["proved"][chain].get("theta", 0)))
    for chain in config["horizon"]["compared"]
}
EVEN = min(proved, key=proved.get)  # the chain with the most even normal load


rule tabulate_work_precision:
    """Time all methods on a proved chain."""
    input:
        certificate=f"results/certificates/chains/{EVEN}.json.gz",
        methods=PAPERS / "methods/methods.csv",
    output:
        work_precision=report("results/tables/work_precision.csv", category="Tables"),
    log:
        "results/logs/tabulate_work_precision.log",
    resources:
        seconds=4,
    params:
        scene=EVEN,
        full=False,
        code=digest("tabulate_work_precision"),
    script:
        "tabulate_work_precision.py"


if IS_COMMITTED:

    rule check_speed:
        """Compare the committed measurements, except times, with those of this build, and copy them if they agree."""
        input:
            tables=[COMMITTED / "speed.csv", COMMITTED / "beside_heyoka.csv"],
            provenance=COMMITTED / "provenance.csv",
            measured="results/tables/work_precision.csv",
        output:
            speed=report("results/tables/speed.csv", category="Tables"),
            beside_heyoka=report("results/tables/beside_heyoka.csv", category="Tables"),
            committed="results/tables/committed_speed.csv",
        log:
            "results/logs/check_speed.log",
        localrule: True
        params:
            code=digest("check_speed"),
        script:
            "check_speed.py"

elif HAS_LONG:

    use rule tabulate_work_precision as tabulate_speed with:
        output:
            speed=report("results/tables/speed.csv", category="Tables"),
        log:
            "results/logs/tabulate_speed.log",
        resources:
            seconds=100,
        params:
            scene=EVEN,
            full=True,
            code=digest("tabulate_work_precision"),

    rule beside_heyoka:
        """Compare computing times and errors of the exact solver, heyoka.py and DOP853 in five sessions."""
        input:
            bench=ROOT / "benchmarks/bench.py",
            ensemble=ROOT / "benchmarks/heyoka_ensemble.py",
        output:
            beside_heyoka=report("results/tables/beside_heyoka.csv", category="Tables"),
        log:
            "results/logs/beside_heyoka.log",
        resources:
            seconds=300,
        params:
            python=sys.executable,
            code=digest("tabulate_work_precision"),
        shell:
            "{params.python} {input.bench} --sessions 5 --output {output} > {log}"

    PUBLISHED |= dict.fromkeys(rules.tabulate_speed.output, ("tabulate_speed", None))
    PUBLISHED |= dict.fromkeys(rules.beside_heyoka.output, ("beside_heyoka", None))


rule draw_work_precision:
    """Draw errors against computing time, from this build and from the published measurements."""
    input:
        measured="results/tables/work_precision.csv",
        published=["results/tables/speed.csv"] if HAS_LONG else [],
    output:
        measured=[
            report(
                "results/figures/work_precision.svg",
                caption="caption.rst",
                category="Accuracy",
                labels={"figure": "work_precision: what accuracy costs, measured by this build"},
            ),
            *collect("results/figures/work_precision.{kind}", kind=MORE_FORMATS),
        ],
        published=(
            [
                report(
                    "results/figures/speed.svg",
                    caption="caption_speed.rst",
                    category="Accuracy",
                    labels={"figure": "speed: what accuracy costs, as published for the paper's slider"},
                ),
                *collect("results/figures/speed.{kind}", kind=MORE_FORMATS),
            ]
            if HAS_LONG
            else []
        ),
    log:
        "results/logs/draw_work_precision.log",
    localrule: True
    params:
        code=digest("draw_work_precision"),
    script:
        "draw_work_precision.py"


rule work_precision:
    """Accuracy against computing time."""
    input:
        rules.tabulate_work_precision.output,
        collect("results/tables/{table}.csv", table=["speed", "beside_heyoka"] if HAS_LONG else []),
        rules.draw_work_precision.output,
    localrule: True


RESULTS.append(rules.work_precision.input)  # files that `all` makes
