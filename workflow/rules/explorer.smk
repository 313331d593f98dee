rule write_explorer:
    """Write the interactive page, which solves the chain in the browser."""
    input:
        page=sorted(
            path for path in (PAPERS / "explorer").iterdir() if path.suffix in (".js", ".css", ".html")
        ),
        slips=SLIPS,
        members="results/tables/digits_members.csv",
        shares="results/tables/digits.csv",
        resolution="results/tables/resolution.csv",
    output:
        page="results/explorer.html",
    log:
        "results/logs/write_explorer.log",
    localrule: True
    params:
        sliders=SLIDERS,
        proved=config["horizon"]["proved"],
        numbers={"duration": config["duration"], "tolerance": config["horizon"]["tolerance"]},
        code=digest("write_explorer"),
    script:
        "../scripts/write_explorer.py"


rule explorer:
    """The interactive page results/explorer.html."""
    input:
        rules.write_explorer.output,
    localrule: True


RESULTS.append(rules.explorer.input)
